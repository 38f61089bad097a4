//! The contact problem with friction: normal jumps t ≤ g with forces λ ≥ 0; tangential jumps w stick while |λ_t| < b,
//! and slip under |λ_t| = b, against the slip.
//!
//! The bound b is given (Tresca), or grows with the normal force (Coulomb), b = c + μ λ: then the matrix of the
//! slipping points isn't symmetric, and no energy has the solution for its minimum. A status for every limit makes the
//! problem linear; semismooth Newton corrects all wrong statuses at once until none is wrong. Where that stalls, it
//! starts again near the end of Lemke's path, which leads to a solution.

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
use super::tangent::OtherTangent;
use super::tangent::TangentialLimit;
pub use super::tangent::{ForceBound, TangentialCondition};

/// The contact problem with friction.
#[derive(Clone, Copy, Debug)]
pub struct FrictionProblem<'a> {
    /// The problem on all limits; the bound of a tangential jump is its sticking position.
    pub contact: ContactProblem<'a>,
    /// Tangential limits.
    pub tangents: &'a [TangentialLimit],
    /// Patch of points in contact from which the search begins.
    pub last_patch: &'a LastPatch,
}

impl FrictionProblem<'_> {
    /// Solves the problem from initial statuses of its limits; `status` then holds those of the solution.
    pub fn solve(&self, status: &mut [Status]) -> ContactSolution {
        if let Some(at_rest) = self.at_rest(status) {
            return at_rest;
        }
        let on_patch = self.solve_on_patch(status);
        on_patch.unwrap_or_else(|| self.solve_whole(status))
    }

    /// Solution t = 0 where nothing drives any jump: what round-off leaves of it would be compared with itself alone.
    fn at_rest(&self, status: &mut [Status]) -> Option<ContactSolution> {
        let ContactProblem { c, bounds, .. } = self.contact;
        let mut at_rest: Vec<Status> = bounds.iter().map(|&g| Status::new(g > 0.0)).collect();
        let mut rests = c.iter().all(|&c| c == 0.0);
        let mut is_tangential = vec![false; bounds.len()];
        for tangent in self.tangents {
            is_tangential[tangent.limit] = true;
            let opens = tangent.bound.only_closed && tangent.normal.is_none_or(|n| bounds[n] > 0.0);
            at_rest[tangent.limit] = Status::new(opens);
            rests &= opens || bounds[tangent.limit] == 0.0;
            rests &= opens || !matches!(tangent.other, OtherTangent::Prescribed(_));
        }
        let mut normal = bounds.iter().zip(&is_tangential);
        rests &= normal.all(|(&g, is_tangential)| *is_tangential || g >= 0.0);
        rests.then(|| {
            status.copy_from_slice(&at_rest);
            ContactSolution::bilateral(c.len(), bounds.len())
        })
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

    /// Change of jumps and forces with fixed statuses; `bounds` are the missing parts of closed ones.
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
