//! Random points with friction, and the residual of a solution in their laws.

use faer::Mat;

use crate::contact::active_set::{ContactProblem, ContactSolution};
use crate::contact::dependent::DependentConstraints;
use crate::contact::friction::{ForceBound, FrictionProblem, Status};
use crate::contact::limits::{OtherTangent, TangentialLimit};
use crate::contact::patch::LastPatch;

pub const COULOMB: ForceBound = ForceBound {
    coefficient: 0.3,
    cohesion: 0.0,
    only_closed: true,
};
pub const GIVEN: ForceBound = ForceBound {
    coefficient: 0.0,
    cohesion: 0.4,
    only_closed: false,
};

/// Points with a normal jump and one or two tangential ones each, normals first, on a random stiffness.
pub struct Points {
    pub h: Mat<f64>,
    pub diagonal: Vec<f64>,
    pub c: Vec<f64>,
    pub bounds: Vec<f64>,
    pub rows: DependentConstraints,
    pub tangents: Vec<TangentialLimit>,
}

/// Reproducible number from −1 to 1.
pub fn noise(seed: usize) -> f64 {
    2.0 * ((seed as f64 * 78.233).sin() * 43758.5453).fract().abs() - 1.0
}

impl Points {
    /// Points in the plane.
    pub fn new(points: usize, seed: usize, bound: ForceBound) -> Self {
        Self::with_tangents(1, points, seed, bound)
    }

    /// Points in space.
    pub fn in_space(points: usize, seed: usize, bound: ForceBound) -> Self {
        Self::with_tangents(2, points, seed, bound)
    }

    fn with_tangents(each: usize, points: usize, seed: usize, bound: ForceBound) -> Self {
        let m = (1 + each) * points;
        let a = Mat::from_fn(m, m, |i, j| noise(seed + 7 * i + 131 * j));
        let mut h = a.transpose() * &a;
        for i in 0..m {
            h[(i, i)] += 2.0;
        }
        let tangent = |k: usize| TangentialLimit {
            limit: points + k,
            normal: Some(k / each),
            bound,
            other: match each {
                1 => OtherTangent::Nothing,
                _ => OtherTangent::Limit(points + (k ^ 1)),
            },
        };
        Self {
            diagonal: (0..m).map(|i| h[(i, i)]).collect(),
            h,
            c: (0..m).map(|i| 3.0 * noise(seed + 1000 + i)).collect(),
            bounds: (0..m).map(|i| 0.1 * noise(seed + 2000 + i)).collect(),
            rows: DependentConstraints::default(),
            tangents: (0..each * points).map(tangent).collect(),
        }
    }

    /// Replaces the stiffness.
    pub fn set_stiffness(&mut self, m: usize, entry: impl Fn(usize, usize) -> f64) {
        self.h = Mat::from_fn(m, m, entry);
        self.diagonal = (0..m).map(|i| self.h[(i, i)]).collect();
    }

    pub fn solve(&self, status: &mut [Status]) -> ContactSolution {
        self.with(|problem| problem.solve(status))
    }

    pub fn with<T>(&self, ask: impl FnOnce(&FrictionProblem<'_>) -> T) -> T {
        let m = self.c.len();
        let c_scale: Vec<f64> = self.c.iter().map(|c| c.abs()).collect();
        ask(&FrictionProblem {
            contact: ContactProblem {
                h: self.h.as_ref(),
                diagonal: &self.diagonal,
                c: &self.c,
                c_scale: &c_scale,
                rows: &self.rows,
                bounds: &self.bounds,
                center: &vec![0.0; m],
                scale: 1.0,
            },
            tangents: &self.tangents,
            last_patch: &LastPatch::default(),
        })
    }

    /// Solution from all limits closed, and its statuses; fails unless it converges and violates equilibrium and laws
    /// by less than `tolerance`.
    #[track_caller]
    pub fn solved(&self, what: &str, tolerance: f64) -> (ContactSolution, Vec<Status>) {
        let mut status = vec![Status::Closed; self.bounds.len()];
        let solution = self.solve(&mut status);
        assert!(solution.converged, "{what}");
        let violation = self.violation(&solution);
        assert!(violation < tolerance, "{what}: {violation:e}");
        (solution, status)
    }

    /// Largest violation of equilibrium and of the laws.
    pub fn violation(&self, solution: &ContactSolution) -> f64 {
        let (t, forces) = (&solution.jumps, &solution.forces);
        let m = t.len();
        let mut left = self.c.clone();
        self.rows.subtract_transposed(&forces[m..], &mut left);
        let held = |i: usize| (0..m).map(|j| self.h[(i, j)] * t[j]).sum::<f64>();
        let unbalanced = (0..m).map(|i| (left[i] - held(i) - forces[i]).abs());
        let mut worst = unbalanced.fold(0.0, f64::max);
        let rows = (0..self.rows.len()).map(|j| self.rows.value(j, t));
        let values: Vec<f64> = t.iter().copied().chain(rows).collect();
        let beyond = |i: usize| values[i] - self.bounds[i];
        let is_tangential = |i: usize| self.tangents.iter().any(|tangent| tangent.limit == i);
        for i in (0..values.len()).filter(|&i| !is_tangential(i)) {
            let product = (beyond(i) * forces[i]).abs();
            worst = worst.max(beyond(i)).max(-forces[i]).max(product);
        }
        for tangent in &self.tangents {
            let (other, slip) = match tangent.other {
                OtherTangent::Limit(other) => (forces[other], beyond(other)),
                OtherTangent::Prescribed(slip) => (0.0, slip),
                OtherTangent::Nothing => (0.0, 0.0),
            };
            let normal = tangent.normal.map_or(0.0, |n| forces[n]);
            let (force, own) = (forces[tangent.limit], beyond(tangent.limit));
            let (size, of_force) = (own.hypot(slip), force.hypot(other));
            let (least, most) = match tangent.normal {
                // About to open, under the rest of the cohesion.
                Some(n) if normal == 0.0 && beyond(n) > -1e-12 => {
                    (0.0, tangent.bound.at(0.0, true))
                }
                _ => [tangent.bound.at(normal, normal > 0.0); 2].into(),
            };
            worst = worst.max(match tangent.other {
                OtherTangent::Prescribed(_) => (force * size - most * own).abs(),
                _ => {
                    let opposed = of_force.max(least) * size - force * own - other * slip;
                    (of_force - most).max(opposed.abs())
                }
            });
        }
        worst
    }
}
