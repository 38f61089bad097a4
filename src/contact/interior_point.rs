//! Open conditions by Mehrotra's predictor-corrector interior-point method.
//!
//! The problem in gaps, w = q + H s with s, w ≥ 0 and sᵀw = 0, is solved along the path sᵢwᵢ = μ → 0
//! in some twenty steps whatever the number of conditions and the condition of H, where an
//! active set may open them one by one or cycle. Linearly dependent constraints add gaps
//! σ = e + D s ≥ 0 and forces μ ≥ 0, w + Dᵀ μ = q + H s.

use faer::linalg::solvers::SolveCore;
use faer::{Conj, Mat, MatMut, MatRef, Side};

use super::dependent::DependentConstraints;
use crate::schur::local::multiply_add;
use crate::vector::axpy;

/// Maximum number of steps.
const MAX_STEPS: usize = 60;
/// Mean product of gap and force, relative to their scales, at which the method ends.
const TOLERANCE: f64 = 1e-20;
/// Length of a step relative to that which reaches the next bound.
const SHARE: f64 = 0.995;
/// Stiffness, relative to the diagonal, that bounds motions without resistance.
const SPRING: f64 = 1e-15;

/// The problem.
#[derive(Clone, Copy, Debug)]
pub struct InGaps<'a> {
    /// H.
    pub h: MatRef<'a, f64>,
    /// q.
    pub q: &'a [f64],
    /// Scales of the diagonal of H.
    pub scale: &'a [f64],
    /// D.
    pub rows: &'a DependentConstraints,
    /// e.
    pub e: &'a [f64],
}

impl InGaps<'_> {
    /// Open conditions of the solution, those of gaps first, the gaps, and the number of linear systems solved.
    pub fn open_conditions(&self) -> (Vec<bool>, Vec<f64>, usize) {
        let n = self.q.len();
        let all = n + self.rows.len();
        // Gaps and forces become square roots of energies, so that units don't matter.
        let root: Vec<f64> = self.scale.iter().map(|d| d.sqrt()).collect();
        let mut rows = DependentConstraints::default();
        let mut e = Vec::with_capacity(self.e.len());
        for (row, e_j) in self.rows.iter().zip(self.e) {
            let scaled = row.iter().map(|&(i, c)| (i, c / root[i]));
            let size = scaled.clone().map(|(_, c)| c * c).sum::<f64>().sqrt();
            rows.push(scaled.map(|(i, c)| (i, c / size)).collect());
            e.push(e_j / size);
        }
        let load = (0..n).fold(0.0, |m: f64, i| m.max((self.q[i] / root[i]).abs()));
        let load = e.iter().fold(load, |m, e| m.max(e.abs()));
        if load == 0.0 || !load.is_finite() {
            return (vec![false; all], vec![0.0; n], 0);
        }
        let problem = Scaled {
            h: Mat::from_fn(n, n, |i, j| {
                self.h[(i, j)] / root[i] / root[j] + if i == j { SPRING } else { 0.0 }
            }),
            q: (0..n).map(|i| self.q[i] / root[i] / load).collect(),
            e: e.iter().map(|e| e / load).collect(),
            rows,
        };
        let mut point = Point {
            s: vec![1.0; all],
            w: vec![1.0; all],
        };
        let mut steps = 0;
        while steps < MAX_STEPS && point.mean_product() > TOLERANCE {
            steps += 1;
            let Some(moved) = problem.step(&point) else {
                break;
            };
            point = moved;
        }
        let open = (point.s.iter().zip(&point.w)).map(|(s, w)| s > w).collect();
        let gaps = (point.s.iter().zip(&root)).map(|(s, root)| s * load / root);
        (open, gaps.collect(), steps)
    }
}

/// The problem without units.
struct Scaled {
    h: Mat<f64>,
    q: Vec<f64>,
    rows: DependentConstraints,
    e: Vec<f64>,
}

