//! Messages of both programs: results on stdout, errors and warnings on stderr, in colour on a terminal.

use std::io::{self, ErrorKind, Write, stderr};

use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};

use crate::error::OutputError;
use crate::explanation::with_name;

/// Style of the word "error:".
pub const ERROR: Style = AnsiColor::Red.on_default().bold();

/// Style of the word "warning:".
pub const WARNING: Style = AnsiColor::Yellow.on_default().bold();

/// Prints on stdout. A closed pipe, as with `| head`, isn't an error.
///
/// # Errors
/// Other write errors, as on a full disk.
pub fn print(text: &str) -> Result<(), OutputError> {
    let mut stdout = anstream::stdout();
    ignoring_closed_pipe((stdout.write_all(text.as_bytes())).and_then(|()| stdout.flush()))
}

/// The result of a write to stdout; a closed pipe isn't an error, see [`print()`].
///
/// # Errors
/// Other write errors.
pub fn ignoring_closed_pipe(written: io::Result<()>) -> Result<(), OutputError> {
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            let (path, reason) = ("stdout".into(), error.to_string());
            Err(OutputError { path, reason })
        }
        _ => Ok(()),
    }
}

/// Prints an error, with the name of its explanation.
pub fn error(text: &str) {
    print_on_stderr(ERROR, "error:", text);
}

/// Prints a warning, with the name of its explanation.
pub fn warning(text: &str) {
    print_on_stderr(WARNING, "warning:", text);
}

fn print_on_stderr(style: Style, word: &str, text: &str) {
    let text = with_name(text);
    let line = match AutoStream::choice(&stderr()) {
        ColorChoice::Never => format!("{word} {text}\n"),
        _ => format!("{style}{word}{style:#} {text}\n"),
    };
    // In a single write, as a launcher may print at the same time. An error on stderr can't be reported.
    let _ = stderr().write_all(line.as_bytes());
}
