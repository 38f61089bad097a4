//! Load steps of a stage, and the transfer from the last of them to the next stage.

use std::cell::Cell;
use std::ops::Range;

use contact_dd_partition::problem::Catalog;
use contact_dd_partition::problem::stage::Stage;

use crate::context::Context;
use crate::fem::contact_state::ContactRow;
use crate::plan::choice::Choice;
use crate::report::log::RunLog;
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::run::handover::Handover;
use crate::run::increment::{Increment, Increments};
use crate::run::operators::Operators;
use crate::run::restart::Finished;
use crate::settings::Settings;
use crate::step::state::StepState;
use crate::step::transfer::StageEnd;
use crate::step::working_set::WorkingSet;

/// The data common to the load steps of a stage.
pub struct StageSteps<'a> {
    /// The stage.
    pub stage: &'a Stage<'a>,
    /// The whole problem.
    pub whole: &'a Catalog,
    /// The load steps of the next stage.
    pub next: Option<&'a Range<usize>>,
    /// The context of its phases.
    pub context: Context<'a>,
    /// The rigid-body analysis at the end of every load step.
    pub analyses: &'a [RigidBodyAnalysis],
    /// The closing motions before the first one.
    pub before: &'a [Vec<f64>],
    /// S_i, S_kl and S_0.
    pub operators: &'a Operators,
    /// The rows of contact points that are absent; on the root.
    pub absent: &'a [ContactRow],
    /// The solver that takes over if the steps don't converge.
    pub robust: Option<&'a Choice>,
}

impl StageSteps<'_> {
    /// The increments of a load step; `linear_solves` counts their linear systems.
    pub fn increments<'a>(
        &'a self,
        settings: &'a Settings,
        log: &'a RunLog<'a>,
        linear_solves: &'a Cell<usize>,
    ) -> Increments<'a> {
        Increments {
            context: self.context,
            settings,
            log,
            operators: self.operators,
            is_relieved: self.robust.is_some(),
            has_derivatives: true,
            linear_solves,
        }
    }

    /// Transfer from the last load step of the stage to the `next` stage. Collective.
    pub fn pass_on(
        &self,
        (solved, analysis): (&Increment, &RigidBodyAnalysis),
        next: &Range<usize>,
        finished: &mut Finished,
    ) {
        let end = StageEnd {
            displacement: &solved.solution.displacement,
            slips: &solved.slips.jumps,
            closing_motions: &analysis.closing_motions,
        };
        let transfer = &finished.transfer;
        finished.transfer = transfer.after(&self.context, self.stage, end, self.whole, next);
    }

    /// The handover of load step k to the more robust solver, or to all contact points if there is none; `start` is the
    /// state before the step, `finished` are the steps before it. Collective.
    pub fn to_more_robust(
        &self,
        (k, start): (usize, &StepState),
        why: &str,
        finished: &mut Finished,
    ) -> Handover {
        match self.robust {
            Some(robust) => {
                finished.count = k;
                Handover::to_solver(self.context.plan, robust, start.clone(), why)
            }
            None => self.with_set(WorkingSet::all(self.whole), (k, start), finished),
        }
    }

    /// The handover of a load step to another working set, from the state before it. Collective.
    pub fn with_set(
        &self,
        set: WorkingSet,
        from: (usize, &StepState),
        finished: &mut Finished,
    ) -> Handover {
        finished.count = from.0;
        let before = finished.working_set.replace(set);
        let outside = before.map(|before| before.outside).unwrap_or_default();
        Handover::to_points(&self.context, (self.stage, self.whole), from, &outside)
    }
}
