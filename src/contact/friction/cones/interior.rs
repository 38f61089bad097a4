//! The interior-point method on cones, which gets near to a solution where Newton's method doesn't.
//!
//! With y the gap that is left, λ_t = b ρ and s the slip, for ε from large to small
//!
//! ```text
//! λ y = ε    s = γ ρ,  γ b (1 − |ρ|²) = 2 ε    λ, y, γ > 0,  |ρ| < 1
//! ```
//!
//! For given bounds it is the central path of a convex problem; b(λ) of Coulomb's law takes part in Newton's steps. What
//! coheres where it is closed has c λ/(λ + y) of its cohesion c. Everything is in the scale of energies, in which
//! stiffnesses are 1.

use faer::Mat;
use faer::linalg::solvers::SolveCore;
use faer::{Conj, MatMut};

use super::{Found, FrictionCones};
use crate::contact::law::PointLaw;
use crate::contact::laws;

/// Steps at most.
const STEPS: usize = 100;
/// The forces of the first place, over those that act.
const FIRST: f64 = 10.0;
/// ε over λ y, after a step of which more than a part could be gone.
const SHRINKS: [(f64, f64); 2] = [(0.5, 0.2), (0.2, 0.5)];
/// Part of the way to the border of what λ, y, γ and ρ may be.
const WITHIN: f64 = 0.95;
/// The shortest step.
const SHORTEST: f64 = 1e-6;
/// λ y, relative to what it was at first, from which on Newton's method is tried, and by how much less again.
const NEAR: f64 = 1e-6;
const NEARER: f64 = 1e-3;
/// Steps of Newton's method then.
const POLISHING: usize = 12;
/// The least b, relative to √ε.
const LEAST_BOUND: f64 = 1e-10;
/// Spring on every jump.
const SPRING: f64 = 1e-13;

/// Where the path is.
struct Central {
    jumps: Vec<f64>,
    /// λ and y of every limit that isn't tangential and has a bound.
    forces: Vec<f64>,
    gaps: Vec<f64>,
    /// ρ and γ of every point.
    rho: Vec<[f64; 2]>,
    gamma: Vec<f64>,
}

/// What a point's own equations need: its bound with the change that the way of its normal limit makes of it and the
/// one without, and what is left of s = γ ρ and γ (1 − |ρ|²) = 2 ε/b.
struct Local {
    bound: f64,
    by_normal: f64,
    change: f64,
    slip: [f64; 2],
    product: f64,
}

/// The problem in the scale of energies.
struct Scaled<'a> {
    cones: &'a FrictionCones<'a>,
    root: Vec<f64>,
    h: Mat<f64>,
    c: Vec<f64>,
    bounds: Vec<f64>,
    /// Limits that aren't tangential and have a bound.
    is_normal: Vec<bool>,
}

impl FrictionCones<'_> {
    /// The solution found from somewhere along the path.
    pub(super) fn along_path(&self) -> Option<Found> {
        let scaled = Scaled::new(self);
        let mut at = scaled.first();
        let first = scaled.measure(&at);
        let (mut epsilon, mut next) = (first, NEAR * first);
        for steps in 1..=STEPS {
            let part = scaled.advance(&mut at, epsilon)?;
            let left = scaled.measure(&at);
            if left.is_nan() || part < SHORTEST {
                break;
            }
            if left < next {
                next = NEARER * left;
                let place = scaled.place(&at);
                let mut state = self.laws.residual(&place, None, 0.0).statuses;
                // Near the solution what would open may be about to open.
                state.opened = vec![true; self.laws.points.len()];
                let found = self.newton(&place, &state, POLISHING);
                if found.converged() {
                    let steps = steps + found.steps;
                    return Some(Found { steps, ..found });
                }
            }
            let shrinks = SHRINKS.iter().find(|(far, _)| part > *far);
            epsilon = left * shrinks.map_or(1.0, |(_, by)| *by);
        }
        None
    }
}

impl<'a> Scaled<'a> {
    fn new(cones: &'a FrictionCones<'a>) -> Self {
        let contact = &cones.contact;
        let m = contact.c.len();
        let root: Vec<f64> = cones.laws.stiffness.iter().map(|r| r.sqrt()).collect();
        let bounds: Vec<f64> = contact
            .bounds
            .iter()
            .zip(&root)
            .map(|(g, r)| g * r)
            .collect();
        let is_normal = (bounds.iter().zip(&cones.laws.is_tangential))
            .map(|(bound, tangential)| bound.is_finite() && !tangential)
            .collect();
        Self {
            h: Mat::from_fn(m, m, |i, j| contact.h[(i, j)] / (root[i] * root[j])),
            c: contact.c.iter().zip(&root).map(|(c, r)| c / r).collect(),
            cones,
            root,
            bounds,
            is_normal,
        }
    }

    /// The terms of limit i in jumps.
    fn terms(&self, i: usize) -> Vec<(usize, f64)> {
        let m = self.c.len();
        match i.checked_sub(m) {
            None => vec![(i, 1.0)],
            Some(row) => (self.cones.contact.rows.row(row).iter())
                .map(|&(j, c)| (j, c * self.root[i] / self.root[j]))
                .collect(),
        }
    }

