//! A file that is there whole or not at all.

use std::fmt::Display;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::error::OutputError;

/// Writes `path` under a temporary name in the same directory and renames it when it is whole, so
/// that whatever stood there is lost only to a complete file.
///
/// # Errors
/// The file can't be written.
pub(crate) fn replace<E: Display>(
    path: &Path,
    write: impl FnOnce(&mut NamedTempFile) -> Result<(), E>,
) -> Result<(), OutputError> {
    let attempt = || {
        if path.is_dir() {
            return Err("it is a folder".to_owned());
        }
        let directory = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".contact-dd-");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // Temporary files are private to their owner by default; results aren't. The system
            // takes the user's umask off.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let mut file = builder.tempfile_in(directory).map_err(|e| e.to_string())?;
        write(&mut file).map_err(|e| e.to_string())?;
        file.persist(path).map_err(|e| e.error.to_string())?;
        Ok(())
    };
    attempt().map_err(|reason| OutputError {
        path: path.to_path_buf(),
        reason,
    })
}

/// Writes `path` as [`replace`] does, from a stream of bytes.
///
/// # Errors
/// The file can't be written.
pub(crate) fn replace_bytes(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), OutputError> {
    replace(path, |file| {
        let mut buffered = BufWriter::new(file);
        write(&mut buffered)?;
        buffered.flush()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_what_was_there_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("kept");
        replace_bytes(&path, |w| w.write_all(b"first")).unwrap();
        let failed = replace_bytes(&path, |w| {
            w.write_all(b"half")?;
            Err(io::Error::other("disk full"))
        });
        assert!(failed.unwrap_err().to_string().contains("disk full"));
        assert_eq!(std::fs::read(&path).unwrap(), b"first");
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}
