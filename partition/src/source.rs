//! Files that are read.

use std::fs::{self, File};
use std::path::Path;

use crate::error::InputError;

/// Opens a file to read it. `what` is what it should hold, as in "a scene in TOML".
///
/// # Errors
/// It isn't there, can't be read, or is something else than a file: a pipe would keep the reader
/// waiting, and a device may have no end.
pub fn open(path: &Path, what: &str) -> Result<File, InputError> {
    let unreadable = |reason: std::io::Error| {
        InputError::new(format!("can't be read: {reason}; expected {what}"))
    };
    match fs::metadata(path).map_err(unreadable)?.is_file() {
        true => File::open(path).map_err(unreadable),
        false => Err(InputError::new(format!(
            "can't be read: it isn't a file; expected {what}"
        ))),
    }
}
