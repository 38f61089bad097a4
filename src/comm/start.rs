//! Start of MPI if there are several ranks, and the handling of panics.

use std::cell::Cell;
use std::{panic, process};

use contact_dd_partition::message;
use mpi::collective::SystemOperation;
use mpi::environment::Universe;
use mpi::topology::SimpleCommunicator;
use mpi::traits::*;

#[cfg(debug_assertions)]
use super::on_purpose;
use super::phase::{current_phase, phase};
use super::signals::listen;
use super::{Clock, Comm, launcher};
use crate::error::Failure;

/// All ranks, and MPI if there are several; MPI ends when this is dropped.
pub struct World {
    /// MPI, until it is dropped; `None` for a single rank, which sends no messages.
    universe: Option<Universe>,
    hosts: usize,
}

impl World {
    /// All ranks.
    pub fn comm(&self) -> Comm {
        let world = self.universe.as_ref().map(Universe::world);
        Comm {
            rank: world.as_ref().map_or(0, |world| world.rank() as usize),
            size: world.as_ref().map_or(1, |world| world.size() as usize),
            hosts: self.hosts,
            world,
            bytes_sent: Cell::new(0),
            messages_sent: Cell::new(0),
            clock: Clock::start(),
        }
    }
}

/// Starts MPI unless the environment shows that this rank is the only one, and makes a panic on any rank end all of
/// them. Collective.
///
/// If a rank is killed, the launcher ends the others.
///
/// # Errors
/// MPI was started already, or the launcher belongs to another MPI than the program, and has started n programs of one
/// rank each.
pub fn start() -> Result<World, Failure> {
    let universe = match launcher::is_one_of_several() {
        true => {
            let twice = || Failure::internal("MPI was initialized twice");
            Some(mpi::initialize().ok_or_else(twice)?)
        }
        false => None,
    };
    let mut world = World { universe, hosts: 1 };
    let comm = world.comm();
    end_all_at_a_panic(&comm);
    launcher::check(comm.size)?;
    listen().map_err(|error| {
        Failure::internal(format!("signal handlers can't be installed: {error}"))
    })?;
    #[cfg(debug_assertions)]
    on_purpose::set_rank(comm.rank);
    if let Some(ranks) = &comm.world {
        let is_first_of_host = ranks.split_shared(ranks.rank()).rank() == 0;
        let hosts = comm.all_reduce(i32::from(is_first_of_host), SystemOperation::sum());
        world.hosts = hosts as usize;
    }
    phase("starting");
    Ok(world)
}

/// Installs a panic hook that names the rank and its phase, and ends all ranks.
fn end_all_at_a_panic(comm: &Comm) {
    let (rank, size, has_mpi) = (comm.rank, comm.size, comm.has_mpi());
    let report = panic::take_hook();
    panic::set_hook(Box::new(move |panic| {
        let phase = current_phase();
        message::error(&format!("rank {rank} of {size} panicked while {phase}"));
        report(panic);
        match has_mpi {
            true => SimpleCommunicator::world().abort(1),
            false => process::exit(1),
        }
    }));
}

/// Name and version of the MPI library, as it reports them.
pub fn library() -> String {
    let version = mpi::environment::library_version().unwrap_or_default();
    // MPICH reports its configuration in further lines.
    let name = version.lines().next().unwrap_or_default();
    // Open MPI includes the terminating zero.
    let name = name.trim_end_matches('\0');
    name.split_whitespace().collect::<Vec<_>>().join(" ")
}
