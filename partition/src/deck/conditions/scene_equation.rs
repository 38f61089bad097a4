//! Translation of conditions to the scene.

use std::collections::BTreeMap;

use super::{Condition, EQUATION, Terms};
use crate::deck::activation::Activation;
use crate::deck::document::{Document, Names, quoted};
use crate::deck::groups::Groups;
use crate::deck::reference::NodeAxis;
use crate::scene::coupling::COMPONENTS;

/// A constraint, or with a stiffness a spring, in the syntax of the scene.
pub(in crate::deck) struct SceneEquation {
    name: Option<String>,
    /// Key and value of the place, component and coefficient.
    terms: Vec<(&'static str, String, usize, f64)>,
    values: Vec<Option<f64>>,
    is_kept: bool,
    is_support: bool,
    stiffness: Option<f64>,
}

/// Translation of terms to the scene.
pub(in crate::deck) struct Translator<'a, 'b, 'c> {
    pub(in crate::deck) groups: &'a mut Groups<'b, 'c>,
    /// The names of couplings by their reference nodes.
    pub(in crate::deck) couplings: BTreeMap<u32, String>,
}

/// The constraints with the groups of their nodes; those with the same values in all steps share a name that isn't in
/// `names`.
pub(in crate::deck) fn in_scene(
    conditions: &[Condition],
    translator: &mut Translator,
    names: &mut Names,
) -> Vec<SceneEquation> {
    let mut known: BTreeMap<(&str, bool, Vec<Option<u64>>), String> = BTreeMap::new();
    let equation = |condition: &Condition| {
        let bits = condition.values.iter().map(|value| value.map(f64::to_bits));
        let is_plain = condition.values.iter().all(|value| *value == Some(0.0));
        let name = (!is_plain || condition.place.is_none()).then(|| {
            let key = (condition.word, condition.is_kept, bits.collect());
            known
                .entry(key)
                .or_insert_with(|| names.unique(condition.word))
                .clone()
        });
        SceneEquation {
            name,
            terms: translator.terms(&condition.terms),
            values: condition.values.clone(),
            is_kept: condition.is_kept,
            is_support: condition.word != EQUATION,
            stiffness: None,
        }
    };
    conditions.iter().map(equation).collect()
}

impl Translator<'_, '_, '_> {
    /// The terms in the syntax of the scene.
    fn terms(&mut self, terms: &Terms) -> Vec<(&'static str, String, usize, f64)> {
        let term = |(&(node, axis), &factor): (&NodeAxis, &f64)| {
            let (key, place) = match self.couplings.get(&node) {
                Some(coupling) => ("coupling", coupling.clone()),
                None => ("at", self.groups.of_nodes(&[node], "equation")?),
            };
            Some((key, place, axis, factor))
        };
        terms.iter().filter_map(term).collect()
    }

    /// A spring whose force is `stiffness` times the sum of the terms.
    pub(in crate::deck) fn spring(
        &mut self,
        name: String,
        terms: &Terms,
        stiffness: f64,
    ) -> SceneEquation {
        SceneEquation {
            name: Some(name),
            terms: self.terms(terms),
            values: Vec::new(),
            is_kept: false,
            is_support: false,
            stiffness: Some(stiffness),
        }
    }
}

impl SceneEquation {
    /// Its name if it is a support, whose force is a reaction.
    pub(in crate::deck) fn support(&self) -> Option<&str> {
        self.name.as_deref().filter(|_| self.is_support)
    }

    /// Writes the equation.
    pub(in crate::deck) fn write(&self, document: &mut Document) {
        let term = |(key, place, axis, factor): &(&str, String, usize, f64)| {
            format!(
                "{{ {key} = {}, component = \"{}\", factor = {factor:?} }}",
                quoted(place),
                COMPONENTS[*axis]
            )
        };
        let terms: Vec<String> = self.terms.iter().map(term).collect();
        document.table("[[equation]]");
        if let Some(name) = &self.name {
            document.key("name", quoted(name));
        }
        document.key("terms", format!("[\n    {},\n]", terms.join(",\n    ")));
        let mut values = self.values.iter().copied().flatten();
        if let Some(value) = values.next().filter(|value| *value != 0.0) {
            document.key("value", format!("{value:?}"));
        }
        if self.values.iter().any(Option::is_none) && !self.is_kept {
            document.key("absolute", "true");
        }
        if let Some(stiffness) = self.stiffness {
            document.key("stiffness", format!("{stiffness:?}"));
        }
    }

    /// The steps in which it is active; `None` if it is active in all.
    pub(in crate::deck) fn activation(&self) -> Option<Activation> {
        let name = self.name.clone().filter(|_| self.values.contains(&None))?;
        let steps = self.values.iter().map(Option::is_some).collect();
        Some(Activation { name, steps })
    }
}

/// Writes the values of a step, if they vary.
pub(in crate::deck) fn write_step(all: &[SceneEquation], step: usize, document: &mut Document) {
    let varies = |of: &&SceneEquation| {
        let mut values = of.values.iter().flatten();
        let first = values.next();
        values.any(|value| Some(value) != first)
    };
    let own = all.iter().filter(varies);
    let values: BTreeMap<&str, f64> =
        (own.filter_map(|of| Some((of.name.as_deref()?, of.values[step]?)))).collect();
    if !values.is_empty() {
        document.table("[step.equation]");
    }
    for (name, value) in values {
        document.key(&quoted(name), format!("{value:?}"));
    }
}
