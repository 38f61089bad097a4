//! Is an answer the solution? The problem is convex: what fulfils all its conditions is.
//!
//! The conditions are checked with matrices that the program never saw, in twice the precision;
//! and the linear problem with the conditions closed that the program says are closed is solved by
//! one sparse factorization, so that the distance to the solution is known, too.

use contact_dd_partition::model::Model;

use super::super::assembled::{Assembled, Row};
use super::super::solution::Solution;
use super::rigid::Bodies;

/// Limits of an answer that is right; the first three stand ten times above what is promised.
const BACKWARD_ERROR: f64 = 1e-13;
const PENETRATION: f64 = 1e-13;
const TENSION: f64 = 1e-11;
const COMPLEMENTARITY: f64 = 1e-10;
/// Difference to the reference that is always round-off, and how many times that which last
/// digits make.
const DIFFERENCE: f64 = 1e-10;
const DISTURBANCES: f64 = 100.0;
/// Resultant of loads and contact forces on bodies that nothing else holds, relative to the loads,
/// that is always round-off.
const BALANCE: f64 = 1e-9;

/// What was found, all relative to the size of what it is about.
#[derive(Clone, Copy, Debug, Default)]
pub struct Findings {
    /// ‖K u − f + Bᵀ λ‖∞ over ‖|K||u| + |f| + |Bᵀ λ|‖∞, where nothing is prescribed.
    pub backward_error: f64,
    pub penetration: f64,
    pub tension: f64,
    /// Resultant of loads and contact forces along the rigid motions that supports leave, over
    /// the sum of the loads; and what round-off in the terms of K u makes of it. A body that
    /// hangs in the air may have a small backward error where it fell far.
    pub balance: f64,
    balance_round_off: f64,
    /// The largest of the lesser of force and gap.
    pub complementarity: f64,
    /// What prescribed displacements are missed by.
    pub supports: f64,
    /// Distance to the reference in the norm of the energy.
    pub difference: Option<f64>,
    /// The same of a reference with stiffness and balance of forces changed in the last digits;
    /// only where the difference is more than round-off.
    pub disturbance: Option<f64>,
    /// Tension or penetration of the reference at most.
    pub reference_signs: Option<f64>,
}

impl Findings {
    /// Judges `solution`, against a reference if `compare`.
    pub fn new(model: &Model, assembled: &Assembled, solution: &Solution, compare: bool) -> Self {
        let u = solution.dofs(model);
        let points = model.contacts.iter().flat_map(|contact| {
            let points = &solution.contacts[&contact.name];
            assert_eq!(points.len(), contact.points.len(), "{}", contact.name);
            points
        });
        let (forces, closed): (Vec<f64>, Vec<bool>) =
            points.map(|point| (point.force, point.closed)).unzip();
        let mut findings = Self::default();
        findings.equilibrium(assembled, &u, &forces);
        findings.balance(model, assembled, &forces);
        if compare {
            findings.compare(model, assembled, &u, &closed);
        }
        findings
    }

    fn equilibrium(&mut self, assembled: &Assembled, u: &[f64], forces: &[f64]) {
        let mut residual = assembled.residual(u, forces);
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
    }

    fn balance(&mut self, model: &Model, assembled: &Assembled, forces: &[f64]) {
        let mut left = assembled.load.clone();
        for ((row, _), force) in assembled.conditions.iter().zip(forces) {
            row.iter().for_each(|&(dof, c)| left[dof] -= c * force);
        }
        let bodies = Bodies::new(model);
        let resultant = bodies.act(&left.into_iter().enumerate().collect::<Row>());
        let free = bodies.unseen(assembled.supports.iter().map(|(row, _)| row));
        let along = free.iter().map(|motion| motion.dot(&resultant).abs());
        let load: f64 = assembled.load.iter().map(|f| f.abs()).sum();
        self.balance = ratio(along.fold(0.0, worse), load);
    }

    /// Solves with the closed conditions as equations; free motions as the program has them.
    fn compare(&mut self, model: &Model, assembled: &Assembled, u: &[f64], closed: &[bool]) {
        let bodies = Bodies::new(model);
        let rows = (assembled.conditions.iter().zip(closed))
            .filter(|(_, closed)| **closed)
            .map(|((row, _), _)| row)
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
        let (reference, forces) = assembled.solve(closed, &free, None);
        let difference = assembled.energy_difference(&reference, u);
        self.difference = Some(difference);
        let given = assembled.conditions.iter().map(|(_, gap)| gap.abs());
        let size = given.fold(largest(&reference), f64::max);
        let force = largest(&forces).max(largest(&assembled.load));
        let gaps = assembled.gaps(&reference);
        let signs = gaps
            .iter()
            .zip(&forces)
            .zip(closed)
            .map(|((gap, f), closed)| match closed {
                true => ratio(-f, force),
                false => ratio(-gap, size),
            });
        self.reference_signs = Some(signs.fold(0.0, f64::max));
        if difference > DIFFERENCE / 10.0 {
            let terms = largest(&assembled.residual(&reference, &forces).terms);
            let (disturbed, _) = assembled.solve(closed, &free, Some(f64::EPSILON * terms));
            self.disturbance = Some(assembled.energy_difference(&reference, &disturbed));
        }
    }

    /// What is wrong, if anything is.
    pub fn faults(&self) -> Vec<String> {
        let mut limits = vec![
            ("backward error", self.backward_error, BACKWARD_ERROR),
            ("penetration", self.penetration, PENETRATION),
            ("tension", self.tension, TENSION),
            ("complementarity", self.complementarity, COMPLEMENTARITY),
            ("supports", self.supports, PENETRATION),
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

/// The greater of both; what isn't a number is worst.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

/// a / b, and 0 where both are.
fn ratio(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}
