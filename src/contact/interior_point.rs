//! Which conditions open, by Mehrotra's predictor-corrector interior-point method.
//!
//! The problem in gaps, w = q + H s with s, w ≥ 0 and sᵀw = 0, is solved along the path sᵢwᵢ = μ → 0
//! in some twenty steps whatever the number of conditions and however H is conditioned, where an
//! active set may open them one by one or turn in circles.

use faer::linalg::solvers::SolveCore;
use faer::{Conj, Mat, MatMut, MatRef, Side};

/// Most steps.
const MAX_STEPS: usize = 60;
/// Mean product of gap and force, relative to their scales, at which it ends.
const TOLERANCE: f64 = 1e-20;
/// Share of the way to the next bound that a step takes.
const SHARE: f64 = 0.995;
/// Stiffness relative to the diagonal that keeps a motion that nothing resists bounded.
const SPRING: f64 = 1e-13;

/// The conditions that are open in the solution of w = q + H s, with gaps s and forces w, and the
/// number of linear systems solved; `scale` measures the diagonal of H.
pub fn open_conditions(h: MatRef<'_, f64>, q: &[f64], scale: &[f64]) -> (Vec<bool>, usize) {
    let n = q.len();
    // Gaps and forces become square roots of energies, so that units don't matter.
    let root: Vec<f64> = scale.iter().map(|d| d.sqrt()).collect();
    let load = (0..n).fold(0.0, |m: f64, i| m.max((q[i] / root[i]).abs()));
    if load == 0.0 || !load.is_finite() {
        return (vec![false; n], 0);
    }
    let q: Vec<f64> = (0..n).map(|i| q[i] / root[i] / load).collect();
    let h = Mat::from_fn(n, n, |i, j| {
        h[(i, j)] / root[i] / root[j] + if i == j { SPRING } else { 0.0 }
    });
    let mut point = Point {
        s: vec![1.0; n],
        w: vec![1.0; n],
    };
    let mut steps = 0;
    while steps < MAX_STEPS && point.mean_product() > TOLERANCE {
        steps += 1;
        let Some(moved) = point.step(h.as_ref(), &q) else {
            break;
        };
        point = moved;
    }
    let open = (point.s.iter().zip(&point.w)).map(|(s, w)| s > w).collect();
    (open, steps)
}

/// Gaps and forces, all positive.
struct Point {
    s: Vec<f64>,
    w: Vec<f64>,
}

impl Point {
    fn mean_product(&self) -> f64 {
        let sum: f64 = self.s.iter().zip(&self.w).map(|(s, w)| s * w).sum();
        sum / self.s.len() as f64
    }

    /// One predictor and one corrector; `None` where round-off leaves no step.
    fn step(&self, h: MatRef<'_, f64>, q: &[f64]) -> Option<Self> {
        let n = q.len();
        let mut missing = q.to_vec();
        for (column, &s) in h.col_iter().zip(&self.s) {
            for (missing, h) in missing.iter_mut().zip(column.iter()) {
                *missing += h * s;
            }
        }
        for (missing, w) in missing.iter_mut().zip(&self.w) {
            *missing -= w;
        }
        let mut matrix = h.to_owned();
        for i in 0..n {
            matrix[(i, i)] += self.w[i] / self.s[i];
        }
        let factor = matrix.llt(Side::Lower).ok()?;
        let solve = |target: &[f64]| {
            let mut ds: Vec<f64> = (0..n)
                .map(|i| target[i] / self.s[i] - self.w[i] - missing[i])
                .collect();
            let column = MatMut::from_column_major_slice_mut(&mut ds, n, 1);
            factor.solve_in_place_with_conj(Conj::No, column);
            let dw: Vec<f64> = (0..n)
                .map(|i| (target[i] - self.w[i] * ds[i]) / self.s[i] - self.w[i])
                .collect();
            (ds, dw)
        };
        let (ds, dw) = solve(&vec![0.0; n]);
        let mu = self.mean_product();
        let predicted = self.moved(&ds, &dw, self.reach(&ds, &dw)).mean_product();
        let aim = mu * (predicted / mu).powi(3);
        let target: Vec<f64> = (0..n).map(|i| aim - ds[i] * dw[i]).collect();
        let (ds, dw) = solve(&target);
        let reach = self.reach(&ds, &dw);
        if reach.is_nan() || reach < 1e-10 {
            return None;
        }
        Some(self.moved(&ds, &dw, (SHARE * reach).min(1.0)))
    }

    /// How far a step may go until a gap or a force is zero, at most 1/SHARE.
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
