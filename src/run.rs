//! The whole solve on one page.
//!
//! read → assemble → condense → S_0 at the root → sweeps → recover → certificate → write

mod affording;
mod clusters;
pub mod condense;
pub mod conditioning;
mod conditions;
mod copies;
mod descend;
pub mod frozen;
pub mod interface;
pub mod merge;
pub mod motions;
mod narrator;
mod pausing;
mod reactions;
pub mod read;
pub mod recover;
pub mod refine;
mod report;
pub mod settle;
mod squeezed;
mod stresses;
pub mod substitute;
pub mod write;

use std::collections::BTreeMap;
use std::time::Instant;

use contact_dd_partition::problem::Catalog;
use contact_dd_partition::problem::read::ProblemFile;
use faer::Par;

use self::affording::afford;
use self::condense::Condensation;
use self::conditioning::condition_number;
use self::copies::check_copies;
use self::descend::{take_out_descent, with_descent};
use self::frozen::{Frozen, FrozenRoot};
use self::interface::assemble_interface;
use self::merge::condense_clusters;
use self::motions::Motions;
use self::narrator::Narrator;
use self::pausing::Checkpoints;
use self::reactions::reactions;
use self::read::{OwnedBlock, read_blocks};
use self::recover::recover;
use self::refine::refine;
use self::report::{Outputs, Totals};
use self::settle::{settle_free_motions, settle_loose_motions};
use self::stresses::{error_estimate, stresses};
use self::substitute::Factors;
use self::write::{Fields, write_solution};
use crate::comm::{Comm, Message, phase};
use crate::contact::s_con::SCon;
use crate::error::Failure;
use crate::output::report::{PhaseSeconds, ReportFile};
use crate::output::resultants::Resultants;
use crate::output::vtkhdf::{Layout, ResultFile};
use crate::plan::Plan;
use crate::rigid::survey::survey;
use crate::settings::Settings;
use crate::settings::given::Given;
use crate::sweep::{SweepRecord, SweepStatus, Sweeps};

/// How a run ended that didn't fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The sweeps converged, or there was nothing to solve for.
    Converged,
    /// They didn't; the results are written all the same.
    NotConverged,
}

