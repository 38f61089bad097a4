//! Linear constraints between displacements of bodies' nodes: `*EQUATION` after eliminating nodes without cells, and
//! supports along local axes or in some of the steps only, also those of reference points.

mod scene_equation;

use std::collections::{BTreeMap, BTreeSet};

pub(super) use self::scene_equation::{SceneEquation, Translator, in_scene, write_step};
use super::equations::Equation;
use super::loads::Loads;
use super::place::Places;
use super::reference::NodeAxis;
use super::steps::{LoadStep, Steps};
use crate::error::InputError;
use crate::mesh::abaqus::LinePlace;

/// The plain name of equations.
const EQUATION: &str = "prescribed";

/// Relative size of coefficients that count as 0.
const ROUND_OFF: f64 = 1e-12;

/// Coefficients by nodes and the axes of the scene, or the components of reference points.
pub(super) type Terms = BTreeMap<NodeAxis, f64>;

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
/// An equation of a pretension's node, one that contradicts supports of its nodes.
pub(super) fn all(
    places: &Places,
    equations: &[Equation],
    steps: &mut Steps,
) -> Result<Vec<Condition>, InputError> {
    let has_cell = places.with_cells();
    let is_loose =
        |node: u32| !has_cell[node as usize] && !steps.loads.references.contains_key(&node);
    let mut all = Vec::new();
    for equation in equations {
        all.push(along_axes(places, equation, steps)?);
    }
    let dofs = all.iter().flat_map(|condition| condition.terms.keys());
    let loose: BTreeSet<NodeAxis> = dofs.copied().filter(|dof| is_loose(dof.0)).collect();
    for dof in loose {
        all = without(dof, &steps.loads, all, &mut steps.done);
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
        let refused = |why: &str| {
            let message = format!(
                "*EQUATION: the degree of freedom {} of the node {} {why}",
                axis + 1,
                places.deck.node_tags[node as usize]
            );
            places.source.error(equation.place, message)
        };
        if let Some(reference) = steps.loads.references.get(&node) {
            let component = reference.of_equation(axis, places.dim()).map_err(refused)?;
            *terms.entry(component).or_default() += factor;
            continue;
        }
        if axis >= places.dim() {
            return Err(refused(
                "is no displacement; expected one, or a reference node",
            ));
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
        word: EQUATION,
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
/// its force is transferred to that constraint's other nodes. A support in some of the steps is another constraint.
fn without(
    dof: NodeAxis,
    Loads {
        fixed, references, ..
    }: &Loads,
    mut all: Vec<Condition>,
    steps: &mut [LoadStep],
) -> Vec<Condition> {
    let (node, axis) = dof;
    let is_kept = fixed.contains(&dof);
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
        return all;
    }
    if let Some(first) = held.iter().position(Option::is_some) {
        all.push(support(dof, Some(steps[first].place), held, is_kept));
    }
    let Some(first) = all
        .iter()
        .position(|condition| condition.terms.contains_key(&dof))
    else {
        return all;
    };
    let mut own = all.remove(first);
    let factor = own.terms.remove(&dof).unwrap_or(1.0);
    for step in steps {
        let load = step.forces.get(&node).map_or(0.0, |force| force[axis]);
        for (&(other, k), term) in own.terms.iter().filter(|_| load != 0.0) {
            let of_point = references
                .contains_key(&other)
                .then(|| step.references.entry(other).or_default());
            let force = match of_point {
                Some(at) => &mut at.load[..],
                None => step.forces.entry(other).or_default(),
            };
            force[k] -= term / factor * load;
        }
    }
    for other in &mut all {
        if let Some(term) = other.terms.remove(&dof) {
            other.add(-term / factor, &own);
        }
    }
    all
}

/// The constraint for a support that holds in some of the steps only.
fn support(
    dof: NodeAxis,
    place: Option<LinePlace>,
    values: Vec<Option<f64>>,
    is_kept: bool,
) -> Condition {
    Condition {
        place,
        terms: BTreeMap::from([(dof, 1.0)]),
        values,
        word: "support",
        is_kept,
    }
}

/// Constraints for supports of bodies' nodes and of reference points of couplings that hold in some of the steps only;
/// they are removed from the steps.
fn passing(has_cell: &[bool], steps: &mut Steps) -> Vec<Condition> {
    let (fixed, systems, references) =
        (&steps.loads.fixed, &steps.systems, &steps.loads.references);
    // The axes of a node with a local system are local there.
    let is_kept = |(node, axis): NodeAxis| match systems.contains_key(&node) {
        true => (0..3).any(|local| fixed.contains(&(node, local))),
        false => fixed.contains(&(node, axis)),
    };
    let is_here = |node: u32| match references.get(&node) {
        Some(reference) => !reference.is_local && !reference.is_of_pretension(),
        None => has_cell[node as usize],
    };
    let steps = &mut steps.done;
    let dofs: BTreeSet<NodeAxis> = steps.iter().flat_map(LoadStep::held).collect();
    let mut all = Vec::new();
    for dof in dofs.into_iter().filter(|dof| is_here(dof.0)) {
        let mut of_steps: Vec<_> = steps.iter_mut().map(|step| step.support(dof)).collect();
        let values: Vec<Option<f64>> = (of_steps.iter())
            .map(|held| held.as_deref().copied().flatten())
            .collect();
        if values.iter().all(Option::is_some) {
            continue;
        }
        of_steps.iter_mut().flatten().for_each(|held| **held = None);
        all.push(support(dof, None, values, is_kept(dof)));
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
