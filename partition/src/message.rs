//! Errors and warnings of both programs on stderr, in colour where a terminal shows them.

use std::io::{Write, stderr};

use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};

/// How the word "error:" is shown.
pub const ERROR: Style = AnsiColor::Red.on_default().bold();

/// How the word "warning:" is shown.
pub const WARNING: Style = AnsiColor::Yellow.on_default().bold();

/// Prints an error.
pub fn error(text: &str) {
    print(ERROR, "error:", text);
}

/// Prints a warning.
pub fn warning(text: &str) {
    print(WARNING, "warning:", text);
}

fn print(style: Style, word: &str, text: &str) {
    let line = match AutoStream::choice(&stderr()) {
        ColorChoice::Never => format!("{word} {text}\n"),
        _ => format!("{style}{word}{style:#} {text}\n"),
    };
    // In one piece: a launcher may be speaking, too. Where it can't be printed there is nobody to tell.
    let _ = stderr().write_all(line.as_bytes());
}
