//! Output files that appear under their name only when they are complete.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use tempfile::{Builder, TempPath};

use crate::error::OutputError;

/// A name for a file and, in the same folder, the temporary file that will be renamed to it.
///
/// Dropped without [`commit`](Self::commit), the temporary file is removed and an existing file stays. A run that is
/// killed leaves its temporary file behind, `.NAME.….part`, until the next run with the same name removes it.
#[derive(Debug)]
pub struct Destination {
    path: PathBuf,
    target: PathBuf,
    temporary: TempPath,
    is_kept: bool,
    /// Lock that marks the temporary file as in use for other programs, as long as it is open.
    owned: Option<File>,
}

/// Most attempts to create a temporary file, as another program may remove it as abandoned before it is locked.
const TRIES: usize = 10;

impl Destination {
    /// Creates the temporary file for `path`.
    ///
    /// # Errors
    /// A folder that doesn't exist or isn't writable, a name of something other than a writable file.
    pub fn new(path: &Path) -> Result<Self, OutputError> {
        let target = target_of(path)?;
        let prefix = hidden(&target);
        remove_left(folder_of(&target), &prefix);
        for _ in 0..TRIES {
            let made = Builder::new()
                .prefix(&prefix)
                .suffix(PART)
                // The umask applies: the same permissions as any file of the user.
                .permissions(Permissions::from_mode(0o666))
                .tempfile_in(folder_of(&target));
            let (file, temporary) = made.map_err(|error| failure(path, error))?.into_parts();
            // Where files can't be locked, none is treated as abandoned.
            if file.lock().is_err() || temporary.exists() {
                return Ok(Self {
                    path: path.to_path_buf(),
                    temporary,
                    is_kept: false,
                    target,
                    owned: Some(file),
                });
            }
        }
        Err(failure(
            path,
            "its temporary file is removed by others again and again",
        ))
    }

    /// The file that an earlier run [kept](Self::keep) for `path`, to be completed.
    ///
    /// # Errors
    /// Errors of [`new`](Self::new).
    pub fn kept(path: &Path) -> Result<Self, OutputError> {
        let target = target_of(path)?;
        let kept = TempPath::try_from_path(unfinished(&target));
        let mut temporary = kept.map_err(|error| failure(path, error))?;
        temporary.disable_cleanup(true);
        Ok(Self {
            path: path.to_path_buf(),
            temporary,
            is_kept: true,
            target,
            owned: None,
        })
    }

    /// Makes the temporary file persist without a commit, under the name [`unfinished`] of the file.
    ///
    /// # Errors
    /// The reason given by the system.
    pub fn keep(&mut self) -> Result<(), OutputError> {
        if self.is_kept() {
            return Ok(());
        }
        let kept = unfinished(&self.target);
        let fails = |error: io::Error| failure(&self.path, error);
        fs::rename(&self.temporary, &kept).map_err(fails)?;
        let mut temporary = TempPath::try_from_path(kept).map_err(fails)?;
        temporary.disable_cleanup(true);
        // The temporary name no longer exists.
        std::mem::replace(&mut self.temporary, temporary).disable_cleanup(true);
        // The new name isn't that of an abandoned file, so that other programs may lock the file to read it.
        self.owned = None;
        self.is_kept = true;
        Ok(())
    }

    /// True if the temporary file persists without a commit.
    pub fn is_kept(&self) -> bool {
        self.is_kept
    }

    /// The path of the final file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file to write to.
    pub fn temporary(&self) -> &Path {
        &self.temporary
    }

    /// An error that names the file, with the system's message where HDF5 quotes it among addresses.
    pub fn failure(&self, reason: impl ToString) -> OutputError {
        let message = reason.to_string();
        let quoted = message.split_once("error message = '");
        let quoted = quoted.and_then(|(_, rest)| rest.split_once('\''));
        failure(&self.path, quoted.map_or(&*message, |(words, _)| words))
    }

    /// Flushes the temporary file to the disk and renames it.
    ///
    /// # Errors
    /// The reason given by the system.
    pub fn commit(self) -> Result<(), OutputError> {
        let sync = |file: &Path| File::open(file).and_then(|file| file.sync_all());
        sync(&self.temporary).map_err(|error| failure(&self.path, error))?;
        let renamed = self.temporary.persist(&self.target);
        renamed.map_err(|error| failure(&self.path, error.error))?;
        // The file has its name, even on a file system that can't sync folders.
        let _ = sync(folder_of(&self.target));
        Ok(())
    }
}

/// The name under which an interrupted run keeps the file `path`, after following links: `NAME.unfinished`.
pub fn unfinished(path: &Path) -> PathBuf {
    let mut name = OsString::from(follow(path));
    name.push(".unfinished");
    PathBuf::from(name)
}

/// The ending of the names of temporary files.
const PART: &str = ".part";

