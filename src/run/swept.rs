//! Result of an increment's sweeps, and the two ways to it.
//!
//! Where clusters in contact are evaluated each by its rank, the root solves
//!
//! ```text
//! S_0 U + S_CON(U) = F                                             (14)
//! ```
//!
//! for the traces U of the displacements on Γ. With the tree solver the unknowns are the statuses of the contact
//! constraints: every iteration solves the linear problem of one active set by fronts along the hierarchy. What both
//! leave is the displacements on the boundaries from which substitution goes back into the blocks.

use std::cell::RefCell;

use contact_dd_partition::id::{OnGroups, OnTreeNodes};

use crate::contact::laws::Statuses;
use crate::contact::limits::Limits;
use crate::context::Context;
use crate::error::Failure;
use crate::interface::s_con::SCon;
use crate::recover::fixed_active_set::FixedActiveSet;
use crate::recover::{DiscreteSolution, recover, substitute_back};
use crate::report::log::RunLog;
use crate::run::operators::Operators;
use crate::settings::Settings;
use crate::step::StepProblem;
use crate::sweep::{Start, SweepOutcome, SweepRecord, Sweeps};
use crate::tree::contact;
use crate::tree::fronts::ActiveSetFronts;

/// Boundaries of clusters, and force and status of every contact constraint, from the tree solver.
type InTree = (OnTreeNodes<Vec<f64>>, OnGroups<Vec<(f64, bool)>>);

/// Result of the sweeps on this rank.
#[derive(Default)]
pub(super) struct Swept {
    /// The outcome; on the root.
    pub(super) outcome: Option<SweepOutcome>,
    /// The statuses of the contact groups, if the tree solver was used.
    pub(super) statuses: OnGroups<Statuses>,
    /// Number of linear systems solved for contact constraints; on the root.
    pub(super) linear_solves: usize,
    in_tree: Option<InTree>,
}

impl Swept {
    /// Solves S_0 U + S_CON(U) = F, (14), from the `start` and logs every sweep: the root solves for U, the other ranks
    /// evaluate S_CON on request. Collective.
    ///
    /// # Errors
    /// A signal stopped the sweeps.
    pub(super) fn on_interface(
        context: &Context<'_>,
        log: &RunLog<'_>,
        settings: &Settings,
        step: &mut StepProblem<'_>,
        start: Start,
    ) -> Result<Self, Failure> {
        let owners = context.plan.pair_owners();
        let mut s_con = SCon::new(context.comm, owners.values(), &mut step.pairs);
        let solved = match &step.interface {
            None => {
                s_con.serve();
                None
            }
            Some(problem) => {
                let in_contact = !problem.interface.pair_interface_dofs.is_empty();
                log.sweeps(in_contact);
                let mut observer = |record: &SweepRecord| {
                    if in_contact {
                        log.sweep(record);
                    }
                };
                let start = match problem.is_unloaded() {
                    true => Start::Bilateral,
                    false => start,
                };
                let settings = settings.sweeps();
                let solved = Sweeps::solve(problem, &mut s_con, settings, start, &mut observer);
                s_con.stop();
                Some(solved)
            }
        };
        let outcome = context.comm.agree(solved.transpose())?;
        Ok(Self {
            linear_solves: outcome.as_ref().map_or(0, |o| o.active_set_iterations),
            outcome,
            ..Self::default()
        })
    }

    /// Active-set iteration of the tree solver, which logs every iteration; the first active set has the statuses of
    /// the load step `before`. Collective.
    ///
    /// # Errors
    /// A part of the scene has a free rigid-body motion.
    pub(super) fn in_tree(
        context: &Context<'_>,
        log: &RunLog<'_>,
        settings: &Settings,
        fronts: &RefCell<ActiveSetFronts>,
        step: &StepProblem<'_>,
        (limits, before): (&OnGroups<Limits>, &OnGroups<Statuses>),
    ) -> Result<Self, Failure> {
        let mut fronts = fronts.borrow_mut();
        log.sweeps(true);
        let solves = fronts.solves;
        let loads = step.condensed.iter();
        let loads = loads.map(|(&v, load)| (v, load.boundary().to_vec()));
        let (loads, most) = (loads.collect(), settings.max_sweeps);
        let mut observer = |record: &SweepRecord| log.sweep(record);
        let loads = (&loads, before);
        let found = contact::solve(context, &mut fronts, limits, loads, most, &mut observer)?;
        Ok(Self {
            outcome: context.comm.is_root().then_some(found.outcome),
            statuses: found.statuses,
            linear_solves: fronts.solves - solves,
            in_tree: Some((found.boundaries, found.conditions)),
        })
    }

    /// Back-substitution: from the result of the sweeps to the full discrete solution. Collective.
    pub(super) fn substituted_back(
        &mut self,
        fixed: &FixedActiveSet<'_>,
        step: &StepProblem<'_>,
        operators: &Operators,
    ) -> DiscreteSolution {
        if let Some((boundaries, conditions)) = self.in_tree.take() {
            return substitute_back(fixed.factors(), step, boundaries, conditions);
        }
        let u = self.outcome.as_ref().map(|outcome| &outcome.u[..]);
        let interface = operators.interface.as_ref();
        let numbers = interface.map(|(n, _)| &n.interface_dofs[..]);
        recover(fixed.factors(), step, u.zip(numbers))
    }
}
