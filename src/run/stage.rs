//! A stage: load steps in which the same bodies and contacts are there, and which share one factorization.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;

use contact_dd_partition::model::PlaneState;
use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::problem::stage::Stage;
use faer::Par;

use crate::comm::{Comm, phase};
use crate::condense::Condensation;
use crate::condense::interface::assemble_interface;
use crate::condense::tree::condense_clusters;
use crate::context::{Context, Moment};
use crate::error::Failure;
use crate::fem::block::Block;
use crate::fem::contact_group::ContactGroup;
use crate::frozen::fronts::FrozenFronts;
use crate::output::memory::afford;
use crate::output::ranks::RankSeconds;
use crate::output::resultants::Resultants;
use crate::output::vtkhdf::beside::FileBeside;
use crate::plan::Plan;
use crate::plan::cluster::Merging;
use crate::plan::cost::CostEstimate;
use crate::read::{check_copies, collect_groups, depend_on_each_other, read_blocks};
use crate::recover::penetration::probe;
use crate::report::Outputs;
use crate::report::log::{Checked, RunLog};
use crate::report::totals::StepTotals;
use crate::report::write::{absent_rows, write_solution};
use crate::run::create_outputs;
use crate::run::increment::Increments;
use crate::run::restart::{Finished, keep};
use crate::settings::Settings;
use crate::step::state::{self, StepState, analyse_steps, stop_if_asked};

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
}

impl Stages<'_> {
    /// Checks the rigid motions in load `steps` in which the same is there. Collective.
    ///
    /// # Errors
    /// A part that moves freely, or one for which there is no place.
    pub fn check(&self, steps: Range<usize>) -> Result<Checked, Failure> {
        let stage = self.file.catalog().stage(steps, &[]);
        let parts = self.parts(&stage, self.settings.check)?;
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

    /// Solves the load `steps` in which the same is there, those from `next` on being another stage. Collective.
    ///
    /// # Errors
    /// As a whole run.
    pub fn solve(
        &self,
        steps: Range<usize>,
        next: Option<&Range<usize>>,
        progress: &mut Progress,
    ) -> Result<(), Failure> {
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
        } = progress;
        let stage = &file.catalog().stage(steps, &finished.passage.since);
        let parts = self.parts(stage, last_plan.is_none())?;
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
        let mut condensed = condense_clusters(&condensation, &analyses[0])
            .map_err(|failure| state::finished(failure, &context, settings, finished.count))?;
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
            None => assemble_interface(&context, &condensed)?,
        };
        seconds.add(|s| &mut s.interface, comm.times() - lap);

        // Load step by load step: each starts from the state that the one before it left.
        let increments = Increments {
            context,
            settings,
            log,
            factors: &condensed,
            interface: interface.as_ref(),
            frozen: frozen.as_ref(),
        };
        let mut state = match finished.count > first {
            true => finished.state(&context),
            false => finished.passage.state(&context, stage),
        };
        for k in stage
            .steps
            .clone()
            .skip(finished.count.saturating_sub(first))
        {
            stop_if_asked(&context, settings, k)?;
            log.step(catalog, k);
            let (at_end, earlier) = (&analyses[k - first], &analyses[..k - first]);
            let earlier = earlier.last().map_or(&before, |last| &last.closing_motions);
            let solved = increments.step(k, (earlier, at_end), state, seconds);
            let solved = solved.map_err(|failure| {
                state::finished(context.in_step(failure, k), &context, settings, k)
            })?;

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
                StepTotals::new(o, solution, resultants, solved.energy, at_end, catalog)
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
        Ok(())
    }

    /// What this rank has of a stage, of the `first` one with a word about the problem. Collective.
    fn parts(&self, stage: &Stage<'_>, first: bool) -> Result<Parts, Failure> {
        let Self { comm, file, .. } = *self;
        let catalog = &stage.catalog;
        phase("reading");
        let merging = comm.agree(self.settings.merging(catalog))?;
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
