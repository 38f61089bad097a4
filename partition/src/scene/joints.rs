//! Pretensions in load steps, and errors in pretensions, springs and cyclic symmetries.

use std::collections::BTreeSet;

use super::fault::{Fault, entry};
use super::material::PlaneState;
use super::number::OR_IN_SPACE;
use super::place::Step;
use super::pretension::{Pretension, PretensionChange, Tightening};
use super::step::LoadStep;
use super::{Scene, suggest};

impl Pretension {
    /// The tightening in every load step, or the single one without steps.
    pub fn in_steps(&self, steps: &[LoadStep]) -> Vec<Tightening> {
        if steps.is_empty() {
            return vec![self.own];
        }
        let mut all = Vec::with_capacity(steps.len());
        let mut before = 0.0;
        let mut is_locked = false;
        for step in steps {
            let change = step.pretension.get(&self.name).copied();
            is_locked = match change {
                Some(PretensionChange::Lock) => true,
                Some(_) => false,
                None => is_locked,
            };
            let given = match (change, self.own) {
                _ if is_locked => Tightening::Locked(before),
                (Some(PretensionChange::Force(force)), _) | (_, Tightening::Force(force)) => {
                    before = step.scale.force * force;
                    Tightening::Force(before)
                }
                (Some(PretensionChange::Shortening(length)), _)
                | (_, Tightening::Shortening(length)) => {
                    Tightening::Shortening(step.scale.displacement * length)
                }
                (_, Tightening::Locked(force)) => Tightening::Locked(force),
            };
            all.push(given);
        }
        all
    }
}

impl Scene {
    /// A pretension with a repeated name, or a step with an invalid change of it.
    pub(super) fn wrong_pretension(&self) -> Option<Fault> {
        for (index, pretension) in self.pretension.iter().enumerate() {
            let others = self.connections().map(|(_, _, name)| name);
            let couplings = self.coupling.iter().map(|of| &of.name[..]);
            let before = self.pretension[..index].iter().map(|of| &of.name[..]);
            let own = [&pretension.name[..], &pretension.hold()[..]];
            let mut all = others.chain(couplings).chain(before);
            if let Some(name) = all.find(|name| own.contains(name)) {
                let message = format!("there is another '{name}' already");
                return Some((entry("pretension", index, "name"), message));
            }
        }
        for (index, step) in self.step.iter().enumerate() {
            for (name, change) in &step.pretension {
                if let Some(message) = self.wrong_change_of(index, name, *change) {
                    let path = [
                        entry("step", index, "pretension"),
                        vec![name.as_str().into()],
                    ];
                    return Some((path.concat(), message));
                }
            }
        }
        None
    }

    /// Reason why step `index` can't change a pretension in this manner.
    fn wrong_change_of(
        &self,
        index: usize,
        name: &str,
        change: PretensionChange,
    ) -> Option<String> {
        let Some(pretension) = self.pretension.iter().find(|of| of.name == *name) else {
            let known = self.pretension.iter().map(|of| &of.name[..]);
            let hint = suggest::hint_and_known(name, known);
            return Some(format!("there is no pretension '{name}'{hint}"));
        };
        let why = match (change, pretension.own) {
            (PretensionChange::Lock, Tightening::Force(_)) if index == 0 => {
                "there is no force to lock in the first step; expected 'lock' in a later one"
            }
            (PretensionChange::Lock, Tightening::Shortening(_)) => {
                "a shortening that is given is held by itself; expected no 'lock'"
            }
            (PretensionChange::Force(_), Tightening::Shortening(_)) => {
                "expected 'shortening', as [[pretension]] gives it"
            }
            (PretensionChange::Shortening(_), Tightening::Force(_)) => {
                "expected 'force' or 'lock = true', as [[pretension]] gives a force"
            }
            _ => return None,
        };
        Some(why.into())
    }

    /// Checks the dimension of pretensions.
    pub(super) fn pretensions_of_wrong_dimension(
        &self,
        dim: usize,
        check: &mut impl FnMut(Vec<Step>, Option<String>),
    ) {
        for (index, pretension) in self.pretension.iter().enumerate() {
            let fault = (pretension.direction.as_ref()).and_then(|direction| direction.fault(dim));
            check(entry("pretension", index, "direction"), fault);
        }
    }
}

impl Scene {
    /// A cyclic symmetry with a repeated name.
    pub(super) fn wrong_cyclic(&self) -> Option<Fault> {
        for (index, cyclic) in self.cyclic.iter().enumerate() {
            let others = self.connections().map(|(_, _, name)| name);
            let couplings = self.coupling.iter().map(|of| &of.name[..]);
            let bolts = self.pretension.iter().map(|of| &of.name[..]);
            let before = self.cyclic[..index].iter().map(|of| &of.name[..]);
            let mut all = others.chain(couplings).chain(bolts).chain(before);
            if all.any(|name| name == cyclic.name) {
                let message = format!("there is another '{}' already", cyclic.name);
                return Some((entry("cyclic", index, "name"), message));
            }
        }
        None
    }

    /// A spring between points with a repeated name.
    pub(super) fn wrong_spring(&self) -> Option<Fault> {
        let mut taken: BTreeSet<String> = (self.connections().map(|(_, _, name)| name))
            .chain(self.coupling.iter().map(|of| &of.name[..]))
            .chain(self.pretension.iter().map(|of| &of.name[..]))
            .chain(self.cyclic.iter().map(|of| &of.name[..]))
            .map(str::to_owned)
            .collect();
        for (index, spring) in self.springs_between() {
            if !taken.insert(spring.title()) {
                let message = format!("there is another '{}' already", spring.title());
                return Some((entry("spring", index, "name"), message));
            }
        }
        None
    }

    /// Checks the dimension of cyclic symmetries.
    pub(super) fn cyclic_of_wrong_dimension(
        &self,
        dim: usize,
        check: &mut impl FnMut(Vec<Step>, Option<String>),
    ) {
        for (index, cyclic) in self.cyclic.iter().enumerate() {
            let fault = (self.plane == Some(PlaneState::Axisymmetric))
                .then(|| "an axisymmetric scene has no sectors".into());
            check(entry("cyclic", index, "sides"), fault);
            check(entry("cyclic", index, "point"), cyclic.point.fault(dim));
            let fault = match (&cyclic.axis, dim) {
                (Some(_), 2) => Some(format!("a plane scene has no 'axis' but z{OR_IN_SPACE}")),
                (None, 3) => Some("expected the direction of the axis in space".into()),
                (axis, _) => axis.as_ref().and_then(|axis| axis.fault(dim)),
            };
            check(entry("cyclic", index, "axis"), fault);
        }
    }
}
