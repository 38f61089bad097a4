//! Restart of a stopped run after its finished load steps.
//!
//! After every load step but the last, its results are on disk, under the result's name + `.unfinished`, together with
//! the state from which the next step starts. `--restart` reads both, on any number of ranks.

use std::collections::BTreeMap;
use std::fs::File;
use std::hash::{DefaultHasher, Hasher};
use std::io::Read;
use std::mem::take;
use std::path::Path;

use contact_dd_partition::destination::unfinished;
use contact_dd_partition::error::InputError;
use contact_dd_partition::problem::stage::Stage;
use serde::{Deserialize, Serialize};

use crate::bytes::Reals;
use crate::certificate::energy::BlockEnergy;
use crate::certificate::scales::Scales;
use crate::comm::Comm;
use crate::contact::friction::Status;
use crate::contact::laws::Statuses;
use crate::contact::pair::PairState;
use crate::context::Context;
use crate::error::Failure;
use crate::output::vtkhdf::{ResultFile, kept as file};
use crate::report::totals::StepTotals;
use crate::run::handover::{Handover, Successor};
use crate::settings::Settings;
use crate::step::state::StepState;
use crate::step::transfer::StageTransfer;
use crate::step::working_set::WorkingSet;

/// State kept with the results of the finished load steps.
#[derive(Default, Serialize, Deserialize)]
struct KeptState {
    /// The identity of the run.
    run: Identity,
    /// The finished load steps.
    steps: Vec<StepTotals>,
    /// U, and the statuses of every cluster in contact.
    interface: Option<(Vec<f64>, Vec<Vec<Status>>)>,
    /// The clusters in contact.
    pairs: Vec<PairState>,
    /// The statuses of every contact group, if the tree solver is used.
    statuses: Vec<Option<Statuses>>,
    /// The tangential jumps of every contact group (m).
    slips: Vec<Vec<f64>>,
    /// Data of every block for the energy balance, if there is friction.
    energies: Vec<BlockEnergy>,
    /// Transfer to the stage of the next load step.
    transfer: StageTransfer,
    /// The working set of contact points, if there is one.
    working_set: Option<WorkingSet>,
}

/// Identity of a run: runs with equal ones have equal results.
#[derive(Default, PartialEq, Serialize, Deserialize)]
struct Identity {
    problem: u64,
    settings: String,
}

impl Identity {
    fn new(settings: &Settings) -> Result<Self, Failure> {
        let path = &settings.problem;
        let problem =
            digest(path).map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
        let Settings {
            threads, no_stress, ..
        } = settings;
        Ok(Self {
            problem,
            settings: format!("{:?}, {threads} threads, {no_stress}", settings.sweeps()),
        })
    }
}

/// A hash of a file's content.
fn digest(path: &Path) -> std::io::Result<u64> {
    let (mut file, mut hasher) = (File::open(path)?, DefaultHasher::new());
    let mut bytes = vec![0; 1 << 20];
    loop {
        match file.read(&mut bytes)? {
            0 => return Ok(hasher.finish()),
            n => hasher.write(&bytes[..n]),
        }
    }
}

/// The finished load steps of a stopped run, and the state after them.
#[derive(Default)]
pub struct Finished {
    /// Number of finished load steps.
    pub count: usize,
    /// The totals of the finished load steps; on the root.
    pub steps: Vec<StepTotals>,
    /// Transfer to the stage of the next load step.
    pub transfer: StageTransfer,
    /// The working set of contact points, if there is one.
    pub working_set: Option<WorkingSet>,
    /// The state from which the next load step starts; on the root.
    kept: Option<KeptState>,
    /// The unfinished result file; on the root.
    pub file: Option<file::Kept>,
    /// The warning that there is no state to restart from; on the root.
    pub warning: Option<String>,
}

/// Finds the state kept by a run with this identity, if `settings` ask for a restart. Collective.
///
/// # Errors
/// It is the state of another problem, of other settings or of another version of the program.
pub fn finished_steps(comm: &Comm, settings: &Settings) -> Result<Finished, Failure> {
    if !settings.restart {
        return Ok(Finished::default());
    }
    let kept = comm.agree(match comm.is_root() {
        true => read(settings),
        false => Ok(None),
    })?;
    let mut finished = Finished::default();
    if let Some((file, mut kept)) = kept {
        finished.file = Some(file);
        finished.count = kept.steps.len();
        finished.steps = take(&mut kept.steps);
        finished.transfer = take(&mut kept.transfer);
        finished.working_set = kept.working_set.take();
        finished.kept = Some(kept);
    } else {
        finished.warning = Some(format!(
            "--restart: there is no {}: this run begins at the start",
            unfinished(&settings.output).display()
        ));
    }
    comm.broadcast(&mut finished.count);
    comm.broadcast(&mut finished.transfer);
    comm.broadcast(&mut finished.working_set);
    Ok(finished)
}

