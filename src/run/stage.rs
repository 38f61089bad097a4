//! A stage: load steps in which the same bodies and contacts are there, and which share one factorization.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ops::Range;

use contact_dd_partition::model::PlaneState;
use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::problem::stage::Stage;
use faer::Par;

use crate::comm::ranks::RankSeconds;
use crate::comm::{Comm, phase};
use crate::condense::Condensation;
use crate::condense::interface::assemble_interface;
use crate::condense::tree::condense_clusters;
use crate::context::{Context, Moment};
use crate::error::{Failure, FailureKind};
use crate::fem::block::Block;
use crate::fem::contact_group::ContactGroup;
use crate::fem::resultants::Resultants;
use crate::frozen::fronts::FrozenFronts;
use crate::output::vtkhdf::beside::FileBeside;
use crate::plan::Plan;
use crate::plan::cluster::Merging;
use crate::plan::cost::CostEstimate;
use crate::plan::memory::afford;
use crate::read::{check_copies, collect_groups, depend_on_each_other, read_blocks};
use crate::recover::penetration::probe;
use crate::report::Outputs;
use crate::report::log::{Checked, RunLog};
use crate::report::totals::StepTotals;
use crate::report::write::{absent_rows, write_solution};
use crate::run::create_outputs;
use crate::run::increment::{Increment, Increments};
use crate::run::restart::{Finished, keep};
use crate::settings::Settings;
use crate::step::state::{self, StepState, analyse_steps, stop_if_asked};
use crate::sweep::SweepStatus;

/// What all stages of a run share.
#[derive(Clone, Copy)]
pub struct Stages<'a> {
    /// All ranks.
    pub comm: &'a Comm,
    /// The problem.
    pub file: &'a ProblemFile,
    /// What a user sets.
    pub settings: &'a Settings,
    /// Where it is told how the run goes.
    pub log: &'a RunLog<'a>,
    /// Threads.
    pub par: Par,
}

/// What ranks have of a stage.
struct Parts {
    plan: Plan,
    blocks: BTreeMap<usize, Block>,
    groups: BTreeMap<usize, ContactGroup>,
    costs: Vec<CostEstimate>,
    available: f64,
}

/// Where another solver takes over in a stage.
struct Relief {
    /// What it merges.
    merging: Merging,
    /// The state that it starts from, with the owners of the plan of before.
    state: StepState,
    plan: Plan,
    /// Which one didn't converge, and why, as the root knows it.
    why: String,
}

/// What the stages so far have come to.
#[derive(Default)]
pub struct Progress {
    /// Where the time went.
    pub seconds: RankSeconds,
    /// Who owned what in the last stage.
    pub plan: Option<Plan>,
    /// The files; on the root.
    pub outputs: Option<Outputs>,
    /// The result file beside the root's, where all ranks may write to it at once.
    pub beside: Option<FileBeside>,
    /// The smallest pivot of all factorizations relative to its diagonal entry.
    pub smallest_pivot: f64,
    /// Load steps that are done, those of an earlier run among them.
    pub finished: Finished,
    /// Linear problems that were solved for contact conditions since the last of them; on the root.
    pub linear_solves: Cell<usize>,
}

