//! A stage: load steps in which the same bodies and contacts are there, and which share one factorization.

use std::collections::BTreeMap;
use std::ops::Range;

use contact_dd_partition::problem::Catalog;
use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::problem::stage::Stage;
use faer::Par;

use crate::comm::{Comm, phase};
use crate::context::Context;
use crate::error::{Failure, FailureKind};
use crate::fem::block::Block;
use crate::fem::contact_group::ContactGroup;
use crate::plan::Plan;
use crate::plan::choice::{Choice, ChosenPlan};
use crate::plan::cluster::Merging;
use crate::plan::cost::CostEstimate;
use crate::read::{check_copies, collect_groups, read_blocks};
use crate::report::log::{Checked, RunLog};
use crate::settings::Settings;
use crate::step::state::{StepState, analyse_steps};
use crate::step::transfer::StageTransfer;
use crate::sweep::{SweepOutcome, SweepStatus};

/// The data that all stages of a run share.
#[derive(Clone, Copy)]
pub struct Stages<'a> {
    /// All ranks.
    pub comm: &'a Comm,
    /// The problem.
    pub file: &'a ProblemFile,
    /// The settings.
    pub settings: &'a Settings,
    /// The log of the run.
    pub log: &'a RunLog<'a>,
    /// Threads.
    pub par: Par,
}

/// The part of a stage that a rank has.
pub struct Parts {
    /// The owners of everything.
    pub plan: Plan,
    blocks: BTreeMap<usize, Block>,
    groups: BTreeMap<usize, ContactGroup>,
    costs: Vec<CostEstimate>,
    available: f64,
    /// Why contact conditions are solved for as they are, in words.
    pub why: String,
}

/// A handover: where a load step is to be solved again, by a more robust solver or for more contact points.
#[derive(Clone)]
pub struct Handover {
    /// The state before the load step, with the owners of the plan before.
    pub state: StepState,
    /// The plan before.
    pub plan: Plan,
    /// The change.
    pub to: Successor,
}

/// The change with which a load step is solved again.
#[derive(Clone)]
pub enum Successor {
    /// A more robust solver.
    Solver {
        /// Its choice.
        choice: Choice,
        /// The solver that didn't converge, and the reason, as the root knows it.
        why: String,
    },
    /// A larger working set of contact points, with the transfer of the slips to it; none before the first load step.
    Points(Option<StageTransfer>),
}

impl Handover {
    /// The handover from the solver of a plan, which didn't converge for this reason, to another one, from the `state` before
    /// the load step.
    pub fn to_solver(plan: &Plan, to: &Choice, state: StepState, why: &str) -> Self {
        let (from, choice) = (plan.merging, to.clone());
        let why = format!(
            "{} didn't converge ({why}); {} took over",
            from.solver(),
            to.merging.solver()
        );
        Self::new(plan, state, Successor::Solver { choice, why })
    }

    /// The handover of load step k of a `stage` to other contact points, from the state before it, when those that were left
    /// out had these jumps. Collective.
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

    /// The solver that took over and the reason, where one did.
    pub fn why(&self) -> Option<String> {
        match &self.to {
            Successor::Solver { why, .. } => Some(why.clone()),
            Successor::Points(_) => None,
        }
    }

    /// The handover from the `state` before a load step.
    fn new(plan: &Plan, state: StepState, to: Successor) -> Self {
        Self {
            // Of other unknowns the state on Γ says nothing.
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

/// The reason for a handover where a load step ended with an outcome, which the root has, converged or not, or failed;
/// `None` where it converged, or a signal stopped it.
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

impl Stages<'_> {
    /// Checks the rigid motions in load `steps` in which the same is there. Collective.
    ///
    /// # Errors
    /// A part that moves freely, or one for which there is no place.
    pub fn check(&self, steps: Range<usize>) -> Result<Checked, Failure> {
        let stage = self.file.catalog().stage(steps, &[]);
        let choices = self.choices(&stage.catalog, None)?;
        let parts = self.parts(&stage, &choices, self.settings.check)?;
        self.log.phase("looking for free rigid motions", None);
        let analyses = analyse_steps(&self.context(&stage, &parts), stage.steps.clone(), &[])?;
        let warnings = analyses
            .into_iter()
            .flat_map(|analysis| analysis.motions.warnings);
        Ok(Checked {
            warnings: warnings.collect(),
            costs: parts.costs,
            available: parts.available,
            why: parts.why,
            coarse_dofs: parts.plan.coarse_dofs(stage.catalog.dim),
        })
    }

    /// The choices of the operator for the contact conditions of a stage, the best one first; that of a handover if there
    /// was one. Collective.
    ///
    /// # Errors
    /// Wishes that exclude each other.
    pub fn choices(
        &self,
        catalog: &Catalog,
        handover: Option<&Handover>,
    ) -> Result<Vec<Choice>, Failure> {
        match handover.map(|handover| &handover.to) {
            Some(Successor::Solver { choice, .. }) => Ok(vec![choice.clone()]),
            _ => (self.comm).agree(Choice::all(catalog, self.settings.wishes())),
        }
    }

    /// The choice that takes over where a `merging` doesn't lead to a solution, if there is memory for it. Collective.
    pub fn more_robust(&self, catalog: &Catalog, merging: Merging) -> Option<Choice> {
        // A limit on sweeps is one on all solvers.
        if self.settings.max_sweeps.is_some() {
            return None;
        }
        let robust = Choice::more_robust(catalog, merging)?;
        ChosenPlan::new(self.comm, catalog, std::slice::from_ref(&robust)).ok()?;
        Some(robust)
    }

    /// The part of this rank of a stage to be solved by the first of some `choices` for which there is memory; of the `first`
    /// stage the log describes the problem. Collective.
    ///
    /// # Errors
    /// Too little memory, or a part of the problem file that isn't what it should be.
    pub fn parts(
        &self,
        stage: &Stage<'_>,
        choices: &[Choice],
        first: bool,
    ) -> Result<Parts, Failure> {
        let Self { comm, file, .. } = *self;
        let catalog = &stage.catalog;
        phase("reading");
        let chosen = ChosenPlan::new(comm, catalog, choices)?;
        let blocks = comm.agree(read_blocks(comm.rank(), file, &chosen.plan))?;
        if first {
            check_copies(comm, file, &blocks)?;
        }
        let groups = collect_groups(comm, file, catalog, &chosen.plan, &blocks)?;
        let ChosenPlan {
            mut choice,
            plan,
            costs,
            available,
        } = chosen;
        let (left, all) = (catalog.points.len(), file.catalog().points.len());
        if left < all && !file.catalog().has_stages() {
            choice.why +=
                &format!("; only {left} of {all} contact points may close, as far as is known");
        }
        if first {
            self.log.problem(file.catalog(), &plan, &choice.why);
        }
        Ok(Parts {
            plan,
            blocks,
            groups,
            costs,
            available,
            why: choice.why,
        })
    }

    /// The context of all phases that work on a stage.
    pub fn context<'a>(&'a self, stage: &'a Stage<'_>, parts: &'a Parts) -> Context<'a> {
        Context {
            comm: self.comm,
            catalog: &stage.catalog,
            plan: &parts.plan,
            blocks: &parts.blocks,
            groups: &parts.groups,
            par: self.par,
            listener: self.log,
        }
    }
}