    /// How far limit i is beyond its bound.
    fn way(&self, i: usize, jumps: &[f64]) -> f64 {
        let sum: f64 = self.terms(i).iter().map(|&(j, c)| c * jumps[j]).sum();
        sum - self.bounds[i]
    }

    fn first(&self) -> Central {
        let m = self.c.len();
        let bounded = |i: usize| match self.is_normal[i] {
            true => self.bounds[i],
            false => 0.0,
        };
        let of_bounds = |i: usize| (0..m).map(|j| self.h[(i, j)] * bounded(j)).sum::<f64>();
        let forces = (0..m).map(|i| self.c[i].abs() + of_bounds(i).abs());
        let size = FIRST * forces.fold(f64::MIN_POSITIVE, f64::max);
        let normal = |value: f64| -> Vec<f64> {
            let of = |is_normal: &bool| if *is_normal { value } else { 0.0 };
            self.is_normal.iter().map(of).collect()
        };
        let points = self.cones.laws.points.len();
        Central {
            jumps: (self.cones.contact.center.iter().zip(&self.root))
                .map(|(t, r)| t * r)
                .collect(),
            forces: normal(size),
            gaps: normal(size),
            rho: vec![[0.0; 2]; points],
            gamma: vec![size; points],
        }
    }

    /// b of a point and its derivatives by λ and y.
    fn bound(&self, point: &PointLaw, at: &Central) -> [f64; 3] {
        let scales = (point.normal.map(|n| self.root[n]), self.root[point.first]);
        let own = point.bound.scaled(scales.0, scales.1);
        match point.normal {
            Some(n) => own.between(at.forces[n], at.gaps[n]),
            None => [own.at(0.0, false), 0.0, 0.0],
        }
    }

    /// The mean of λ y and γ b (1 − |ρ|²)/2.
    fn measure(&self, at: &Central) -> f64 {
        let normal = at
            .forces
            .iter()
            .zip(&at.gaps)
            .map(|(force, gap)| force * gap);
        let points = self
            .cones
            .laws
            .points
            .iter()
            .zip(at.rho.iter().zip(&at.gamma));
        let points = points.map(|(point, (rho, gamma))| {
            0.5 * gamma * self.bound(point, at)[0] * (1.0 - square(*rho))
        });
        let count = self
            .is_normal
            .iter()
            .filter(|is_normal| **is_normal)
            .count();
        let count = count + self.cones.laws.points.len();
        (normal.sum::<f64>() + points.sum::<f64>()) / count.max(1) as f64
    }

    /// All forces, those of points b ρ.
    fn forces(&self, at: &Central) -> Vec<f64> {
        let mut forces = at.forces.clone();
        for (point, rho) in self.cones.laws.points.iter().zip(&at.rho) {
            let [bound, ..] = self.bound(point, at);
            for (i, rho) in point.tangents.into_iter().zip(rho) {
                if let Some(i) = i {
                    forces[i] = bound * rho;
                }
            }
        }
        forces
    }

    fn place(&self, at: &Central) -> laws::Iterate {
        let m = self.c.len();
        let jumps = at.jumps.iter().zip(&self.root).map(|(t, r)| t / r);
        let of_rows = self.forces(at).into_iter().zip(&self.root).skip(m);
        let of_rows = of_rows.map(|(force, r)| force * r).collect();
        self.cones.place(jumps.collect(), of_rows)
    }

