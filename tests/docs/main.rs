//! The documents: their pages, and the gallery of the built-in scenes.

#![expect(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod documents;
mod gallery;
#[allow(
    dead_code,
    reason = "every test binary takes what it needs and leaves the rest"
)]
#[path = "../support/process.rs"]
mod process;

use std::panic;
use std::process::ExitCode;

use libtest_mimic::{Arguments, Trial};

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    // The harness shows the message; this adds the location.
    panic::set_hook(Box::new(|panic| {
        panic.location().inspect(|place| eprintln!("at {place}:"));
    }));
    let mut trials = documents::trials();
    trials.extend(gallery::trials());
    libtest_mimic::run(&arguments, trials).exit_code()
}

fn trial(name: impl Into<String>, case: impl FnOnce() + Send + 'static) -> Trial {
    Trial::test(name, move || {
        case();
        Ok(())
    })
}
