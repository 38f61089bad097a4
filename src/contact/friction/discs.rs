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
//! Where this gets no further, dashpots at all jumps make the problem easier, the slower things move the less.
//!
//! P. Alart, A. Curnier, *A mixed formulation for frictional contact problems prone to Newton like solution methods*,
//! Comput. Methods Appl. Mech. Engrg 92 (1991); S. Hüeber, G. Stadler, B. Wohlmuth, *A primal-dual active set algorithm
//! for three-dimensional contact problems with Coulomb friction*, SIAM J. Sci. Comput. 30 (2008).

mod law;
mod linear;

use super::{FrictionProblem, Status};
use crate::contact::active_set::{ContactProblem, ContactSolution, FORCE_TOLERANCE};
use crate::contact::limits::{Beside, TangentialLimit};
use crate::contact::open_factor::scale_of;

/// Most steps of Newton's method.
const STEPS: usize = 40;
/// The same between two changes of dashpots.
const DAMPED_STEPS: usize = 15;
/// Part of a step that is too small.
const SMALLEST: f64 = 1e-3;
/// Part of the merit, for every part of a step, by which that has to lessen it.
const LESSENS: f64 = 1e-4;
/// Force, relative to its terms, up to which a limit does what it did.
const STAYS: f64 = 1e-15;
/// What may be missed of the law, relative to what acts.
const LAW: f64 = 1e-9;
/// What is missed that can't be less.
const ROUND_OFF: f64 = 1e-15;
/// Dashpots, relative to stiffness and time: the first, the weakest and the strongest ones.
const DASHPOTS: [f64; 3] = [0.1, 1e-4, 10.0];
/// Part of the way before that isn't less, and how often that may be.
const SLOWER: f64 = 0.9;
const PATIENCE: usize = 3;
/// Most changes of dashpots.
const CHANGES: usize = 24;

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
}

/// What all limits do.
#[derive(Clone, Debug)]
struct State {
    /// Of every limit that isn't tangential whether it is closed.
    closed: Vec<bool>,
    points: Vec<Act>,
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
        let (found, fell_back) = discs.solve(status);
        discs.tell(&found.state, status);
        let (jumps, forces) = discs.exact(&found);
        ContactSolution {
            jumps,
            forces,
            steps: found.steps,
            fell_back,
            converged: found.converged(),
        }
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
            let (second, prescribed) = match tangent.beside {
                Beside::Limit(other) if other < tangent.limit => continue,
                Beside::Limit(other) => (Some(other), 0.0),
                Beside::Prescribed(slip) => (None, slip),
                Beside::Nothing => (None, 0.0),
            };
            // The same along both tangents, however they are turned.
            let mean = second.map_or(stiffness[tangent.limit], |other| {
                0.5 * (stiffness[tangent.limit] + stiffness[other])
            });
            let tangents = [Some(tangent.limit), second];
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

    /// The solution, found from where these statuses are right, and whether that took dashpots.
    fn solve(&self, status: &[Status]) -> (Found, bool) {
        let start = self.start();
        let state = self.begin(status, &start);
        let at_once = self.newton(&start, &state, STEPS);
        match at_once.converged() {
            true => (at_once, false),
            false => (self.with_dashpots(&start, &state, at_once), true),
        }
    }

    /// The place from which open jumps go where the load drives them.
    fn start(&self) -> Place {
        let rows = self.contact.rows.len();
        self.place(self.contact.center.to_vec(), vec![0.0; rows])
    }

