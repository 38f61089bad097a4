//! The whole solve on one page.
//!
//! read → assemble → condense → S_0 at the root → for each load step: F → sweeps → recover → write

mod increment;
mod restart;
mod sweeping;

use std::cell::RefCell;
use std::time::Instant;

use contact_dd_partition::model::PlaneState;
use contact_dd_partition::problem::read::ProblemFile;
use faer::Par;

use self::increment::Increments;
use self::restart::{finished_steps, keep};
use crate::comm::{Comm, phase};
use crate::condense::Condensation;
use crate::condense::interface::assemble_interface;
use crate::condense::tree::condense_clusters;
use crate::context::{Context, Moment};
use crate::error::Failure;
use crate::frozen::fronts::FrozenFronts;
use crate::output::memory::afford;
use crate::output::ranks::PhaseSeconds;
use crate::output::report::ReportFile;
use crate::output::resultants::Resultants;
use crate::output::vtkhdf::{Layout, ResultFile};
use crate::plan::Plan;
use crate::plan::cluster::Merging;
use crate::read::{check_copies, collect_groups, depend_on_each_other, read_blocks};
use crate::report::log::RunLog;
use crate::report::totals::{StepTotals, Totals};
use crate::report::write::write_solution;
use crate::report::{Outputs, collect};
use crate::settings::Settings;
use crate::settings::command_line::CommandLine;
use crate::step::state::{StepState, analyse_steps, stop_if_asked};
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
    let began = Instant::now();
    let mut seconds = PhaseSeconds::default();
    // Settings of the command line take precedence over those of the problem file.
    phase("reading");
    let file = comm.agree(ProblemFile::open(&command_line.problem()).map_err(Failure::from))?;
    let settings = &Settings::new(command_line, &file.catalog().solver);
    comm.agree(settings.check_paths())?;
    let par = match settings.threads {
        1 => Par::Seq,
        n => Par::rayon(usize::from(n)),
    };
    // Where faer's dense algebra takes no `par`, it would use all cores.
    faer::set_global_parallelism(par);
    let log = RunLog::new(comm, settings, began);

    // Every rank reads its own subdomains and pairs.
    let catalog = file.catalog();
    let merging = comm.agree(settings.merging(catalog))?;
    let mut plan = Plan::new(catalog, comm.size(), merging);
    let costs = plan.cost_estimates(catalog, comm.size());
    let available = afford(comm, &costs)?;
    let blocks = comm.agree(read_blocks(comm.rank(), &file, &plan))?;
    check_copies(comm, &file, &plan, &blocks)?;
    let groups = collect_groups(comm, &file, &plan, &blocks)?;
    if merging.is_frozen() && depend_on_each_other(comm, &plan, &groups) {
        plan.form_clusters(Merging::All);
    }
    log.problem(catalog, &plan);

    let context = Context {
        comm,
        catalog,
        plan: &plan,
        blocks: &blocks,
        groups: &groups,
        par,
    };

    // Rigid-body modes that neither supports nor contact restrain, and the bodies' closing motions.
    log.phase("looking for free rigid motions", None);
    let analyses = analyse_steps(&context)?;
    if settings.check {
        log.check(&analyses, &costs, available, plan.coarse_dofs(catalog.dim));
        return Ok(Ending::Converged);
    }
    log.phase("creating the outputs", None);
    let finished = finished_steps(&context, settings)?;
    let mut outputs = create_outputs(&context, settings, finished.count)?;
    seconds.read = began.elapsed().as_secs_f64();

    // S_i of the linear subdomains, (11), and S_kl of the pairs, (12), merged up the hierarchy.
    log.phase("factorizing", Some(blocks.len()));
    let condensation = Condensation {
        context,
        loads: &StepState::default().loads(&context, Moment::end_of(0), &analyses[0]),
        fixing_dofs: &analyses[0].motions.fixing_dofs,
    };
    let mut condensed = condense_clusters(&condensation, &analyses[0], &|| log.bar.advance())?;
    [seconds.assemble, seconds.factorize] = condensed.seconds;

    // The root assembles S_0, (15), and the bilateral operator.
    log.phase("assembling the interface problem", None);
    let lap = Instant::now();
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
    seconds.interface = lap.elapsed().as_secs_f64();

    // Load step by load step: each starts from the state that the one before it left.
    let increments = Increments {
        context,
        settings,
        log: &log,
        factors: &condensed,
        interface: interface.as_ref(),
        frozen: frozen.as_ref(),
    };
    let (mut state, mut steps) = (finished.state, finished.steps);
    for (k, at_end) in analyses.iter().enumerate().skip(finished.count) {
        stop_if_asked(&context, settings, k)?;
        log.step(catalog, k);
        let solved = increments.step(k, &analyses, state, &mut seconds);
        let solved = solved.map_err(|failure| context.in_step(failure, k))?;

        // Results travel to the root in slabs of subdomains and are written as they arrive.
        log.phase("writing", None);
        let lap = Instant::now();
        let mut resultants = Resultants::new(catalog, solved.solution.reactions.clone());
        let result = outputs.as_mut().map(|outputs| &mut outputs.result);
        let contacts = &mut resultants.contacts;
        write_solution(&context, &solved.solution, &solved.slips, result, contacts)?;
        if catalog.plane == Some(PlaneState::Axisymmetric) {
            resultants.sum_around_axis();
        }
        seconds.write += lap.elapsed().as_secs_f64();
        let totals = solved.outcome.clone();
        let totals =
            totals.map(|o| StepTotals::new(o, &solved.solution, resultants, solved.energy, at_end));
        steps.extend(totals);
        state = solved.into_state(settings.method);
        if k + 1 < analyses.len() {
            let result = outputs.as_mut().map(|outputs| &mut outputs.result);
            keep(&context, settings, &state, &steps, result)?;
        }
    }
    seconds.total = began.elapsed().as_secs_f64();

    let ranks = collect(comm, &seconds, &plan);
    let converged = steps
        .iter()
        .all(|step| step.outcome.status == SweepStatus::Converged);
    let smallest_pivot = match (&interface, &frozen) {
        (Some((_, interface)), _) => interface.smallest_pivot(),
        (None, fronts) => fronts
            .as_ref()
            .map_or(1.0, |fronts| fronts.borrow().smallest_pivot),
    };
    let finished = match outputs {
        Some(outputs) => {
            let totals = Totals {
                catalog,
                plan: &plan,
                steps,
                smallest_pivot,
                ranks,
                warnings: settings
                    .unused()
                    .into_iter()
                    .chain(finished.warning)
                    .collect(),
            };
            log.finish(&totals, outputs)
        }
        _ => Ok(()),
    };
    comm.agree(finished)?;
    Ok(match comm.decide(converged) {
        true => Ending::Converged,
        false => Ending::NotConverged,
    })
}

/// Creates the output files, so that a folder that can't be written is found before the work, or opens those of a run
/// that was stopped after some `finished` load steps.
/// Collective; the root has the files.
///
/// # Errors
/// A file can't be made.
fn create_outputs(
    context: &Context<'_>,
    settings: &Settings,
    finished: usize,
) -> Result<Option<Outputs>, Failure> {
    let &Context {
        comm,
        catalog,
        plan,
        blocks,
        ..
    } = context;
    let mut connectivity = Vec::new();
    comm.gather(
        plan.owners(),
        |s| (blocks.get(&s)).map_or(0, |block| block.subdomain.cells.connectivity().len()),
        |_, length| connectivity.push(length),
    );
    let create = || -> Result<Outputs, Failure> {
        let layout = Layout::new(catalog, &connectivity, !settings.no_stress);
        let report = settings.report.as_deref().map(ReportFile::create);
        Ok(Outputs {
            result: match finished {
                0 => ResultFile::create(&settings.output, &layout)?,
                steps => ResultFile::resume(&settings.output, &layout, steps)?,
            },
            report: report.transpose()?,
        })
    };
    comm.agree(comm.is_root().then(create).transpose())
}
