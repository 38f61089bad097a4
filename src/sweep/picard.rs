//! The paper's successive approximations: S_0 U^k = F − S_CON U^(k−1), (18), with relaxation.
//!
//! They converge where ρ(S_0⁻¹ S_CON') < 1, which the paper leaves open and which equal
//! stiffness on both sides of Γ doesn't give; relaxed, U ← U + θ S_0⁻¹ r converges for
//! θ < 2 / (1 + λ), λ the largest eigenvalue of S_0⁻¹ S_CON', wherever S_0 is regular.

use super::method::Memory;
use super::{Next, Residual, SweepStatus, Sweeps, axpy};
use crate::schur::factor::BoundaryLastCholesky;
use crate::vector::{dot, largest};

/// Sweeps before it gives up.
const MAX_SWEEPS: usize = 2000;
/// Steps of the power iteration.
const POWER_STEPS: usize = 60;
/// Growth of U over the bilateral start at which it diverges.
const DIVERGED: f64 = 1e8;

/// θ and where it began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation {
    theta: f64,
    /// ρ(S_0⁻¹ S_CON').
    rho: f64,
    first_residual: f64,
    /// ‖U^0‖∞.
    start: f64,
}

impl Sweeps<'_, '_> {
    pub(super) fn picard(&mut self, relaxation: Option<Relaxation>, before: Residual) -> Next {
        if self.s_0.is_none() {
            self.s_0 = self.problem.interface.factor_s_0();
        }
        let Some(s_0) = self.s_0.take() else {
            return Next::End(SweepStatus::NotConverged(
                "S_0 is singular: a part of the interface belongs to contact subdomains alone, or \
                 a linear subdomain floats, so that (18) isn't defined for this partition; use \
                 --method newton or --method anderson"
                    .into(),
            ));
        };
        let relaxation = relaxation.unwrap_or_else(|| self.relaxation(&s_0, before.relative));
        let Relaxation { theta, rho, .. } = relaxation;
        let growth = largest(&self.progress.u) / relaxation.start;
        let diverged = !before.relative.is_finite() || growth > DIVERGED;
        let limit = self.settings.max_sweeps.unwrap_or(MAX_SWEEPS);
        if diverged || self.sweeps_done() >= limit {
            let why = if diverged {
                format!(
                    "(18) with relaxation {theta:.4} diverges: the spectral radius of \
                     S_0^-1 S_CON' is about {rho:.3}; use --method newton; stopped"
                )
            } else {
                format!(
                    "picard with relaxation {theta:.4} isn't there (it began at a residual of \
                     {:.1e}; use --method newton); stopped",
                    relaxation.first_residual
                )
            };
            return Next::End(self.gave_up(&before, &why));
        }
        let mut step = before.r;
        s_0.solve(&mut step);
        axpy(theta, &step, &mut self.progress.u);
        let residual = self.evaluate(None);
        self.s_0 = Some(s_0);
        Next::Sweep(Memory::Picard(Some(relaxation)), residual)
    }

    /// The relaxation that is set or converges, and a note about it.
    fn relaxation(&mut self, s_0: &BoundaryLastCholesky, first_residual: f64) -> Relaxation {
        let rho = self.spectral_radius(s_0);
        let theta = self.settings.relaxation.unwrap_or(2.0 / (2.0 + rho));
        let verdict = if rho < 1.0 {
            "(18) as printed converges here"
        } else {
            "(18) as printed diverges here"
        };
        self.progress.notes.push(format!(
            "picard: the spectral radius of S_0^-1 S_CON' is about {rho:.3}, so that {verdict}; \
             relaxation {theta:.4}"
        ));
        Relaxation {
            theta,
            rho,
            first_residual,
            start: largest(&self.progress.u).max(f64::MIN_POSITIVE),
        }
    }

    /// ρ(S_0⁻¹ S_CON') at the active sets of the last evaluation, by power iteration from a vector
    /// that no symmetry of a scene can be orthogonal to.
    fn spectral_radius(&mut self, s_0: &BoundaryLastCholesky) -> f64 {
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
            s_0.solve(&mut y);
            rho = dot(&y, &y).sqrt();
            x = y;
        }
        rho
    }
}
