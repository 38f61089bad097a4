//! The solution at the conditions of a contact group, and its corrections by the laws of contact.

use crate::contact::law::{PointLaw, PointState};
use crate::contact::status::{LimitState, Status};
use crate::fem::contact_group::ContactGroup;
use crate::tree::slip_law::AT_BOUND;

/// The solution at the conditions of a contact group.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupSolution {
    /// Force of every condition (N/m).
    pub forces: Vec<f64>,
    /// Closed conditions; a tangential one is closed where the sides stick.
    pub closed: Vec<bool>,
    /// The remaining gap at every condition, g − B u; for tangential ones the slip with its sign reversed (m).
    pub gaps: Vec<f64>,
}

impl GroupSolution {
    /// The state of a point with friction.
    pub fn point(&self, law: &PointLaw) -> PointState {
        law.at(|j| -self.gaps[j], &self.forces, &self.closed)
    }

    /// True if a point slips while its contact is about to open: closed, under less than its bound.
    pub fn parts(&self, law: &PointLaw) -> bool {
        let here = self.point(law);
        let sticks = law.limits().all(|j| self.closed[j]);
        !sticks && law.is_closed(&self.closed) && here.size() < AT_BOUND * here.bound
    }

    /// The states of all conditions.
    pub fn states(&self, group: &ContactGroup) -> Vec<LimitState> {
        let all = self.forces.iter().zip(&self.gaps).zip(&self.closed);
        let state = |((&force, &gap), &closed): ((&f64, &f64), &bool)| LimitState {
            force,
            gap,
            status: Status::new(!closed),
        };
        let mut states: Vec<LimitState> = all.map(state).collect();
        for point in group.point_laws() {
            let parts = self.parts(&point);
            for j in point.limits().filter(|&j| !self.closed[j]) {
                states[j].status = match parts {
                    true => Status::Parting,
                    false if point.has_opened(&self.closed) => Status::Open,
                    false => Status::of_slip(self.forces[j]),
                };
            }
        }
        states
    }

    /// Sets forces and closed flags of all conditions but ties.
    pub fn take(&mut self, group: &ContactGroup, known: Vec<(f64, bool)>) {
        let all = self.forces.iter_mut().zip(&mut self.closed).zip(known);
        for (((force, closed), known), condition) in all.zip(group.conditions()) {
            if !condition.is_tied {
                (*force, *closed) = known;
            }
        }
    }

    /// Reduces tangential forces to their bounds.
    pub fn keep_to_bounds(&mut self, group: &ContactGroup) {
        for point in group.point_laws() {
            let here = self.point(&point);
            let size = here.size();
            for j in point.limits().filter(|_| size > here.bound) {
                self.forces[j] *= here.bound / size;
            }
        }
    }

    /// Opens normal conditions that are closed without a force and closes open ones with an overlap; returns whether
    /// any changed.
    pub fn open_or_close(&mut self, group: &ContactGroup) -> bool {
        let mut changed = false;
        let unilateral = group.points.iter().enumerate();
        let unilateral = unilateral.filter(|(_, point)| !point.law.is_tied());
        for (j, _) in unilateral {
            let is_wrong = match self.closed[j] {
                true => self.forces[j] <= 0.0,
                false => self.gaps[j] < 0.0,
            };
            self.closed[j] ^= is_wrong;
            changed |= is_wrong;
        }
        self.release_opened(group);
        changed
    }

    /// Removes the friction of points that have opened.
    pub fn release_opened(&mut self, group: &ContactGroup) {
        for point in group.point_laws() {
            if point.has_opened(&self.closed) {
                for j in point.limits() {
                    self.closed[j] = false;
                    self.forces[j] = 0.0;
                }
            }
        }
    }

    /// Changes sticking points beyond their bound to slipping, and slipping points whose force drives the slip to
    /// sticking. A slipping point without a force, lost with its pressure, gets that of its law. Returns whether any
    /// changed.
    pub fn stick_or_slip(&mut self, group: &ContactGroup) -> bool {
        let mut changed = false;
        for point in group.point_laws() {
            let here = self.point(&point);
            let (size, distance) = (here.size(), here.distance());
            let sticks = point.limits().all(|j| self.closed[j]);
            for (slip, j) in here.slip.into_iter().zip(point.limits()) {
                match sticks {
                    true if size > here.bound => {
                        self.closed[j] = false;
                        self.forces[j] *= here.bound / size;
                    }
                    false if here.work() < 0.0 => self.closed[j] = true,
                    false if size == 0.0 && here.bound * distance > 0.0 => {
                        self.forces[j] = here.bound / distance * slip;
                    }
                    _ => continue,
                }
                changed = true;
            }
        }
        changed
    }
}

#[cfg(test)]
pub mod tests;
