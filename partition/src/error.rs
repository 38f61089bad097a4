//! Errors of a user's input.

use std::path::{Path, PathBuf};

/// Invalid input: the message says where (file, key, dataset, group, element, node) and what was expected. Both
/// programs end with exit code 2.
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

    /// The function that makes an error from a reason: its message begins with `what` is wrong.
    pub fn about(what: &str) -> impl Fn(String) -> Self {
        move |reason| Self::new(format!("{what}: {reason}"))
    }

    /// This error with the name of its file, unless it already has one.
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
        escape(f, &shortened(&self.message), "\n")
    }
}

/// Number of shown characters of a word in a message: a value in a file may have any length.
const LONGEST_WORD: usize = 1000;

/// Number of shown characters of a message.
const LONGEST: usize = 5000;

/// A message truncated to a readable length, like its words.
fn shortened(message: &str) -> String {
    if message.len() <= LONGEST_WORD {
        return message.to_owned();
    }
    let mut short = String::new();
    let (mut count, mut in_word) = (0, 0);
    for c in message.chars() {
        in_word = if c.is_whitespace() { 0 } else { in_word + 1 };
        if in_word > LONGEST_WORD {
            continue;
        }
        if count == LONGEST {
            short.push('…');
            break;
        }
        short.push(if in_word == LONGEST_WORD { '…' } else { c });
        count += 1;
    }
    short
}

/// Writes text from a file, or the name of a file, without control characters except those `kept`.
fn escape(f: &mut std::fmt::Formatter<'_>, text: &str, kept: &str) -> std::fmt::Result {
    for c in text.chars() {
        match c.is_control() && !kept.contains(c) {
            true => write!(f, "{}", c.escape_debug())?,
            false => write!(f, "{c}")?,
        }
    }
    Ok(())
}

/// An output file that can't be written. Exit code 5.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{path}: can't be written: {reason}")]
pub struct OutputError {
    /// The file.
    pub path: PathBuf,
    /// The system's message.
    pub reason: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_short_whatever_it_cites() {
        let printed = |found: &str| {
            InputError::new(format!(
                "line 3: expected a number, found `{found}`; expected more"
            ))
            .in_file(Path::new("a.inp"))
            .to_string()
        };
        assert_eq!(
            printed("x\u{1b}[31m"),
            "a.inp: line 3: expected a number, found `x\\u{1b}[31m`; expected more"
        );
        let word = printed(&"9".repeat(100_000));
        assert!(word.len() < 1200, "{}", word.len());
        assert!(word.ends_with("9… expected more"), "{word}");
        let text = printed(&"9 ".repeat(100_000));
        assert!(text.len() < 5200, "{}", text.len());
        assert!(text.ends_with('…'), "{text}");
    }
}
