//! Linear constraints between displacements of bodies' nodes: `*EQUATION` after eliminating nodes without cells, and
//! supports along local axes or in some of the steps only.

use std::collections::{BTreeMap, BTreeSet};

use super::activation::Activation;
use super::document::{Document, Names, quoted};
use super::equations::Equation;
use super::groups::Groups;
use super::place::Places;
use super::reference::NodeAxis;
use super::steps::{LoadStep, Steps};
use crate::error::InputError;
use crate::mesh::abaqus::LinePlace;

/// Relative size of coefficients that count as 0.
const ROUND_OFF: f64 = 1e-12;

/// Coefficients by nodes and the axes of the scene.
type Terms = BTreeMap<NodeAxis, f64>;

/// Σ factor · displacement = value.
pub(super) struct Condition {
    place: Option<LinePlace>,
    terms: Terms,
    /// Values by step; `None` where the constraint is inactive.
    values: Vec<Option<f64>>,
    /// The plain name of constraints with values.
    word: &'static str,
    /// True if activation fixes the current displacements.
    is_kept: bool,
}

/// A constraint in the syntax of the scene.
pub(super) struct SceneEquation {
    name: Option<String>,
    /// Groups, axes and coefficients.
    terms: Vec<(String, usize, f64)>,
    values: Vec<Option<f64>>,
    is_kept: bool,
}

impl Condition {
    /// Adds a multiple of another constraint.
    fn add(&mut self, factor: f64, other: &Self) {
        for (&dof, term) in &other.terms {
            let sum = self.terms.entry(dof).or_default();
            *sum += factor * term;
            if sum.abs() <= f64::EPSILON * (factor * term).abs() {
                self.terms.remove(&dof);
            }
        }
        for (sum, value) in self.values.iter_mut().zip(&other.values) {
            *sum = sum.zip(*value).map(|(sum, value)| sum + factor * value);
        }
    }
}

/// The constraints of a deck. Forces on nodes without cells are transferred to the nodes that these depend on, and
/// supports that become constraints are removed from the steps.
///
/// # Errors
/// An equation of a reference node, one that contradicts supports of its nodes, a node without cells that is held in
/// some of the steps only.
pub(super) fn all(
    places: &Places,
    equations: &[Equation],
    steps: &mut Steps,
) -> Result<Vec<Condition>, InputError> {
    let has_cell = places.with_cells();
    let mut all = Vec::new();
    for equation in equations {
        all.push(along_axes(places, equation, steps)?);
    }
    let dofs = all.iter().flat_map(|condition| condition.terms.keys());
    let loose: BTreeSet<NodeAxis> = dofs
        .copied()
        .filter(|dof| !has_cell[dof.0 as usize])
        .collect();
    for dof in loose {
        all = without(places, dof, all, &mut steps.done)?;
    }
    let held = steps
        .done
        .iter()
        .flat_map(|step| step.supports.values().flatten());
    let largest = held
        .flatten()
        .fold(0.0, |largest: f64, value| largest.max(value.abs()));
    for condition in &all {
        let mut values = condition.values.iter().flatten();
        let wrong = values.find(|value| value.abs() > ROUND_OFF * largest);
        if let (true, Some(value), Some(place)) =
            (condition.terms.is_empty(), wrong, condition.place)
        {
            let message = format!(
                "supports of its nodes contradict the equation by {value:e}; expected supports that agree with it"
            );
            return Err(places.source.error(place, message));
        }
    }
    all.retain(|condition| !condition.terms.is_empty());
    all.extend(passing(&has_cell, steps));
    all.extend(turned(places, steps));
    Ok(all)
}

/// An equation along the axes of the scene.
fn along_axes(
    places: &Places,
    equation: &Equation,
    steps: &Steps,
) -> Result<Condition, InputError> {
    let mut terms = Terms::new();
    for &((node, axis), factor) in &equation.terms {
        if steps.loads.references.contains_key(&node) {
            let message = "an equation of the reference node of a coupling isn't supported; expected nodes of bodies";
            return Err(places.source.error(equation.place, message));
        }
        for (k, part) in direction(places, steps, (node, axis))
            .into_iter()
            .enumerate()
        {
            if part != 0.0 {
                *terms.entry((node, k)).or_default() += factor * part;
            }
        }
    }
    Ok(Condition {
        place: Some(equation.place),
        terms,
        values: vec![Some(0.0); steps.done.len()],
        word: "prescribed",
        is_kept: false,
    })
}

/// The direction of a local axis of a node.
fn direction(places: &Places, steps: &Steps, (node, axis): NodeAxis) -> [f64; 3] {
    match steps.systems.get(&node) {
        Some(system) => system.at(places.deck.points[node as usize])[axis],
        None => std::array::from_fn(|k| f64::from(u8::from(k == axis))),
    }
}

