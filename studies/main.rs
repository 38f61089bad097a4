//! Studies of the program, each of which writes a page of docs/: `scripts/stress`, `scripts/validate` and
//! `scripts/accuracy` run them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a study that can't go on has failed"
)]

extern crate contact_dd_trials as support;

mod accuracy;
mod iterations;
mod record;
mod stability;
mod validation;

use std::process::{Command, ExitCode};

use clap::Parser;

#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    study: Study,
    /// Cargo adds it.
    #[arg(long, hide = true, global = true)]
    bench: bool,
}

#[derive(clap::Subcommand)]
enum Study {
    /// Runs scenes that are hard on the solver and says what became of each.
    Stability(stability::Arguments),
    /// Compares solutions with exact answers on finer and finer meshes.
    Validation(validation::Arguments),
    /// Measures run time against error on finer and finer meshes.
    Accuracy(accuracy::Arguments),
    /// Counts the iterations of the interface solver between more and more clusters.
    Iterations(iterations::Arguments),
    /// Runs random scenes of all kinds and writes a line on each.
    Record(record::Arguments),
    /// Says in what a record differs from an older one.
    Compare(record::compare::Arguments),
}

/// Date and commit of a measured page, in the words of all of them.
fn measured() -> String {
    let printed = |command: &mut Command| match command.output() {
        Ok(output) => String::from_utf8_lossy(&output.stdout).trim().to_owned(),
        Err(_) => "unknown".to_owned(),
    };
    let commit = [
        "describe",
        "--always",
        "--dirty",
        "--exclude=*",
        "--abbrev=8",
    ];
    format!(
        "Measured on {} at commit {}",
        printed(Command::new("date").arg("+%F")),
        printed(Command::new("git").args(commit))
    )
}

fn main() -> ExitCode {
    match Arguments::parse().study {
        Study::Stability(arguments) => stability::run(&arguments),
        Study::Validation(arguments) => validation::run(&arguments),
        Study::Accuracy(arguments) => accuracy::run(&arguments),
        Study::Iterations(arguments) => iterations::run(&arguments),
        Study::Record(arguments) => record::run(&arguments),
        Study::Compare(arguments) => record::compare::run(&arguments),
    }
}
