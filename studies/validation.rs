//! Scenes with exact answers, refined further than among the tests.
//!
//! `scripts/validate` runs it and writes docs/validation.md.

mod document;

use std::path::PathBuf;
use std::process::ExitCode;

use crate::support::validation::{Measured, cases};

/// Compares solutions with exact answers on finer and finer meshes.
#[derive(clap::Args)]
pub struct Arguments {
    /// Runs the cases alone whose titles contain this.
    #[arg(long, value_name = "TEXT", conflicts_with = "markdown")]
    only: Option<String>,
    /// Writes the results as markdown.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Writes the errors on all meshes, to be drawn.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> ExitCode {
    let (mut chapters, mut lines) = (String::new(), String::new());
    let mut kept = true;
    let mut all = Vec::new();
    for case in cases() {
        if (arguments.only.as_ref()).is_some_and(|only| !case.title.contains(only)) {
            continue;
        }
        let ran: Vec<Vec<Measured>> = (case.families.iter())
            .map(|family| family.measure(family.meshes[1]))
            .collect();
        let pairs = case.families.iter().zip(&ran);
        let broken = pairs.flat_map(|(family, all)| {
            let found = family.faults(all).into_iter();
            found.map(|fault| format!("{}, {fault}", family.name))
        });
        let broken: Vec<String> = broken.collect();
        let chapter = document::chapter(&case, &ran, &broken);
        print!("{chapter}");
        chapters += &chapter;
        lines += &document::line(&case, &ran, &broken);
        all.push(document::errors(&case, &ran));
        kept &= broken.is_empty();
    }
    if let Some(path) = &arguments.markdown {
        let text = document::whole(&lines, &chapters);
        std::fs::write(path, text).unwrap();
    }
    if let Some(path) = &arguments.json {
        std::fs::write(path, serde_json::Value::from(all).to_string()).unwrap();
    }
    match kept {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}
