//! Friction in space, where a point has two tangents: a force within a disc, |λ_t| ≤ b, against the slip s.
//!
//! Whatever stiffness r > 0, the laws of a point are
//!
//! ```text
//! λ = max(0, ξ)                 with ξ = λ + r (t − g)
//! λ_t = ξ_t min(1, b / |ξ_t|)   with ξ_t = λ_t + r s,   b = c + μ λ
//! ```
//!
//! Semismooth Newton: where ξ and ξ_t are says what is open, closed, sticks or slips, and a linear problem follows
//! ([`linear`]). What is missed of the laws is the merit of a step, which is halved as long as it doesn't lessen that.
//! Where this gets no further, it starts again from near the solution, where an interior-point method leads
//! ([`interior`]), and after that dashpots at all jumps make the problem easier, the slower things move the less.
//!
//! P. Alart, A. Curnier, *A mixed formulation for frictional contact problems prone to Newton like solution methods*,
//! Comput. Methods Appl. Mech. Engrg 92 (1991); S. Hüeber, G. Stadler, B. Wohlmuth, *A primal-dual active set algorithm
//! for three-dimensional contact problems with Coulomb friction*, SIAM J. Sci. Comput. 30 (2008).

mod interior;
mod law;
mod linear;
mod newton;

use super::{FrictionProblem, Status};
use crate::contact::active_set::{ContactProblem, ContactSolution, FORCE_TOLERANCE};
use crate::contact::limits::{Beside, TangentialLimit};
use crate::contact::open_factor::scale_of;

/// Force, relative to its terms, up to which a limit does what it did.
const STAYS: f64 = 1e-15;
/// What may be missed of the law, relative to what acts.
const LAW: f64 = 1e-9;
/// A point with friction: its limits and what bounds its force.
#[derive(Clone, Copy, Debug)]
struct Point {
    normal: Option<usize>,
    /// The tangential limits, the second of which may not be one.
    tangents: [Option<usize>; 2],
    /// Slip along the second tangent if that is prescribed.
    prescribed: f64,
    own: TangentialLimit,
}

impl Point {
    /// κ, of which there is none where nothing can slip but along one line.
    fn across(&self, stiffness: f64) -> f64 {
        match self.tangents[1].is_some() || self.prescribed != 0.0 {
            true => stiffness,
            false => 0.0,
        }
    }
}

/// What a point does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Act {
    /// It is open.
    Rests,
    Sticks,
    /// It slips along e, under λ_t = b e, and κ times what of the slip is across it.
    Slips {
        e: [f64; 2],
        across: f64,
    },
    /// It slips along e while it is about to open: without pressure, under what is left of the cohesion, and κ times what
    /// of the slip is across e.
    Parts {
        e: [f64; 2],
        across: f64,
    },
}

/// What all limits do.
#[derive(Clone, Debug)]
struct State {
    /// Of every limit that isn't tangential whether it is closed.
    closed: Vec<bool>,
    points: Vec<Act>,
    /// Which points have been open on the way here.
    opened: Vec<bool>,
}

/// Jumps and forces.
#[derive(Clone, Debug)]
struct Place {
    /// t.
    jumps: Vec<f64>,
    /// λ = c − H t − Dᵀ μ, then μ.
    forces: Vec<f64>,
}

/// How right a place is.
struct Look {
    /// What all limits should do there.
    state: State,
    /// What is missed of the laws: in the norm of energies, and of any of them at most, relative to its forces.
    merit: f64,
    missed: f64,
}

/// A problem whose points have discs.
struct Discs<'a> {
    contact: ContactProblem<'a>,
    points: Vec<Point>,
    is_tangential: Vec<bool>,
    /// r of every limit.
    stiffness: Vec<f64>,
    /// The norm of energies of the forces that act before anything moves.
    acting: f64,
}

/// Where Newton's method ends.
struct Found {
    place: Place,
    state: State,
    missed: f64,
    steps: usize,
}

/// What dashpots lead to.
enum Rest {
    Found(Found),
    Slides,
    Unknown,
}

impl Found {
    fn converged(&self) -> bool {
        self.missed <= FORCE_TOLERANCE
    }
}

