//! The watcher of a host: a process beside its ranks that sees them end.
//!
//! A rank that is killed can't say so itself, and launchers end the others at once. The watcher is the
//! program itself under another name, in a session of its own, where no signal to the ranks reaches
//! it. It ends with the last rank.
//!
//! A pipe leads from each rank to the watcher. The system closes it with the rank's other files, the
//! last one opened first, and so before the launcher's own connection: the watcher hears of a rank that is
//! killed before the launcher ends another. Only a rank that reads the memory of the dying one in between,
//! and falls over that, can be before it.

use std::env;
use std::ffi::{CStr, OsStr};
use std::fs::{self, File};
use std::io::{self, Read, Write, stderr, stdin, stdout};
use std::os::fd::{AsFd, OwnedFd};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::process::CommandExt;
use std::process::{self, Command, Stdio};
use std::time::{Duration, Instant};

use rustix::event::{Timespec, epoll};
use rustix::process::{Pid, PidfdFlags, Signal, pidfd_open, pidfd_send_signal, setsid};
use rustix::thread::set_name;

use super::board::Board;

/// What the watcher is called.
const NAME: &CStr = c"rank-watcher";

/// How long the launcher has to end the ranks that are left.
const GRACE: Duration = Duration::from_secs(3);

/// A rank to be watched.
#[derive(Clone, Copy, Debug)]
pub struct Watched {
    /// Its process.
    pub process: i64,
    /// Its number among all ranks.
    pub rank: i64,
    /// The watcher's end of the pipe that leads to it, as a file descriptor of the process that starts
    /// the watcher.
    pub line: i32,
}

/// Starts the watcher of `ranks`, those of a run of `size` ranks that have entries on `board`.
///
/// # Errors
/// What the system said.
pub fn start(board: &Board, ranks: &[Watched], size: usize) -> io::Result<()> {
    let list = (ranks.iter()).map(|r| format!("{}:{}:{}", r.process, r.rank, r.line));
    let mut watcher = Command::new("/proc/self/exe")
        .arg0(OsStr::from_bytes(NAME.to_bytes()))
        .args([size.to_string(), process::id().to_string()])
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
    if env::args_os().next()?.as_bytes() != NAME.to_bytes() {
        return None;
    }
    let mut arguments = env::args().skip(1);
    let (size, starter) = (arguments.next()?, arguments.next()?);
    let ranks: Option<Vec<Watched>> = arguments.map(|rank| parse(&rank)).collect();
    // A watcher that can't watch leaves a rank's end to the launcher to report.
    let _ = watch(&size, &starter, &ranks?);
    Some(())
}

fn parse(rank: &str) -> Option<Watched> {
    let mut numbers = rank.split(':');
    Some(Watched {
        process: numbers.next()?.parse().ok()?,
        rank: numbers.next()?.parse().ok()?,
        line: numbers.next()?.parse().ok()?,
    })
}

fn watch(size: &str, starter: &str, ranks: &[Watched]) -> io::Result<()> {
    let _ = (setsid(), set_name(NAME));
    close_inherited();
    let board = Board::handed(stdin().as_fd().try_clone_to_owned()?);
    let ends = epoll::create(epoll::CreateFlags::CLOEXEC)?;
    let (mut processes, mut lines) = (Vec::new(), Vec::new());
    for (place, watched) in ranks.iter().enumerate() {
        let id = i32::try_from(watched.process).ok().and_then(Pid::from_raw);
        let id = id.ok_or(io::ErrorKind::InvalidInput)?;
        processes.push(pidfd_open(id, PidfdFlags::empty())?);
        let line = File::open(format!("/proc/{starter}/fd/{}", watched.line))?;
        let data = epoll::EventData::new_u64(place as u64);
        epoll::add(&ends, &line, data, epoll::EventFlags::IN)?;
        lines.push(line);
    }
    stdout().write_all(&[1])?;
    stdout().flush()?;
    let mut deadline = None;
    for _ in ranks {
        let Some(place) = next_end(&ends, deadline)? else {
            for process in &processes {
                let _ = pidfd_send_signal(process, Signal::KILL);
            }
            break;
        };
        epoll::delete(&ends, &lines[place])?;
        let phase = board.read(place);
        if phase.is_empty() {
            continue;
        }
        deadline.get_or_insert_with(|| Instant::now() + GRACE);
        if board.claim_message() {
            let message = format!(
                "error: rank {} of {size} ended unexpectedly while {phase}: killed, crashed or out \
                 of memory\n",
                ranks[place].rank
            );
            // In one piece: the launcher may be speaking, too.
            let _ = stderr().write_all(message.as_bytes());
        }
    }
    Ok(())
}

/// Waits for the next rank to end, those that ended first come first; `None` after the deadline.
fn next_end(ends: &OwnedFd, deadline: Option<Instant>) -> io::Result<Option<usize>> {
    let mut events = Vec::with_capacity(1);
    loop {
        let left = deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()));
        let left = left.map(Timespec::try_from).transpose();
        let left = left.map_err(io::Error::other)?;
        let room = rustix::buffer::spare_capacity(&mut events);
        match epoll::wait(ends, room, left.as_ref()) {
            Ok(0) if left.is_some() => return Ok(None),
            Ok(_) => {}
            Err(rustix::io::Errno::INTR) => continue,
            Err(error) => return Err(error.into()),
        }
        if let Some(event) = events.first() {
            return Ok(Some(event.data.u64() as usize));
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
