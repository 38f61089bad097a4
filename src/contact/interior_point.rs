//! Convex contact problems by Mehrotra's predictor-corrector interior-point method.
//!
//! With the values v = \[I; D\] t − \[g; d\] of all limits,
//!
//! ```text
//! min ½ tᵀ H t − cᵀ t + Σ b |v|  over points with given friction,  subject to  v ≤ 0  along normals
//! ```
//!
//! is solved along the path on which gap s = −v and force w of every normal limit have the product s w = μ → 0, and
//! slip and force of every point in their cones, too (`cone`), in some twenty to fifty steps whatever the number of
//! conditions and the condition of H, where Newton's method on statuses may change them one by one or cycle.

mod cone;
mod iterate;
mod problem;
mod scaled;

pub use self::problem::{ConvexProblem, GivenFriction};
use self::scaled::Scaled;

/// Maximum number of steps.
const MAX_STEPS: usize = 80;
/// Mean product of gap and force, relative to their scales, at which the method ends.
const TOLERANCE: f64 = 1e-20;
/// Steps in a row that may fail to halve the smallest mean product: round-off keeps it from falling.
const PATIENCE: usize = 10;

/// An approximate solution.
#[derive(Debug)]
pub struct NearSolution {
    /// t.
    pub jumps: Vec<f64>,
    /// Forces of the rows.
    pub of_rows: Vec<f64>,
    /// Flags of the open limits, false for tangential ones.
    pub open: Vec<bool>,
    /// Linear systems solved.
    pub steps: usize,
}

impl ConvexProblem<'_> {
    /// The solution to within round-off, or as near as the steps come.
    pub fn solve(&self) -> NearSolution {
        let n = self.c.len();
        let mut near = NearSolution {
            jumps: self.bounds[..n].to_vec(),
            of_rows: vec![0.0; self.rows.len()],
            open: vec![false; self.bounds.len()],
            steps: 0,
        };
        let Some(scaled) = Scaled::new(self) else {
            return near;
        };
        let mut at = scaled.start();
        let (mut best, mut patience) = (at.clone(), PATIENCE);
        while near.steps < MAX_STEPS && patience > 0 && best.mean_product() > TOLERANCE {
            near.steps += 1;
            let Some(moved) = scaled.step(&at) else {
                break;
            };
            at = moved;
            match at.mean_product() < 0.5 * best.mean_product() {
                true => (best, patience) = (at.clone(), PATIENCE),
                false => patience -= 1,
            }
        }
        let at = best;
        let forces = scaled.forces(&at);
        let all = near.jumps.iter_mut().zip(at.t.iter().zip(&scaled.size));
        all.for_each(|(t, (scaled_t, size))| *t = scaled_t * scaled.load / size);
        for (j, force) in near.of_rows.iter_mut().enumerate() {
            *force = forces[n + j] * scaled.load * scaled.size[n + j];
        }
        for (&i, (s, w)) in scaled.normals.iter().zip(at.s.iter().zip(&at.w)) {
            near.open[i] = s > w;
            if let Some(t) = near.jumps.get_mut(i) {
                *t = self.bounds[i] - s * scaled.load / scaled.size[i];
            }
        }
        near
    }
}
