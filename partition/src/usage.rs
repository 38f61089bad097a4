//! What a program answers to a command line that asks for no work: help, or what is wrong with it.

use std::process::ExitCode;

use clap::Command;
use clap::error::ErrorKind;

use crate::manual::{Document, Manual};
use crate::message;

/// Exit code of bad usage.
pub const BAD_USAGE: u8 = 2;

/// An answer, and what the program ends with.
#[derive(Clone, Debug)]
pub enum Answer {
    /// Text for stdout, with the codes of colours.
    Text(String),
    /// What is wrong, in one line.
    Refusal(String),
}

impl Answer {
    /// The answer that stands for what the parser found: help, the version, or an error.
    pub fn of(error: &clap::Error) -> Self {
        let said = error.render();
        match error.kind() {
            ErrorKind::DisplayHelp
            | ErrorKind::DisplayVersion
            | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
                Self::Text(said.ansi().to_string())
            }
            _ => Self::Refusal(in_one_line(&said.to_string())),
        }
    }

    /// A document of a program.
    pub fn document(document: Document, command: Command, manual: &Manual) -> Self {
        Self::Text(manual.write(document, command))
    }

    /// What the program ends with.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Text(_) => ExitCode::SUCCESS,
            Self::Refusal(_) => ExitCode::from(BAD_USAGE),
        }
    }

    /// Prints the answer. Where nobody reads it, there is nobody to tell.
    pub fn print(&self) {
        use std::io::Write as _;
        match self {
            Self::Text(text) => {
                let _ = write!(anstream::stdout(), "{text}");
            }
            Self::Refusal(why) => message::error(why),
        }
    }
}

/// What the parsers of numbers say, and what they mean.
const WORDS: [(&str, &str); 6] = [
    ("invalid digit found in string", "expected a whole number"),
    (
        "cannot parse integer from empty string",
        "expected a whole number",
    ),
    (
        "number would be zero for non-zero type",
        "expected 1 or more",
    ),
    (
        "number too large to fit in target type",
        "expected a smaller number",
    ),
    ("invalid float literal", "expected a number"),
    (
        "unexpected argument '-n' found",
        "unexpected argument '-n' found; the launcher says how many ranks there are: mpirun -n N contact-dd-mpi",
    ),
];

/// What clap says but for the word "error:", the usage and where to read of it.
fn in_one_line(message: &str) -> String {
    let said = message.strip_prefix("error: ").unwrap_or(message);
    let said = said.lines().map(str::trim).take_while(|line| {
        !line.starts_with("Usage:") && !line.starts_with("For more information")
    });
    let words: Vec<&str> = said.filter(|line| !line.is_empty()).collect();
    let mut words = words.join(" ").replace(" tip: ", "; ");
    // No option takes a value that begins with a hyphen.
    if let Some(at) = words.find("; to pass '-") {
        words.truncate(at);
    }
    for (said, meant) in WORDS {
        words = words.replace(said, meant);
    }
    format!("{words} (--help tells more)")
}
