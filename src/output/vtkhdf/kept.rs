//! The state that a run keeps beside its finished load steps, in `RESULT.unfinished.state`: a file that is written anew
//! after every load step, and takes the place of the one before when it is on the disk.

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
    /// The state in which the run goes on.
    #[serde(with = "crate::bytes")]
    pub state: Vec<u8>,
}

/// The file as it is.
#[derive(Serialize, Deserialize)]
struct Sealed {
    /// The program's version, which every version can read.
    version: String,
    /// A hash (XXH3) of the content.
    digest: u64,
    #[serde(with = "crate::bytes")]
    content: Vec<u8>,
}

impl Kept {
    /// Before there is a state.
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

    /// State that the last run with the result `path` kept; `None` where there is none.
    ///
    /// # Errors
    /// It is of another version of the program, or not what was written.
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
        read.map(Some).map_err(|error| unread(&state, &error))
    }

    /// Checks that the unfinished file of the result `path` holds what was written of the finished load steps.
    ///
    /// # Errors
    /// It doesn't, or can't be read; the first dataset that isn't what was written is named.
    pub fn check(&self, path: &Path) -> Result<(), InputError> {
        let file = File::open(unfinished(path)).map_err(|error| error.to_string());
        let whole = file.and_then(|file| self.checkpoint.check_all(&file));
        whole.map_err(|why| {
            let expected = "expected the load steps of the run that was stopped, or no such file";
            InputError::new(format!("{why}; {expected}")).in_file(&unfinished(path))
        })
    }

    /// Keeps this for the result `path`.
    ///
    /// # Errors
    /// The file can't be written; the one before stays.
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

/// An error for what has the right version and digest, and can't be read all the same.
pub fn unread(state: &Path, error: &ciborium::de::Error<io::Error>) -> InputError {
    let why = format!("it can't be read, as where another build of the program wrote it: {error}");
    InputError::new(why).in_file(state)
}

/// Forgets what was kept for the result `path`.
///
/// # Errors
/// It can't be removed.
pub(super) fn forget(path: &Path) -> Result<(), OutputError> {
    match fs::remove_file(state_of(path)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(failure(path, error)),
        _ => Ok(()),
    }
}

/// The name of what is kept for the result `path`.
pub fn state_of(path: &Path) -> PathBuf {
    let mut name = OsString::from(unfinished(path));
    name.push(".state");
    PathBuf::from(name)
}
