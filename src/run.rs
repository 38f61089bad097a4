//! The whole solution procedure in one module.
//!
//! for each stage: read → assemble → condense → S_0 at the root → for each load step: F → sweeps → recover → write

mod cases;
mod files;
mod handover;
mod increment;
mod operators;
mod prediction;
mod restart;
mod stage;
mod stage_steps;
mod step_totals;
mod study;
mod swept;

use std::cell::Cell;
use std::ops::Range;
use std::time::Instant;

use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::problem::stage::Stage;
use faer::Par;

use self::files::{RunFiles, absent_rows};
use self::handover::{Handover, reason_to_hand_over};
use self::increment::Increment;
use self::operators::Operators;
use self::restart::{Finished, finished_steps, keep};
use self::stage::Stages;
use self::stage_steps::StageSteps;
use crate::comm::ranks::RankSeconds;
use crate::comm::{Comm, phase};
use crate::context::{Context, LoadPoint};
use crate::error::{Failure, FailureKind};
use crate::fem::contact_state::ContactRow;
use crate::output::lock::OutputLock;
use crate::output::report::Status;
use crate::plan::Plan;
use crate::read::check_problem;
use crate::recover::stress_intensity::check_quantities;
use crate::report::collect;
use crate::report::log::RunLog;
use crate::report::totals::{StepTotals, Totals};
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::settings::Settings;
use crate::settings::command_line::CommandLine;
use crate::step::state::{self, StepState, analyse_steps, stop_if_asked};
use crate::step::working_set::{Outside, WorkingSet, pays};

/// Result of a run that didn't fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The sweeps converged, or there was nothing to solve for.
    Converged,
    /// The sweeps didn't converge; the results are written all the same.
    NotConverged,
}

/// Progress of a run: results of its stages so far.
#[derive(Default)]
struct Progress {
    /// The time that each phase took.
    seconds: RankSeconds,
    /// The plan of the last stage, and the reason for its solver of the contact constraints.
    plan: Option<(Plan, String)>,
    files: RunFiles,
    /// The smallest pivot of all factorizations relative to its diagonal entry.
    smallest_pivot: f64,
    /// Load steps that are finished, including those of an earlier, restarted run.
    finished: Finished,
    /// Number of linear systems solved for contact constraints since the last load step; on the root.
    linear_solves: Cell<usize>,
}

/// Solves the problem that the command line names and writes the results. Collective.
///
/// # Errors
/// Bad input, a scene without equilibrium, or an output that can't be written; the same on all
/// ranks.
pub fn run(comm: &Comm, command_line: &CommandLine) -> Result<Ending, Failure> {
    let (began, start) = (Instant::now(), comm.times());
    // Settings of the command line take precedence over those of the problem file.
    phase("reading");
    let path = command_line.problem();
    check_problem(comm, &path)?;
    let file = comm.agree(ProblemFile::open(&path).map_err(Failure::from))?;
    let settings = &Settings::new(command_line, &file.catalog().solver);
    comm.agree(settings.check_paths())?;
    comm.agree(check_quantities(file.catalog()))?;
    let par = match settings.threads {
        1 => Par::Seq,
        n => Par::rayon(usize::from(n)),
    };
    // faer's dense functions without a `par` argument would use all cores.
    faer::set_global_parallelism(par);
    let log = RunLog::new(comm, settings, began);

    // A stage ends where bodies or contacts are added or removed; most problems have one.
    let stages = Stages {
        comm,
        file: &file,
        settings,
        log: &log,
        par,
    };
    let all = file.catalog().stages();
    if settings.check {
        let checked = all.into_iter().map(|steps| stages.check(steps));
        log.check(&checked.collect::<Result<Vec<_>, _>>()?);
        comm.agree(log.check_written())?;
        return Ok(Ending::Converged);
    }
    let lock = comm.is_root().then(|| OutputLock::take(&settings.output));
    let _lock = comm.agree(lock.transpose().map_err(Failure::from))?;
    if let Some(cases) = &command_line.run.study {
        return Ok(match stages.study(cases)? {
            true => Ending::Converged,
            false => Ending::NotConverged,
        });
    }
    let mut progress = Progress {
        finished: finished_steps(comm, settings)?,
        smallest_pivot: 1.0,
        ..Progress::default()
    };
    (progress.seconds).add(|s| &mut s.read, comm.times() - start);
    let done = progress.finished.count;
    let left: Vec<Range<usize>> = (all.into_iter()).filter(|steps| steps.end > done).collect();
    // Invalid later stages are found before the first one is solved.
    for steps in left.iter().skip(1) {
        stages.check(steps.clone())?;
    }
    for (i, steps) in left.iter().enumerate() {
        stages.solve(steps.clone(), left.get(i + 1), &mut progress)?;
    }
    (progress.seconds).add(|s| &mut s.total, comm.times() - start);
    progress.finish(&stages)
}