    /// Goes from one position to the next of a problem with dashpots, which weaken as long as that is found; to no end
    /// where things slide on and on.
    fn with_dashpots(&self, start: &Place, state: &State, failed: Found) -> Found {
        let [mut dashpots, weakest, strongest] = DASHPOTS;
        let (mut place, mut state) = (start.clone(), state.clone());
        let mut steps = failed.steps;
        let (mut last, mut sliding) = (f64::INFINITY, 0);
        for _ in 0..CHANGES {
            let found = self.damped(dashpots, &place, &state);
            steps += found.steps;
            if !found.converged() {
                if dashpots >= strongest {
                    break;
                }
                dashpots = (4.0 * dashpots).min(strongest);
                continue;
            }
            let ways = found.place.jumps.iter().zip(&place.jumps);
            let way = ways.fold(0.0, |most: f64, (to, from)| most.max((to - from).abs()));
            if dashpots <= weakest && way > SLOWER * last {
                sliding += 1;
                if sliding == PATIENCE {
                    break;
                }
            }
            let slows = way < last;
            last = way;
            dashpots = (0.25 * dashpots).max(weakest);
            let of_rows = found.place.forces[self.contact.c.len()..].to_vec();
            place = self.place(found.place.jumps, of_rows);
            state = found.state;
            if !slows {
                continue;
            }
            let free = self.newton(&place, &state, DAMPED_STEPS);
            steps += free.steps;
            if free.converged() {
                return Found { steps, ..free };
            }
        }
        Found { steps, ..failed }
    }

    /// The solution where every jump is held by a dashpot at where it is.
    fn damped(&self, dashpots: f64, place: &Place, state: &State) -> Found {
        let contact = &self.contact;
        let mut h = contact.h.to_owned();
        let (mut c, mut c_scale) = (contact.c.to_vec(), contact.c_scale.to_vec());
        for (i, t) in place.jumps.iter().enumerate() {
            let own = dashpots * self.stiffness[i];
            h[(i, i)] += own;
            c[i] += own * t;
            c_scale[i] += (own * t).abs();
        }
        let damped = Discs {
            contact: ContactProblem {
                h: h.as_ref(),
                c: &c,
                c_scale: &c_scale,
                ..*contact
            },
            points: self.points.clone(),
            is_tangential: self.is_tangential.clone(),
            stiffness: self.stiffness.clone(),
            acting: self.acting,
        };
        damped.newton(place, state, DAMPED_STEPS)
    }

    /// Newton's method from a place where limits do this.
    fn newton(&self, start: &Place, state: &State, most: usize) -> Found {
        let mut place = start.clone();
        let mut state = state.clone();
        let mut merit = f64::INFINITY;
        let mut best: Option<Found> = None;
        for steps in 1..=most {
            let target = self.step(&place, &state);
            let look = self.look(&target, Some(&state));
            if let Some(found) = &mut best
                && look.missed > 0.5 * found.missed
            {
                found.steps = steps;
                break;
            }
            if look.missed <= FORCE_TOLERANCE {
                let found = Found {
                    place: target.clone(),
                    state: state.clone(),
                    missed: look.missed,
                    steps,
                };
                let exact = found.missed <= ROUND_OFF;
                best = Some(found);
                if exact {
                    break;
                }
            }
            (place, merit, state) = self.part_of_way(place, merit, target, look);
        }
        best.unwrap_or(Found {
            place,
            state,
            missed: f64::INFINITY,
            steps: most,
        })
    }

    /// The part of the way from a place with this `merit` to a `target` that lessens it; the whole way if none does.
    fn part_of_way(
        &self,
        place: Place,
        merit: f64,
        target: Place,
        whole: Look,
    ) -> (Place, f64, State) {
        let lessens = |look: &Look, part: f64| look.merit <= (1.0 - LESSENS * part) * merit;
        if merit == f64::INFINITY || lessens(&whole, 1.0) {
            return (target, whole.merit, whole.state);
        }
        let m = place.jumps.len();
        let mut part = 0.5;
        while part >= SMALLEST {
            let between = |a: &[f64], b: &[f64]| -> Vec<f64> {
                a.iter().zip(b).map(|(a, b)| a + part * (b - a)).collect()
            };
            let jumps = between(&place.jumps, &target.jumps);
            let there = self.place(jumps, between(&place.forces[m..], &target.forces[m..]));
            let look = self.look(&there, None);
            if lessens(&look, part) {
                return (there, look.merit, look.state);
            }
            part *= 0.5;
        }
        (target, whole.merit, whole.state)
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
            let bound = self.bound(point, &cut, &state.closed);
            // Small slips know their direction less well than what balances the bodies.
            let [_, [first, second]] = self.tangential(point, place);
            let size = first.hypot(second);
            let part = match act {
                Act::Sticks => continue,
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
