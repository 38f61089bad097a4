//! Check whether an answer is the solution. Without friction the problem is convex: an answer that fulfils all
//! conditions is the only solution. With Coulomb's friction it is a solution, though there may be others.
//!
//! The conditions are checked with matrices independent of the program, in twice the precision; and the linear problem
//! with the program's closed, sticking and slipping points is solved by one sparse factorization, which gives the
//! distance to the solution, too. Friction opposes the tangential jump since the load step before.

use contact_dd_partition::model::Model;

use super::super::assembled::{Along, Assembled, Disturbance, Row, Solved, Tangent};
use super::super::solution::Solution;
use super::answer::{Answer, dot};
use super::rigid::Bodies;

/// Limits for a right answer; the first three are ten times their targets.
const BACKWARD_ERROR: f64 = 1e-13;
const PENETRATION: f64 = 1e-13;
const TENSION: f64 = 1e-11;
const COMPLEMENTARITY: f64 = 1e-10;
/// Limit for the law of friction: relative to the largest bound, or to this part of the loads if that is more.
const FRICTION: f64 = 1e-9;
const LEAST_BOUND: f64 = 1e-3;
/// Difference of equal tangential jumps, relative to the largest displacement.
const STUCK: f64 = 1e-10;
/// Difference to the reference that is always round-off, and the factor on a difference due to last digits.
const DIFFERENCE: f64 = 1e-10;
const DISTURBANCES: f64 = 100.0;
/// Number of disturbances tried: a single one may happen not to move the softest mode.
const SAMPLES: u64 = 4;
/// Resultant of loads and contact forces on otherwise free bodies, relative to the loads, that is always round-off.
const BALANCE: f64 = 1e-9;

/// Findings, each relative to the size of its quantity.
#[derive(Clone, Copy, Debug, Default)]
pub struct Findings {
    /// ‖K u − f + Bᵀ λ‖∞ over ‖|K||u| + |f| + |Bᵀ λ|‖∞, on unknowns that aren't prescribed.
    pub backward_error: f64,
    pub penetration: f64,
    pub tension: f64,
    /// Resultant of loads and contact forces along the rigid motions that supports leave, over the sum of the loads,
    /// and the round-off of the terms of K u in it. An unsupported body may have a small backward error after a long
    /// fall.
    pub balance: f64,
    balance_round_off: f64,
    /// The largest of the lesser of force and gap.
    pub complementarity: f64,
    /// Largest error of prescribed displacements.
    pub supports: f64,
    /// Largest excess of tangential forces over their bound.
    pub bound: f64,
    /// The largest of the lesser of slip since the step before and the shortfall of the opposing force.
    pub direction: f64,
    /// Difference between the slip and that of the displacements.
    pub slip: f64,
    /// Force or slip outside the tangential direction, or without friction.
    pub off_tangent: f64,
    /// Deviation of points from their status: open with a force, closed with a gap, slipping with less force than the
    /// bound.
    pub status: f64,
    /// The largest slip of sticking points since the step before.
    pub stuck: f64,
    /// Distance to the reference in the energy norm.
    pub difference: Option<f64>,
    /// The largest distance among some references with stiffness and balance of forces changed in the last digits; only
    /// if the difference is more than round-off.
    pub disturbance: Option<f64>,
    /// Largest tension or penetration of the reference.
    pub reference_signs: Option<f64>,
}

impl Findings {
    /// Judges `solution`, against a reference if `compare`; without friction, or in a first load step.
    pub fn new(model: &Model, assembled: &Assembled, solution: &Solution, compare: bool) -> Self {
        Self::after(None, model, assembled, solution, compare)
    }

    /// Judges `solution`, which follows the one `before`; `assembled` has its loads.
    pub fn after(
        before: Option<&Solution>,
        model: &Model,
        assembled: &Assembled,
        solution: &Solution,
        compare: bool,
    ) -> Self {
        let u = solution.dofs(model);
        let state = Answer::new(model, assembled, solution, before);
        let mut findings = Self::default();
        let before = before.map_or(0.0, Solution::largest_displacement);
        findings.equilibrium(assembled, &u, &state, before);
        findings.balance(model, assembled, &state);
        if compare {
            findings.compare(model, assembled, &u, &state);
        }
        findings
    }

