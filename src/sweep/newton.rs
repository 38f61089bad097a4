//! Newton's method for generalized equations, S_0 δ + S_CON(U + δ) − S_CON(U) = r: every sweep solves the
//! contact problem of all pairs, coupled through the interface.
//!
//! S_CON is piecewise linear. With every pair's active set fixed at U^(k−1), this is semismooth Newton, whose active
//! set may change by one constraint per sweep; with the contact laws λ ≥ 0, t ≤ g kept, it is a [`CoupledContact`]
//! problem whose solution is U: one sweep solves it, further ones remove round-off.

use super::{ROUND_OFF, Residual, SweepStatus, Sweeps};
use crate::error::Failure;
use crate::interface::coupled::CoupledContact;
use crate::vector::axpy;

/// Sweeps before another method takes over.
const MAX_SWEEPS: usize = 20;
/// Successive sweeps that change no contact and reduce the residual to no less than half, after which the remaining
/// residual counts as round-off of stiff bodies.
const PATIENCE: usize = 3;

/// Most refinements after the sweeps.
const MAX_REFINEMENTS: usize = 3;

impl Sweeps<'_, '_> {
    pub(super) fn newton(&mut self, mut residual: Residual) -> Result<SweepStatus, Failure> {
        let limit = self.settings.max_sweeps.unwrap_or(MAX_SWEEPS);
        // Successive sweeps without progress.
        let mut stalls = 0;
        while self.needs_sweep(&residual)? {
            let Some(coupled) = CoupledContact::new(self.problem) else {
                return self.fall_back(residual, "the pairs have too many conditions for newton");
            };
            if self.sweeps_done() >= limit {
                if self.settings.max_sweeps.is_some() {
                    return Ok(self.gave_up(&residual, "newton stopped"));
                }
                let why = format!("newton didn't converge in {limit} sweeps");
                return self.fall_back(residual, &why);
            }
            let step = coupled.solve(&self.outcome.u, &residual.r, &self.state);
            self.outcome.active_set_iterations += step.contact.steps;
            if step.contact.fell_back {
                (self.outcome).fell_back(
                    "newton: active set taken from an interior-point or dual active-set method, or from Lemke's path",
                );
            }
            if !step.contact.converged && coupled.has_friction() {
                self.outcome.unsettled = step.violated_limits;
                self.outcome.slides = step.contact.slides;
                self.outcome.is_settled = true;
                return Ok(self.gave_up(&residual, "statuses of contacts with friction cycle"));
            }
            if !step.contact.converged {
                return self.fall_back(residual, "newton's contact problem didn't converge");
            }
            axpy(1.0, &step.u, &mut self.outcome.u);
            let before = residual.relative;
            residual = self.evaluate(Some(&step.expected));
            let stalled = residual.totals.changed == 0 && residual.relative >= 0.5 * before;
            stalls = if stalled { stalls + 1 } else { 0 };
            if stalls == PATIENCE && !self.is_converged(&residual) {
                // The remaining residual is round-off, or that of a pair: the certificate decides.
                self.outcome.is_settled = true;
                return Ok(self.gave_up(&residual, "newton got no further"));
            }
            // A contact with zero force and gap may be open at the root and closed in its pair.
            let settled = before.max(residual.relative) <= self.tolerance();
            if settled && residual.totals.failed_pairs == 0 {
                break;
            }
        }
        Ok(SweepStatus::Converged)
    }

    /// Continues with anderson.
    fn fall_back(&mut self, residual: Residual, why: &str) -> Result<SweepStatus, Failure> {
        (self.outcome).fell_back(&format!("{why}; switched to Anderson acceleration"));
        self.has_fallen_back = true;
        self.anderson(residual)
    }

    /// Searches for another solution with friction.
    pub(super) fn find_second_solution(&mut self) {
        let residual = self.residual(None);
        let coupled = CoupledContact::new(self.problem);
        let Some(coupled) = coupled.filter(CoupledContact::has_friction) else {
            return;
        };
        let other = coupled.other_solution(&self.outcome.u, &residual.r, &self.state);
        self.outcome.other_solution = Some(other.is_some());
        if let Some(difference) = other {
            self.outcome.notes.push(format!(
                "a second start found another solution with friction, whose jumps differ by up to {difference:.1e} m"
            ));
        }
    }

    /// Refinement by Newton steps beyond the tolerance of the sweeps, so that this doesn't limit the accuracy.
    pub(super) fn refine(&mut self) {
        let mut residual = self.residual(None);
        for _ in 0..MAX_REFINEMENTS {
            if residual.relative <= ROUND_OFF {
                return;
            }
            let Some(coupled) = CoupledContact::new(self.problem) else {
                return;
            };
            let step = coupled.solve(&self.outcome.u, &residual.r, &self.state);
            self.outcome.active_set_iterations += step.contact.steps;
            let coarse = self.outcome.u.clone();
            axpy(1.0, &step.u, &mut self.outcome.u);
            let after = self.residual(Some(&step.expected));
            if !step.contact.converged
                || after.totals.failed_pairs > 0
                || after.relative > 0.5 * residual.relative
            {
                self.outcome.u = coarse;
                return;
            }
            residual = after;
        }
    }
}