/// Solves the problem file that was `given` and writes the results. Collective.
///
/// # Errors
/// Bad input, a scene without equilibrium, or an output that can't be written; the same on all
/// ranks.
pub fn run(comm: &Comm, given: &Given) -> Result<Ending, Failure> {
    let began = Instant::now();
    let mut seconds = PhaseSeconds::default();
    // What a problem file asks for counts where nobody says otherwise.
    phase("reading");
    let file = comm.agree(ProblemFile::open(&given.problem()).map_err(Failure::from))?;
    let settings = &given.resolve(&file.catalog().solver);
    comm.agree(settings.check_paths())?;
    let par = match settings.threads {
        1 => Par::Seq,
        n => Par::rayon(usize::from(n)),
    };
    // Dense algebra, which takes no such argument everywhere, would use all cores.
    faer::set_global_parallelism(par);
    let narrator = Narrator::new(comm, settings, began);

    // Every rank reads its own subdomains and pairs.
    let catalog = file.catalog();
    let plan = Plan::new(catalog, comm.size(), settings.merging());
    let demands = plan.demands(catalog, comm.size());
    let available = afford(comm, &demands)?;
    narrator.problem(catalog, &plan);
    let mut blocks = comm.agree(read_blocks(comm, &file, &plan))?;
    comm.agree(check_copies(comm, &file, &plan, &blocks))?;
    let mut checkpoints = Checkpoints::new(settings);
    let earlier = match comm.is_root() {
        true => checkpoints.last(),
        false => Ok(None),
    };
    let earlier = comm.agree(earlier)?;

    // Rigid motions that neither supports nor contact hold, and those by which bodies come to rest.
    narrator.phase("looking for free rigid motions", None);
    let survey = survey(comm, &blocks, catalog, &plan)?;
    if settings.check {
        narrator.check(&survey, &demands, available);
        return Ok(Ending::Converged);
    }
    narrator.phase("creating the outputs", None);
    let mut outputs = comm.agree(create_outputs(comm, settings, catalog, &plan, &blocks))?;
    take_out_descent(&mut blocks, &survey, catalog.dim);
    seconds.read = began.elapsed().as_secs_f64();

    // S_i of the linear subdomains, (11), and S_kl of the pairs, (12), merged up the hierarchy.
    narrator.phase("factorizing", Some(blocks.len()));
    let condensation = Condensation {
        catalog,
        plan: &plan,
        pins: &survey.motions.pins,
        par,
    };
    let mut condensed = condense_clusters(comm, &condensation, &blocks, &survey, &narrator.bar)?;
    [seconds.assemble, seconds.factorize] = condensed.seconds;

    // The root assembles S_0 and F, (15), and the bilateral operator.
    narrator.phase("assembling the interface problem", None);
    let lap = Instant::now();
    let interface = comm.agree(assemble_interface(
        comm, &condensed, catalog, &plan, &survey, par,
    ))?;
    seconds.interface = lap.elapsed().as_secs_f64();

    // S_0 U + S_CON(U) = F, (14), from the bilateral start (16)-(17).
    narrator.phase("sweeping", None);
    let lap = Instant::now();
    let pair_owners = plan.contact_owners();
    let mut s_con = SCon::new(comm, &pair_owners, &mut condensed.pairs);
    let outcome = match &interface {
        Some((_, interface)) => {
            narrator.sweeps(interface, earlier.as_ref());
            let mut observer = |record: &SweepRecord| narrator.sweep(interface, record);
            let restored = checkpoints.restore(earlier, interface, &mut s_con);
            let solved = restored.and_then(|earlier| {
                let sweeps = settings.sweeps();
                let pause = &mut checkpoints;
                Sweeps::solve(interface, &mut s_con, sweeps, earlier, pause, &mut observer)
                    .ok_or_else(|| checkpoints.stopped())
            });
            s_con.stop();
            solved.map(Some)
        }
        None => {
            s_con.serve();
            Ok(None)
        }
    };
    let mut outcome = comm.agree(outcome)?;
    seconds.sweeps = lap.elapsed().as_secs_f64();

    // Back-substitution, and the check of the full discrete problem.
    narrator.phase("recovering", None);
    let lap = Instant::now();
    let root = outcome.as_ref().zip(interface.as_ref());
    let trace_of_root = root.map(|(o, (numbering, _))| (&o.u[..], &numbering.traces[..]));
    let factors = Factors {
        comm,
        plan: &plan,
        condensed: &condensed,
    };
    let mut solutions = recover(factors, trace_of_root);
    let frozen = Frozen {
        comm,
        blocks: &blocks,
        condensed: &condensed,
        catalog,
        plan: &plan,
        descent: survey.longest_descent(),
        free: Motions {
            list: &survey.motions.free,
            frames: &survey.frames,
        },
        root: root.map(|(outcome, (numbering, interface))| FrozenRoot {
            numbering,
            interface,
            converged: outcome.status == SweepStatus::Converged,
        }),
    };
    settle_free_motions(&frozen, &mut solutions);
    let mut certificate = refine(&frozen, &mut solutions);
    let settled = settle_loose_motions(&frozen, &survey, &mut solutions, &mut certificate);
    // What is loose has no stiffness that could be compared.
    let condition = match settled.is_loose {
        true => None,
        false => condition_number(&frozen, &solutions),
    };
    let reactions = reactions(&frozen, &solutions);
    let stress = (!settings.no_stress).then(|| stresses(comm, &blocks, &solutions, catalog, &plan));
    let estimate = (stress.as_ref()).map(|stress| error_estimate(comm, stress, &plan));
    let displacement = with_descent(&blocks, &solutions, &survey, catalog.dim);
    if let Some(outcome) = &mut outcome {
        outcome.accept(&certificate);
    }
    seconds.recover = lap.elapsed().as_secs_f64();

    // Results travel to the root in slabs of subdomains and are written as they arrive.
    narrator.phase("writing", None);
    let lap = Instant::now();
    let fields = Fields {
        solutions: &solutions,
        displacement: &displacement,
        stress: stress.as_ref(),
    };
    let mut resultants = Resultants::new(catalog, reactions);
    let contacts = &mut resultants.contacts;
    let result = outputs.as_mut().map(|outputs| &mut outputs.result);
    let written = write_solution(comm, &blocks, fields, &plan, result, contacts);
    comm.agree(written.map_err(Failure::from))?;
    seconds.write = lap.elapsed().as_secs_f64();
    seconds.total = began.elapsed().as_secs_f64();

    let ranks = report::collect(comm, &seconds, &plan, condensed.repeats.found);
    let finished = match (&outcome, &interface, outputs) {
        (Some(outcome), Some((_, interface)), Some(outputs)) => {
            let totals = Totals {
                catalog,
                plan: &plan,
                outcome,
                active: outcome.totals.active - settled.opened,
                interface_dofs: interface.len + interface.eliminated,
                smallest_pivot: interface.smallest_pivot(),
                certificate,
                condition,
                ranks,
                resultants,
                estimate,
                warnings: [
                    checkpoints.warnings.clone(),
                    survey.motions.warnings,
                    settled.warnings,
                ]
                .concat(),
            };
            let finished = narrator.finish(&totals, outputs);
            if finished.is_ok() && outcome.status == SweepStatus::Converged {
                checkpoints.remove();
            }
            finished
        }
        _ => Ok(()),
    };
    comm.agree(finished)?;
    let mut converged = Message {
        integers: vec![i64::from(
            outcome.is_none_or(|o| o.status == SweepStatus::Converged),
        )],
        reals: Vec::new(),
    };
    comm.broadcast(&mut converged);
    Ok(match converged.read().integer() {
        0 => Ending::NotConverged,
        _ => Ending::Converged,
    })
}

/// Makes the files of the outputs, so that a place where they can't be is found before the work.
/// Collective; the root has the files.
fn create_outputs(
    comm: &Comm,
    settings: &Settings,
    catalog: &Catalog,
    plan: &Plan,
    blocks: &BTreeMap<usize, OwnedBlock>,
) -> Result<Option<Outputs>, Failure> {
    let owners: Vec<usize> = plan
        .block_of
        .iter()
        .map(|&b| plan.blocks[b].owner)
        .collect();
    let mut connectivity = Vec::new();
    comm.gather(
        &owners,
        |s| {
            // Called on the owner of subdomain s, which has read its block.
            let block = &blocks[&plan.block_of[s]].block;
            let cells = block.member(s).map(|m| &block.members[m].cells);
            Message {
                integers: vec![cells.map_or(0, |c| c.connectivity().len() as i64)],
                reals: Vec::new(),
            }
        },
        |_, message| connectivity.push(message.read().count()),
    );
    if !comm.is_root() {
        return Ok(None);
    }
    let layout = Layout::new(catalog, &connectivity, !settings.no_stress);
    let report = settings.report.as_deref().map(ReportFile::create);
    Ok(Some(Outputs {
        result: ResultFile::create(&settings.output, &layout)?,
        report: report.transpose()?,
    }))
}
