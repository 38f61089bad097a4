//! What the ranks of a host are doing, in memory that outlives each of them.

use std::fs::File;
use std::io;
use std::os::fd::{AsRawFd, OwnedFd};
use std::os::unix::fs::FileExt;

use rustix::fs::{MemfdFlags, memfd_create};

/// Bytes of an entry.
const ENTRY: usize = 128;

/// First a byte that tells whether the end of a rank was reported, then an entry for each rank of the
/// host: its phase, filled up with zeros, and nothing else where the rank has left.
#[derive(Debug)]
pub struct Board {
    file: File,
}

impl Board {
    /// A new board, without a name, gone with the last process that has it.
    ///
    /// # Errors
    /// The system has no such memory.
    pub fn new() -> io::Result<Self> {
        let file = memfd_create("ranks", MemfdFlags::CLOEXEC)?.into();
        Ok(Self { file })
    }

    /// The board that another process of this host has made.
    ///
    /// # Errors
    /// It can't be opened.
    pub fn of(process: i64, descriptor: i64) -> io::Result<Self> {
        let path = format!("/proc/{process}/fd/{descriptor}");
        let file = File::options().read(true).write(true).open(path)?;
        Ok(Self { file })
    }

    /// The same board in the hands of a process that was started with it.
    pub fn handed(descriptor: OwnedFd) -> Self {
        let file = descriptor.into();
        Self { file }
    }

    /// Its file descriptor, by which other processes find it.
    pub fn descriptor(&self) -> i64 {
        self.file.as_raw_fd().into()
    }

    /// A descriptor to hand to another process.
    ///
    /// # Errors
    /// There are too many.
    pub fn to_hand(&self) -> io::Result<OwnedFd> {
        self.file.try_clone().map(OwnedFd::from)
    }

    /// Notes what the rank at `place` is doing, nothing where it leaves.
    pub fn write(&self, place: usize, phase: &str) {
        let mut entry = [0; ENTRY];
        let length = phase.len().min(ENTRY);
        entry[..length].copy_from_slice(&phase.as_bytes()[..length]);
        // Where the memory of a board can't be had, others will say so.
        let _ = self.file.write_all_at(&entry, offset(place));
    }

    /// What the rank at `place` is or was doing, empty where it has left.
    pub fn read(&self, place: usize) -> String {
        let mut entry = [0; ENTRY];
        let _ = self.file.read_exact_at(&mut entry, offset(place));
        let phase = entry.split(|&byte| byte == 0).next().unwrap_or_default();
        String::from_utf8_lossy(phase).into_owned()
    }

    /// Whether the caller is the first to report how the run ended, and so the one who does.
    pub fn claim_message(&self) -> bool {
        let mut claimed = [0];
        // Without a lock there may be two messages, which is better than none.
        let lock = self.file.lock();
        let first = self.file.read_exact_at(&mut claimed, 0).is_err() || claimed == [0];
        let _ = self.file.write_all_at(&[1], 0);
        if lock.is_ok() {
            let _ = self.file.unlock();
        }
        first
    }
}

fn offset(place: usize) -> u64 {
    ((place + 1) * ENTRY) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_process_reads_what_was_written_and_who_has_left() {
        let board = Board::new().unwrap();
        let other = Board::of(std::process::id().into(), board.descriptor()).unwrap();
        board.write(0, "assembling the interface problem");
        board.write(1, "sweeping");
        other.write(1, "writing");
        other.write(2, &"long ".repeat(100));
        assert_eq!(other.read(0), "assembling the interface problem");
        assert_eq!(board.read(1), "writing");
        assert_eq!(board.read(2).len(), ENTRY);
        board.write(0, "");
        assert_eq!(other.read(0), "");
        assert_eq!(other.read(7), "");
    }

    #[test]
    fn one_of_many_reports() {
        let board = Board::new().unwrap();
        let claims = std::thread::scope(|scope| {
            let claim = || {
                let own = Board::of(std::process::id().into(), board.descriptor()).unwrap();
                own.claim_message()
            };
            let all: Vec<_> = (0..8).map(|_| scope.spawn(claim)).collect();
            let claims = all.into_iter().map(|claim| claim.join().unwrap());
            claims.filter(|&first| first).count()
        });
        assert_eq!(claims, 1);
    }
}
