//! The paper's successive approximations: S_0 U^k = F − S_CON U^(k−1), (18), with relaxation.
//!
//! They converge if ρ(S_0⁻¹ S_CON') < 1, which the paper doesn't discuss and which doesn't hold for equal stiffness on
//! both sides of Γ. With relaxation, U ← U + θ S_0⁻¹ r converges for θ < 2 / (1 + λ), λ the largest eigenvalue of S_0⁻¹
//! S_CON'. If S_0 is singular, a fraction of the pairs' bilateral Schur complements is moved from S_CON to S_0, which
//! leaves the solution unchanged.

use super::{Residual, SweepStatus, Sweeps};
use crate::error::Failure;
use crate::schur::factor::BoundaryLastCholesky;
use crate::vector::{axpy, dot, largest};

/// Most sweeps.
const MAX_SWEEPS: usize = 2000;
/// Number of power iterations.
const POWER_STEPS: usize = 60;
/// Growth of U over the bilateral start above which the method counts as diverged.
const DIVERGED: f64 = 1e8;

impl Sweeps<'_, '_> {
    pub(super) fn picard(&mut self, mut residual: Residual) -> Result<SweepStatus, Failure> {
        if !self.needs_sweep(&residual)? {
            return Ok(SweepStatus::Converged);
        }
        let Some((s_0, share)) = self.problem.interface.factor_s_0() else {
            return Ok(SweepStatus::NotConverged(
                "S_0 is singular, so that (18) isn't defined for this partition; use --method \
                 newton or --method anderson"
                    .into(),
            ));
        };
        if share > 0.0 {
            self.outcome.notes.push(format!(
                "picard: S_0 is singular, a part of the interface belongs to contact alone: \
                 {share} of the pairs' bilateral Schur complements is counted to it"
            ));
        }
        let rho = self.spectral_radius(&s_0, share);
        let theta = self.relaxation(rho);
        let first_residual = residual.relative;
        let start = largest(&self.outcome.u).max(f64::MIN_POSITIVE);
        let limit = self.settings.max_sweeps.unwrap_or(MAX_SWEEPS);
        while self.needs_sweep(&residual)? {
            let growth = largest(&self.outcome.u) / start;
            if !residual.relative.is_finite() || growth > DIVERGED {
                let why = format!(
                    "(18) with relaxation {theta:.4} diverges: the spectral radius of \
                     S_0^-1 S_CON' is about {rho:.3}; use --method newton; stopped"
                );
                return Ok(self.gave_up(&residual, &why));
            }
            if self.sweeps_done() >= limit {
                let why = format!(
                    "picard with relaxation {theta:.4} hasn't converged (the residual was {first_residual:.1e} at \
                     first; use --method newton); stopped"
                );
                return Ok(self.gave_up(&residual, &why));
            }
            let mut step = residual.r;
            s_0.solve(&mut step);
            axpy(theta, &step, &mut self.outcome.u);
            residual = self.evaluate(None);
        }
        Ok(SweepStatus::Converged)
    }

    /// The relaxation θ, set by the user or convergent by the estimate of ρ, with a note about it.
    fn relaxation(&mut self, rho: f64) -> f64 {
        let theta = self.settings.relaxation.unwrap_or(2.0 / (2.0 + rho));
        let verdict = if rho < 1.0 {
            "(18) as printed converges"
        } else {
            "(18) as printed diverges"
        };
        self.outcome.notes.push(format!(
            "picard: the spectral radius of S_0^-1 S_CON' is about {rho:.3} with the contacts that are closed at the \
             start, with which {verdict}; relaxation {theta:.4}"
        ));
        theta
    }

    /// ρ(S_0⁻¹ S_CON') at the active sets of the last evaluation, where a `share` of S_CON' is moved to S_0; by power
    /// iteration from a vector that isn't orthogonal to any mode by symmetry.
    fn spectral_radius(&mut self, s_0: &BoundaryLastCholesky, share: f64) -> f64 {
        let n = self.problem.interface.len;
        let mut x: Vec<f64> = (0..n)
            .map(|i| 1.0 + (i as f64 * 0.754_877_666).fract())
            .collect();
        let mut rho = 0.0;
        for _ in 0..POWER_STEPS {
            let norm = dot(&x, &x).sqrt();
            if norm == 0.0 {
                return 0.0;
            }
            for x in &mut x {
                *x /= norm;
            }
            let mut y = vec![0.0; n];
            self.s_con
                .add_derivative(self.problem.interface, &x, &mut y);
            if share > 0.0 {
                (self.problem.interface).add_bilateral_con(-share, &x, &mut y);
            }
            s_0.solve(&mut y);
            rho = dot(&y, &y).sqrt();
            x = y;
        }
        rho
    }
}
