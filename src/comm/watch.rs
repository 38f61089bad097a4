//! Ranks of a host watch one another: one that is killed can't say so itself.
//!
//! Every rank notes on a board in shared memory what it is doing. Each watches the next one, the last
//! the first; when that is gone before it has left, its watcher reads from the board what it was
//! doing, and says so. The launcher ends the others; where it doesn't, the watcher does.

use std::fs::{self, File};
use std::io::{Write, stderr};
use std::os::fd::{AsRawFd, OwnedFd};
use std::os::unix::fs::{FileExt, MetadataExt};
use std::process;
use std::thread;
use std::time::Duration;

use mpi::topology::SimpleCommunicator;
use mpi::traits::*;
use rustix::event::{PollFd, PollFlags, poll};
use rustix::fs::{MemfdFlags, memfd_create};
use rustix::process::{Pid, PidfdFlags, pidfd_open};

use super::environment::abort_all;

/// Bytes of an entry of the board.
const ENTRY: usize = 128;

/// How long the launcher has to end the ranks that are left.
const GRACE: Duration = Duration::from_secs(3);

/// What the ranks of a host are doing.
///
/// First a byte that tells whether the end of a rank was reported, then an entry for each rank: its
/// phase, filled up with zeros, and nothing else where the rank has left.
pub struct Board {
    file: File,
    /// Entry of this rank.
    place: usize,
    next: Next,
}

/// The rank that this one watches.
struct Next {
    place: usize,
    rank: i64,
    process: OwnedFd,
}

impl Board {
    /// The board of the ranks of `host`, to which this one belongs as `rank`. Collective.
    ///
    /// `None` on all of them where there is but one, or where the system lacks what it takes.
    pub fn share(host: &SimpleCommunicator, rank: i32) -> Option<Self> {
        let (place, count) = (host.rank() as usize, host.size() as usize);
        if count == 1 {
            return None;
        }
        let own = (place == 0).then(|| memfd_create("ranks", MemfdFlags::CLOEXEC));
        let own = own.and_then(Result::ok).map(File::from);
        let mine = [
            process::id().into(),
            process_space().map_or(-1, |space| space as i64),
            own.as_ref().map_or(-1, |file| file.as_raw_fd().into()),
            rank.into(),
        ];
        let mut all = vec![0i64; mine.len() * count];
        host.all_gather_into(&mine, &mut all);
        let all = all.as_chunks::<4>().0;
        let [maker, space, descriptor, _] = all[0];
        // The number of a process means the same to all only if they are in one name space.
        let comparable = space != -1 && descriptor != -1 && all.iter().all(|rank| rank[1] == space);
        let board = comparable.then(|| {
            let path = format!("/proc/{maker}/fd/{descriptor}");
            let file = own.or_else(|| File::options().read(true).write(true).open(path).ok())?;
            let place_of_next = (place + 1) % count;
            let [next, _, _, rank] = all[place_of_next];
            let process = Pid::from_raw(i32::try_from(next).ok()?)?;
            let next = Next {
                place: place_of_next,
                rank,
                process: pidfd_open(process, PidfdFlags::empty()).ok()?,
            };
            Some(Self { file, place, next })
        });
        let board = board.flatten();
        let mut shared = vec![false; count];
        host.all_gather_into(&board.is_some(), &mut shared);
        board.filter(|_| shared.iter().all(|&shared| shared))
    }

    /// Notes what this rank is doing.
    pub fn write(&self, phase: &str) {
        let mut entry = [0; ENTRY];
        let bytes = phase.as_bytes();
        let length = bytes.len().min(ENTRY);
        entry[..length].copy_from_slice(&bytes[..length]);
        // A board in memory that can't be written is out of memory, which comes out otherwise.
        let _ = self.file.write_all_at(&entry, offset(self.place));
    }

    /// Notes that this rank has nothing to do with the run any more.
    pub fn leave(&self) {
        self.write("");
    }

    /// Whether this rank is the one of its host that reports how the run ended.
    pub fn claim_message(&self) -> bool {
        let mut claimed = [0];
        // Without a lock there may be two messages, which is better than none.
        let locked = self.file.lock();
        let first = self.file.read_exact_at(&mut claimed, 0).is_err() || claimed == [0];
        let _ = self.file.write_all_at(&[1], 0);
        if locked.is_ok() {
            let _ = self.file.unlock();
        }
        first
    }

    /// Watches the next rank in a thread of its own, as long as this process lives.
    pub fn watch(&'static self, size: i32) {
        let watcher = move || {
            self.wait_for_next();
            let phase = self.phase_of_next();
            if phase.is_empty() {
                return;
            }
            if self.claim_message() {
                let message = format!(
                    "error: rank {} of {size} ended unexpectedly while {phase}: killed, crashed or \
                     out of memory\n",
                    self.next.rank
                );
                // In one piece: the launcher may be speaking, too.
                let _ = stderr().write_all(message.as_bytes());
            }
            thread::sleep(GRACE);
            abort_all();
        };
        // Without a thread a rank's end is the launcher's to report.
        let _ = thread::Builder::new().name("watcher".into()).spawn(watcher);
    }

    fn wait_for_next(&self) {
        let mut ends = [PollFd::new(&self.next.process, PollFlags::IN)];
        // An interrupted call is repeated.
        while poll(&mut ends, None).is_err() {}
    }

    fn phase_of_next(&self) -> String {
        let mut entry = [0; ENTRY];
        let _ = self.file.read_exact_at(&mut entry, offset(self.next.place));
        let bytes = entry.split(|&byte| byte == 0).next().unwrap_or_default();
        String::from_utf8_lossy(bytes).into_owned()
    }
}

fn offset(place: usize) -> u64 {
    ((place + 1) * ENTRY) as u64
}

/// Which name space the numbers of processes are of; `None` where /proc is of another one.
fn process_space() -> Option<u64> {
    let own = fs::read_link("/proc/self").ok()?;
    if own.to_str()? != process::id().to_string() {
        return None;
    }
    Some(fs::metadata("/proc/self/ns/pid").ok()?.ino())
}
