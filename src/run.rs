//! The whole solve on one page.
//!
//! for each stage: read → assemble → condense → S_0 at the root → for each load step: F → sweeps → recover → write

mod increment;
mod passage;
mod restart;
mod stage;
mod sweeping;

use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::problem::trial;
use faer::Par;

use self::restart::{Finished, finished_steps};
use self::stage::{Progress, Stages};
use crate::comm::{Comm, is_asked_to_stop, phase};
use crate::context::Context;
use crate::error::Failure;
use crate::output::lock::OutputLock;
use crate::output::report::ReportFile;
use crate::output::vtkhdf::beside::FileBeside;
use crate::output::vtkhdf::kept::Kept;
use crate::output::vtkhdf::{Layout, ResultFile};
use crate::report::log::RunLog;
use crate::report::totals::Totals;
use crate::report::{Outputs, collect};
use crate::settings::Settings;
use crate::settings::command_line::CommandLine;
use crate::sweep::SweepStatus;

/// How a run ended that didn't fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The sweeps converged, or there was nothing to solve for.
    Converged,
    /// They didn't; the results are written all the same.
    NotConverged,
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
    let par = match settings.threads {
        1 => Par::Seq,
        n => Par::rayon(usize::from(n)),
    };
    // Where faer's dense algebra takes no `par`, it would use all cores.
    faer::set_global_parallelism(par);
    let log = RunLog::new(comm, settings, began);

    // A stage ends where bodies or contacts come or go; most problems have one.
    let catalog = file.catalog();
    let stages = Stages {
        comm,
        file: &file,
        settings,
        log: &log,
        par,
    };
    let all = catalog.stages();
    if settings.check {
        let checked = all.into_iter().map(|steps| stages.check(steps));
        log.check(&checked.collect::<Result<Vec<_>, _>>()?);
        comm.agree(log.heard())?;
        return Ok(Ending::Converged);
    }
    let lock = comm.is_root().then(|| OutputLock::take(&settings.output));
    let _lock = comm.agree(lock.transpose().map_err(Failure::from))?;
    let mut progress = Progress {
        finished: finished_steps(comm, settings)?,
        smallest_pivot: 1.0,
        ..Progress::default()
    };
    (progress.seconds).add(|s| &mut s.read, comm.times() - start);
    let done = progress.finished.count;
    let left: Vec<Range<usize>> = (all.into_iter()).filter(|steps| steps.end > done).collect();
    // What a later stage can't be is found before the first one is solved.
    for steps in left.iter().skip(1) {
        stages.check(steps.clone())?;
    }
    for (i, steps) in left.iter().enumerate() {
        stages.solve(steps.clone(), left.get(i + 1), &mut progress)?;
    }
    let Progress {
        mut seconds,
        plan: Some(plan),
        outputs,
        smallest_pivot,
        finished: Finished { steps, warning, .. },
        ..
    } = progress
    else {
        return Err(Failure::internal("no load step is left"));
    };
    seconds.add(|s| &mut s.total, comm.times() - start);

    let ranks = collect(comm, &seconds, &plan);
    let converged = steps
        .iter()
        .all(|step| step.outcome.status == SweepStatus::Converged);
    let finished = match outputs {
        Some(outputs) => {
            let totals = Totals {
                catalog,
                plan: &plan,
                steps,
                smallest_pivot,
                ranks,
                warnings: settings.unused().into_iter().chain(warning).collect(),
            };
            log.finish(&totals, outputs).and_then(|()| log.heard())
        }
        _ => Ok(()),
    };
    comm.agree(finished)?;
    Ok(match comm.decide(converged) {
        true => Ending::Converged,
        false => Ending::NotConverged,
    })
}

/// Checks that the HDF5 library can read the problem file, on the root alone. Collective.
///
/// # Errors
/// It isn't there or is damaged, or a signal asked the run to stop.
fn check_problem(comm: &Comm, path: &Path) -> Result<(), Failure> {
    let check = || trial::check(path, is_asked_to_stop).err();
    let mut damage = comm.is_root().then(check).flatten().map(Failure::from);
    comm.broadcast(&mut damage);
    match damage {
        Some(damage) => Err(damage),
        None if comm.is_any_asked_to_stop() => Err(Failure::interrupted(
            "interrupted while reading, before a result was written",
        )),
        None => Ok(()),
    }
}

/// Creates the output files, so that a folder that can't be written is found before the work, or opens those of a run
/// that was stopped, with what it kept of `finished` load steps.
/// Collective; the root has the files, and all ranks have the result file beside it where they may write to it at once.
///
/// # Errors
/// A file can't be made, or doesn't hold what was written of finished load steps.
fn create_outputs(
    context: &Context<'_>,
    settings: &Settings,
    finished: Option<Kept>,
) -> Result<(Option<Outputs>, Option<FileBeside>), Failure> {
    let comm = context.comm;
    let layout = layout(context, settings);
    let create = move |layout: &Layout| -> Result<Outputs, Failure> {
        let report = settings.report.as_deref().map(ReportFile::create);
        Ok(Outputs {
            result: match finished {
                None => ResultFile::create(&settings.output, layout)?,
                Some(kept) => {
                    let whole = kept.check(&settings.output);
                    whole.map_err(|error| Failure::input(format!("--restart: {error}")))?;
                    ResultFile::resume(&settings.output, layout, kept)?
                }
            },
            report: report.transpose()?,
        })
    };
    let outputs = comm.agree(comm.is_root().then(|| create(&layout)).transpose())?;
    // A single rank needs nobody beside it.
    let result = outputs.as_ref().filter(|_| comm.size() > 1);
    let mut places = result.and_then(|outputs| outputs.result.places());
    comm.broadcast(&mut places);
    let beside = places
        .and_then(|places| FileBeside::open(&places, &settings.output, &layout, comm.hosts()));
    let is_alone = comm.is_any(beside.is_none());
    Ok((outputs, beside.filter(|_| !is_alone)))
}

/// How much room everything takes in the result file. Collective.
fn layout(context: &Context<'_>, settings: &Settings) -> Layout {
    let &Context {
        comm,
        catalog,
        plan,
        blocks,
        ..
    } = context;
    let mut connectivity = vec![0; plan.blocks()];
    comm.gather(
        plan.owners(),
        |s| (blocks.get(&s)).map_or(0, |block| block.subdomain.cells.connectivity().len()),
        |s, length| connectivity[s] = length,
    );
    comm.broadcast(&mut connectivity);
    Layout::new(catalog, &connectivity, !settings.no_stress)
}
