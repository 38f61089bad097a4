//! Starting MPI, and what happens when a rank panics.

use std::cell::Cell;
use std::sync::{Mutex, PoisonError};

use mpi::environment::Universe;
use mpi::traits::*;

use super::Comm;
use crate::error::Failure;

static PHASE: Mutex<&str> = Mutex::new("starting");

/// Names what this rank is doing, for the message of a panic.
pub fn phase(name: &'static str) {
    *PHASE.lock().unwrap_or_else(PoisonError::into_inner) = name;
}

/// MPI while it runs; it ends when this is dropped.
pub struct World {
    universe: Universe,
}

impl World {
    /// All ranks.
    pub fn comm(&self) -> Comm {
        Comm {
            world: self.universe.world(),
            bytes_sent: Cell::new(0),
        }
    }
}

/// Starts MPI, and makes a panic of any rank end all of them.
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
        let phase = *PHASE.lock().unwrap_or_else(PoisonError::into_inner);
        eprintln!("error: rank {rank} of {size} panicked while {phase}");
        report(panic);
        universe_abort();
    }));
    check_launcher(size)?;
    super::signal::listen()
        .map_err(|error| Failure::internal(format!("signals can't be listened to: {error}")))?;
    Ok(World { universe })
}

fn universe_abort() {
    mpi::topology::SimpleCommunicator::world().abort(1);
}

/// The launcher's own count of ranks must be MPI's.
fn check_launcher(size: i32) -> Result<(), Failure> {
    for name in ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS"] {
        let launched = std::env::var(name).ok().and_then(|n| n.parse::<i32>().ok());
        if let Some(launched) = launched
            && launched != size
        {
            return Err(Failure::input(format!(
                "the launcher started {launched} ranks ({name}), but MPI counts {size}: mpirun \
                 belongs to another MPI than the one this program was built with"
            )));
        }
    }
    Ok(())
}