/// Eliminates a displacement of a node without cells from the constraints. If it is prescribed, it becomes part of the
/// constraints' values; otherwise the first constraint with it is solved for it and substituted into the others, and
/// its force is transferred to that constraint's other nodes.
fn without(
    places: &Places,
    dof: NodeAxis,
    mut all: Vec<Condition>,
    steps: &mut [LoadStep],
) -> Result<Vec<Condition>, InputError> {
    let (node, axis) = dof;
    let held = steps
        .iter()
        .map(|step| step.supports.get(&node).and_then(|held| held[axis]));
    let held: Vec<Option<f64>> = held.collect();
    if held.iter().all(Option::is_some) {
        for condition in &mut all {
            let Some(factor) = condition.terms.remove(&dof) else {
                continue;
            };
            for (value, held) in condition.values.iter_mut().zip(&held) {
                *value = value.zip(*held).map(|(value, held)| value - factor * held);
            }
        }
        return Ok(all);
    }
    if let Some(step) = held
        .iter()
        .position(|other| other.is_some() != held[0].is_some())
    {
        let message = format!(
            "supports of the node {}, which is of no body, begin or end in this step, which isn't supported; expected the same in \
             every step",
            places.deck.node_tags[node as usize]
        );
        return Err(places.source.error(steps[step].place, message));
    }
    let Some(first) = all
        .iter()
        .position(|condition| condition.terms.contains_key(&dof))
    else {
        return Ok(all);
    };
    let mut own = all.remove(first);
    let factor = own.terms.remove(&dof).unwrap_or(1.0);
    for step in steps {
        let load = step.forces.get(&node).map_or(0.0, |force| force[axis]);
        for (&(other, k), term) in own.terms.iter().filter(|_| load != 0.0) {
            step.forces.entry(other).or_default()[k] -= term / factor * load;
        }
    }
    for other in &mut all {
        if let Some(term) = other.terms.remove(&dof) {
            other.add(-term / factor, &own);
        }
    }
    Ok(all)
}

/// Constraints for supports of bodies' nodes that hold in some of the steps only; they are removed from the steps.
fn passing(has_cell: &[bool], steps: &mut Steps) -> Vec<Condition> {
    let (fixed, systems) = (&steps.loads.fixed, &steps.systems);
    // The axes of a node with a local system are local there.
    let is_kept = |(node, axis): NodeAxis| match systems.contains_key(&node) {
        true => (0..3).any(|local| fixed.contains(&(node, local))),
        false => fixed.contains(&(node, axis)),
    };
    let steps = &mut steps.done;
    let held = |step: &LoadStep, (node, axis): NodeAxis| {
        step.supports.get(&node).and_then(|held| held[axis])
    };
    let of_step = |step: &LoadStep| {
        let axes = step
            .supports
            .keys()
            .flat_map(|&node| (0..3).map(move |axis| (node, axis)));
        axes.filter(|dof| held(step, *dof).is_some())
            .collect::<Vec<_>>()
    };
    let dofs: BTreeSet<NodeAxis> = steps.iter().flat_map(of_step).collect();
    let mut all = Vec::new();
    for dof in dofs.into_iter().filter(|dof| has_cell[dof.0 as usize]) {
        let values: Vec<Option<f64>> = steps.iter().map(|step| held(step, dof)).collect();
        if values.iter().all(Option::is_some) {
            continue;
        }
        for of_node in steps
            .iter_mut()
            .filter_map(|step| step.supports.get_mut(&dof.0))
        {
            of_node[dof.1] = None;
        }
        all.push(Condition {
            place: None,
            terms: BTreeMap::from([(dof, 1.0)]),
            values,
            word: "support",
            is_kept: is_kept(dof),
        });
    }
    for step in steps {
        (step.supports).retain(|_, held| held.iter().any(Option::is_some));
    }
    all
}

/// Constraints for supports along local axes other than the scene's.
fn turned(places: &Places, steps: &Steps) -> Vec<Condition> {
    let dofs: BTreeSet<NodeAxis> = (steps.done.iter())
        .flat_map(|step| step.turned.keys().copied())
        .collect();
    let condition = |dof| {
        let parts = (0..)
            .zip(direction(places, steps, dof))
            .filter(|(_, part)| *part != 0.0);
        Condition {
            place: None,
            terms: parts.map(|(k, part)| ((dof.0, k), part)).collect(),
            values: steps
                .done
                .iter()
                .map(|step| step.turned.get(&dof).copied())
                .collect(),
            word: "support along a local axis",
            is_kept: steps.loads.fixed.contains(&dof),
        }
    };
    dofs.into_iter().map(condition).collect()
}

/// The constraints with the groups of their nodes; those with the same values in all steps share a name that isn't in
/// `names`.
pub(super) fn in_scene(
    conditions: &[Condition],
    groups: &mut Groups,
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
        let terms = condition
            .terms
            .iter()
            .filter_map(|(&(node, axis), &factor)| {
                Some((groups.of_nodes(&[node], "equation")?, axis, factor))
            });
        SceneEquation {
            name,
            terms: terms.collect(),
            values: condition.values.clone(),
            is_kept: condition.is_kept,
        }
    };
    conditions.iter().map(equation).collect()
}

impl SceneEquation {
    /// Writes the equation.
    pub(super) fn write(&self, document: &mut Document) {
        let term = |(group, axis, factor): &(String, usize, f64)| {
            let component = ["x", "y", "z"][*axis];
            format!(
                "{{ at = {}, component = \"{component}\", factor = {factor:?} }}",
                quoted(group)
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
    }

    /// The steps in which it is active; `None` if it is active in all.
    pub(super) fn activation(&self) -> Option<Activation> {
        let name = self.name.clone().filter(|_| self.values.contains(&None))?;
        let steps = self.values.iter().map(Option::is_some).collect();
        Some(Activation { name, steps })
    }
}

/// Writes the values of a step, if they vary.
pub(super) fn write_step(all: &[SceneEquation], step: usize, document: &mut Document) {
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
