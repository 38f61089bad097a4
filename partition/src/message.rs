//! Errors and warnings of both programs on stderr, in colour where a terminal shows them.

use anstyle::{AnsiColor, Style};

/// How the word "error:" is shown.
pub const ERROR: Style = AnsiColor::Red.on_default().bold();

/// How the word "warning:" is shown.
pub const WARNING: Style = AnsiColor::Yellow.on_default().bold();

/// Prints an error.
pub fn error(text: &str) {
    anstream::eprintln!("{ERROR}error:{ERROR:#} {text}");
}

/// Prints a warning.
pub fn warning(text: &str) {
    anstream::eprintln!("{WARNING}warning:{WARNING:#} {text}");
}