impl FrictionProblem<'_> {
    /// Whether a point slips in a plane.
    pub(super) fn has_discs(&self) -> bool {
        let beside = |tangent: &TangentialLimit| tangent.beside != Beside::Nothing;
        self.tangents.iter().any(beside)
    }

    /// Solves the problem from the statuses that its limits have at first, and leaves there those of the solution.
    pub(super) fn solve_discs(&self, status: &mut [Status]) -> ContactSolution {
        let discs = Discs::new(self);
        let (found, fell_back, slides) = discs.solve(status);
        discs.tell(&found.state, status);
        let (jumps, forces) = discs.exact(&found);
        ContactSolution {
            jumps,
            forces,
            steps: found.steps,
            fell_back,
            converged: found.converged(),
            slides,
        }
    }

    /// The change of jumps and forces where limits keep these statuses and slips turn, as [`Self::change`] says.
    pub(super) fn change_discs(&self, status: &[Status], turns: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let share = |i: Option<usize>| i.map_or(0.0, |i| self.contact.bounds[i]);
        let slips = |i: usize| status[i].sign() != 0.0;
        let mut bounds = self.contact.bounds.to_vec();
        let mut tangents = self.tangents.to_vec();
        for tangent in &mut tangents {
            tangent.bound.cohesion = 0.0;
            if slips(tangent.limit) {
                bounds[tangent.limit] = 0.0;
            }
            if matches!(tangent.beside, Beside::Prescribed(_)) {
                tangent.beside = Beside::Nothing;
            }
        }
        let changes = FrictionProblem {
            contact: ContactProblem {
                bounds: &bounds,
                ..self.contact
            },
            tangents: &tangents,
        };
        let discs = Discs::new(&changes);
        let act = |point: &Point| match point.own.limit {
            i if slips(i) => Act::Slips {
                e: point.tangents.map(share),
                across: turns[i],
            },
            i if status[i].is_closed() => Act::Sticks,
            _ => Act::Rests,
        };
        let state = State {
            closed: status.iter().map(|status| status.is_closed()).collect(),
            points: discs.points.iter().map(act).collect(),
            opened: Vec::new(),
        };
        let Place { jumps, mut forces } = discs.step(&discs.start(), &state);
        for (force, status) in forces.iter_mut().zip(status) {
            if *status == Status::Open {
                *force = 0.0;
            }
        }
        (jumps, forces)
    }

    /// The limits whose law isn't fulfilled one step after they had these statuses.
    pub(super) fn unsettled_discs(&self, status: &[Status]) -> Vec<usize> {
        let discs = Discs::new(self);
        let start = discs.start();
        let place = discs.step(&start, &discs.begin(status, &start));
        let missed = discs.missed(&place, &discs.look(&place, None).state);
        let is_wrong =
            |&i: &usize| missed[i].abs() > FORCE_TOLERANCE * discs.force_scale(i, &place);
        (0..missed.len()).filter(is_wrong).collect()
    }
}

impl<'a> Discs<'a> {
    fn new(problem: &FrictionProblem<'a>) -> Self {
        let contact = problem.contact;
        let m = contact.c.len();
        let of_jump = |i: usize| scale_of(contact.h[(i, i)], contact.diagonal[i]);
        let compliance =
            |row: &[(usize, f64)]| -> f64 { row.iter().map(|&(i, c)| c * c / of_jump(i)).sum() };
        let rows = contact.rows.iter().map(|row| 1.0 / compliance(row));
        let mut stiffness: Vec<f64> = (0..m).map(of_jump).chain(rows).collect();
        let mut is_tangential = vec![false; stiffness.len()];
        let mut points = Vec::new();
        for tangent in problem.tangents {
            is_tangential[tangent.limit] = true;
            let Some((tangents, prescribed)) = tangent.of_point() else {
                continue;
            };
            // The same along both tangents, however they are turned.
            let mean = tangents[1].map_or(stiffness[tangent.limit], |other| {
                0.5 * (stiffness[tangent.limit] + stiffness[other])
            });
            for i in tangents.into_iter().flatten() {
                stiffness[i] = mean;
            }
            points.push(Point {
                normal: tangent.normal,
                tangents,
                prescribed,
                own: *tangent,
            });
        }
        let acting = |i: usize| contact.scale_of(i, &vec![0.0; m]).powi(2) / stiffness[i];
        Self {
            acting: (0..m).map(acting).sum::<f64>().sqrt(),
            contact,
            points,
            is_tangential,
            stiffness,
        }
    }

    /// The place with these jumps and forces of dependent rows.
    fn place(&self, jumps: Vec<f64>, mut of_rows: Vec<f64>) -> Place {
        let mut forces = self.contact.c.to_vec();
        self.contact.subtract(&jumps, &mut forces);
        self.contact.rows.subtract_transposed(&of_rows, &mut forces);
        forces.append(&mut of_rows);
        Place { jumps, forces }
    }

    /// The statuses of all limits.
    fn tell(&self, state: &State, status: &mut [Status]) {
        for (status, &closed) in status.iter_mut().zip(&state.closed) {
            *status = Status::new(!closed);
        }
        for (point, act) in self.points.iter().zip(&state.points) {
            for i in point.tangents.into_iter().flatten() {
                status[i] = match act {
                    Act::Rests => Status::Open,
                    Act::Sticks => Status::Closed,
                    Act::Slips { .. } => Status::Slipping,
                    Act::Parts { .. } => Status::Parting,
                };
            }
        }
    }

    /// Jumps and forces with exactly what limits do: nothing beyond bounds, no force where open.
    fn exact(&self, found: &Found) -> (Vec<f64>, Vec<f64>) {
        let Found { place, state, .. } = found;
        let (mut jumps, mut forces) = (place.jumps.clone(), place.forces.clone());
        for i in (0..forces.len()).filter(|&i| !self.is_tangential[i]) {
            forces[i] = if state.closed[i] {
                forces[i].max(0.0)
            } else {
                0.0
            };
            if let Some(t) = jumps.get_mut(i) {
                *t = t.min(self.contact.bounds[i]);
            }
        }
        let cut = Place { jumps, forces };
        let mut forces = cut.forces.clone();
        for (point, act) in self.points.iter().zip(&state.points) {
            if let (Act::Parts { .. }, Some(n)) = (act, point.normal) {
                forces[n] = 0.0;
                continue;
            }
            let bound = self.bound(point, &cut, &state.closed);
            // Small slips know their direction less well than what balances the bodies.
            let [_, [first, second]] = self.tangential(point, place);
            let size = first.hypot(second);
            let part = match act {
                Act::Sticks | Act::Parts { .. } => continue,
                Act::Slips { .. } if size > 0.0 && point.prescribed == 0.0 => bound / size,
                Act::Slips { .. } => 1.0,
                Act::Rests => 0.0,
            };
            for i in point.tangents.into_iter().flatten() {
                forces[i] = part * place.forces[i];
            }
        }
        (cut.jumps, forces)
    }
}

#[cfg(test)]
mod tests;
