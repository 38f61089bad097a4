//! Messages between ranks. The only importer of `mpi`.
//!
//! Ranks agree on errors at the end of every phase: nobody leaves between matching calls, so no
//! rank waits for one that is gone.

mod environment;
mod message;
#[cfg(debug_assertions)]
mod on_purpose;
mod signal;

use std::cell::Cell;

use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::*;

use environment::current_phase;
pub use environment::{World, is_launched, library, phase, start};
pub use message::{Message, MessageReader};
pub use signal::is_asked_to_stop;

use crate::error::{Failure, FailureKind};

/// The rank that assembles S_0 and writes the results.
pub const ROOT: usize = 0;

/// Most elements in one piece of a message; MPI counts with 32 bits.
const PIECE: usize = 1 << 27;

/// All ranks of a run.
pub struct Comm {
    world: SimpleCommunicator,
    hosts: usize,
    bytes_sent: Cell<u64>,
}

impl Comm {
    /// This rank.
    pub fn rank(&self) -> usize {
        self.world.rank() as usize
    }

    /// Number of ranks.
    pub fn size(&self) -> usize {
        self.world.size() as usize
    }

    /// The name of the host that this rank is on.
    pub fn host_name(&self) -> String {
        mpi::environment::processor_name().unwrap_or_default()
    }

    /// Whether this rank is the root.
    pub fn is_root(&self) -> bool {
        self.rank() == ROOT
    }

    /// Number of hosts that they run on.
    pub fn hosts(&self) -> usize {
        self.hosts
    }

    /// Makes the failure of the lowest failing rank the result of all. Collective.
    ///
    /// Where others have no failure its message ends with the rank and the phase.
    ///
    /// # Errors
    /// The failure that the ranks agreed on.
    pub fn agree<T>(&self, result: Result<T, Failure>) -> Result<T, Failure> {
        #[cfg(debug_assertions)]
        let result = on_purpose::failure().map_or(result, Err);
        let mine = match &result {
            Ok(_) => self.size() as i32,
            Err(_) => self.rank() as i32,
        };
        let mut lowest = 0i32;
        self.world
            .all_reduce_into(&mine, &mut lowest, SystemOperation::min());
        if lowest as usize == self.size() {
            return result;
        }
        let mut failed = 0i32;
        self.world.all_reduce_into(
            &i32::from(result.is_err()),
            &mut failed,
            SystemOperation::sum(),
        );
        let mut message = match &result {
            Err(failure) if self.rank() == lowest as usize => Message::of_failure(failure),
            _ => Message::default(),
        };
        self.broadcast_from(lowest as usize, &mut message);
        let mut failure = message.into_failure();
        if (failed as usize) < self.size() {
            let place = format!(" (rank {lowest} of {}, {})", self.size(), current_phase());
            failure.message += &place;
        }
        Err(failure)
    }

    /// Whether any rank was asked to stop. Collective.
    pub fn is_any_asked_to_stop(&self) -> bool {
        let mine = i32::from(is_asked_to_stop());
        let mut any = 0i32;
        self.world
            .all_reduce_into(&mine, &mut any, SystemOperation::max());
        any != 0
    }

    /// The root's `decision`, on all ranks. Collective.
    pub fn decide(&self, decision: bool) -> bool {
        let mut message = Message {
            integers: vec![i64::from(decision)],
            reals: Vec::new(),
        };
        self.broadcast(&mut message);
        message.read().integer() != 0
    }

    /// Gives all ranks the root's message. Collective.
    pub fn broadcast(&self, message: &mut Message) {
        self.broadcast_from(ROOT, message);
    }

    fn broadcast_from(&self, from: usize, message: &mut Message) {
        if from == self.rank() && self.size() > 1 {
            self.count(message);
        }
        let process = self.world.process_at_rank(from as i32);
        let mut lengths = [message.integers.len() as u64, message.reals.len() as u64];
        process.broadcast_into(&mut lengths);
        message.integers.resize(lengths[0] as usize, 0);
        message.reals.resize(lengths[1] as usize, 0.0);
        for piece in message.integers.chunks_mut(PIECE) {
            process.broadcast_into(piece);
        }
        for piece in message.reals.chunks_mut(PIECE) {
            process.broadcast_into(piece);
        }
    }