/// Removes temporary files of killed programs: those that no process has locked.
fn remove_left(folder: &Path, prefix: &OsStr) {
    let prefix = prefix.as_encoded_bytes();
    let is_part = |name: &OsStr| {
        let name = name.as_encoded_bytes();
        name.starts_with(prefix) && name.ends_with(PART.as_bytes())
    };
    // Errors of reading the folder or removing a file are ignored.
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if is_part(&entry.file_name()) {
            let file = File::options().read(true).write(true).open(entry.path());
            if file.is_ok_and(|file| file.try_lock().is_ok()) {
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

/// The file `.NAME.ending` next to the file `path`, after following links.
///
/// # Errors
/// Errors of [`Destination::new`].
pub fn beside(path: &Path, ending: &str) -> Result<PathBuf, OutputError> {
    let target = target_of(path)?;
    let mut name = hidden(&target);
    name.push(ending);
    Ok(folder_of(&target).join(name))
}

/// The prefix of the names of temporary files for `target`: `.NAME.`.
fn hidden(target: &Path) -> OsString {
    let mut name = OsString::from(".");
    name.push(target.file_name().unwrap_or_default());
    name.push(".");
    name
}

/// The path without links: the target of a link is replaced, not the link.
fn follow(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf())
}

/// The file that `path` names, after following links.
fn target_of(path: &Path) -> Result<PathBuf, OutputError> {
    let fails = |reason: &str| Err(failure(path, reason));
    let target = follow(path);
    if let Ok(metadata) = fs::metadata(&target) {
        if !metadata.is_file() {
            return fails("it isn't a file");
        }
        if metadata.permissions().readonly() {
            return fails("the file that is there is write-protected");
        }
    }
    if target.file_name().is_none() {
        return fails("this names a folder; expected a file name");
    }
    if !folder_of(&target).is_dir() {
        return fails("its folder doesn't exist");
    }
    Ok(target)
}

/// Writes `path` as a stream of bytes; it gets its name when it is complete.
///
/// # Errors
/// A file that can't be written.
pub fn write_bytes(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), OutputError> {
    let destination = Destination::new(path)?;
    let written = File::create(destination.temporary()).and_then(|file| {
        let mut buffered = BufWriter::new(file);
        write(&mut buffered)?;
        buffered.flush()
    });
    written.map_err(|error| destination.failure(error))?;
    destination.commit()
}

/// An error for `path`.
pub fn failure(path: &Path, reason: impl ToString) -> OutputError {
    OutputError {
        path: path.to_path_buf(),
        reason: reason.to_string(),
    }
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_keeps_its_content_until_the_other_one_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result");
        fs::write(&path, "before").unwrap();

        let failed = write_bytes(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("disk full"))
        });
        assert!(failed.unwrap_err().to_string().contains("disk full"));
        assert_eq!(fs::read_to_string(&path).unwrap(), "before");

        let complete = Destination::new(&path).unwrap();
        fs::write(complete.temporary(), "after").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "before");
        complete.commit().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "after");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_is_kept_is_kept_once_by_whichever_path() {
        // A relative path is relative to the working directory.
        let folder = tempfile::tempdir_in(".").unwrap();
        let relative = Path::new(folder.path().file_name().unwrap()).join("result");
        for path in [folder.path().join("result"), relative] {
            let mut destination = Destination::new(&path).unwrap();
            assert!(!destination.is_kept());
            destination.keep().unwrap();
            assert!(destination.is_kept(), "{}", path.display());
            drop(destination);
            assert!(Destination::kept(&path).unwrap().is_kept());
            assert!(unfinished(&path).exists());
        }
    }

    #[test]
    fn what_killed_programs_left_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result");
        let others = [
            ".result.part.bak",
            ".result2.abc.part",
            "result.abc.part",
            ".results",
        ];
        for name in [".result.abcdef.part", ".result.123456.part"]
            .iter()
            .chain(&others)
        {
            fs::write(folder.path().join(name), "half").unwrap();
        }
        let first = Destination::new(&path).unwrap();
        let second = Destination::new(&path).unwrap();
        let names = || {
            let all = fs::read_dir(folder.path()).unwrap();
            let names = all.map(|entry| entry.unwrap().file_name().into_string().unwrap());
            let mut names: Vec<String> = names.collect();
            names.sort();
            names
        };
        assert!(first.temporary().exists() && second.temporary().exists());
        assert_eq!(names().len(), others.len() + 2);
        drop((first, second));
        let mut others = others.map(String::from);
        others.sort();
        assert_eq!(names(), others);
    }

    #[test]
    fn a_link_stays_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "before").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let destination = Destination::new(&link).unwrap();
        fs::write(destination.temporary(), "after").unwrap();
        destination.commit().unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "after");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }

    #[test]
    fn what_is_no_file_is_refused_before_anything_is_computed() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |path: &Path| Destination::new(path).unwrap_err().to_string();
        assert!(refused(folder.path()).contains("isn't a file"));
        assert!(refused(&folder.path().join("no/result")).contains("folder doesn't exist"));
        assert!(refused(Path::new("/dev/null")).contains("isn't a file"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
