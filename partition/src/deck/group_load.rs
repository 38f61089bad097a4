//! Loads and supports on groups of the mesh, each with its values in all steps.

use std::collections::{BTreeMap, BTreeSet};

use super::document::{Document, quoted, vector};
use super::groups::Groups;
use super::steps::Steps;
use crate::error::InputError;
use crate::mesh::abaqus::Source;

/// The values of a load in all steps, as bits, by which loads with equal values are grouped.
type LoadHistory<V> = Vec<Option<V>>;

/// A load on a group of the mesh: its table, the group, its key, and its value in each step.
pub(super) struct OnGroup {
    pub(super) list: &'static str,
    on: String,
    /// Key and value.
    pub(super) values: LoadHistory<Vec<(&'static str, String)>>,
}

impl OnGroup {
    /// Writes its values in a step.
    pub(super) fn write(&self, step: usize, within: &str, document: &mut Document) {
        let Some(values) = &self.values[step] else {
            return;
        };
        document.table(&format!("[[{within}{}]]", self.list));
        document.key("on", quoted(&self.on));
        values
            .iter()
            .for_each(|(key, value)| document.key(key, value));
    }
}

/// Translation of loads and supports to groups of the mesh.
pub(super) struct OnGroups<'a, 'b, 'c> {
    pub(super) steps: &'a Steps,
    pub(super) dim: usize,
    /// Thickness of plane sections: forces of the scene are per thickness.
    pub(super) thickness: f64,
    pub(super) groups: Groups<'b, 'c>,
}

impl OnGroups<'_, '_, '_> {
    /// All loads and supports.
    ///
    /// # Errors
    /// Supports that differ between steps in their nodes or axes.
    pub(super) fn all(&mut self, source: &Source) -> Result<Vec<OnGroup>, InputError> {
        let steps = &self.steps.done;
        let mut all = self.supports(source)?;
        self.add_pressures(&mut all);
        self.add_tractions(&mut all);
        let (dim, thickness) = (self.dim, self.thickness);
        let force = |force: &[f64; 3]| {
            let is_there = force.iter().any(|&component| component != 0.0);
            is_there.then(|| vector(&force.map(|component| component / thickness), dim))
        };
        for (nodes, course) in together(steps.iter().map(|step| &step.forces), force) {
            if let Some(on) = self.groups.of_nodes(&nodes, "force") {
                all.push(OnGroup {
                    list: "force",
                    on,
                    values: of_key(course, "each"),
                });
            }
        }
        Ok(all)
    }

    /// Appends the pressures to `all`, those on faces of elements before those on surfaces.
    fn add_pressures(&mut self, all: &mut Vec<OnGroup>) {
        let steps = &self.steps.done;
        for (faces, course) in
            together(steps.iter().map(|step| &step.faces), |&value| number(value))
        {
            let on = self.groups.of_faces(&faces);
            all.push(OnGroup {
                list: "pressure",
                on,
                values: of_key(course, "value"),
            });
        }
        let surfaces: BTreeSet<&String> =
            steps.iter().flat_map(|step| step.surfaces.keys()).collect();
        for surface in surfaces {
            let course = steps
                .iter()
                .map(|step| step.surfaces.get(surface).and_then(|&value| number(value)));
            let on = self.groups.of_surface(surface);
            all.push(OnGroup {
                list: "pressure",
                on,
                values: of_key(course.collect(), "value"),
            });
        }
    }

    /// Appends the tractions on surfaces to `all`.
    fn add_tractions(&mut self, all: &mut Vec<OnGroup>) {
        let steps = &self.steps.done;
        let tractions: BTreeSet<&(String, usize)> = steps
            .iter()
            .flat_map(|step| step.tractions.keys())
            .collect();
        for key in tractions {
            let direction = self.steps.loads.directions[key.1];
            let course = steps.iter().map(|step| {
                let value = step
                    .tractions
                    .get(key)
                    .copied()
                    .filter(|&value| value != 0.0)?;
                Some(vector(
                    &direction.map(|component| value * component),
                    self.dim,
                ))
            });
            let course = of_key(course.collect(), "value");
            let on = self.groups.of_surface(&key.0);
            all.push(OnGroup {
                list: "traction",
                on,
                values: course,
            });
        }
    }

    /// Prescribed displacements.
    ///
    /// # Errors
    /// Supports that differ between steps in their nodes or axes.
    fn supports(&mut self, source: &Source) -> Result<Vec<OnGroup>, InputError> {
        let steps = &self.steps.done;
        let axes = |held: &[Option<f64>; 3]| held.map(|value| value.is_some());
        let mut all = Vec::new();
        let shown = |held: &[Option<f64>; 3]| {
            let keys = ["x", "y", "z"].into_iter().zip(held);
            let keys =
                keys.filter_map(|(key, value)| Some((key, format!("{:?}", (*value)? + 0.0))));
            Some((axes(held), keys.collect::<Vec<_>>()))
        };
        for (nodes, course) in together(steps.iter().map(|step| &step.supports), shown) {
            let Some(on) = self.groups.of_nodes(&nodes, "support") else {
                continue;
            };
            let held = |of_step: &Option<([bool; 3], _)>| of_step.as_ref().map(|(axes, _)| *axes);
            if let Some(other) = course
                .iter()
                .position(|of_step| held(of_step) != held(&course[0]))
            {
                let message = format!(
                    "supports begin or end in this step, on {} nodes ({on}), which isn't supported yet; expected the same \
                     degrees of freedom in every step",
                    nodes.len()
                );
                return Err(source.error(steps[other].place, message));
            }
            let values = course
                .into_iter()
                .map(|of_step| of_step.map(|(_, values)| values));
            all.push(OnGroup {
                list: "displacement",
                on,
                values: values.collect(),
            });
        }
        Ok(all)
    }
}

/// A nonzero number, as text.
fn number(value: f64) -> Option<String> {
    (value != 0.0).then(|| format!("{value:?}"))
}

fn of_key(
    course: LoadHistory<String>,
    key: &'static str,
) -> LoadHistory<Vec<(&'static str, String)>> {
    let values = course.into_iter();
    values
        .map(|value| value.map(|value| vec![(key, value)]))
        .collect()
}

/// Groups of keys with the same values in all steps, in the order of their smallest key; keys without values are left
/// out.
fn together<'a, K: Ord + Clone + 'a, V: 'a, T: Ord>(
    steps: impl Iterator<Item = &'a BTreeMap<K, V>> + Clone,
    shown: impl Fn(&V) -> Option<T>,
) -> Vec<(Vec<K>, LoadHistory<T>)> {
    let keys: BTreeSet<&K> = steps.clone().flat_map(|step| step.keys()).collect();
    let mut found: BTreeMap<LoadHistory<T>, Vec<K>> = BTreeMap::new();
    for key in keys {
        let course: LoadHistory<T> = steps
            .clone()
            .map(|step| step.get(key).and_then(&shown))
            .collect();
        if course.iter().any(Option::is_some) {
            found.entry(course).or_default().push(key.clone());
        }
    }
    let mut classes: Vec<(Vec<K>, LoadHistory<T>)> = found
        .into_iter()
        .map(|(course, keys)| (keys, course))
        .collect();
    classes.sort_by(|(one, _), (other, _)| one[0].cmp(&other[0]));
    classes
}