impl Scaled {
    /// Residuals q + H s − w − Dᵀ μ, then e + D s − σ.
    fn missing(&self, point: &Point) -> Vec<f64> {
        let n = self.q.len();
        let mut missing = self.q.clone();
        multiply_add(self.h.as_ref(), &point.s, &mut missing);
        axpy(-1.0, &point.w, &mut missing);
        self.rows.subtract_transposed(&point.w[n..], &mut missing);
        for (j, e) in self.e.iter().enumerate() {
            missing.push(e + self.rows.value(j, &point.s) - point.s[n + j]);
        }
        missing
    }

    /// H with the slopes w/s of all conditions.
    fn matrix(&self, point: &Point) -> Mat<f64> {
        let n = self.q.len();
        let mut matrix = self.h.clone();
        for i in 0..n {
            matrix[(i, i)] += point.w[i] / point.s[i];
        }
        for (j, row) in self.rows.iter().enumerate() {
            let slope = point.w[n + j] / point.s[n + j];
            for &(b, d_b) in row {
                for &(a, d_a) in row {
                    matrix[(a, b)] += slope * d_a * d_b;
                }
            }
        }
        matrix
    }

    /// Predictor and corrector; `None` where round-off leaves no step.
    fn step(&self, point: &Point) -> Option<Point> {
        let (n, all) = (self.q.len(), point.s.len());
        let missing = self.missing(point);
        let factor = self.matrix(point).llt(Side::Lower).ok()?;
        let solve = |target: &[f64]| {
            let mut ds: Vec<f64> = (0..n)
                .map(|i| target[i] / point.s[i] - point.w[i] - missing[i])
                .collect();
            let of_rows: Vec<f64> = (n..all)
                .map(|i| point.w[i] - (target[i] - point.w[i] * missing[i]) / point.s[i])
                .collect();
            self.rows.subtract_transposed(&of_rows, &mut ds);
            let column = MatMut::from_column_major_slice_mut(&mut ds, n, 1);
            factor.solve_in_place_with_conj(Conj::No, column);
            for j in 0..self.rows.len() {
                ds.push(self.rows.value(j, &ds) + missing[n + j]);
            }
            let dw: Vec<f64> = (0..all)
                .map(|i| (target[i] - point.w[i] * ds[i]) / point.s[i] - point.w[i])
                .collect();
            (ds, dw)
        };
        let (ds, dw) = solve(&vec![0.0; all]);
        let mu = point.mean_product();
        let predicted = point.moved(&ds, &dw, point.reach(&ds, &dw)).mean_product();
        let aim = mu * (predicted / mu).powi(3);
        let target: Vec<f64> = (0..all).map(|i| aim - ds[i] * dw[i]).collect();
        let (ds, dw) = solve(&target);
        let reach = point.reach(&ds, &dw);
        if reach.is_nan() || reach < 1e-10 {
            return None;
        }
        Some(point.moved(&ds, &dw, (SHARE * reach).min(1.0)))
    }
}

/// Gaps and forces of all conditions, all positive.
struct Point {
    s: Vec<f64>,
    w: Vec<f64>,
}

impl Point {
    fn mean_product(&self) -> f64 {
        let sum: f64 = self.s.iter().zip(&self.w).map(|(s, w)| s * w).sum();
        sum / self.s.len() as f64
    }

    /// Length of the step to the first zero gap or force, at most 1/SHARE.
    fn reach(&self, ds: &[f64], dw: &[f64]) -> f64 {
        let steps = self.s.iter().zip(ds).chain(self.w.iter().zip(dw));
        steps.fold(1.0 / SHARE, |reach, (x, dx)| {
            if *dx < 0.0 { reach.min(-x / dx) } else { reach }
        })
    }

    fn moved(&self, ds: &[f64], dw: &[f64], share: f64) -> Self {
        let add = |x: &[f64], dx: &[f64]| {
            (x.iter().zip(dx))
                .map(|(x, dx)| (x + share * dx).max(f64::MIN_POSITIVE))
                .collect()
        };
        Self {
            s: add(&self.s, ds),
            w: add(&self.w, dw),
        }
    }
}
