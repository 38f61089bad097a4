//! A stage: load steps with the same bodies and contacts, which share one factorization.

use std::ops::Range;

use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::id::{OnBlocks, OnGroups};
use contact_dd_partition::problem::Catalog;
use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::problem::stage::Stage;
use faer::Par;

use crate::comm::{Comm, phase};
use crate::context::Context;
use crate::error::Failure;
use crate::fem::block::Block;
use crate::fem::contact_group::ContactGroup;
use crate::plan::Plan;
use crate::plan::choice::{Choice, ChosenPlan};
use crate::plan::cost::CostEstimate;
use crate::read::{check_copies, collect_groups, read_blocks};
use crate::report::log::{Checked, RunLog};
use crate::run::handover::{Handover, Successor};
use crate::settings::Settings;
use crate::step::state::analyse_steps;

/// The data common to all stages of a run.
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

/// The part of a stage on one rank.
pub struct Parts {
    /// The plan, which assigns owners.
    pub plan: Plan,
    blocks: OnBlocks<Block>,
    groups: OnGroups<ContactGroup>,
    costs: Vec<CostEstimate>,
    available: f64,
    /// Reason for the choice of the solver of contact constraints, as text.
    pub why: String,
}

impl Stages<'_> {
    /// Checks the rigid-body motions in load `steps` of one stage. Collective.
    ///
    /// # Errors
    /// A part with a free rigid-body motion driven by the load, or contradictory constraints on a node.
    pub fn check(&self, steps: Range<usize>) -> Result<Checked, Failure> {
        let stage = self.file.catalog().stage(steps, &[]);
        let parts = self.parts(&stage, None, self.settings.check)?;
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

    /// The choices of the operator for the contact constraints of a stage with this tree, the best one first; after a
    /// handover to another solver, its choice only. Collective.
    ///
    /// # Errors
    /// Contradictory choices of the user.
    fn choices(
        &self,
        (catalog, tree): (&Catalog, &Tree),
        handover: Option<&Handover>,
    ) -> Result<Vec<Choice>, Failure> {
        match handover.map(|handover| &handover.to) {
            Some(Successor::Solver { choice, .. }) => Ok(vec![choice.clone()]),
            _ => (self.comm).agree(Choice::all(catalog, tree, self.settings.solver_request())),
        }
    }

    /// The choice to take over if the operator of a `plan` doesn't converge, if there is memory for it. Collective.
    pub fn more_robust(&self, catalog: &Catalog, plan: &Plan) -> Option<Choice> {
        // A limit on sweeps applies to all solvers together.
        if self.settings.max_sweeps.is_some() {
            return None;
        }
        let robust = Choice::more_robust(catalog, &plan.tree, plan.merging)?;
        ChosenPlan::new(
            self.comm,
            (catalog, &plan.tree),
            std::slice::from_ref(&robust),
        )
        .ok()?;
        Some(robust)
    }

    /// The part of a stage on this rank, by the best choice of an operator for which there is memory; for the `first`
    /// stage the problem is logged. Collective.
    ///
    /// # Errors
    /// Contradictory choices of the user, too little memory, or invalid data in the problem file.
    pub fn parts(
        &self,
        stage: &Stage<'_>,
        handover: Option<&Handover>,
        first: bool,
    ) -> Result<Parts, Failure> {
        let Self { comm, file, .. } = *self;
        let catalog = &stage.catalog;
        phase("reading");
        let tree = Tree::new(catalog);
        let choices = self.choices((catalog, &tree), handover)?;
        let chosen = ChosenPlan::new(comm, (catalog, &tree), &choices)?;
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

    /// The context of all phases of a stage.
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
