//! The ranks of one host.

use std::fs::{self, File};
use std::io::{self, PipeReader, PipeWriter};
use std::os::fd::AsRawFd;
use std::os::unix::fs::MetadataExt;
use std::process;

use mpi::topology::SimpleCommunicator;
use mpi::traits::*;

use super::board::Board;
use super::watcher::{self, Watched};

/// This rank among those of its host, all of which are watched.
#[derive(Debug)]
pub struct Host {
    board: Board,
    place: usize,
    /// The watcher has the other end: it hears when this one is closed, be it by the system.
    _line: File,
}

impl Host {
    /// Has the ranks of `ranks`, all of one host, watched; this one is `rank` of `size`. Collective.
    ///
    /// `None` on all of them where the system lacks what it takes.
    pub fn watched(ranks: &SimpleCommunicator, rank: i32, size: i32) -> Option<Self> {
        let (place, count) = (ranks.rank() as usize, ranks.size() as usize);
        let made = (place == 0).then(|| Made::new(count)).and_then(Result::ok);
        let mine = [
            process::id().into(),
            rank.into(),
            process_space().map_or(-1, |space| space as i64),
            made.as_ref().map_or(-1, |made| made.board.descriptor()),
        ];
        let mut all = vec![0i64; mine.len() * count];
        ranks.all_gather_into(&mine, &mut all);
        let all = all.as_chunks::<4>().0;
        let mut lines = vec![-1i64; count];
        if let Some(made) = &made {
            let ends = made.lines.iter().map(|(_, end)| end.as_raw_fd().into());
            lines = ends.collect();
        }
        ranks.process_at_rank(0).broadcast_into(&mut lines);
        let [maker, _, space, descriptor] = all[0];
        // The number of a process means the same to all only if they are in one name space.
        let comparable = space != -1 && descriptor != -1 && all.iter().all(|rank| rank[2] == space);
        let host = || {
            if let Some(made) = &made {
                made.start_watcher(all, size as usize)?;
            }
            let line = format!("/proc/{maker}/fd/{}", lines[place]);
            io::Result::Ok(Self {
                board: Board::of(maker, descriptor)?,
                place,
                _line: File::options().write(true).open(line)?,
            })
        };
        let host = comparable.then(host).and_then(Result::ok);
        let mut everywhere = vec![false; count];
        ranks.all_gather_into(&host.is_some(), &mut everywhere);
        // By now all have opened what the first one made.
        drop(made);
        host.filter(|_| everywhere.into_iter().all(|watched| watched))
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

/// What the first rank of a host makes for all of them.
struct Made {
    board: Board,
    lines: Vec<(PipeReader, PipeWriter)>,
}

impl Made {
    fn new(count: usize) -> io::Result<Self> {
        Ok(Self {
            board: Board::new()?,
            lines: (0..count).map(|_| io::pipe()).collect::<io::Result<_>>()?,
        })
    }

    fn start_watcher(&self, all: &[[i64; 4]], size: usize) -> io::Result<()> {
        let watched = all.iter().zip(&self.lines);
        let watched = watched.map(|(&[process, rank, ..], (end, _))| Watched {
            process,
            rank,
            line: end.as_raw_fd(),
        });
        watcher::start(&self.board, &watched.collect::<Vec<_>>(), size)
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
