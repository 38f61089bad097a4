//! Semismooth Newton: (S_0 + S_CON'(U)) δ = r.
//!
//! A sweep freezes every pair's active set at U^(k−1) and solves the linear interface problem. r is
//! minus the gradient of a convex energy, along which a line search gets down.
//!
use super::frozen::Frozen;
use super::{Residual, SweepStatus, Sweeps, axpy, dot};
use crate::contact::s_con::Openings;

/// Sweeps before another method takes over.
const MAX_SWEEPS: usize = 80;
/// Share of the bilateral operator that is blended in where the derivative is singular.
const BLEND: f64 = 1e-3;

impl Sweeps<'_, '_> {
    pub(super) fn newton(&mut self, u: &mut [f64], mut residual: Residual) -> SweepStatus {
        let limit = self.settings.max_sweeps.unwrap_or(MAX_SWEEPS);
        while !self.is_converged(&residual) {
            // A pair that fails at a residual of zero fails again.
            if residual.relative == 0.0 && residual.totals.failed_pairs > 0 {
                return self.gave_up(&residual, "newton stopped");
            }
            if self.sweeps_done() >= limit {
                if self.settings.max_sweeps.is_some() {
                    return self.gave_up(&residual, "newton stopped");
                }
                self.notes.push(format!(
                    "newton didn't converge in {limit} sweeps; anderson took over"
                ));
                return self.anderson(u, residual);
            }
            let frozen = Frozen::new(self.interface, &self.state);
            let (r, scale) = (&residual.r, residual.scale);
            let step = frozen
                .solve(r, scale)
                .or_else(|| frozen.solve_blended(r, scale, 0.0))
                .or_else(|| frozen.solve_blended(r, scale, BLEND));
            let Some(step) = step else {
                return self.gave_up(&residual, "newton found no direction");
            };
            residual = self.line_search(u, &step, &residual);
            self.record(&residual);
        }
        SweepStatus::Converged
    }

    /// Moves U along `step` and returns the residual there.
    ///
    /// r is minus the gradient of a convex energy: a step too far shows in a slope stepᵀr that has
    /// turned and is as steep as before; then a shorter one is taken. The residual's size may rise.
    fn line_search(&mut self, u: &mut [f64], step: &[f64], before: &Residual) -> Residual {
        let slope = dot(step, &before.r);
        let mut alpha = 1.0;
        loop {
            let mut trial = u.to_vec();
            axpy(alpha, step, &mut trial);
            let residual = self.residual(&trial, Openings::Changed);
            let there = dot(step, &residual.r);
            let accepted = there >= -0.9 * slope || self.is_converged(&residual);
            if accepted || alpha < 1e-4 {
                u.copy_from_slice(&trial);
                return residual;
            }
            alpha *= (slope / (slope - there)).clamp(0.1, 0.6);
        }
    }
}
