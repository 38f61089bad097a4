//! Compares two records.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::examples;
use crate::support::stress::record::Record;
use crate::support::stress::record::comparison::Comparison;

/// Says in what a record differs from an older one; fails where any scene is worse.
#[derive(clap::Args)]
pub struct Arguments {
    /// The record from before, or the folder of results.
    old: PathBuf,
    /// The one of now.
    new: PathBuf,
}

pub fn run(arguments: &Arguments) -> ExitCode {
    let Arguments { old, new } = arguments;
    let is_good = match old.is_dir() {
        true => examples::agree(old, new),
        false => {
            let comparison = Comparison::new(&read(old), &read(new));
            print!("{comparison}");
            !comparison.is_worse()
        }
    };
    match is_good {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}

fn read(path: &Path) -> Record {
    let text =
        std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.parse()
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