impl Stages<'_> {
    /// Solves the load `steps` of a stage, with the same bodies and contacts; steps from `next` on belong to another
    /// stage. Where the chosen solver doesn't converge, a more robust one continues from there. Collective.
    ///
    /// # Errors
    /// Errors of the whole run.
    fn solve(
        &self,
        steps: Range<usize>,
        next: Option<&Range<usize>>,
        progress: &mut Progress,
    ) -> Result<(), Failure> {
        let whole = (self.file.catalog()).stage(steps, &progress.finished.transfer.since);
        if progress.finished.working_set.is_none() && pays(&whole.catalog, self.settings) {
            progress.finished.working_set =
                self.predict_working_set(&whole, &mut progress.seconds)?;
        }
        let mut handover = None;
        loop {
            let set = progress.finished.working_set.as_ref();
            let stage = set.map(|set| whole.with_points(&set.points));
            let stage = stage.as_ref().unwrap_or(&whole);
            match self.solve_from(handover.clone(), stage, next, progress) {
                Ok(None) => return Ok(()),
                Ok(again) => handover = again,
                // Bodies that the contact points of the working set don't hold may be held by the others.
                Err(failure)
                    if failure.kind == FailureKind::IllPosed
                        && stage.points.len() < whole.points.len() =>
                {
                    progress.finished.working_set = Some(WorkingSet::all(&whole.catalog));
                }
                Err(failure) => return Err(failure),
            }
        }
    }

    /// Solves the remaining load steps of a `stage`, from the state of another solver's handover if there is one;
    /// returns the handover to a more robust solver if one is needed. Collective.
    ///
    /// # Errors
    /// Errors of the whole run.
    fn solve_from(
        &self,
        handover: Option<Handover>,
        stage: &Stage<'_>,
        next: Option<&Range<usize>>,
        progress: &mut Progress,
    ) -> Result<Option<Handover>, Failure> {
        let (comm, settings, log) = (self.comm, self.settings, self.log);
        let (first, done) = (stage.steps.start, progress.finished.count);

        // Blocks and contact groups of this rank.
        let is_first = progress.plan.is_none();
        let lap = comm.times();
        let parts = self.parts(stage, handover.as_ref(), is_first)?;
        let context = self.context(stage, &parts);
        stop_if_asked(&context, settings, done)?;
        let after = |failure| state::finished(failure, &context, settings, done);

        // Rigid-body modes that neither supports nor contact restrain, and the bodies' closing motions.
        log.phase("looking for free rigid motions", None);
        let before = progress.finished.transfer.closing_motions.clone();
        let analyses = analyse_steps(&context, stage.steps.clone(), &before)?;
        log.phase("creating the outputs", None);
        if is_first {
            let kept = progress.finished.file.take();
            progress.files = RunFiles::create(&context, settings, kept).map_err(after)?;
        }
        let absent = (comm.is_root() && self.file.catalog().has_stages())
            .then(|| absent_rows(self.file.catalog(), stage));
        (progress.seconds).add(|s| &mut s.read, comm.times() - lap);

        // S_i of the linear subdomains, (11), S_kl of the pairs, (12), and S_0, (15).
        let loads = StepState::default().loads(&context, LoadPoint::end_of(first), &analyses[0]);
        let operators = Operators::new(context, log, &loads, &analyses[0], &mut progress.seconds)
            .map_err(after)?;

        // Each load step starts from the state that the one before it left.
        let robust = self.more_robust(&stage.catalog, &parts.plan);
        let steps = StageSteps {
            stage,
            whole: self.file.catalog(),
            next,
            context,
            analyses: &analyses,
            before: &before,
            operators: &operators,
            absent: &absent.unwrap_or_default(),
            robust: robust.as_ref(),
        };
        let took_over = handover.as_ref().and_then(Handover::why);
        let start = progress.finished.start(&context, handover, stage);
        let handover = self.solve_steps(&steps, (start, took_over), progress)?;
        progress.smallest_pivot = progress.smallest_pivot.min(operators.smallest_pivot());
        progress.plan = Some((parts.plan, parts.why));
        Ok(handover)
    }

    /// Solves the remaining load steps of a stage from a given state; the report of the first one gives the reason why
    /// another solver took over, if one did. Returns the handover to a more robust solver if one is needed. Collective.
    ///
    /// # Errors
    /// Errors of the whole run.
    fn solve_steps(
        &self,
        steps: &StageSteps<'_>,
        (mut state, mut took_over): (StepState, Option<String>),
        progress: &mut Progress,
    ) -> Result<Option<Handover>, Failure> {
        let (settings, log) = (self.settings, self.log);
        let &StageSteps {
            stage,
            context,
            analyses,
            robust,
            ..
        } = steps;
        let (first, done) = (stage.steps.start, progress.finished.count);
        for k in stage.steps.clone().skip(done.saturating_sub(first)) {
            stop_if_asked(&context, settings, k)?;
            log.step(context.catalog, k);
            let increments = steps.increments(settings, log, &progress.linear_solves);
            let (analysis, earlier) = (&analyses[k - first], &analyses[..k - first]);
            let earlier = (earlier.last()).map_or(steps.before, |last| &last.closing_motions);
            let set = progress.finished.working_set.as_ref();
            let waits = set.is_some_and(|set| !set.outside.is_empty());
            let start = (robust.is_some() || waits).then(|| state.clone());
            let solved = increments.step(k, (earlier, analysis), state, &mut progress.seconds);
            let why = reason_to_hand_over(increments.ended(&solved));
            if let Some((start, why)) = start.as_ref().zip(why) {
                let handover = steps.to_more_robust((k, start), &why, &mut progress.finished);
                return Ok(Some(handover));
            }
            let mut solved = solved.map_err(|failure| {
                state::finished(context.in_step(failure, k), &context, settings, k)
            })?;
            let mut rows = steps.absent.to_vec();
            if let (Some(start), Some(set)) = (&start, &mut progress.finished.working_set) {
                match set.after_step(&context, steps.whole, &solved.solution.displacement) {
                    Outside::Open(open) => rows.extend(open),
                    Outside::Overlaps(larger) => {
                        let handover = steps.with_set(larger, (k, start), &mut progress.finished);
                        return Ok(Some(handover));
                    }
                }
            }
            if let Some((outcome, why)) = solved.outcome.as_mut().zip(took_over.take()) {
                outcome.take_over(why);
            }
            log.phase("writing", None);
            progress.finish_step(&context, &solved, analysis, &rows, k)?;
            if let Some(next) = steps.next.filter(|next| next.start == k + 1) {
                steps.pass_on((&solved, analysis), next, &mut progress.finished);
            }
            state = solved.into_state(settings.method);
            if k + 1 < context.catalog.steps.len() {
                let result = progress.files.result.as_mut();
                keep(&context, settings, &state, &progress.finished, result)?;
            }
        }
        progress.finished.count = stage.steps.end;
        Ok(None)
    }
}

