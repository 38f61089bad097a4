//! Writes `problem.h5`.

use std::path::Path;

use super::Problem;
use crate::error::OutputError;

impl Problem {
    /// Writes the problem under a temporary name and renames it when it is whole.
    ///
    /// # Errors
    /// The file can't be written.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        Err(OutputError {
            path: path.to_path_buf(),
            reason: "not yet".into(),
        })
    }
}
