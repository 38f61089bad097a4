//! Starting MPI, and what happens when a rank fails without a word to the others.

use std::cell::Cell;
use std::sync::{Mutex, PoisonError};

use contact_dd_partition::message;
use mpi::collective::SystemOperation;
use mpi::environment::Universe;
use mpi::topology::SimpleCommunicator;
use mpi::traits::*;

use super::Comm;
#[cfg(debug_assertions)]
use super::on_purpose;
use crate::error::Failure;

static PHASE: Mutex<&str> = Mutex::new("starting");

/// Names what this rank is doing, for the messages of failures and panics.
pub fn phase(name: &'static str) {
    *PHASE.lock().unwrap_or_else(PoisonError::into_inner) = name;
    #[cfg(debug_assertions)]
    on_purpose::end(name);
}

/// What this rank is doing.
pub(super) fn current_phase() -> &'static str {
    *PHASE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// MPI while it runs; it ends when this is dropped.
pub struct World {
    universe: Universe,
    hosts: usize,
}

impl World {
    /// All ranks.
    pub fn comm(&self) -> Comm {
        Comm {
            world: self.universe.world(),
            hosts: self.hosts,
            bytes_sent: Cell::new(0),
        }
    }
}

/// Starts MPI, and makes the panic of any rank the end of all. Collective.
///
/// A rank that is killed is the launcher's affair, which ends the others.
///
/// # Errors
/// MPI was started already, or the launcher belongs to another MPI than the program: then it
/// started n programs of one rank each.
pub fn start() -> Result<World, Failure> {
    let universe =
        mpi::initialize().ok_or_else(|| Failure::internal("MPI was initialized twice"))?;
    let world = universe.world();
    let (rank, size) = (world.rank(), world.size());
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let phase = current_phase();
        message::error(&format!("rank {rank} of {size} panicked while {phase}"));
        report(panic);
        SimpleCommunicator::world().abort(1);
    }));
    check_launcher(size)?;
    super::signal::listen()
        .map_err(|error| Failure::internal(format!("signals can't be listened to: {error}")))?;
    #[cfg(debug_assertions)]
    on_purpose::set_rank(rank);
    let host = world.split_shared(rank);
    let mut hosts = 0i32;
    world.all_reduce_into(
        &i32::from(host.rank() == 0),
        &mut hosts,
        SystemOperation::sum(),
    );
    phase("starting");
    Ok(World {
        universe,
        hosts: hosts as usize,
    })
}

/// The MPI library and its version, as it calls itself.
pub fn library() -> String {
    let said = mpi::environment::library_version().unwrap_or_default();
    // MPICH tells in further lines how it was configured.
    let name = said.lines().next().unwrap_or_default();
    // Open MPI counts the end of its string to it.
    let name = name.trim_end_matches('\0');
    name.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Where launchers tell a rank of how many it is.
const SIZES: [&str; 2] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"];

/// Whether a launcher started this process, be it as the only rank.
pub fn is_launched() -> bool {
    // PMIx, as of Slurm, tells the size only to who asks.
    let names = SIZES.iter().chain(&["PMIX_RANK", "PMI_RANK"]);
    names.copied().any(|name| std::env::var_os(name).is_some())
}

/// The launcher's own count of ranks must be MPI's.
fn check_launcher(size: i32) -> Result<(), Failure> {
    let number = |name: &str| std::env::var(name).ok()?.parse().ok();
    match launched(number) {
        Some((name, launched)) if launched != size => Err(Failure::input(format!(
            "the launcher started {launched} ranks ({name}), but MPI counts {size}: {}",
            match name {
                SRUN_RANKS =>
                    "srun doesn't know how this MPI's ranks find each other; expected \
                     srun --mpi=pmix with OpenMPI, --mpi=pmi2 with MPICH, or mpirun",
                _ => "mpirun belongs to another MPI than the one this program was built with",
            }
        ))),
        _ => Ok(()),
    }
}

/// What srun counts.
const SRUN_RANKS: &str = "SLURM_STEP_NUM_TASKS";

/// How many ranks the launcher started, and the variable in which it says so.
fn launched(number: impl Fn(&str) -> Option<i32>) -> Option<(&'static str, i32)> {
    // Where mpirun starts its daemons by srun, srun counts these.
    (SIZES.into_iter().chain([SRUN_RANKS])).find_map(|name| Some((name, number(name)?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srun_is_believed_where_no_launcher_of_mpi_counts() {
        let of = |given: &[(&str, i32)]| {
            launched(|name| {
                given
                    .iter()
                    .find(|(n, _)| *n == name)
                    .map(|(_, count)| *count)
            })
        };
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[(SRUN_RANKS, 4)]), Some((SRUN_RANKS, 4)));
        let daemons_of_two_nodes = [(SRUN_RANKS, 2), ("PMI_SIZE", 16)];
        assert_eq!(of(&daemons_of_two_nodes), Some(("PMI_SIZE", 16)));
    }
}