    /// The findings for a step made in parts, without those about the whole step: a point that slipped in one part may
    /// stick in the last.
    pub fn in_parts(self) -> Self {
        Self {
            direction: 0.0,
            stuck: 0.0,
            ..self
        }
    }

    /// The worse of two for every finding.
    pub fn or(self, other: Self) -> Self {
        let either = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => Some(worse(a, b)),
            _ => a.or(b),
        };
        Self {
            backward_error: worse(self.backward_error, other.backward_error),
            penetration: worse(self.penetration, other.penetration),
            tension: worse(self.tension, other.tension),
            balance: worse(self.balance, other.balance),
            balance_round_off: worse(self.balance_round_off, other.balance_round_off),
            complementarity: worse(self.complementarity, other.complementarity),
            supports: worse(self.supports, other.supports),
            bound: worse(self.bound, other.bound),
            direction: worse(self.direction, other.direction),
            slip: worse(self.slip, other.slip),
            off_tangent: worse(self.off_tangent, other.off_tangent),
            status: worse(self.status, other.status),
            stuck: worse(self.stuck, other.stuck),
            difference: either(self.difference, other.difference),
            disturbance: either(self.disturbance, other.disturbance),
            reference_signs: either(self.reference_signs, other.reference_signs),
        }
    }

    fn equilibrium(&mut self, assembled: &Assembled, u: &[f64], state: &Answer, before: f64) {
        let forces = &state.forces;
        let mut residual = assembled.residual(u, forces, &state.tangential);
        let mut load_scale = largest(&assembled.load).max(largest(forces));
        for (row, _) in &assembled.supports {
            let reaction: f64 = row.iter().map(|&(dof, c)| c * residual.value[dof]).sum();
            load_scale = load_scale.max(reaction.abs());
            for &(dof, c) in row {
                residual.value[dof] -= c * reaction;
            }
        }
        self.backward_error = ratio(largest(&residual.value), largest(&residual.terms));
        let sum = |values: &[f64]| values.iter().map(|x| x.abs()).sum::<f64>();
        self.balance_round_off = f64::EPSILON * ratio(sum(&residual.terms), sum(&assembled.load));
        let given = assembled.conditions.iter().map(|(_, gap)| gap.abs());
        let size = given.fold(largest(u), f64::max);
        let gaps = assembled.gaps(u);
        for (&gap, &force) in gaps.iter().zip(forces) {
            let (gap, force) = (ratio(gap, size), ratio(force, load_scale));
            self.penetration = worse(self.penetration, -gap);
            self.tension = worse(self.tension, -force);
            self.complementarity = worse(self.complementarity, gap.min(force));
        }
        for (row, value) in &assembled.supports {
            let there: f64 = row.iter().map(|&(dof, c)| c * u[dof]).sum();
            self.supports = worse(self.supports, ratio((there - value).abs(), size));
        }
        for (point, gap) in state.points.iter().zip(&gaps) {
            let wrong = match point.closed {
                true => ratio(gap.abs(), size),
                false => ratio(point.force.abs(), load_scale),
            };
            self.status = worse(self.status, wrong / STUCK);
        }
        // The law holds up to the round-off of the terms of K u where these are so large that it acts like a force.
        let round_off = 10.0 * f64::EPSILON * largest(&residual.terms) / FRICTION;
        let least = (LEAST_BOUND * load_scale).max(round_off);
        self.friction(assembled, state, size.max(before), least);
    }

    /// The law of friction, with displacements of this size and forces of at least this scale.
    fn friction(&mut self, assembled: &Assembled, state: &Answer, size: f64, least: f64) {
        let bounds = state.bounds(assembled);
        let scale = largest(&bounds).max(least);
        let mut has_friction = vec![false; state.points.len()];
        let all: Vec<(usize, &Tangent)> = assembled.tangents.iter().enumerate().collect();
        for of_point in all.chunk_by(|(_, a), (_, b)| a.condition == b.condition) {
            let (k, tangent) = of_point[0];
            let point = state.points[tangent.condition];
            let vector = |values: &[f64]| {
                let parts = of_point
                    .iter()
                    .map(|&(k, tangent)| (values[k], tangent.direction));
                parts.fold([0.0; 3], |sum, (x, t)| [0, 1, 2].map(|i| sum[i] + x * t[i]))
            };
            let (force, since) = (vector(&state.tangential), vector(&state.since));
            let [size_of_force, way] = [force, since].map(|v| dot(v, v).sqrt());
            has_friction[tangent.condition] = true;
            self.bound = worse(self.bound, ratio(size_of_force - bounds[k], scale));
            // A point about to open, without pressure, may have any part of its cohesion.
            let normal = state.forces[tangent.condition];
            let is_parting = !tangent.is_given() && normal <= FRICTION * scale;
            // The direction of a small slip is less certain.
            let angle = ratio(dot(force, since), size_of_force * way)
                .clamp(-1.0, 1.0)
                .acos();
            let unknown = ratio(STUCK * size, way).min(1.0).asin();
            let opposing = size_of_force * (angle - unknown).max(0.0).cos();
            let least_bound = if is_parting { size_of_force } else { bounds[k] };
            let shortfall = ratio(least_bound - opposing, scale) / FRICTION;
            let slipped = ratio(way, size) / STUCK;
            self.direction = worse(self.direction, shortfall.min(slipped));
            for &(k, tangent) in of_point {
                let slip = dot(point.slip, tangent.direction);
                self.slip = worse(self.slip, ratio((slip - state.jumps[k]).abs(), size));
            }
            for (vector, scale) in [(point.tangential_force, scale), (point.slip, size)] {
                let off = of_point.iter().fold(vector, |rest, (_, tangent)| {
                    let along = dot(vector, tangent.direction);
                    [0, 1, 2].map(|i| rest[i] - along * tangent.direction[i])
                });
                let off = off.iter().fold(0.0, |m: f64, x| worse(m, x.abs()));
                self.off_tangent = worse(self.off_tangent, ratio(off, scale));
            }
            match (point.closed, point.slipping) {
                (false, _) => {}
                (true, false) => self.stuck = worse(self.stuck, slipped),
                (true, true) => {
                    let least_bound = if is_parting { 0.0 } else { bounds[k] };
                    let shortfall = ratio(least_bound - size_of_force, scale) / FRICTION;
                    self.status = worse(self.status, shortfall);
                }
            }
        }
        for (point, has_friction) in state.points.iter().zip(has_friction) {
            let there = |vector: [f64; 3]| vector.iter().any(|x| *x != 0.0);
            if !has_friction && (point.slipping || there(point.tangential_force)) {
                self.off_tangent = f64::INFINITY;
            }
            if point.slipping && !point.closed {
                self.status = f64::INFINITY;
            }
        }
    }

    fn balance(&mut self, model: &Model, assembled: &Assembled, state: &Answer) {
        let mut left = assembled.load.clone();
        for ((row, _), force) in assembled.conditions.iter().zip(&state.forces) {
            row.iter().for_each(|&(dof, c)| left[dof] -= c * force);
        }
        for (tangent, force) in assembled.tangents.iter().zip(&state.tangential) {
            (tangent.row.iter()).for_each(|&(dof, c)| left[dof] -= c * force);
        }
        let bodies = Bodies::new(model);
        let resultant = bodies.act(&left.into_iter().enumerate().collect::<Row>());
        let free = bodies.unseen(assembled.supports.iter().map(|(row, _)| row));
        let along = free.iter().map(|motion| motion.dot(&resultant).abs());
        let load: f64 = assembled.load.iter().map(|f| f.abs()).sum();
        self.balance = ratio(along.fold(0.0, worse), load);
    }

    /// Solves with the closed conditions as equations and the program's statuses of friction; free motions as in the
    /// program's solution.
    fn compare(&mut self, model: &Model, assembled: &Assembled, u: &[f64], state: &Answer) {
        let closed: Vec<bool> = state.points.iter().map(|point| point.closed).collect();
        let along = self.along(assembled, state);
        let bodies = Bodies::new(model);
        let stuck = assembled.tangents.iter().zip(&along);
        let stuck = stuck.filter(|(_, along)| matches!(along, Along::Stuck(_)));
        let rows = (assembled.conditions.iter().zip(&closed))
            .filter(|(_, closed)| **closed)
            .map(|((row, _), _)| row)
            .chain(stuck.map(|(tangent, _)| &tangent.row))
            .chain(assembled.supports.iter().map(|(row, _)| row));
        let free: Vec<(Row, f64)> = (bodies.unseen(rows).iter())
            .map(|motion| {
                let moved = bodies.displacement(motion.as_slice());
                let length = moved.iter().map(|c| c * c).sum::<f64>().sqrt();
                let row: Row = moved.iter().map(|c| c / length).enumerate().collect();
                let value = row.iter().map(|&(dof, c)| c * u[dof]).sum();
                (row, value)
            })
            .collect();
        let solve = |disturbed| assembled.solve_along(&closed, &along, &free, disturbed);
        let Solved {
            u: reference,
            forces,
            tangential,
        } = solve(None);
        let difference = assembled.energy_difference(&reference, u);
        self.difference = Some(difference);
        let given = assembled.conditions.iter().map(|(_, gap)| gap.abs());
        let size = given.fold(largest(&reference), f64::max);
        let force = largest(&forces).max(largest(&assembled.load));
        let gaps = assembled.gaps(&reference);
        let signs = gaps
            .iter()
            .zip(&forces)
            .zip(&closed)
            .map(|((gap, f), closed)| match closed {
                true => ratio(-f, force),
                false => ratio(-gap, size),
            });
        self.reference_signs = Some(signs.fold(0.0, f64::max));
        if difference > DIFFERENCE / 10.0 {
            let residual = assembled.residual(&reference, &forces, &tangential);
            let terms = largest(&residual.terms);
            let force = f64::EPSILON * terms;
            let differences = (1..=SAMPLES).map(|seed| {
                let disturbed = solve(Some(Disturbance { force, seed })).u;
                assembled.energy_difference(&reference, &disturbed)
            });
            self.disturbance = differences.reduce(worse);
        }
    }

    /// Conditions along tangents that stick or slip by their status, or have a given bound, by their force. Slipping
    /// points keep their forces: by the law these would depend on the normal forces, which need not be unique where
    /// conditions depend on others.
    fn along(&self, assembled: &Assembled, state: &Answer) -> Vec<Along> {
        let bounds = state.bounds(assembled);
        let one = |(k, tangent): (usize, &Tangent)| {
            let (point, force) = (state.points[tangent.condition], state.tangential[k]);
            let whole = dot(point.tangential_force, point.tangential_force).sqrt();
            let slips = match tangent.is_given() && !point.closed {
                true => whole >= (1.0 - FRICTION) * bounds[k],
                false => point.slipping,
            };
            match (slips, point.closed || tangent.is_given()) {
                (true, _) => Along::Pushed(force),
                (false, true) => Along::Stuck(state.jumps[k]),
                (false, false) => Along::Free,
            }
        };
        assembled.tangents.iter().enumerate().map(one).collect()
    }

    /// The faults in words; empty if there are none.
    pub fn faults(&self) -> Vec<String> {
        let mut limits = vec![
            ("backward error", self.backward_error, BACKWARD_ERROR),
            ("penetration", self.penetration, PENETRATION),
            ("tension", self.tension, TENSION),
            ("complementarity", self.complementarity, COMPLEMENTARITY),
            ("supports", self.supports, PENETRATION),
            ("bound", self.bound, FRICTION),
            ("direction", self.direction, 1.0),
            ("slip", self.slip, PENETRATION),
            ("off the tangent", self.off_tangent, PENETRATION),
            ("status", self.status, 1.0),
            ("stuck", self.stuck, 1.0),
        ];
        if self.balance_round_off.is_finite() {
            let allowed = DISTURBANCES * self.balance_round_off;
            limits.push(("balance", self.balance, allowed.max(BALANCE)));
        }
        if let Some(difference) = self.difference {
            let allowed = DISTURBANCES * self.disturbance.unwrap_or(0.0);
            limits.push(("difference", difference, allowed.max(DIFFERENCE)));
        }
        (limits.into_iter())
            .filter(|(_, value, limit)| value.is_nan() || value > limit)
            .map(|(name, value, limit)| format!("{name} {value:.1e} > {limit:.0e}"))
            .collect()
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| worse(m, x.abs()))
}

/// The greater of two; NaN is worst.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

/// a / b, and 0 if both are.
fn ratio(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}
