//! Motions in load steps: of obstacles, the values of equations, and the reference points of couplings.

use std::collections::BTreeMap;

use super::condition::Obstacle;
use super::contact::{Contact, Partner};
use super::coupling::{COMPONENTS, CouplingKind};
use super::fault::{Fault, entry};
use super::material::PlaneState;
use super::number::ConstantVector;
use super::place::Step;
use super::step::LoadStep;
use super::{Scene, suggest};
use crate::element::geometry::length;

impl Scene {
    /// The displacement of every moving obstacle, by the name of its contact, in all load steps (m), or a single one
    /// without steps.
    pub fn motions(&self) -> BTreeMap<&str, Vec<[f64; 3]>> {
        let of_contact = |(contact, _): (&'_ Contact, &Obstacle)| {
            let own = contact.motion.as_ref().map(|motion| motion.value);
            let in_step = |step: &LoadStep| {
                let given = step.motion.get(&contact.name).map(|motion| motion.value);
                let motion = given.or(own).unwrap_or_default();
                motion.map(|c| step.scale.displacement * c)
            };
            match self.step.is_empty() {
                true => own.into_iter().collect(),
                false => self.step.iter().map(in_step).collect::<Vec<_>>(),
            }
        };
        let all = self.obstacles();
        let all =
            all.map(|(_, contact, obstacle)| (&contact.name[..], of_contact((contact, obstacle))));
        all.filter(|(_, motion)| motion.iter().any(|m| *m != [0.0; 3]))
            .collect()
    }

    /// The contacts with obstacles, each with its index in the list.
    fn obstacles(&self) -> impl Iterator<Item = (usize, &Contact, &Obstacle)> {
        let all = self.contact.iter().enumerate();
        all.filter_map(|(index, declared)| match declared.contact() {
            Some(contact) => match &contact.partner {
                Partner::Obstacle(obstacle) => Some((index, contact, obstacle)),
                Partner::Side(_) => None,
            },
            None => None,
        })
    }

    /// A step with a motion of an unknown obstacle, or a value of an unknown equation.
    pub(super) fn wrong_motion(&self) -> Option<Fault> {
        for (index, step) in self.step.iter().enumerate() {
            let path =
                |list: &str, name: &str| [entry("step", index, list), vec![name.into()]].concat();
            let known = || self.obstacles().map(|(_, contact, _)| &contact.name[..]);
            if let Some(name) = step
                .motion
                .keys()
                .find(|name| known().all(|of| of != **name))
            {
                let hint = suggest::hint_and_known(name, known());
                return Some((
                    path("motion", name),
                    format!("there is no contact '{name}' with an obstacle{hint}"),
                ));
            }
            let known = || self.equation.iter().map(|of| &of.name[..]);
            if let Some(name) = step
                .equation
                .keys()
                .find(|name| known().all(|of| of != **name))
            {
                let hint = suggest::hint_and_known(name, known());
                return Some((
                    path("equation", name),
                    format!("there is no equation '{name}'{hint}"),
                ));
            }
        }
        None
    }

    /// Checks the dimension of motions, couplings, pretensions and cyclic symmetries.
    pub(super) fn motions_of_wrong_dimension(
        &self,
        dim: usize,
        check: &mut impl FnMut(Vec<Step>, Option<String>),
    ) {
        for (index, contact, _) in self.obstacles() {
            let fault = contact.motion.as_ref().and_then(|motion| motion.fault(dim));
            check(entry("contact", index, "motion"), fault);
        }
        for (index, step) in self.step.iter().enumerate() {
            for (name, motion) in &step.motion {
                let path = [entry("step", index, "motion"), vec![name.as_str().into()]].concat();
                check(path, motion.fault(dim));
            }
        }
        self.couplings_of_wrong_dimension(dim, check);
        self.pretensions_of_wrong_dimension(dim, check);
        self.cyclic_of_wrong_dimension(dim, check);
    }
}

