//! The settings of a run, resolved.
//!
//! [`command_line`] parses options, [`mod@file`] reads those of `--settings`, the problem file may hold
//! some, and [`given`] lets the first that says something win; [`origin`] remembers which it was.

pub mod command_line;
pub mod file;
pub mod given;
pub mod origin;
pub mod result_path;

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use self::command_line::LogFormat;
use self::origin::{Origin, Origins};
use crate::error::Failure;
use crate::plan::cluster::Merging;
use crate::sweep::{Method, SweepSettings, merging};

/// Relative residual of the interface problem at which sweeps end.
pub const DEFAULT_TOLERANCE: f64 = 1e-10;

/// The settings of a run, as the report shows them: `None` is what the method decides.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(description = "The options of a run.")]
pub struct Settings {
    /// Problem file.
    #[serde(serialize_with = "as_text")]
    #[schemars(with = "String")]
    pub problem: PathBuf,
    /// Result file.
    #[serde(serialize_with = "as_text")]
    #[schemars(with = "String")]
    pub output: PathBuf,
    /// Where the report goes as well.
    #[serde(serialize_with = "as_optional_text")]
    #[schemars(with = "Option<String>")]
    pub report: Option<PathBuf>,
    /// How the interface problem is solved.
    pub method: Method,
    /// Residual of the interface problem, relative to the terms it is a sum of, at which sweeps end.
    pub tolerance: f64,
    /// Most sweeps.
    pub max_sweeps: Option<usize>,
    /// Relaxation of picard; 1 is the paper's (18) to the letter.
    pub relaxation: Option<f64>,
    /// Threads of each rank.
    pub threads: u16,
    /// Whether stresses are left out: neither recovered nor written.
    pub no_stress: bool,
    /// Whether to validate the problem file and solve nothing.
    pub check: bool,
    /// Whether to print nothing but warnings and errors.
    pub quiet: bool,
    /// What is printed.
    pub log: LogFormat,
    /// The settings file.
    #[serde(serialize_with = "as_optional_text")]
    #[schemars(with = "Option<String>")]
    pub settings: Option<PathBuf>,
    /// Where each of these came from.
    #[serde(skip)]
    pub from: Origins,
}

impl Settings {
    /// What a command line of these words settles alone.
    #[cfg(test)]
    pub fn of_options(words: &[&str]) -> Self {
        use clap::Parser;
        let words = ["contact-dd-mpi"].iter().chain(words);
        let command_line = command_line::CommandLine::parse_from(words);
        let given = given::Given::read(command_line).unwrap();
        given.resolve(&Default::default())
    }

    /// Checks that the results replace nothing that they are made from.
    ///
    /// # Errors
    /// One of the outputs is the problem file, the settings file or the other output.
    pub fn check_paths(&self) -> Result<(), Failure> {
        let outputs = [
            ("--output", Some(&self.output)),
            ("--report", self.report.as_ref()),
        ];
        let inputs = [
            ("problem", Some(&self.problem)),
            ("settings", self.settings.as_ref()),
        ];
        let refuse = |option: &str, path: &Path, what: &str| {
            let path = path.display();
            let message =
                format!("{option} {path}: that is the {what} file; expected another name");
            Err(Failure::input(message))
        };
        for (option, output) in outputs {
            for (what, input) in inputs {
                if let (Some(output), Some(input)) = (output, input)
                    && same_file(output, input)
                {
                    return refuse(option, input, what);
                }
            }
        }
        match &self.report {
            Some(report) if same_file(report, &self.output) => refuse("--report", report, "result"),
            _ => Ok(()),
        }
    }

    /// What the sweeps need to know.
    pub fn sweeps(&self) -> SweepSettings {
        SweepSettings {
            method: self.method,
            tolerance: self.tolerance,
            max_sweeps: self.max_sweeps,
            relaxation: self.relaxation,
        }
    }

    /// What was asked for in this run and isn't used, in words.
    pub fn unused(&self) -> Option<String> {
        let is_asked_for = self.from.of("relaxation") == Origin::CommandLine;
        (is_asked_for && self.method != Method::Picard).then(|| {
            format!(
                "--relaxation goes with --method picard; {} doesn't use it",
                self.method.name()
            )
        })
    }

    /// What becomes of contact when Schur complements are merged.
    pub fn merging(&self) -> Merging {
        merging(self.method)
    }

    /// The settings by name, for people: those that aren't the default with what settled them.
    pub fn in_words(&self) -> Vec<(&'static str, String)> {
        let settled = |name: &str, value: String| match self.from.of(name) {
            Origin::Default => value,
            origin => format!("{value} ({origin})"),
        };
        let mut list = vec![
            ("method", settled("method", self.method.name().to_string())),
            (
                "tolerance",
                settled("tolerance", format!("{:e}", self.tolerance)),
            ),
        ];
        if let Some(n) = self.max_sweeps {
            list.push(("sweeps", settled("max_sweeps", format!("at most {n}"))));
        }
        if let Some(theta) = self.relaxation {
            list.push(("relaxation", settled("relaxation", theta.to_string())));
        }
        if self.no_stress {
            list.push(("stress", settled("no_stress", "left out".to_string())));
        }
        if let Some(file) = &self.settings {
            list.push(("settings", file.display().to_string()));
        }
        let path = |name: &str, path: &Path| settled(name, path.display().to_string());
        if let Some(report) = &self.report {
            list.push(("report", path("report", report)));
        }
        list.push(("result", path("output", &self.output)));
        list
    }
}

/// Whether two paths lead to one place.
fn same_file(a: &Path, b: &Path) -> bool {
    a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// A path of whatever bytes.
fn as_text<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}

fn as_optional_text<S: Serializer>(
    path: &Option<PathBuf>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let text = path.as_ref().map(|path| path.display().to_string());
    text.serialize(serializer)
}
