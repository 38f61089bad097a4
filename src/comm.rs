//! Messages between ranks. The only importer of `mpi`.
//!
//! Ranks agree on errors at the end of every phase: nobody leaves between matching calls, so no
//! rank waits for one that is gone.

mod launcher;
#[cfg(debug_assertions)]
mod on_purpose;
mod start;

use std::cell::Cell;
use std::collections::BTreeMap;

use mpi::collective::SystemOperation;
use mpi::topology::{Process, SimpleCommunicator};
use mpi::traits::*;
use rustix::system::uname;
use serde::Serialize;
use serde::de::DeserializeOwned;

pub use launcher::{is_first, is_launched};
use start::current_phase;
pub use start::{World, is_asked_to_stop, library, phase, start};

use crate::bytes::Reals;
use crate::error::Failure;

/// The rank that assembles S_0 and writes the results.
pub const ROOT: usize = 0;

/// Most bytes in one piece of a message; MPI counts with 32 bits.
const PIECE: usize = 1 << 30;

/// All ranks of a run.
pub struct Comm {
    rank: usize,
    size: usize,
    hosts: usize,
    /// `None` for a single rank that runs without MPI.
    world: Option<SimpleCommunicator>,
    bytes_sent: Cell<u64>,
}

impl Comm {
    /// This rank.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Number of ranks.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The name of the host that this rank is on.
    pub fn host_name(&self) -> String {
        uname().nodename().to_string_lossy().into_owned()
    }

    /// Whether this rank is the root.
    pub fn is_root(&self) -> bool {
        self.rank() == ROOT
    }

    /// Whether messages go through MPI, which a single rank doesn't need.
    pub fn has_mpi(&self) -> bool {
        self.world.is_some()
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

    /// Whether any rank was asked to stop. Collective.
    pub fn is_any_asked_to_stop(&self) -> bool {
        let mine = i32::from(is_asked_to_stop());
        self.all_reduce(mine, SystemOperation::max()) != 0
    }

    /// The least, the largest or the sum of `mine` over all ranks. Collective.
    fn all_reduce(&self, mine: i32, by: SystemOperation) -> i32 {
        let mut all = mine;
        if let Some(world) = &self.world {
            world.all_reduce_into(&mine, &mut all, by);
        }
        all
    }

    /// A rank to send to or to receive from.
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

    /// Gives all ranks the root's `value`. Collective.
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
        let mut length = bytes.len() as u64;
        process.broadcast_into(&mut length);
        bytes.resize(length as usize, 0);
        for piece in bytes.chunks_mut(PIECE) {
            process.broadcast_into(piece);
        }
        if !is_mine {
            *value = self.decode(from, &bytes);
        }
    }

    /// What this rank has sent to others, broadcasts counted once (bytes).
    pub fn bytes_sent(&self) -> u64 {
        self.bytes_sent.get()
    }

    fn encode<T: Serialize>(&self, value: &T) -> Vec<u8> {
        match postcard::to_stdvec(value) {
            Ok(bytes) => {
                let sent = self.bytes_sent.get() + bytes.len() as u64;
                self.bytes_sent.set(sent);
                bytes
            }
            Err(why) => self.give_up("can't be sent", &why),
        }
    }

    fn decode<T: DeserializeOwned>(&self, from: usize, bytes: &[u8]) -> T {
        read(bytes)
            .unwrap_or_else(|why| self.give_up(&format!("of rank {from} can't be read"), &why))
    }

    /// The other ranks wait for what can't be had: no error could be agreed on.
    #[expect(clippy::panic, reason = "both ends are the same program")]
    fn give_up(&self, what: &str, why: &postcard::Error) -> ! {
        panic!("a message {what}: {why}");
    }

    /// Sends a value to another rank, which receives it from this one.
    pub fn send<T: Serialize>(&self, to: usize, value: &T) {
        let bytes = self.encode(value);
        let process = self.process(to);
        process.send(&(bytes.len() as u64));
        for piece in bytes.chunks(PIECE) {
            process.send(piece);
        }
    }

    /// Receives the next value of another rank.
    pub fn receive<T: DeserializeOwned>(&self, from: usize) -> T {
        let process = self.process(from);
        let mut length = 0u64;
        process.receive_into(&mut length);
        let mut bytes = vec![0; length as usize];
        for piece in bytes.chunks_mut(PIECE) {
            process.receive_into(piece);
        }
        self.decode(from, &bytes)
    }

    /// Brings one value for each of `owners` to the root, in their order whoever owns what.
    /// Collective.
    ///
    /// `make(i)` is called on the owner of `i`, `take(i, value)` on the root.
    pub fn gather<T: Serialize + DeserializeOwned>(
        &self,
        owners: &[usize],
        make: impl FnMut(usize) -> T,
        take: impl FnMut(usize, T),
    ) {
        self.route(owners.iter().map(|&owner| (owner, ROOT)), make, take);
    }

    /// Brings one value of the root to each of `owners`, in their order. Collective.
    ///
    /// `make(i)` is called on the root, `take(i, value)` on the owner of `i`.
    pub fn scatter<T: Serialize + DeserializeOwned>(
        &self,
        owners: &[usize],
        make: impl FnMut(usize) -> T,
        take: impl FnMut(usize, T),
    ) {
        self.route(owners.iter().map(|&owner| (ROOT, owner)), make, take);
    }

    /// Brings a value along each of `ways`, from one rank to another, in their order. Collective.
    ///
    /// `make(i)` is called where way `i` begins, `take(i, value)` where it ends.
    pub fn route<T: Serialize + DeserializeOwned>(
        &self,
        ways: impl IntoIterator<Item = (usize, usize)>,
        mut make: impl FnMut(usize) -> T,
        mut take: impl FnMut(usize, T),
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

    /// Brings a list along each of `ways`, from one rank to another, all between two ranks in one message; returns those
    /// that end here, by the number of their way. Collective.
    ///
    /// `make(i)` is called where way `i` begins.
    pub fn route_lists(
        &self,
        ways: &[(usize, usize)],
        mut make: impl FnMut(usize) -> Vec<f64>,
    ) -> BTreeMap<usize, Vec<f64>> {
        let mut bundles: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
        for (i, &way) in ways.iter().enumerate() {
            bundles.entry(way).or_default().push(i);
        }
        let bundles: Vec<_> = bundles.into_iter().collect();
        let mut arrived = BTreeMap::new();
        self.route(
            bundles.iter().map(|(way, _)| *way),
            |b| -> Vec<Reals> { bundles[b].1.iter().map(|&i| Reals(make(i))).collect() },
            |b, lists| arrived.extend(bundles[b].1.iter().copied().zip(lists)),
        );
        let lists = arrived.into_iter().map(|(i, Reals(list))| (i, list));
        lists.collect()
    }

    /// Brings the value of every rank to the root, which gets them in the order of ranks; the
    /// others get nothing. Collective.
    pub fn collect<T: Serialize + DeserializeOwned + Clone>(&self, value: &T) -> Vec<T> {
        let mut all = Vec::new();
        let ranks: Vec<usize> = (0..self.size()).collect();
        self.gather(&ranks, |_| value.clone(), |_, value| all.push(value));
        all
    }
}

/// The value that `bytes` stand for, all of them, in the encoding of postcard.
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
