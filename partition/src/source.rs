//! Input files.

use std::fs::{self, File};
use std::io::Read as _;
use std::path::Path;

use crate::error::InputError;

/// Largest size of a handwritten file (bytes).
const LARGEST: u64 = 16 << 20;

/// Opens a file for reading. `what` is its expected content, as in "a scene in TOML".
///
/// # Errors
/// A file that doesn't exist or can't be read, or something else than a file: reading a pipe would block, and a device
/// may be endless.
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

/// The first bytes of a file, by which its format is recognized; empty if it can't be read.
pub fn head(path: &Path) -> Vec<u8> {
    const LENGTH: u64 = 64;
    let mut bytes = Vec::new();
    if let Ok(file) = open(path, "") {
        // Errors are left to the reader of the file.
        let _ = file.take(LENGTH).read_to_end(&mut bytes);
    }
    bytes
}

/// Reads a handwritten file. `what` is its expected content.
///
/// # Errors
/// A file that can't be opened or read, is too large, or isn't UTF-8; the last one with its line.
pub fn text(path: &Path, what: &str) -> Result<String, InputError> {
    let file = open(path, what)?;
    let mut bytes = Vec::new();
    (file.take(LARGEST + 1).read_to_end(&mut bytes))
        .map_err(|error| InputError::new(format!("can't be read: {error}")))?;
    if bytes.len() as u64 > LARGEST {
        return Err(InputError::new(format!(
            "larger than {LARGEST} bytes; expected {what}"
        )));
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = good.iter().filter(|&&c| c == b'\n').count() + 1;
        InputError::new(format!("line {line}: isn't UTF-8 text; expected {what}"))
    })
}
