//! The watcher of a host: a process beside its ranks that sees them end.
//!
//! A rank that is killed can't say so itself, and launchers end the others at once. The watcher is the
//! program itself under another name, in a session of its own, where no signal to the ranks reaches
//! it. It ends with the last rank.

use std::io::{self, Read, Write, stderr, stdin, stdout};
use std::os::fd::{AsFd, OwnedFd};
use std::os::unix::process::CommandExt;
use std::process::{Command, Stdio};
use std::time::Duration;
use std::{env, fs, thread};

use rustix::event::epoll;
use rustix::process::{Pid, PidfdFlags, Signal, pidfd_open, pidfd_send_signal, setsid};

use super::board::Board;

/// What the watcher is called.
const NAME: &str = "rank-watcher";

/// How long the launcher has to end the ranks that are left.
const GRACE: Duration = Duration::from_secs(3);

/// A rank to be watched.
#[derive(Clone, Copy, Debug)]
pub struct Watched {
    /// Its process.
    pub process: i64,
    /// Its number among all ranks.
    pub rank: i64,
}

/// Starts the watcher of `ranks`, those of a run of `size` ranks that have entries on `board`.
///
/// # Errors
/// What the system said.
pub fn start(board: &Board, ranks: &[Watched], size: usize) -> io::Result<()> {
    let list = ranks.iter().map(|r| format!("{}:{}", r.process, r.rank));
    let mut watcher = Command::new("/proc/self/exe")
        .arg0(NAME)
        .arg(size.to_string())
        .args(list)
        .stdin(board.to_hand()?)
        .stdout(Stdio::piped())
        .spawn()?;
    // A byte says that it watches.
    match &mut watcher.stdout {
        Some(said) => said.read_exact(&mut [0]),
        None => Ok(()),
    }
}

/// Watches if this process was started to do so, until no rank is left; `None` if it wasn't.
pub fn watch_if_asked() -> Option<()> {
    let mut arguments = env::args();
    if arguments.next()? != NAME {
        return None;
    }
    let size = arguments.next()?;
    let ranks: Option<Vec<Watched>> = arguments.map(|rank| parse(&rank)).collect();
    // A watcher that can't watch leaves a rank's end to the launcher to report.
    let _ = watch(&size, &ranks?);
    Some(())
}

fn parse(rank: &str) -> Option<Watched> {
    let (process, rank) = rank.split_once(':')?;
    Some(Watched {
        process: process.parse().ok()?,
        rank: rank.parse().ok()?,
    })
}

fn watch(size: &str, ranks: &[Watched]) -> io::Result<()> {
    let _ = setsid();
    close_inherited();
    let board = Board::handed(stdin().as_fd().try_clone_to_owned()?);
    let ends = epoll::create(epoll::CreateFlags::CLOEXEC)?;
    let mut processes = Vec::new();
    for (place, watched) in ranks.iter().enumerate() {
        let id = i32::try_from(watched.process).ok().and_then(Pid::from_raw);
        let process = pidfd_open(id.ok_or(io::ErrorKind::InvalidInput)?, PidfdFlags::empty())?;
        let data = epoll::EventData::new_u64(place as u64);
        epoll::add(&ends, &process, data, epoll::EventFlags::IN)?;
        processes.push(process);
    }
    stdout().write_all(&[1])?;
    stdout().flush()?;
    for _ in ranks {
        let place = next_end(&ends)?;
        epoll::delete(&ends, &processes[place])?;
        let phase = board.read(place);
        if phase.is_empty() {
            continue;
        }
        if board.claim_message() {
            let message = format!(
                "error: rank {} of {size} ended unexpectedly while {phase}: killed, crashed or out \
                 of memory\n",
                ranks[place].rank
            );
            // In one piece: the launcher may be speaking, too.
            let _ = stderr().write_all(message.as_bytes());
        }
        thread::sleep(GRACE);
        for process in &processes {
            let _ = pidfd_send_signal(process, Signal::KILL);
        }
        break;
    }
    Ok(())
}

/// Waits for the next rank to end, those that ended first come first.
fn next_end(ends: &OwnedFd) -> io::Result<usize> {
    let mut events = Vec::with_capacity(1);
    loop {
        let waited = epoll::wait(ends, rustix::buffer::spare_capacity(&mut events), None);
        match (waited, events.first()) {
            (Ok(_), Some(event)) => return Ok(event.data.u64() as usize),
            (Ok(_) | Err(rustix::io::Errno::INTR), _) => {}
            (Err(error), _) => return Err(error.into()),
        }
    }
}

/// Closes what launchers and MPI libraries leave open across the start of a program: a launcher takes a
/// connection that is closed for the end of a rank.
fn close_inherited() {
    let open = fs::read_dir("/proc/self/fd")
        .into_iter()
        .flatten()
        .flatten();
    let open: Vec<i32> = open
        .filter_map(|entry| entry.file_name().to_str()?.parse().ok())
        .filter(|&descriptor| descriptor > 2)
        .collect();
    // Among them was the folder itself.
    let is_open =
        |descriptor: &i32| fs::symlink_metadata(format!("/proc/self/fd/{descriptor}")).is_ok();
    for descriptor in open.into_iter().filter(is_open) {
        // SAFETY: this process has just begun and owns nothing but its standard streams.
        unsafe { rustix::io::close(descriptor) };
    }
}
