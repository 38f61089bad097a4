//! Messages between ranks; the only module that uses `mpi`.
//!
//! Ranks agree on errors at the end of every phase. No rank returns between two matching calls, so that none waits
//! forever for a message.

pub mod clock;
pub mod collectives;
mod launcher;
#[cfg(debug_assertions)]
mod on_purpose;
pub mod owners;
mod phase;
pub mod ranks;
mod signals;
mod start;

use std::cell::Cell;

use mpi::collective::SystemOperation;
use mpi::topology::{Process, SimpleCommunicator};
use mpi::traits::*;
use rustix::system::uname;
use serde::Serialize;
use serde::de::DeserializeOwned;

use clock::{Clock, Stamp, Times};
pub use launcher::{is_first, is_launched};
use phase::current_phase;
pub use phase::phase;
pub use signals::is_asked_to_stop;
pub use start::{World, library, start};

use crate::error::Failure;

/// The rank that assembles S_0 and writes the results.
pub const ROOT: usize = 0;

/// Most bytes in one piece of a message, as MPI counts in 32 bits.
const PIECE: usize = 1 << 30;

/// The name of this process's host.
pub fn host_name() -> String {
    uname().nodename().to_string_lossy().into_owned()
}

/// All ranks of a run.
pub struct Comm {
    rank: usize,
    size: usize,
    hosts: usize,
    /// MPI's communicator; `None` for a single rank that runs without MPI.
    world: Option<SimpleCommunicator>,
    bytes_sent: Cell<u64>,
    messages_sent: Cell<u64>,
    clock: Clock,
}

impl Comm {
    /// Number of this rank.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Number of ranks.
    pub fn size(&self) -> usize {
        self.size
    }

    /// True if this rank is the root.
    pub fn is_root(&self) -> bool {
        self.rank() == ROOT
    }

    /// True if messages go through MPI; a single rank needs none.
    pub fn has_mpi(&self) -> bool {
        self.world.is_some()
    }

    /// Number of hosts that the ranks run on.
    pub fn hosts(&self) -> usize {
        self.hosts
    }

    /// Turns the failure of any rank into that of all. Collective.
    ///
    /// Where several ranks fail, the failure of the lowest one counts; its message ends with the rank and the phase if
    /// other ranks haven't failed.
    ///
    /// # Errors
    /// The failure of the lowest failing rank.
    pub fn agree<T>(&self, result: Result<T, Failure>) -> Result<T, Failure> {
        #[cfg(debug_assertions)]
        let result = on_purpose::failure(current_phase()).map_or(result, Err);
        let mine = match &result {
            Ok(_) => self.size() as i32,
            Err(_) => self.rank() as i32,
        };
        let lowest = self.all_reduce(mine, SystemOperation::min());
        if lowest as usize == self.size() {
            return result;
        }
        let failed = self.all_reduce(i32::from(result.is_err()), SystemOperation::sum());
        let mut failure = match result {
            Err(failure) => failure,
            Ok(_) => Failure::default(),
        };
        self.broadcast_from(lowest as usize, &mut failure);
        if (failed as usize) < self.size() {
            let place = format!(" (rank {lowest} of {}, {})", self.size(), current_phase());
            failure.message += &place;
        }
        Err(failure)
    }

    /// True if any rank received a signal to stop. Collective.
    pub fn is_any_asked_to_stop(&self) -> bool {
        self.is_any(is_asked_to_stop())
    }

    /// True if `mine` is true on any rank. Collective.
    pub fn is_any(&self, mine: bool) -> bool {
        self.all_reduce(i32::from(mine), SystemOperation::max()) != 0
    }

    /// The least, the largest or the sum of `mine` over all ranks. Collective.
    fn all_reduce(&self, mine: i32, by: SystemOperation) -> i32 {
        let mut all = mine;
        if let Some(world) = &self.world {
            let Stamp { modelled, chain } = self.clock.pause();
            let mut latest = [0.0; 2];
            world.all_reduce_into(&mine, &mut all, by);
            world.all_reduce_into(
                &[modelled, chain][..],
                &mut latest[..],
                SystemOperation::max(),
            );
            let [modelled, chain] = latest;
            self.clock
                .resume_all(Stamp { modelled, chain }, self.hops());
        }
        all
    }

    /// Number of consecutive messages in a broadcast, or in a reduction over all ranks.
    fn hops(&self) -> u32 {
        self.size.next_power_of_two().trailing_zeros()
    }