impl Progress {
    /// Writes the solution of load step `step`, including the rows of contact points that are `absent`, and keeps its
    /// totals. Collective.
    ///
    /// # Errors
    /// The file can't be written.
    fn finish_step(
        &mut self,
        context: &Context<'_>,
        solved: &Increment,
        analysis: &RigidBodyAnalysis,
        absent: &[ContactRow],
        step: usize,
    ) -> Result<(), Failure> {
        let solution = &solved.solution;
        let lap = context.comm.times();
        let resultants = (self.files).write(context, solution, &solved.slips, absent, step)?;
        (self.seconds).add(|s| &mut s.write, context.comm.times() - lap);
        let totals = solved.outcome.clone().map(|outcome| {
            let found = (outcome, self.linear_solves.take());
            let sums = (resultants, solved.energy);
            StepTotals::new(found, solution, sums, analysis, context.catalog)
        });
        self.finished.steps.extend(totals);
        Ok(())
    }

    /// Writes the files of a run whose load steps are all done. Collective.
    ///
    /// # Errors
    /// A file that can't be written.
    fn finish(self, run: &Stages<'_>) -> Result<Ending, Failure> {
        let Some((plan, why)) = self.plan else {
            return Err(Failure::internal("no load step is left"));
        };
        let Finished { steps, warning, .. } = self.finished;
        let totals = Totals {
            catalog: run.file.catalog(),
            plan: &plan,
            why: &why,
            steps,
            smallest_pivot: self.smallest_pivot,
            ranks: collect(run.comm, &self.seconds, &plan),
            warnings: run.settings.unused().into_iter().chain(warning).collect(),
        };
        let is_root = run.comm.is_root();
        let write = || (run.log).finish(&totals, |report| self.files.finish(&totals, report));
        run.comm.agree(is_root.then(write).transpose())?;
        Ok(
            match run.comm.decide(totals.status() == Status::Converged) {
                true => Ending::Converged,
                false => Ending::NotConverged,
            },
        )
    }
}