impl Finished {
    /// The state from which the next load step of a `stage` starts: that of a `handover` if there is one. Collective.
    pub fn start(
        &mut self,
        context: &Context<'_>,
        handover: Option<Handover>,
        stage: &Stage<'_>,
    ) -> StepState {
        let state = match handover {
            Some(Handover { state, plan, to }) => match to {
                Successor::Solver { .. } => state.handed_over(context, &plan),
                Successor::Points(transfer) => {
                    let state = StepState {
                        slips: BTreeMap::new(),
                        ..state
                    };
                    let slips = transfer.map(|transfer| transfer.state(context, stage).slips);
                    StepState {
                        slips: slips.unwrap_or_default(),
                        ..state.handed_over(context, &plan)
                    }
                }
            },
            None if self.count > stage.steps.start => self.state(context),
            None => self.transfer.state(context, stage),
        };
        let scales = self.steps.iter().map(|step| step.scales);
        StepState {
            // The scales of the finished load steps that converged; on the root.
            scales: scales.fold(Scales::default(), Scales::and),
            ..state
        }
    }

    /// The state from which the load step after the finished ones starts, within a stage. Collective.
    fn state(&mut self, context: &Context<'_>) -> StepState {
        let Context { comm, plan, .. } = *context;
        let mut kept = self.kept.take().unwrap_or_default();
        let groups = plan.group_owners();
        let pairs = comm.scattered(&plan.pair_owners(), |p| kept.pairs[p.index()].clone());
        let slips = comm.scattered(&groups, |g| Reals(take(&mut kept.slips[g.index()])));
        let statuses = comm.scattered(&groups, |g| take(&mut kept.statuses[g.index()]));
        let statuses = statuses.into_iter();
        let energies = match context.catalog.has_friction() {
            true => comm.scattered(&plan.owners(), |b| take(&mut kept.energies[b.index()])),
            false => BTreeMap::new(),
        };
        StepState {
            interface: kept.interface,
            pairs,
            statuses: statuses.filter_map(|(g, s)| Some((g, s?))).collect(),
            slips: (slips.into_iter())
                .map(|(g, Reals(slips))| (g, slips))
                .collect(),
            energies,
            scales: Scales::default(),
        }
    }
}

fn read(settings: &Settings) -> Result<Option<(file::Kept, KeptState)>, Failure> {
    let refused = |error: InputError| Failure::input(format!("--restart: {error}"));
    let Some(mut file) = file::Kept::read(&settings.output).map_err(refused)? else {
        return Ok(None);
    };
    let state = take(&mut file.state);
    let kept: KeptState = ciborium::from_reader(&state[..]).map_err(|error| {
        let state = file::state_of(&settings.output);
        refused(file::unreadable_state(&state, &error))
    })?;
    let run = Identity::new(settings)?;
    let why = match &kept.run {
        kept if kept.problem != run.problem => "it is of another problem file",
        kept if kept.settings != run.settings => "it is of a run with other settings",
        _ => return Ok(Some((file, kept))),
    };
    let name = unfinished(&settings.output);
    Err(Failure::input(format!(
        "--restart: {}: {why}",
        name.display()
    )))
}

/// Keeps the results of the `finished` load steps and the `state` after them for a restart. Collective; `result` is the
/// root's.
///
/// # Errors
/// The file can't be written.
pub fn keep(
    context: &Context<'_>,
    settings: &Settings,
    state: &StepState,
    finished: &Finished,
    result: Option<&mut ResultFile>,
) -> Result<(), Failure> {
    let Context { comm, plan, .. } = *context;
    let groups = plan.group_owners();
    let pairs = comm.gathered(&plan.pair_owners(), |p| state.pairs[&p].clone());
    let slips = comm.gathered(&groups, |g| Reals(state.slips[&g].clone()));
    let statuses = comm.gathered(&groups, |g| state.statuses.get(&g).cloned());
    let energies = match context.catalog.has_friction() {
        true => comm.gathered(&plan.owners(), |b| state.energies[&b].clone()),
        false => Vec::new(),
    };
    let write = |result: &mut ResultFile| -> Result<(), Failure> {
        let kept = KeptState {
            run: Identity::new(settings)?,
            steps: finished.steps.clone(),
            interface: state.interface.clone(),
            pairs,
            statuses,
            slips: slips.into_iter().map(|Reals(slips)| slips).collect(),
            energies,
            transfer: finished.transfer.clone(),
            working_set: finished.working_set.clone(),
        };
        let mut bytes = Vec::new();
        ciborium::into_writer(&kept, &mut bytes)
            .map_err(|error| Failure::internal(error.to_string()))?;
        Ok(result.keep(&bytes)?)
    };
    comm.agree(result.map_or(Ok(()), write))
}
