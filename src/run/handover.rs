//! Handover of a load step in which a solver doesn't converge, or whose working set of contact points is too small.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;
use contact_dd_partition::problem::stage::Stage;

use crate::context::Context;
use crate::error::{Failure, FailureKind};
use crate::plan::Plan;
use crate::plan::choice::Choice;
use crate::step::state::StepState;
use crate::step::transfer::StageTransfer;
use crate::sweep::{SweepOutcome, SweepStatus};

/// A handover: a load step is solved again, with a more robust solver or for more contact points.
#[derive(Clone)]
pub struct Handover {
    /// The state before the load step, distributed over the owners of the previous plan.
    pub state: StepState,
    /// The previous plan.
    pub plan: Plan,
    /// The change for the next attempt.
    pub to: Successor,
}

/// The change with which a load step is solved again.
#[derive(Clone)]
pub enum Successor {
    /// A more robust solver.
    Solver {
        /// The choice.
        choice: Choice,
        /// The solver that didn't converge, and the reason, as text; on the root.
        why: String,
    },
    /// A larger working set of contact points, and the transfer of slips to it; `None` before the first load step.
    Points(Option<StageTransfer>),
}

impl Handover {
    /// The handover from the solver of a plan, which didn't converge for the reason `why`, to another one, from the
    /// `state` before the load step.
    pub fn to_solver(plan: &Plan, to: &Choice, state: StepState, why: &str) -> Self {
        let (from, choice) = (plan.merging, to.clone());
        let why = format!(
            "{} didn't converge ({why}); {} took over",
            from.solver(),
            to.merging.solver()
        );
        Self::new(plan, state, Successor::Solver { choice, why })
    }

    /// The handover of load step k of a `stage` to another set of contact points, from the state before it; the jumps
    /// of the points outside the present set are given. Collective.
    pub fn to_points(
        context: &Context<'_>,
        (stage, whole): (&Stage<'_>, &Catalog),
        (k, start): (usize, &StepState),
        outside: &BTreeMap<usize, [f64; 3]>,
    ) -> Self {
        let transfer = (k > stage.steps.start)
            .then(|| StageTransfer::between_sets(context, stage, &start.slips, outside, whole));
        Self::new(context.plan, start.clone(), Successor::Points(transfer))
    }

    /// The solver that took over and the reason, as text, if one did.
    pub fn why(&self) -> Option<String> {
        match &self.to {
            Successor::Solver { why, .. } => Some(why.clone()),
            Successor::Points(_) => None,
        }
    }

    /// The handover from the `state` before a load step.
    fn new(plan: &Plan, state: StepState, to: Successor) -> Self {
        Self {
            // With other unknowns on Γ, the state there can't be used.
            state: StepState {
                interface: None,
                pairs: BTreeMap::new(),
                ..state
            },
            plan: plan.clone(),
            to,
        }
    }
}

/// The reason for a handover after a load step that ended with this result: converged or not with an outcome, which the
/// root has, or failed. `None` if it converged, or a signal stopped it.
pub fn reason_to_hand_over(
    ended: Result<(bool, Option<&SweepOutcome>), &Failure>,
) -> Option<String> {
    match ended {
        Ok((true, _)) => None,
        Ok((false, outcome)) => Some(match outcome.map(|outcome| &outcome.status) {
            Some(SweepStatus::NotConverged(why)) => why.clone(),
            _ => String::new(),
        }),
        Err(failure) if failure.kind == FailureKind::IllPosed => Some(failure.message.clone()),
        Err(_) => None,
    }
}