impl Stages<'_> {
    /// Checks the rigid motions in load `steps` in which the same is there. Collective.
    ///
    /// # Errors
    /// A part that moves freely, or one for which there is no place.
    pub fn check(&self, steps: Range<usize>) -> Result<Checked, Failure> {
        let stage = self.file.catalog().stage(steps, &[]);
        let merging = self.comm.agree(self.settings.merging(&stage.catalog))?;
        let parts = self.parts(&stage, merging, self.settings.check)?;
        self.log.phase("looking for free rigid motions", None);
        let analyses = analyse_steps(&self.context(&stage, &parts), stage.steps.clone(), &[])?;
        let warnings = analyses
            .into_iter()
            .flat_map(|analysis| analysis.motions.warnings);
        Ok(Checked {
            warnings: warnings.collect(),
            costs: parts.costs,
            available: parts.available,
            coarse_dofs: parts.plan.coarse_dofs(stage.catalog.dim),
        })
    }

    /// Solves the load `steps` in which the same is there, those from `next` on being another stage. Where the solver that
    /// was chosen doesn't converge, a more robust one goes on from there. Collective.
    ///
    /// # Errors
    /// As a whole run.
    pub fn solve(
        &self,
        steps: Range<usize>,
        next: Option<&Range<usize>>,
        progress: &mut Progress,
    ) -> Result<(), Failure> {
        let stage = (self.file.catalog()).stage(steps, &progress.finished.passage.since);
        let mut merging = self.comm.agree(self.settings.merging(&stage.catalog))?;
        let mut relief = None;
        loop {
            relief = self.solve_with(merging, relief, &stage, next, progress)?;
            match &relief {
                Some(relief) => merging = relief.merging,
                None => return Ok(()),
            }
        }
    }

    /// What takes over where a `merging` doesn't lead to a solution, if there is memory for it. Collective.
    fn relief(&self, stage: &Stage<'_>, merging: Merging) -> Option<Merging> {
        // A limit on sweeps is one on all solvers.
        if self.settings.max_sweeps.is_some() {
            return None;
        }
        let robust = Plan::more_robust(&stage.catalog, merging)?;
        let plan = Plan::new(&stage.catalog, self.comm.size(), robust);
        let costs = plan.cost_estimates(&stage.catalog, self.comm.size());
        afford(self.comm, &costs).is_ok().then_some(robust)
    }

    /// Solves the load steps of a `stage` that are left, with this `merging` and from where another solver was relieved;
    /// returns where a more robust one is to take over. Collective.
    ///
    /// # Errors
    /// As a whole run.
    fn solve_with(
        &self,
        merging: Merging,
        relieved: Option<Relief>,
        stage: &Stage<'_>,
        next: Option<&Range<usize>>,
        progress: &mut Progress,
    ) -> Result<Option<Relief>, Failure> {
        let &Self {
            comm,
            settings,
            log,
            file,
            ..
        } = self;
        let lap = comm.times();
        let Progress {
            seconds,
            plan: last_plan,
            outputs,
            beside,
            smallest_pivot,
            finished,
            linear_solves,
        } = progress;
        let parts = self.parts(stage, merging, last_plan.is_none())?;
        let context = self.context(stage, &parts);
        let Context {
            catalog,
            plan,
            blocks,
            ..
        } = context;
        stop_if_asked(&context, settings, finished.count)?;

        // Rigid-body modes that neither supports nor contact restrain, and the bodies' closing motions.
        log.phase("looking for free rigid motions", None);
        let before = finished.passage.closing_motions.clone();
        let analyses = analyse_steps(&context, stage.steps.clone(), &before)?;
        log.phase("creating the outputs", None);
        if last_plan.is_none() {
            (*outputs, *beside) = create_outputs(&context, settings, finished.file.take())?;
        }
        let absent = match comm.is_root() {
            true => absent_rows(file.catalog(), stage),
            false => Vec::new(),
        };
        seconds.add(|s| &mut s.read, comm.times() - lap);

        // S_i of the linear subdomains, (11), and S_kl of the pairs, (12), merged up the hierarchy.
        log.phase("factorizing", Some(blocks.len()));
        let lap = comm.times();
        let first = stage.steps.start;
        let condensation = Condensation {
            context,
            loads: &StepState::default().loads(&context, Moment::end_of(first), &analyses[0]),
            fixing_dofs: &analyses[0].motions.fixing_dofs,
        };
        let mut condensed =
            condense_clusters(&condensation, &analyses[0].cluster_modes).map_err(|failure| {
                let failure = context.of_pivot(failure);
                state::finished(failure, &context, settings, finished.count)
            })?;
        let [assembling, factorizing] = condensed.seconds;
        let mut condensing = comm.times() - lap - assembling;
        // Waiting is nobody's time on the wall.
        condensing.elapsed = factorizing.elapsed;
        seconds.add(|s| &mut s.assemble, assembling);
        seconds.add(|s| &mut s.factorize, condensing);

        // The root assembles S_0, (15), and the bilateral operator.
        log.phase("assembling the interface problem", None);
        let lap = comm.times();
        let frozen = match plan.merging.is_frozen() {
            true => Some(RefCell::new(FrozenFronts::new(
                &condensation,
                std::mem::take(&mut condensed.linear),
            )?)),
            false => None,
        };
        let interface = match frozen {
            Some(_) => None,
            None => assemble_interface(&context, &condensed)
                .map_err(|failure| context.of_pivot(failure))?,
        };
        seconds.add(|s| &mut s.interface, comm.times() - lap);

        // Load step by load step: each starts from the state that the one before it left.
        let merging = plan.merging;
        let relief = self.relief(stage, merging);
        let increments = Increments {
            context,
            settings,
            log,
            factors: &condensed,
            interface: interface.as_ref(),
            frozen: frozen.as_ref(),
            is_relieved: relief.is_some(),
            linear_solves,
        };
        let (mut state, mut why) = match relieved {
            Some(relieved) => (
                relieved.state.handed_over(&context, &relieved.plan),
                Some(relieved.why),
            ),
            None if finished.count > first => (finished.state(&context), None),
            None => (finished.passage.state(&context, stage), None),
        };
        state.scales = finished.scales();
        for k in stage
            .steps
            .clone()
            .skip(finished.count.saturating_sub(first))
        {
            stop_if_asked(&context, settings, k)?;
            log.step(catalog, k);
            let (at_end, earlier) = (&analyses[k - first], &analyses[..k - first]);
            let earlier = earlier.last().map_or(&before, |last| &last.closing_motions);
            let before = relief.map(|relief| (relief, state.clone()));
            let solved = increments.step(k, (earlier, at_end), state, seconds);
            if let Some((relief, state)) = before
                && let Some(why) = self.why_relieved(&increments, &solved)
            {
                finished.count = k;
                *last_plan = Some(parts.plan.clone());
                // Of another solver the state on Γ says nothing.
                let state = StepState {
                    interface: None,
                    pairs: BTreeMap::new(),
                    ..state
                };
                return Ok(Some(Relief {
                    merging: relief,
                    state,
                    plan: parts.plan.clone(),
                    why: format!(
                        "{} didn't converge ({why}); {} took over",
                        merging.solver(),
                        relief.solver()
                    ),
                }));
            }
            let mut solved = solved.map_err(|failure| {
                state::finished(context.in_step(failure, k), &context, settings, k)
            })?;
            if let Some((outcome, why)) = solved.outcome.as_mut().zip(why.take()) {
                outcome.take_over(why);
            }

            log.phase("writing", None);
            let lap = comm.times();
            let mut resultants = Resultants::new(catalog, solved.solution.reactions.clone());
            let result = outputs.as_mut().map(|outputs| &mut outputs.result);
            let contacts = &mut resultants.contacts;
            write_solution(
                &context,
                &solved.solution,
                &solved.slips,
                result,
                beside.as_mut(),
                contacts,
                &absent,
            )?;
            probe(
                &context,
                &solved.solution.displacement,
                &mut resultants.contacts,
            );
            if catalog.plane == Some(PlaneState::Axisymmetric) {
                resultants.sum_around_axis();
            }
            seconds.add(|s| &mut s.write, comm.times() - lap);
            let totals = solved.outcome.clone();
            let totals = totals.map(|o| {
                let solution = &solved.solution;
                StepTotals {
                    linear_solves: linear_solves.take(),
                    ..StepTotals::new(o, solution, resultants, solved.energy, at_end, catalog)
                }
            });
            finished.steps.extend(totals);
            if let Some(next) = next.filter(|next| next.start == k + 1) {
                let whole = file.catalog();
                finished.passage = (finished.passage).after(
                    &context,
                    stage,
                    &solved,
                    &at_end.closing_motions,
                    whole,
                    next,
                );
            }
            state = solved.into_state(settings.method);
            if k + 1 < catalog.steps.len() {
                let result = outputs.as_mut().map(|outputs| &mut outputs.result);
                keep(
                    &context,
                    settings,
                    &state,
                    &finished.passage,
                    &finished.steps,
                    result,
                )?;
            }
        }
        finished.count = stage.steps.end;
        *smallest_pivot = smallest_pivot.min(match (&interface, &frozen) {
            (Some((_, interface)), _) => interface.smallest_pivot(),
            (None, fronts) => fronts
                .as_ref()
                .map_or(1.0, |fronts| fronts.borrow().smallest_pivot),
        });
        *last_plan = Some(parts.plan);
        Ok(None)
    }

    /// Why another solver is to take over where a load step was `solved` so; `None` where it converged, or a signal
    /// stopped it. Collective.
    fn why_relieved(
        &self,
        increments: &Increments<'_>,
        solved: &Result<Increment, Failure>,
    ) -> Option<String> {
        match solved {
            Ok(solved) if increments.is_converged(solved) => None,
            Ok(solved) => {
                let status = solved.outcome.as_ref().map(|outcome| &outcome.status);
                Some(match status {
                    Some(SweepStatus::NotConverged(why)) => why.clone(),
                    _ => String::new(),
                })
            }
            Err(failure) if failure.kind == FailureKind::IllPosed => Some(failure.message.clone()),
            Err(_) => None,
        }
    }

    /// What this rank has of a stage to be solved with this `merging`, of the `first` one with a word about the problem.
    /// Collective.
    fn parts(&self, stage: &Stage<'_>, merging: Merging, first: bool) -> Result<Parts, Failure> {
        let Self { comm, file, .. } = *self;
        let catalog = &stage.catalog;
        phase("reading");
        let mut plan = Plan::new(catalog, comm.size(), merging);
        let costs = plan.cost_estimates(catalog, comm.size());
        let available = afford(comm, &costs)?;
        let blocks = comm.agree(read_blocks(comm.rank(), file, &plan))?;
        if first {
            check_copies(comm, file, &blocks)?;
        }
        let groups = collect_groups(comm, file, catalog, &plan, &blocks)?;
        if merging.is_frozen() && depend_on_each_other(comm, &plan, &groups) {
            plan.form_clusters(Merging::All);
        }
        if first {
            self.log.problem(file.catalog(), &plan);
        }
        Ok(Parts {
            plan,
            blocks,
            groups,
            costs,
            available,
        })
    }

    fn context<'a>(&'a self, stage: &'a Stage<'_>, parts: &'a Parts) -> Context<'a> {
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
