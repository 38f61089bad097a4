//! What can be wrong with what a user hands in.

use std::path::{Path, PathBuf};

/// Bad input: the message says where (file, key, dataset, group, element, node) and what was
/// expected. Both programs end with exit code 2.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub struct InputError {
    place: Option<PathBuf>,
    message: String,
}

impl InputError {
    /// An error with a message that says where within its file and what was expected.
    pub fn new(message: impl Into<String>) -> Self {
        Self {
            place: None,
            message: message.into(),
        }
    }

    /// What makes an error of a reason: it begins with `what` is wrong.
    pub fn about(what: &str) -> impl Fn(String) -> Self {
        move |reason| Self::new(format!("{what}: {reason}"))
    }

    /// The same error with the file it was found in, unless it names one already.
    #[must_use]
    pub fn in_file(mut self, path: &Path) -> Self {
        self.place.get_or_insert_with(|| path.to_path_buf());
        self
    }
}

impl std::fmt::Display for InputError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Some(path) = &self.place {
            escape(f, &path.display().to_string(), "")?;
            f.write_str(": ")?;
        }
        escape(f, &self.message, "\n")
    }
}

/// Writes text of a file, or the name of one, without control characters but for those `kept`.
fn escape(f: &mut std::fmt::Formatter<'_>, text: &str, kept: &str) -> std::fmt::Result {
    for c in text.chars() {
        match c.is_control() && !kept.contains(c) {
            true => write!(f, "{}", c.escape_debug())?,
            false => write!(f, "{c}")?,
        }
    }
    Ok(())
}

/// The program's result file can't be written. Exit code 5.
#[derive(Debug, thiserror::Error)]
#[error("{path}: can't be written: {reason}")]
pub struct OutputError {
    /// The file.
    pub path: PathBuf,
    /// What the system said.
    pub reason: String,
}
