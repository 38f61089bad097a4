//! The temporary file that takes a name when it is whole, and those that killed runs left behind.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;

use tempfile::{Builder, TempPath};

const ENDING: &str = ".part";

/// Random letters in the name of a temporary file.
const LETTERS: usize = 6;

/// A temporary file, locked as long as its owner lives: what no lock holds is left from a run that
/// was killed.
#[derive(Debug)]
pub struct Temporary {
    path: TempPath,
    /// Held, never read. Released after the file is gone or has its name.
    _lock: File,
}

impl Temporary {
    /// Makes the temporary file for `name` in `folder` and removes what killed runs left of others.
    ///
    /// # Errors
    /// What the system said.
    pub fn new(folder: &Path, name: &OsStr) -> io::Result<Self> {
        let prefix = prefix(name);
        remove_stale(folder, &prefix);
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(ENDING).rand_bytes(LETTERS);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The umask has its say: the same permissions as any file that the user makes.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        loop {
            let (file, path) = builder.tempfile_in(folder)?.into_parts();
            match file.try_lock() {
                // Another run has it for stale before it was locked, and is about to remove it.
                Err(TryLockError::WouldBlock) => {}
                Ok(()) if !path.exists() => {}
                // Where the file system has no locks, nobody removes anything.
                Ok(()) | Err(TryLockError::Error(_)) => return Ok(Self { path, _lock: file }),
            }
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives it the name `target`.
    ///
    /// # Errors
    /// What the system said.
    pub fn persist(self, target: &Path) -> io::Result<()> {
        self.path.persist(target).map_err(|error| error.error)
    }
}

/// What the names of all temporary files of `name` on this machine begin with: on a file system that
/// several share, a lock of another machine may not be seen.
fn prefix(name: &OsStr) -> OsString {
    let mut prefix = OsString::from(".");
    prefix.push(name);
    #[cfg(unix)]
    {
        let machine = rustix::system::uname();
        prefix.push(".");
        prefix.push(machine.nodename().to_string_lossy().as_ref());
    }
    prefix.push(".");
    prefix
}

/// Removes the temporary files that nobody holds. What can't be removed stays: it does no harm.
fn remove_stale(folder: &Path, prefix: &OsStr) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if !is_file || !is_temporary(&entry.file_name(), prefix) {
            continue;
        }
        let path = entry.path();
        // Some file systems lock only what may be written.
        let held = File::options().read(true).write(true).open(&path);
        if let Ok(held) = held
            && held.try_lock().is_ok()
        {
            let _ = fs::remove_file(&path);
        }
    }
}

fn is_temporary(name: &OsStr, prefix: &OsStr) -> bool {
    let letters = (name.as_encoded_bytes())
        .strip_prefix(prefix.as_encoded_bytes())
        .and_then(|rest| rest.strip_suffix(ENDING.as_bytes()));
    letters.is_some_and(|letters| {
        letters.len() == LETTERS && letters.iter().all(u8::is_ascii_alphanumeric)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn what_a_killed_run_left_goes_with_the_next_one_and_what_is_in_use_stays() {
        let folder = tempfile::tempdir().unwrap();
        let name = OsStr::new("result.vtkhdf");
        // A killed process holds no lock and removes nothing.
        let (left, lock) = {
            let killed = Temporary::new(folder.path(), name).unwrap();
            (killed.path.keep().unwrap(), killed._lock)
        };
        drop(lock);
        let alive = Temporary::new(folder.path(), name).unwrap();
        assert!(!left.exists());
        let other = Temporary::new(folder.path(), name).unwrap();
        assert!(alive.path().exists() && other.path().exists());
        assert_eq!(names(folder.path()), 2);
    }

    #[test]
    fn files_of_other_names_stay() {
        let folder = tempfile::tempdir().unwrap();
        let machine = prefix(OsStr::new("a"));
        let with = |end: &str| {
            let mut name = machine.clone();
            name.push(end);
            folder.path().join(name)
        };
        let kept = [
            with("b.abcdef.part"),
            with("abcdefg.part"),
            with("abc-ef.part"),
            with("abcdef.h5"),
            folder.path().join(".a.another-machine.abcdef.part"),
            folder.path().join("a"),
        ];
        for path in &kept {
            fs::write(path, "").unwrap();
        }
        fs::create_dir(with("folder.part")).unwrap();
        fs::write(with("abcdef.part"), "").unwrap();
        drop(Temporary::new(folder.path(), OsStr::new("a")).unwrap());
        assert!(kept.iter().all(|path| path.exists()));
        assert_eq!(names(folder.path()), kept.len() + 1);
    }

    #[test]
    fn runs_that_begin_at_once_leave_each_other_alone() {
        let folder = tempfile::tempdir().unwrap();
        let name = OsStr::new("result");
        std::thread::scope(|scope| {
            let runs: Vec<_> = (0..8)
                .map(|_| {
                    scope.spawn(|| {
                        for _ in 0..50 {
                            let temporary = Temporary::new(folder.path(), name).unwrap();
                            fs::write(temporary.path(), "whole").unwrap();
                            temporary.persist(&folder.path().join(name)).unwrap();
                        }
                    })
                })
                .collect();
            runs.into_iter().for_each(|run| run.join().unwrap());
        });
        assert_eq!(
            fs::read_to_string(folder.path().join(name)).unwrap(),
            "whole"
        );
        assert_eq!(names(folder.path()), 1);
    }
}