    /// A step towards the point of the path that has `epsilon`; the part of it that could be gone.
    fn advance(&self, at: &mut Central, epsilon: f64) -> Option<f64> {
        let forces = self.forces(at);
        let all = 0..forces.len();
        let ways: Vec<f64> = all.clone().map(|i| self.way(i, &at.jumps)).collect();
        // y + way = 0 isn't so at first.
        let missed: Vec<f64> = at
            .gaps
            .iter()
            .zip(&ways)
            .map(|(gap, way)| gap + way)
            .collect();
        // Changes of forces: factors of those of ways, and constants.
        let mut factors: Vec<(usize, usize, f64)> = Vec::new();
        let mut changes = vec![0.0; forces.len()];
        let normal = || all.clone().filter(|&i| self.is_normal[i]);
        for i in normal() {
            let (force, gap) = (at.forces[i], at.gaps[i]);
            factors.push((i, i, force / gap));
            changes[i] = (epsilon - force * gap + force * missed[i]) / gap;
        }
        let points = || self.cones.laws.points.iter().zip(&at.rho).zip(&at.gamma);
        let mut locals = Vec::new();
        for ((point, rho), gamma) in points() {
            let [bound, by_force, by_gap] = self.bound(point, at);
            let bound = bound.max(LEAST_BOUND * epsilon.sqrt());
            let (mut by_normal, mut change) = (0.0, 0.0);
            if let Some(n) = point.normal {
                by_normal = by_force * at.forces[n] / at.gaps[n] - by_gap;
                change = by_force * changes[n] - by_gap * missed[n];
            }
            let prescribed = point.prescribed * self.root[point.first];
            let slip = point.tangents.map(|i| i.map_or(prescribed, |i| ways[i]));
            let local = Local {
                bound,
                by_normal,
                change,
                slip: [0, 1].map(|k| slip[k] - gamma * rho[k]),
                product: 2.0 * epsilon / bound - gamma * (1.0 - square(*rho)),
            };
            let [first, second, _] = local.turn(*rho, *gamma, [0.0; 2], change);
            let whole = 1.0 + square(*rho);
            for (k, i) in point.tangents.into_iter().enumerate() {
                let Some(i) = i else { continue };
                changes[i] = bound * [first, second][k] + rho[k] * change;
                for (l, j) in point.tangents.into_iter().enumerate() {
                    let unit = if k == l { 1.0 } else { 0.0 };
                    let across = unit - 2.0 * rho[k] * rho[l] / whole;
                    factors.extend(j.map(|j| (i, j, bound / gamma * across)));
                }
                factors.extend(
                    point
                        .normal
                        .map(|n| (i, n, 2.0 / whole * rho[k] * by_normal)),
                );
            }
            locals.push(local);
        }
        let step = self.step(&at.jumps, &forces, &changes, &factors)?;
        let moved: Vec<f64> = all
            .clone()
            .map(|i| self.terms(i).iter().map(|&(j, c)| c * step[j]).sum())
            .collect();
        for (i, by, factor) in factors {
            changes[i] += factor * moved[by];
        }
        let of_gap = |i: usize| -moved[i] - missed[i];
        let turns: Vec<[f64; 3]> = (points().zip(&locals))
            .map(|(((point, rho), gamma), local)| {
                let slip = point.tangents.map(|i| i.map_or(0.0, |i| moved[i]));
                let by_normal = point.normal.map_or(0.0, |n| local.by_normal * moved[n]);
                local.turn(*rho, *gamma, slip, local.change + by_normal)
            })
            .collect();
        let until_none = |value: f64, change: f64| match change < 0.0 {
            true => WITHIN * value / -change,
            false => 1.0,
        };
        let mut part = 1.0_f64;
        for i in normal() {
            let force = until_none(at.forces[i], changes[i]);
            part = part.min(force).min(until_none(at.gaps[i], of_gap(i)));
        }
        for (((_, rho), gamma), [d, e, f]) in points().zip(&turns) {
            part = part.min(until_none(*gamma, *f));
            // Where 1 − |ρ|² has lost that part.
            let (room, along) = (WITHIN * (1.0 - square(*rho)), rho[0] * d + rho[1] * e);
            let root = along.mul_add(along, square([*d, *e]) * room).sqrt();
            if root + along > 0.0 {
                part = part.min(room / (root + along));
            }
        }
        (at.jumps.iter_mut().zip(&step)).for_each(|(t, step)| *t += part * step);
        for i in normal() {
            at.forces[i] += part * changes[i];
            at.gaps[i] += part * of_gap(i);
        }
        for ((rho, gamma), [d, e, f]) in at.rho.iter_mut().zip(&mut at.gamma).zip(turns) {
            *rho = [rho[0] + part * d, rho[1] + part * e];
            *gamma += part * f;
        }
        part.is_finite().then_some(part)
    }

    /// The change of the jumps where forces are these and change by `changes` and by `factors` of changes of ways.
    fn step(
        &self,
        jumps: &[f64],
        forces: &[f64],
        changes: &[f64],
        factors: &[(usize, usize, f64)],
    ) -> Option<Vec<f64>> {
        let m = self.c.len();
        let mut left = self.c.clone();
        for (column, &t) in self.h.col_iter().zip(jumps) {
            for (left, h) in left.iter_mut().zip(column.iter()) {
                *left -= h * t;
            }
        }
        for (i, (force, change)) in forces.iter().zip(changes).enumerate() {
            for (j, c) in self.terms(i) {
                left[j] -= c * (force + change);
            }
        }
        let mut a = self.h.clone();
        for &(i, by, factor) in factors {
            for (row, of_row) in self.terms(i) {
                for (column, of_column) in self.terms(by) {
                    a[(row, column)] += of_row * factor * of_column;
                }
            }
        }
        (0..m).for_each(|i| a[(i, i)] += SPRING);
        let lu = a.partial_piv_lu();
        let column = MatMut::from_column_major_slice_mut(&mut left, m, 1);
        lu.solve_in_place_with_conj(Conj::No, column);
        left.iter().all(|x| x.is_finite()).then_some(left)
    }
}

impl Local {
    /// Δρ and Δγ for these changes of slip and bound.
    fn turn(&self, rho: [f64; 2], gamma: f64, slip: [f64; 2], bound: f64) -> [f64; 3] {
        let slip = [0, 1].map(|k| self.slip[k] + slip[k]);
        let product = self.product - gamma * (1.0 - square(rho)) / self.bound * bound;
        let along = rho[0] * slip[0] + rho[1] * slip[1];
        let grows = (product + 2.0 * along) / (1.0 + square(rho));
        let turn = |k: usize| (slip[k] - rho[k] * grows) / gamma;
        [turn(0), turn(1), grows]
    }
}

fn square([a, b]: [f64; 2]) -> f64 {
    a * a + b * b
}
