//! Newton's method for generalized equations: every sweep solves the contact problem of all pairs,
//! coupled through the interface.
//!
//! S_CON is piecewise linear. Freezing every pair's active set at U^(k−1) gives semismooth Newton,
//! whose sets may peel off one condition a sweep; keeping the law as it stands, λ ≥ 0, t ≤ g, gives
//! a [`CoupledContact`] whose solution is U: one sweep gets there, the next ones take off round-off.

use super::{ROUND_OFF, Residual, SweepStatus, Sweeps, axpy};
use crate::interface::coupled::CoupledContact;

/// Sweeps before another method takes over.
const MAX_SWEEPS: usize = 20;
/// Sweeps in a row that change no contact and leave half of the residual before that is what round-off
/// of stiff bodies leaves it.
const PATIENCE: usize = 3;
/// Residual to which the other method goes.
const FALL_BACK_TOLERANCE: f64 = 1e-13;

impl Sweeps<'_, '_> {
    pub(super) fn newton(&mut self, u: &mut [f64], mut residual: Residual) -> SweepStatus {
        let limit = self.settings.max_sweeps.unwrap_or(MAX_SWEEPS);
        if self.is_converged(&residual) {
            return SweepStatus::Converged;
        }
        let Some(coupled) = CoupledContact::new(self.interface) else {
            return self.fall_back(u, residual, "the pairs have too many conditions for newton");
        };
        let mut stalls = 0;
        while !self.is_converged(&residual) {
            if self.sweeps_done() >= limit {
                if self.settings.max_sweeps.is_some() {
                    return self.gave_up(&residual, "newton stopped");
                }
                let why = format!("newton didn't converge in {limit} sweeps");
                return self.fall_back(u, residual, &why);
            }
            let step = coupled.solve(u, &residual.r, &self.state);
            self.inner_steps += step.steps;
            if step.fell_back {
                self.fell_back("newton: the interior-point method named the closed contacts");
            }
            if !step.converged {
                return self.fall_back(u, residual, "newton's contact problem didn't converge");
            }
            axpy(1.0, &step.u, u);
            let before = std::mem::replace(&mut residual, self.residual(u, Some(&step.open)));
            self.record(&residual);
            let stalled =
                residual.totals.changed == 0 && residual.relative >= 0.5 * before.relative;
            stalls = if stalled { stalls + 1 } else { 0 };
            if stalls == PATIENCE && !self.is_converged(&residual) {
                return self.fall_back(u, residual, "newton got no further");
            }
            // A contact without force and gap may come out open at the root and closed in its pair.
            let tolerance = self.settings.tolerance;
            let settled = before.relative.max(residual.relative) <= tolerance;
            if settled && residual.totals.failed_pairs == 0 {
                break;
            }
        }
        SweepStatus::Converged
    }

    fn fall_back(&mut self, u: &mut [f64], residual: Residual, why: &str) -> SweepStatus {
        self.fell_back(&format!("{why}; anderson took over"));
        // There may be nothing to refine with afterwards.
        self.settings.tolerance = self.settings.tolerance.min(FALL_BACK_TOLERANCE);
        self.anderson(u, residual)
    }

    /// Newton's steps beyond the tolerance of the sweeps, which isn't what limits the solution.
    pub(super) fn refine(&mut self, u: &mut [f64]) {
        let mut residual = self.residual(u, None);
        for _ in 0..MAX_REFINEMENTS {
            if residual.relative <= ROUND_OFF {
                return;
            }
            let Some(coupled) = CoupledContact::new(self.interface) else {
                return;
            };
            let step = coupled.solve(u, &residual.r, &self.state);
            self.inner_steps += step.steps;
            let mut refined = u.to_vec();
            axpy(1.0, &step.u, &mut refined);
            let after = self.residual(&refined, Some(&step.open));
            if !step.converged
                || after.totals.failed_pairs > 0
                || after.relative > 0.5 * residual.relative
            {
                return;
            }
            u.copy_from_slice(&refined);
            residual = after;
        }
    }
}

/// Most refinements after the sweeps.
const MAX_REFINEMENTS: usize = 3;
