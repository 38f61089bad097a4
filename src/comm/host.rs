//! The ranks of one host.

use std::os::unix::fs::MetadataExt;
use std::{fs, process};

use mpi::topology::SimpleCommunicator;
use mpi::traits::*;

use super::board::Board;
use super::watcher::{self, Watched};

/// This rank among those of its host, all of which are watched.
#[derive(Debug)]
pub struct Host {
    board: Board,
    place: usize,
}

impl Host {
    /// Has the ranks of `ranks`, all of one host, watched; this one is `rank` of `size`. Collective.
    ///
    /// `None` on all of them where the system lacks what it takes.
    pub fn watched(ranks: &SimpleCommunicator, rank: i32, size: i32) -> Option<Self> {
        let place = ranks.rank() as usize;
        let own = (place == 0).then(Board::new).and_then(Result::ok);
        let mine = [
            process::id().into(),
            rank.into(),
            process_space().map_or(-1, |space| space as i64),
            own.as_ref().map_or(-1, Board::descriptor),
        ];
        let mut all = vec![0i64; mine.len() * ranks.size() as usize];
        ranks.all_gather_into(&mine, &mut all);
        let all = all.as_chunks::<4>().0;
        let [maker, _, space, descriptor] = all[0];
        // The number of a process means the same to all only if they are in one name space.
        let comparable = space != -1 && descriptor != -1 && all.iter().all(|rank| rank[2] == space);
        let board = match own {
            _ if !comparable => None,
            Some(board) => {
                let list = all
                    .iter()
                    .map(|&[process, rank, ..]| Watched { process, rank });
                let started = watcher::start(&board, &list.collect::<Vec<_>>(), size as usize);
                started.ok().map(|()| board)
            }
            None => Board::of(maker, descriptor).ok(),
        };
        let mut everywhere = vec![false; all.len()];
        ranks.all_gather_into(&board.is_some(), &mut everywhere);
        let everywhere = everywhere.into_iter().all(|shared| shared);
        board
            .filter(|_| everywhere)
            .map(|board| Self { board, place })
    }

    /// Notes what this rank is doing.
    pub fn note(&self, phase: &str) {
        self.board.write(self.place, phase);
    }

    /// Notes that this rank has nothing to do with the run any more.
    pub fn leave(&self) {
        self.note("");
    }

    /// Whether this rank is the one of its host that reports how the run ended.
    pub fn claim_message(&self) -> bool {
        self.board.claim_message()
    }
}

/// Which name space the numbers of processes are of; `None` where /proc is of another one.
fn process_space() -> Option<u64> {
    let own = fs::read_link("/proc/self").ok()?;
    if own.to_str()? != process::id().to_string() {
        return None;
    }
    Some(fs::metadata("/proc/self/ns/pid").ok()?.ino())
}