    /// What this rank has sent to others, broadcasts counted once (bytes).
    pub fn bytes_sent(&self) -> u64 {
        self.bytes_sent.get()
    }

    fn count(&self, message: &Message) {
        let numbers = message.integers.len() + message.reals.len();
        let bytes = 8 * numbers as u64;
        self.bytes_sent.set(self.bytes_sent.get() + bytes);
    }

    /// Sends a message to another rank, which receives it from this one.
    pub fn send(&self, to: usize, message: &Message) {
        self.count(message);
        let process = self.world.process_at_rank(to as i32);
        let lengths = [message.integers.len() as u64, message.reals.len() as u64];
        process.send(&lengths);
        for piece in message.integers.chunks(PIECE) {
            process.send(piece);
        }
        for piece in message.reals.chunks(PIECE) {
            process.send(piece);
        }
    }

    /// Receives the next message of another rank.
    pub fn receive(&self, from: usize) -> Message {
        let process = self.world.process_at_rank(from as i32);
        let mut lengths = [0u64; 2];
        process.receive_into(&mut lengths);
        let mut message = Message {
            integers: vec![0; lengths[0] as usize],
            reals: vec![0.0; lengths[1] as usize],
        };
        for piece in message.integers.chunks_mut(PIECE) {
            process.receive_into(piece);
        }
        for piece in message.reals.chunks_mut(PIECE) {
            process.receive_into(piece);
        }
        message
    }

    /// Brings one message for each of `owners` to the root, in their order whoever owns what.
    /// Collective.
    ///
    /// `make(i)` is called on the owner of `i`, `take(i, message)` on the root.
    pub fn gather(
        &self,
        owners: &[usize],
        make: impl FnMut(usize) -> Message,
        take: impl FnMut(usize, Message),
    ) {
        self.route(owners.iter().map(|&owner| (owner, ROOT)), make, take);
    }

    /// Brings one message of the root to each of `owners`, in their order. Collective.
    ///
    /// `make(i)` is called on the root, `take(i, message)` on the owner of `i`.
    pub fn scatter(
        &self,
        owners: &[usize],
        make: impl FnMut(usize) -> Message,
        take: impl FnMut(usize, Message),
    ) {
        self.route(owners.iter().map(|&owner| (ROOT, owner)), make, take);
    }

    /// Brings a message along each of `ways`, from one rank to another, in their order. Collective.
    ///
    /// `make(i)` is called where way `i` begins, `take(i, message)` where it ends.
    pub fn route(
        &self,
        ways: impl IntoIterator<Item = (usize, usize)>,
        mut make: impl FnMut(usize) -> Message,
        mut take: impl FnMut(usize, Message),
    ) {
        for (i, (from, to)) in ways.into_iter().enumerate() {
            match (from == self.rank(), to == self.rank()) {
                (true, true) => take(i, make(i)),
                (true, false) => self.send(to, &make(i)),
                (false, true) => take(i, self.receive(from)),
                (false, false) => {}
            }
        }
    }

    /// Brings a message of every rank to the root, which gets them in the order of ranks; the
    /// others get nothing. Collective.
    pub fn collect(&self, message: Message) -> Vec<Message> {
        let mut all = Vec::new();
        let mut mine = Some(message);
        let ranks: Vec<usize> = (0..self.size()).collect();
        self.gather(
            &ranks,
            |_| mine.take().unwrap_or_default(),
            |_, message| all.push(message),
        );
        all
    }
}

impl Message {
    fn of_failure(failure: &Failure) -> Self {
        let mut integers = vec![failure.kind as i64];
        integers.extend(failure.message.bytes().map(i64::from));
        Self {
            integers,
            reals: Vec::new(),
        }
    }

    fn into_failure(self) -> Failure {
        let bytes: Vec<u8> = self.integers.iter().skip(1).map(|&b| b as u8).collect();
        Failure {
            kind: FailureKind::from_code(self.integers.first().copied().unwrap_or(1)),
            message: String::from_utf8_lossy(&bytes).into_owned(),
        }
    }
}