    /// MPI's handle of a rank, to send to or to receive from.
    #[expect(clippy::expect_used, reason = "a single rank sends itself nothing")]
    fn process(&self, rank: usize) -> Process<'_> {
        let world = self.world.as_ref();
        world.expect("MPI runs").process_at_rank(rank as i32)
    }

    /// The root's `decision`, on all ranks. Collective.
    pub fn decide(&self, mut decision: bool) -> bool {
        self.broadcast(&mut decision);
        decision
    }

    /// Sends the root's `value` to all ranks. Collective.
    pub fn broadcast<T: Serialize + DeserializeOwned>(&self, value: &mut T) {
        self.broadcast_from(ROOT, value);
    }

    fn broadcast_from<T: Serialize + DeserializeOwned>(&self, from: usize, value: &mut T) {
        if self.size() == 1 {
            return;
        }
        let is_mine = from == self.rank();
        let mut bytes = match is_mine {
            true => self.encode(value),
            false => Vec::new(),
        };
        let process = self.process(from);
        let mut head = Head::new(bytes.len(), self.clock.pause());
        process.broadcast_into(&mut head.0);
        bytes.resize(head.length(), 0);
        for piece in bytes.chunks_mut(PIECE) {
            process.broadcast_into(piece);
        }
        match is_mine {
            true => self.clock.resume_sender(bytes.len(), self.hops()),
            false => (self.clock).resume_receiver(head.sent(), bytes.len(), self.hops()),
        }
        if !is_mine {
            *value = self.decode(from, &bytes);
        }
    }

    /// Bytes that this rank has sent to others, broadcasts counted once.
    pub fn bytes_sent(&self) -> u64 {
        self.bytes_sent.get()
    }

    /// Number of messages that this rank has sent, broadcasts counted once.
    pub fn messages_sent(&self) -> u64 {
        self.messages_sent.get()
    }

    /// Length of the longest chain of messages up to now, each sent after the one before it had arrived.
    pub fn longest_chain(&self) -> u64 {
        self.clock.chain()
    }

    /// Time that this rank has spent, by kind.
    pub fn times(&self) -> Times {
        self.clock.times()
    }

    fn encode<T: Serialize>(&self, value: &T) -> Vec<u8> {
        match postcard::to_stdvec(value) {
            Ok(bytes) => {
                let sent = self.bytes_sent.get() + bytes.len() as u64;
                self.bytes_sent.set(sent);
                self.messages_sent.set(self.messages_sent.get() + 1);
                bytes
            }
            Err(why) => self.give_up("can't be sent", &why),
        }
    }

    fn decode<T: DeserializeOwned>(&self, from: usize, bytes: &[u8]) -> T {
        read(bytes)
            .unwrap_or_else(|why| self.give_up(&format!("of rank {from} can't be read"), &why))
    }

    /// Aborts at a malformed message: the other ranks wait for the rest of it, so that no error could be agreed on.
    #[expect(clippy::panic, reason = "both ends are the same program")]
    fn give_up(&self, what: &str, why: &postcard::Error) -> ! {
        panic!("a message {what}: {why}");
    }

    /// Sends a value to another rank, which receives it from this one.
    pub fn send<T: Serialize>(&self, to: usize, value: &T) {
        let bytes = self.encode(value);
        let process = self.process(to);
        process.send(&Head::new(bytes.len(), self.clock.pause()).0);
        for piece in bytes.chunks(PIECE) {
            process.send(piece);
        }
        self.clock.resume_sender(bytes.len(), 1);
    }

    /// Receives the next value of another rank.
    pub fn receive<T: DeserializeOwned>(&self, from: usize) -> T {
        let process = self.process(from);
        self.clock.pause();
        let mut head = Head::default();
        process.receive_into(&mut head.0);
        let mut bytes = vec![0; head.length()];
        for piece in bytes.chunks_mut(PIECE) {
            process.receive_into(piece);
        }
        self.clock.resume_receiver(head.sent(), bytes.len(), 1);
        self.decode(from, &bytes)
    }
}

/// Header of a message: its length, and the sender's clock.
#[derive(Clone, Copy, Debug, Default)]
struct Head([u64; 3]);

impl Head {
    fn new(length: usize, sent: Stamp) -> Self {
        Self([length as u64, sent.modelled.to_bits(), sent.chain.to_bits()])
    }

    fn length(self) -> usize {
        self.0[0] as usize
    }

    fn sent(self) -> Stamp {
        let [modelled, chain] = [self.0[1], self.0[2]].map(f64::from_bits);
        Stamp { modelled, chain }
    }
}

/// The value encoded by `bytes`, all of them, in postcard's format.
fn read<T: DeserializeOwned>(bytes: &[u8]) -> postcard::Result<T> {
    match postcard::take_from_bytes(bytes)? {
        (value, []) => Ok(value),
        _ => Err(postcard::Error::DeserializeBadEncoding),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_short_or_too_long_is_an_error() {
        let sent = (7usize, vec![1.5, -0.0], String::from("a name"));
        let bytes = postcard::to_stdvec(&sent).unwrap();
        assert_eq!(read::<(usize, Vec<f64>, String)>(&bytes).unwrap(), sent);
        for length in 0..bytes.len() {
            assert!(read::<(usize, Vec<f64>, String)>(&bytes[..length]).is_err());
        }
        let longer = [&bytes[..], &[0]].concat();
        assert!(read::<(usize, Vec<f64>, String)>(&longer).is_err());
    }
}
