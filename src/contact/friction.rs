//! The contact problem with friction: normal jumps t ≤ g with forces λ ≥ 0, tangential jumps w that stick where they
//! are as long as |λ_t| ≤ b, and slip under |λ_t| = b, against the slip.
//!
//! The bound b is given, or grows with the normal force, b = c + μ λ: then the matrix of the slipping ones isn't
//! symmetric, and no energy has the solution for its minimum. A status for every limit makes the problem linear; all
//! wrong statuses are corrected at once until none is wrong, as semismooth Newton does, and where that gets no
//! further, from near the end of Lemke's path, which leads to a solution.

mod cones;
mod lemke;
mod other;
mod patch;
#[cfg(test)]
mod points;
mod system;

use super::active_set::{ContactProblem, ContactSolution, Trial};
use super::laws::Iterate;
use super::patch::LastPatch;
use super::status::FixedStatus;
pub use super::status::Status;
use super::tangent::TangentialLimit;
pub use super::tangent::{ForceBound, TangentialCondition};

/// The contact problem with friction.
#[derive(Clone, Copy, Debug)]
pub struct FrictionProblem<'a> {
    /// All limits; those of tangential jumps are where these stick.
    pub contact: ContactProblem<'a>,
    /// Tangential limits.
    pub tangents: &'a [TangentialLimit],
    /// Where the search for what touches begins.
    pub last_patch: &'a LastPatch,
}

impl FrictionProblem<'_> {
    /// Solves the problem from the statuses that its limits have at first, and leaves there those of the solution.
    pub fn solve(&self, status: &mut [Status]) -> ContactSolution {
        let on_patch = self.solve_on_patch(status);
        on_patch.unwrap_or_else(|| self.solve_whole(status))
    }

    fn solve_whole(&self, status: &mut [Status]) -> ContactSolution {
        if self.tangents.is_empty() {
            let mut open: Vec<bool> = status.iter().map(|status| !status.is_closed()).collect();
            let solution = self.contact.solve(&mut open);
            for (status, open) in status.iter_mut().zip(open) {
                *status = Status::new(open);
            }
            return solution;
        }
        self.solve_cones(status)
    }

    /// The change of jumps and forces where limits keep these statuses; `bounds` are what the closed ones lack.
    pub fn change(&self, fixed: &[FixedStatus]) -> Iterate {
        let on_patch = self.change_on_patch(fixed);
        on_patch.unwrap_or_else(|| self.change_whole(fixed))
    }

    fn change_whole(&self, fixed: &[FixedStatus]) -> Iterate {
        let slips = |status: &FixedStatus| !status.is_closed() && *status != FixedStatus::Open;
        if !fixed.iter().any(slips) {
            let open: Vec<bool> = fixed.iter().map(|status| !status.is_closed()).collect();
            let Trial { jumps, forces, .. } = self.contact.linear(&open);
            return Iterate { jumps, forces };
        }
        self.change_cones(fixed)
    }
}

#[cfg(test)]
mod tests;
