//! The trial of a problem file: a check that it can be read.
//!
//! On a damaged file the HDF5 library may crash or hang. A file with a valid [digest](super::digest) isn't damaged. Any
//! other is first read by a separate process, which runs this program again.

use std::ffi::OsStr;
use std::fmt::Display;
use std::os::unix::process::ExitStatusExt as _;
use std::path::Path;
use std::process::{Child, Command, ExitCode, ExitStatus, Stdio};
use std::time::Duration;
use std::{env, fs, io, thread};

use rustix::process::{
    Resource, Rlimit, Signal, getrlimit, set_parent_process_death_signal, setrlimit,
};
use rustix::time::{ClockId, clock_gettime};

use super::digest::Digest;
use super::read::ProblemFile;
use crate::error::InputError;

/// Environment variable with the file's name for the process that tries it.
const FILE: &str = "CONTACT_DD_TRIAL";

/// Number of subdomains read at once.
const AT_ONCE: usize = 64;

/// Limit of the CPU time of each step of reading a small file (seconds).
const PATIENCE: u64 = 1;

/// Least rate of reading, in a debug build (bytes per second).
const SLOWEST: u64 = 20 << 20;

/// Memory limit for a small file, far above its need (bytes).
const MEMORY: u64 = 4 << 30;

/// Memory limit for a large file, relative to its size, above its need.
const MEMORY_OF_SIZE: u64 = 8;

/// Interval of polling the other process.
const PAUSE: Duration = Duration::from_millis(2);

/// Checks that the HDF5 library can read a problem file: by its digest, or by trial. Ends early, without a result, once
/// the program `is_asked_to_stop`.
///
/// [`answer`] has to be called first by the program.
///
/// # Errors
/// A missing or damaged file.
pub fn check(path: &Path, is_asked_to_stop: fn() -> bool) -> Result<(), InputError> {
    let checked = match Digest::of(path) {
        Ok(Digest::Right) => Ok(()),
        Ok(Digest::Absent) => attempt(path, is_asked_to_stop),
        Err(error) => Err(error),
    };
    checked.map_err(|error| error.in_file(path))
}

/// Reads the file if this process was started for a trial; errors in its content are left to the process that reads it
/// afterwards.
pub fn answer() -> Option<ExitCode> {
    let path = env::var_os(FILE)?;
    let read = || -> Result<(), InputError> {
        let limits = Limits::of(Path::new(&path));
        limits.start();
        let file = ProblemFile::open(Path::new(&path))?;
        let count = file.catalog().subdomains.len();
        for first in (0..count).step_by(AT_ONCE) {
            limits.extend();
            file.subdomains(first..count.min(first + AT_ONCE))?;
        }
        Ok(())
    };
    let _ = read();
    Some(ExitCode::SUCCESS)
}

/// Reads the file in another process.
fn attempt(path: &Path, is_asked_to_stop: fn() -> bool) -> Result<(), InputError> {
    let damaged = |how: &dyn Display| {
        InputError::new(format!(
            "is damaged: the HDF5 library {how}. Expected a whole file; make it again"
        ))
    };
    // If no process can be started, the file is read without a trial.
    let Ok(child) = start(path.as_os_str()) else {
        return Ok(());
    };
    match wait(child, is_asked_to_stop) {
        Ok(Some(status)) if !status.success() => Err(match status.signal() {
            Some(signal) if signal == Signal::XCPU.as_raw() => {
                damaged(&"doesn't come to an end with it")
            }
            _ => damaged(&format!("crashes on it ({status})")),
        }),
        _ => Ok(()),
    }
}

fn start(path: &OsStr) -> io::Result<Child> {
    Command::new(env::current_exe()?)
        .env(FILE, path)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
}

/// Exit status of a process; `None` if it was killed because the program `is_asked_to_stop`.
fn wait(mut child: Child, is_asked_to_stop: fn() -> bool) -> io::Result<Option<ExitStatus>> {
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if is_asked_to_stop() {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        thread::sleep(PAUSE);
    }
}

/// The limits of a process that tries a file.
struct Limits {
    memory: u64,
    /// CPU time of a step (seconds).
    patience: u64,
}

impl Limits {
    fn of(path: &Path) -> Self {
        let size = fs::metadata(path).map_or(0, |file| file.len());
        Self {
            memory: MEMORY + MEMORY_OF_SIZE * size,
            patience: PATIENCE + size / SLOWEST,
        }
    }

    /// Limits the memory and the first step, disables core files, and makes the process end with its parent.
    fn start(&self) {
        let _ = set_parent_process_death_signal(Some(Signal::KILL));
        limit(Resource::Core, 0);
        limit(Resource::As, self.memory);
        self.extend();
    }

    /// Allows CPU time for another step.
    fn extend(&self) {
        let spent = clock_gettime(ClockId::ProcessCPUTime).tv_sec as u64;
        limit(Resource::Cpu, spent + 1 + self.patience);
    }
}

/// Sets a limit, or the system's own if that is lower. Errors are ignored.
fn limit(resource: Resource, most: u64) {
    let given = getrlimit(resource);
    let current = given.maximum.map_or(most, |maximum| maximum.min(most));
    let limited = Rlimit {
        current: Some(current),
        ..given
    };
    let _ = setrlimit(resource, limited);
}
