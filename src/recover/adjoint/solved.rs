//! The solution whose quantities are evaluated.

use crate::recover::fixed_active_set::FixedActiveSet;
use crate::recover::solution::Solution;

/// The solution of a load step, whose quantities are evaluated.
#[derive(Clone, Copy)]
pub struct Solved<'a> {
    /// The problem with its active set.
    pub fixed: &'a FixedActiveSet<'a>,
    /// The solution.
    pub solution: &'a Solution,
    /// Load step.
    pub step: usize,
}

impl Solved<'_> {
    /// Reason why there are no derivatives, as text; on the root.
    pub fn without_derivatives(&self) -> Option<String> {
        let solution = self.solution;
        let root = self.fixed.root?;
        let is_ready = root.is_refined && root.can_solve();
        let why = if !is_ready {
            "the load step isn't converged"
        } else if solution.minimum_norm.has_released_modes {
            "the contacts leave a rigid-body motion that the loads don't determine"
        } else if !solution.friction_limit.is_empty() {
            "friction is at its limit"
        } else {
            return None;
        };
        Some(why.into())
    }
}