impl Scene {
    /// Two couplings with the same name, or a step that prescribes a component that the coupling doesn't.
    pub(super) fn wrong_coupling(&self) -> Option<Fault> {
        let names = || self.coupling.iter().map(|of| &of.name[..]);
        for (index, coupling) in self.coupling.iter().enumerate() {
            let others = self.connections().map(|(_, _, name)| name);
            if others
                .chain(names().take(index))
                .any(|name| name == coupling.name)
            {
                let message = format!("there is another '{}' already", coupling.name);
                return Some((entry("coupling", index, "name"), message));
            }
        }
        for (index, step) in self.step.iter().enumerate() {
            for (name, loads) in &step.coupling {
                let path = [entry("step", index, "coupling"), vec![name.as_str().into()]].concat();
                let Some(coupling) = self.coupling.iter().find(|of| of.name == *name) else {
                    let hint = suggest::hint_and_known(name, names());
                    return Some((path, format!("there is no coupling '{name}'{hint}")));
                };
                let both = loads
                    .prescribed()
                    .into_iter()
                    .zip(coupling.loads.prescribed());
                let is_new =
                    |both: (Option<f64>, Option<f64>)| both.0.is_some() && both.1.is_none();
                if let Some((_, key)) = both.zip(COMPONENTS).find(|&(both, _)| is_new(both)) {
                    let message = format!(
                        "expected '{key}' in [[coupling]], too: all steps hold the same components"
                    );
                    return Some(([path, vec![key.into()]].concat(), message));
                }
            }
        }
        None
    }

    /// Checks the dimension of couplings.
    fn couplings_of_wrong_dimension(
        &self,
        dim: usize,
        check: &mut impl FnMut(Vec<Step>, Option<String>),
    ) {
        for (index, coupling) in self.coupling.iter().enumerate() {
            let fault = (self.plane == Some(PlaneState::Axisymmetric)).then(|| {
                "there are no couplings around an axis; expected a scene of the plane or in space".into()
            });
            check(entry("coupling", index, "on"), fault);
            check(entry("coupling", index, "point"), coupling.point.fault(dim));
            let too_many = || {
                let is_too_many = coupling.directions.len() > dim;
                is_too_many.then(|| format!("expected {dim} at most, perpendicular to each other"))
            };
            let of_distributing = || {
                let is_wrong =
                    coupling.kind == CouplingKind::Distributing && !coupling.directions.is_empty();
                is_wrong.then(|| "a distributing coupling has none".into())
            };
            let axis = coupling.axis.as_ref();
            let of_axis = axis.and_then(|axis| match coupling.directions[..] {
                [] => Some("'axis' is of 'directions', which are missing".to_owned()),
                _ if length(axis.direction.value) == 0.0 => {
                    Some("its direction has no length".into())
                }
                _ => axis.point.fault(dim).or_else(|| axis.direction.fault(dim)),
            });
            check(entry("coupling", index, "axis"), of_axis);
            let fault = (coupling.directions.iter()).find_map(|direction| direction.fault(dim));
            let fault = fault.or_else(too_many).or_else(of_distributing);
            check(entry("coupling", index, "directions"), fault);
            if let Some((key, fault)) = coupling.loads.fault(dim) {
                check(entry("coupling", index, key), Some(fault));
            }
        }
        for (index, step) in self.step.iter().enumerate() {
            for (name, loads) in &step.coupling {
                if let Some((key, fault)) = loads.fault(dim) {
                    let path = vec![name.as_str().into(), key.into()];
                    check(
                        [entry("step", index, "coupling"), path].concat(),
                        Some(fault),
                    );
                }
            }
        }
    }
}

impl ConstantVector {
    /// The error in the vector for `dim` dimensions.
    pub(super) fn fault(&self, dim: usize) -> Option<String> {
        (self.dim != dim).then(|| super::number::expected_components(dim))
    }
}
