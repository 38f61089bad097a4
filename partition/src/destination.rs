//! A file that appears under its name only when it is whole.

mod temporary;

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use self::temporary::Temporary;
use crate::error::OutputError;

/// A name for a file and, in the same folder, the temporary file that will take it.
///
/// Dropped without [`commit`](Self::commit), the temporary file goes and what stood under the name
/// stays. A run that is killed leaves its temporary file behind; the next one on the same machine
/// that writes to the same name removes it.
#[derive(Debug)]
pub struct Destination {
    path: PathBuf,
    target: PathBuf,
    temporary: Temporary,
}

impl Destination {
    /// Makes the temporary file for `path`.
    ///
    /// # Errors
    /// A folder that doesn't exist or can't be written, a name that something other than a
    /// writable file has.
    pub fn new(path: &Path) -> Result<Self, OutputError> {
        // A link is followed: what it points to is replaced, not the link.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        if let Ok(metadata) = fs::metadata(&target) {
            if metadata.is_dir() {
                return Err(failure(path, "it is a folder, which isn't a file"));
            }
            if !metadata.is_file() {
                return Err(failure(path, "something that isn't a file has this name"));
            }
            if metadata.permissions().readonly() {
                return Err(failure(path, "the file that is there is write-protected"));
            }
        }
        let Some(name) = target.file_name() else {
            return Err(failure(path, "this names a folder; expected a file name"));
        };
        let folder = folder_of(&target);
        if !folder.is_dir() {
            let reason = format!("there is no folder '{}'", folder.display());
            return Err(failure(path, reason));
        }
        let temporary =
            Temporary::new(folder, name).map_err(|error| failure(path, plain_words(&error)))?;
        Ok(Self {
            path: path.to_path_buf(),
            target,
            temporary,
        })
    }

    /// The file to write to.
    pub fn temporary(&self) -> &Path {
        self.temporary.path()
    }

    /// An error that names the file.
    pub fn failure(&self, reason: impl ToString) -> OutputError {
        failure(&self.path, reason)
    }

    /// Brings the temporary file to the disk and gives it its name.
    ///
    /// # Errors
    /// What the system said.
    pub fn commit(self) -> Result<(), OutputError> {
        let sync = |file: &Path| File::open(file).and_then(|file| file.sync_all());
        sync(self.temporary.path()).map_err(|error| failure(&self.path, plain_words(&error)))?;
        self.temporary
            .persist(&self.target)
            .map_err(|error| failure(&self.path, plain_words(&error)))?;
        // The file has its name; a file system that can't sync folders doesn't make that untrue.
        let _ = sync(folder_of(&self.target));
        Ok(())
    }
}

/// Writes `path` as a stream of bytes; it gets its name when it is whole.
///
/// # Errors
/// The file can't be written.
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
    written.map_err(|error| destination.failure(plain_words(&error)))?;
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

/// What a library said of a call that failed, in the system's words where it quotes `errno` among file
/// descriptors and addresses, as HDF5 does.
pub fn quoted_words(said: &str) -> String {
    let number = said.split_once("errno = ").and_then(|(_, rest)| {
        let digits = rest.split(|c: char| !c.is_ascii_digit()).next()?;
        digits.parse().ok()
    });
    match number {
        Some(number) => plain_words(&io::Error::from_raw_os_error(number)),
        None => said.to_owned(),
    }
}

/// The system's words without the path of the temporary file, which means nothing to the user.
pub fn plain_words(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "its folder is gone".into(),
        io::ErrorKind::PermissionDenied => "no permission to write into its folder".into(),
        io::ErrorKind::ReadOnlyFilesystem => "its file system is read-only".into(),
        io::ErrorKind::StorageFull => "no space is left on its file system".into(),
        io::ErrorKind::QuotaExceeded => "its quota of space is used up".into(),
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_keeps_its_content_until_the_other_one_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result");
        fs::write(&path, "before").unwrap();

        let dropped = Destination::new(&path).unwrap();
        fs::write(dropped.temporary(), "half").unwrap();
        drop(dropped);
        assert_eq!(fs::read_to_string(&path).unwrap(), "before");

        let whole = Destination::new(&path).unwrap();
        fs::write(whole.temporary(), "after").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "before");
        whole.commit().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "after");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
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
        assert!(refused(&folder.path().join("no/result")).contains("there is no folder"));
        assert!(refused(Path::new("/dev/null")).contains("isn't a file"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[cfg(unix)]
    #[test]
    fn the_system_is_quoted_alone() {
        let said = "H5Fflush(): file write failed: errno = 28, \
                    error message = 'No space left on device', buf = 0x55ed55b88fd8";
        assert_eq!(quoted_words(said), "no space is left on its file system");
        assert_eq!(quoted_words("unable to write"), "unable to write");
    }

    #[test]
    fn a_failed_write_leaves_what_was_there_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("kept");
        write_bytes(&path, |w| w.write_all(b"first")).unwrap();
        let failed = write_bytes(&path, |w| {
            w.write_all(b"half")?;
            Err(io::Error::other("disk full"))
        });
        assert!(failed.unwrap_err().to_string().contains("disk full"));
        assert_eq!(fs::read(&path).unwrap(), b"first");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}
