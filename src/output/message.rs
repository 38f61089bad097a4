//! Errors and warnings on stderr, in the format of the log.

use std::env;
use std::io::stderr;

use anstream::ColorChoice;
use contact_dd_partition::message;

use super::event::Event;
use crate::settings::command_line::LogFormat;

/// Prints why the program ends with `exit_code`.
pub fn error(log: LogFormat, exit_code: u8, message: &str) {
    match log {
        LogFormat::Text => message::error(message),
        // Where it can't be printed there is nobody to tell.
        LogFormat::Json => {
            let _ = Event::Error { exit_code, message }.write(stderr());
        }
    }
}

/// Prints what the user should know.
pub fn warning(log: LogFormat, message: &str) {
    match log {
        LogFormat::Text => message::warning(message),
        LogFormat::Json => {
            let _ = Event::Warning { message }.write(stderr());
        }
    }
}

/// Leaves colours out of everything that is printed, unless the environment insists on them.
pub fn without_colours() {
    let forced = env::var_os("CLICOLOR_FORCE").is_some_and(|value| value != "0");
    if !forced {
        ColorChoice::Never.write_global();
    }
}
