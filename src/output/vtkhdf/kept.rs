//! The state kept with the finished load steps, in `RESULT.unfinished.state`. After every load step it is written to a
//! new file, which replaces the previous one once it is on disk.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use contact_dd_partition::destination::{failure, unfinished, write_bytes};
use contact_dd_partition::error::{InputError, OutputError};
use serde::{Deserialize, Serialize};
use twox_hash::XxHash3_64;

use super::checkpoint::Checkpoint;

/// The finished load steps that are kept.
#[derive(Debug, Serialize, Deserialize)]
pub struct Kept {
    /// The finished load steps in the result file.
    pub(super) checkpoint: Checkpoint,
    /// The state from which the run continues.
    #[serde(with = "crate::bytes")]
    pub state: Vec<u8>,
}

/// The content of the state file.
#[derive(Serialize, Deserialize)]
struct Sealed {
    /// The version of the program, in a format that all versions can read.
    version: String,
    /// A hash (XXH3) of the content.
    digest: u64,
    #[serde(with = "crate::bytes")]
    content: Vec<u8>,
}

impl Kept {
    /// The state before any load step is finished.
    pub(super) fn new(checkpoint: Checkpoint) -> Self {
        Self {
            checkpoint,
            state: Vec::new(),
        }
    }

    /// Number of finished load steps.
    pub(super) fn finished(&self) -> usize {
        self.checkpoint.finished()
    }

    /// State kept by the last run with the result `path`; `None` if there is none.
    ///
    /// # Errors
    /// The state was written by another version of the program, or is damaged.
    pub fn read(path: &Path) -> Result<Option<Self>, InputError> {
        let state = state_of(path);
        if !unfinished(path).exists() || !state.exists() {
            return Ok(None);
        }
        let refused = |why: &str| InputError::new(why).in_file(&state);
        let bytes = fs::read(&state).map_err(|error| refused(&error.to_string()))?;
        let Sealed {
            version,
            digest,
            content,
        } = ciborium::from_reader(&bytes[..]).map_err(|_| {
            refused("it isn't what a run that was stopped leaves; expected its state")
        })?;
        if version != env!("CARGO_PKG_VERSION") {
            return Err(refused(&format!(
                "it is of version {version} of the program; expected {}",
                env!("CARGO_PKG_VERSION")
            )));
        }
        if digest != XxHash3_64::oneshot(&content) {
            return Err(refused("it is damaged; expected what was written"));
        }
        let read = ciborium::from_reader(&content[..]);
        read.map(Some)
            .map_err(|error| unreadable_state(&state, &error))
    }

    /// Checks that the unfinished file of the result `path` contains the finished load steps as they were written.
    ///
    /// # Errors
    /// It doesn't, or can't be read; the message names the first dataset with a difference.
    pub fn check(&self, path: &Path) -> Result<(), InputError> {
        let file = File::open(unfinished(path)).map_err(|error| error.to_string());
        let whole = file.and_then(|file| self.checkpoint.check_all(&file));
        whole.map_err(|why| {
            let expected = "expected the load steps of the run that was stopped, or no such file";
            InputError::new(format!("{why}; {expected}")).in_file(&unfinished(path))
        })
    }

    /// Writes this state for the result `path`.
    ///
    /// # Errors
    /// The file can't be written; the one before remains.
    pub(super) fn write(&self, path: &Path) -> Result<(), OutputError> {
        let fails = |error: ciborium::ser::Error<io::Error>| failure(path, error);
        let (mut content, mut bytes) = (Vec::new(), Vec::new());
        ciborium::into_writer(self, &mut content).map_err(fails)?;
        let sealed = Sealed {
            version: env!("CARGO_PKG_VERSION").into(),
            digest: XxHash3_64::oneshot(&content),
            content,
        };
        ciborium::into_writer(&sealed, &mut bytes).map_err(fails)?;
        write_bytes(&state_of(path), |out| out.write_all(&bytes))
    }
}

/// The error of a state with the right version and digest that can't be read.
pub fn unreadable_state(state: &Path, error: &ciborium::de::Error<io::Error>) -> InputError {
    let why =
        format!("it can't be read, perhaps as another build of the program wrote it: {error}");
    InputError::new(why).in_file(state)
}

/// Deletes the state kept for the result `path`.
///
/// # Errors
/// It can't be deleted.
pub(super) fn forget(path: &Path) -> Result<(), OutputError> {
    match fs::remove_file(state_of(path)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(failure(path, error)),
        _ => Ok(()),
    }
}

/// The name of the state file of the result `path`.
pub fn state_of(path: &Path) -> PathBuf {
    let mut name = OsString::from(unfinished(path));
    name.push(".state");
    PathBuf::from(name)
}
