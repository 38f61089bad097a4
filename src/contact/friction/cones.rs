//! Friction cone of a point along one or two tangents: |λ_t| ≤ b, against the slip s.
//!
//! Semismooth Newton on the laws ([`newton`](crate::contact::newton)), with a dense linear problem for given statuses
//! ([`linear`]). Where it stalls, it starts again near the solution, at the end of Lemke's path
//! ([`lemke`](super::lemke)). The last resort is viscous regularization of all jumps, which vanishes with the velocity.

mod linear;
mod newton;
mod sliding;

use super::{FrictionProblem, Status};
use crate::contact::active_set::{ContactProblem, ContactSolution, FORCE_TOLERANCE};
use crate::contact::law::{PointLaw, PointStatus};
use crate::contact::laws::{ContactLaws, Iterate, Statuses};
use crate::contact::open_factor::scale_of;
use crate::contact::status::FixedStatus;
use crate::contact::tangent::OtherTangent;

/// Accepted residual, relative to the terms of forces, once steps no longer lessen it: round-off of points whose own
/// stiffness is far above that of others. The certificate checks the result.
const ACCEPTABLE: f64 = 1e-10;

/// Share of the terms of the acting forces: more than their round-off, times the tolerance of Newton's method.
const OF_TERMS: f64 = 1e-5;

/// Dense problem with friction cones.
struct FrictionCones<'a> {
    contact: ContactProblem<'a>,
    laws: ContactLaws<'a>,
    /// Square roots of the stiffness of all limits: the two tangents of a point may differ by far.
    sizes: Vec<f64>,
    /// Energy norm of the forces that act before any motion, with their round-off.
    acting: f64,
}

/// Result of Newton's method.
struct Found {
    place: Iterate,
    state: Statuses,
    residual: f64,
    steps: usize,
}

/// Result of the viscous regularization.
enum Rest {
    Found(Found),
    Slides,
    Unknown,
}

impl Found {
    fn converged(&self) -> bool {
        self.residual <= ACCEPTABLE
    }
}

impl FrictionProblem<'_> {
    /// Solves the problem from the statuses that its limits have at first, and leaves there those of the solution.
    pub(super) fn solve_cones(&self, status: &mut [Status]) -> ContactSolution {
        let cones = FrictionCones::new(self);
        let (found, fell_back, slides) = cones.solve(self, status);
        cones.write_statuses(&found.state, status);
        let (jumps, forces) = cones.exact(&found);
        ContactSolution {
            jumps,
            forces,
            steps: found.steps,
            fell_back,
            converged: found.converged(),
            slides,
        }
    }

    /// Change of jumps and forces with fixed statuses, as in [`Self::change`].
    pub(super) fn change_cones(&self, fixed: &[FixedStatus]) -> Iterate {
        let mut tangents = self.tangents.to_vec();
        for tangent in &mut tangents {
            tangent.bound.cohesion = 0.0;
            if matches!(fixed[tangent.limit], FixedStatus::Turns { .. }) {
                tangent.bound.coefficient = 0.0;
            }
            if matches!(tangent.other, OtherTangent::Prescribed(_)) {
                tangent.other = OtherTangent::Nothing;
            }
        }
        let cones = FrictionCones::new(&FrictionProblem {
            tangents: &tangents,
            ..*self
        });
        let share = |i: Option<usize>| i.and_then(|i| fixed[i].slip()).map_or(0.0, |[e, _]| e);
        let act = |point: &PointLaw| match fixed[point.first] {
            FixedStatus::Open => PointStatus::Open,
            FixedStatus::Closed { .. } => PointStatus::Sticks,
            FixedStatus::Slips { turning, .. } | FixedStatus::Turns { turning, .. } => {
                PointStatus::Slips {
                    direction: point.tangents.map(share),
                    turning,
                }
            }
            FixedStatus::Parts => PointStatus::Parts {
                direction: [1.0, 0.0],
                turning: 0.0,
            },
        };
        let state = Statuses {
            closed: fixed.iter().map(FixedStatus::is_closed).collect(),
            points: cones.laws.points.iter().map(act).collect(),
            past: Vec::new(),
        };
        let mut change = cones.step(&cones.start(), &state);
        for (force, fixed) in change.forces.iter_mut().zip(fixed) {
            if *fixed == FixedStatus::Open {
                *force = 0.0;
            }
        }
        change
    }

    /// Limits whose law is violated one step after these statuses.
    pub fn violated_limits(&self, status: &[Status]) -> Vec<usize> {
        let cones = FrictionCones::new(self);
        let start = cones.start();
        let place = cones.step(&start, &cones.laws.begin(status, &start));
        let right = cones.laws.residual(&place, None, 0.0).statuses;
        let residuals = cones.laws.residuals(&place, &right);
        let is_wrong =
            |&i: &usize| residuals[i].abs() > FORCE_TOLERANCE * cones.force_scale(i, &place);
        (0..residuals.len()).filter(is_wrong).collect()
    }
}

