//! A lock on an output, so that only one run at a time writes it.
//!
//! It is a lock of the operating system on `.NAME.lock` beside the output. It ends with the process that holds it,
//! however that ends, and holds across hosts on network file systems that support it (NFS, Lustre with `flock`, GPFS,
//! BeeGFS, CephFS). The file's content is for messages, and for file systems without locks.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use std::{fmt, process, thread};

use contact_dd_partition::destination::{beside, failure};
use contact_dd_partition::error::OutputError;

use crate::comm::host_name;

/// Time to wait for a lock: the lock of a killed run holds until the system has released its memory.
const PATIENCE: Duration = Duration::from_secs(3);

/// Time between two attempts.
const PAUSE: Duration = Duration::from_millis(50);

/// Exclusive right to write an output, until it is dropped.
#[derive(Debug)]
pub struct OutputLock {
    path: PathBuf,
    // Closed after the removal of the file; closing releases the lock.
    _file: File,
}

impl OutputLock {
    /// Takes the lock on `output`, including a stale one of a run that has ended.
    ///
    /// # Errors
    /// Another run holds it, which the message names by host and process; a folder that can't be written.
    pub fn take(output: &Path) -> Result<Self, OutputError> {
        let path = beside(output, "lock")?;
        let since = Instant::now();
        loop {
            let why = match attempt(&path) {
                Ok(Some(file)) => return Ok(Self { path, _file: file }),
                Ok(None) => "other runs lock it again and again".to_owned(),
                Err(Refusal::System(error)) => return Err(failure(output, error)),
                Err(Refusal::Held(why)) => why,
            };
            if since.elapsed() > PATIENCE {
                return Err(failure(output, why));
            }
            thread::sleep(PAUSE);
        }
    }
}

impl Drop for OutputLock {
    fn drop(&mut self) {
        // If it can't be removed, it does no harm, as no process holds it.
        let _ = fs::remove_file(&self.path);
    }
}

/// Reason why a lock can't be taken.
enum Refusal {
    Held(String),
    System(io::Error),
}

impl From<io::Error> for Refusal {
    fn from(error: io::Error) -> Self {
        Self::System(error)
    }
}

/// The locked file; `None` if its holder has removed it since it was opened.
fn attempt(path: &Path) -> Result<Option<File>, Refusal> {
    let mut options = OpenOptions::new();
    options.read(true).write(true).create(true).truncate(false);
    let mut file = options.open(path)?;
    let mut text = String::new();
    // A lock file that isn't text has no holder.
    let _ = file.read_to_string(&mut text);
    let holder = Holder::read(&text);
    match file.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => {
            let who = holder.map_or_else(String::new, |holder| format!(": {holder}"));
            return Err(Refusal::Held(format!("another run writes it{who}")));
        }
        // The file system doesn't support locks.
        Err(TryLockError::Error(_)) => match holder {
            Some(holder) if holder.may_live() => {
                return Err(Refusal::Held(format!(
                    "another run writes it: {holder}; its file system has no locks by which to check whether \
                     that still runs: if it doesn't, remove {}",
                    path.display()
                )));
            }
            _ => {}
        },
    }
    if fs::metadata(path).ok().map(|found| found.ino()) != Some(file.metadata()?.ino()) {
        return Ok(None);
    }
    file.set_len(0)?;
    file.rewind()?;
    if let Err(error) = file.write_all(Holder::this().line().as_bytes()) {
        let _ = fs::remove_file(path);
        return Err(error.into());
    }
    Ok(Some(file))
}

/// The process that holds a lock.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Holder {
    process: u32,
    /// Start time of the process as counted by Linux (ticks since the host's start); it distinguishes processes with
    /// the same number.
    began: u64,
    host: String,
}

impl Holder {
    fn this() -> Self {
        let process = process::id();
        Self {
            process,
            began: beginning(process).unwrap_or(0),
            host: host_name(),
        }
    }

    fn line(&self) -> String {
        let Self {
            process,
            began,
            host,
        } = self;
        format!("{process} {began} {host}\n")
    }

    fn read(text: &str) -> Option<Self> {
        let mut words = text.trim_end().splitn(3, ' ');
        Some(Self {
            process: words.next()?.parse().ok()?,
            began: words.next()?.parse().ok()?,
            host: words.next()?.to_owned(),
        })
    }

    /// True if the process may still run; processes of other hosts can't be checked.
    fn may_live(&self) -> bool {
        self.host != host_name() || beginning(self.process) == Some(self.began)
    }
}

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "process {} on host '{}'", self.process, self.host)
    }
}

/// Start time of a process of this host; `None` if there is none.
fn beginning(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The process name, in parentheses, may contain spaces and parentheses; the fields after it don't.
    let (_, fields) = status.rsplit_once(')')?;
    fields.split_whitespace().nth(19)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_run_at_a_time_has_the_lock() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("result.vtkhdf");
        let held = OutputLock::take(&output).unwrap();
        let refused = OutputLock::take(&output).unwrap_err().to_string();
        let process = format!("process {} on host '{}'", process::id(), host_name());
        for words in ["result.vtkhdf", "another run writes it", &process] {
            assert!(refused.contains(words), "{refused}");
        }
        // A symbolic link names the same file.
        fs::write(&output, "of yesterday").unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink(&output, &link).unwrap();
        OutputLock::take(&link).unwrap_err();
        OutputLock::take(&folder.path().join("other.vtkhdf")).unwrap();
        // A holder about to end is waited for.
        let waiting = thread::spawn(move || drop(OutputLock::take(&link).unwrap()));
        thread::sleep(2 * PAUSE);
        drop(held);
        waiting.join().unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn what_a_run_left_that_is_gone_is_no_lock() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("result.vtkhdf");
        for left in ["", "1 7 elsewhere\n", "something else"] {
            fs::write(folder.path().join(".result.vtkhdf.lock"), left).unwrap();
            let lock = OutputLock::take(&output).unwrap();
            let now = fs::read_to_string(&lock.path).unwrap();
            assert_eq!(Holder::read(&now), Some(Holder::this()));
        }
    }

    #[test]
    fn without_locks_a_process_of_this_host_is_looked_for() {
        let this = Holder::this();
        assert!(this.may_live());
        let later = Holder {
            began: this.began + 1,
            ..this.clone()
        };
        assert!(!later.may_live());
        let elsewhere = Holder {
            host: "elsewhere".into(),
            ..later
        };
        assert!(elsewhere.may_live());
        assert_eq!(Holder::read(&this.line()), Some(this));
    }
}