impl<'a> FrictionCones<'a> {
    fn new(problem: &FrictionProblem<'a>) -> Self {
        let contact = problem.contact;
        let m = contact.c.len();
        let of_jump = |i: usize| scale_of(contact.h[(i, i)], contact.diagonal[i]);
        let compliance =
            |row: &[(usize, f64)]| -> f64 { row.iter().map(|&(i, c)| c * c / of_jump(i)).sum() };
        let rows = contact.rows.iter().map(|row| 1.0 / compliance(row));
        let stiffness: Vec<f64> = (0..m).map(of_jump).chain(rows).collect();
        let sizes = stiffness.iter().map(|r| r.sqrt()).collect();
        let laws = ContactLaws::new(contact.bounds, contact.rows, problem.tangents, stiffness);
        let norm = |forces: &[f64]| laws.squares(forces).sqrt();
        let at_rest = vec![0.0; m];
        let terms: Vec<f64> = (0..m).map(|i| contact.scale_of(i, &at_rest)).collect();
        Self {
            acting: norm(contact.c) + OF_TERMS * norm(&terms),
            contact,
            laws,
            sizes,
        }
    }

    /// Iterate with these jumps and forces of dependent rows.
    fn place(&self, jumps: Vec<f64>, mut of_rows: Vec<f64>) -> Iterate {
        let mut forces = self.contact.c.to_vec();
        self.contact.subtract(&jumps, &mut forces);
        self.contact.rows.subtract_transposed(&of_rows, &mut forces);
        forces.append(&mut of_rows);
        Iterate { jumps, forces }
    }

    /// The statuses of all limits.
    fn write_statuses(&self, state: &Statuses, status: &mut [Status]) {
        for (status, &closed) in status.iter_mut().zip(&state.closed) {
            *status = Status::new(!closed);
        }
        for (point, act) in self.laws.points.iter().zip(&state.points) {
            for i in point.limits() {
                status[i] = match act {
                    PointStatus::Open => Status::Open,
                    PointStatus::Sticks => Status::Closed,
                    PointStatus::Slips { direction, .. } if point.is_along_a_line() => {
                        Status::of_slip(direction[0])
                    }
                    PointStatus::Slips { .. } => Status::Slipping,
                    PointStatus::Parts { .. } => Status::Parting,
                };
            }
        }
    }

    /// Scale of the terms in the force of limit i (N/m).
    fn force_scale(&self, i: usize, place: &Iterate) -> f64 {
        let m = place.jumps.len();
        let of_jump = |j: usize| {
            let by_rows = self.contact.rows.iter().zip(&place.forces[m..]);
            let by_rows = by_rows.map(|(row, force)| {
                let share = row.iter().find(|&&(jump, _)| jump == j);
                share.map_or(0.0, |(_, share)| (share * force).abs())
            });
            self.contact.scale_of(j, &place.jumps) + by_rows.sum::<f64>()
        };
        match i < m {
            true => of_jump(i),
            false => {
                let row = self.contact.rows.row(i - m).iter();
                row.map(|&(j, c)| c.abs() * of_jump(j)).sum()
            }
        }
    }

    /// Jumps and forces with exact laws: no overshoot of bounds, no force where open.
    fn exact(&self, found: &Found) -> (Vec<f64>, Vec<f64>) {
        let Found { place, state, .. } = found;
        let (mut jumps, mut forces) = (place.jumps.clone(), place.forces.clone());
        for i in (0..forces.len()).filter(|&i| !self.laws.is_tangential[i]) {
            forces[i] = if state.closed[i] {
                forces[i].max(0.0)
            } else {
                0.0
            };
            if let Some(t) = jumps.get_mut(i) {
                *t = t.min(self.contact.bounds[i]);
            }
        }
        let cut = Iterate { jumps, forces };
        let mut forces = cut.forces.clone();
        for (point, act) in self.laws.points.iter().zip(&state.points) {
            if let (PointStatus::Parts { .. }, Some(n)) = (act, point.normal) {
                forces[n] = 0.0;
                continue;
            }
            // The direction of a small slip is less accurate than the force that balances the bodies.
            let here = self.laws.point(point, &cut, &state.closed);
            let size = here.size();
            let part = match act {
                PointStatus::Sticks | PointStatus::Parts { .. } => continue,
                PointStatus::Slips { .. } if size > 0.0 && point.prescribed == 0.0 => {
                    here.bound / size
                }
                PointStatus::Slips { .. } => 1.0,
                PointStatus::Open => 0.0,
            };
            for i in point.limits() {
                forces[i] = part * place.forces[i];
            }
        }
        (cut.jumps, forces)
    }
}

#[cfg(test)]
mod tests;
