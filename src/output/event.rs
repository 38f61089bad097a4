//! Events of a run, of which the log consists: one JSON object in each line for programs, lines of text for people;
//! errors and warnings in the log's format.

use std::env;
use std::io::{self, Write, stderr};

use anstream::ColorChoice;
use contact_dd_partition::message;
use contact_dd_partition::problem::Catalog;
use serde::Serialize;

use super::report::Report;
use crate::settings::command_line::LogFormat;
use crate::settings::{Origins, Settings};
use crate::sweep::SweepRecord;

/// The problem, and the ranks and threads that solve it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary<'a> {
    /// Version of the program.
    pub version: &'static str,
    /// The problem file.
    pub problem: String,
    /// Title of the scene.
    pub title: &'a str,
    /// Number of degrees of freedom.
    pub dofs: usize,
    /// Number of degrees of freedom on Γ.
    pub interface_dofs: usize,
    /// Number of subdomains.
    pub subdomains: usize,
    /// Number of pairs, or groups, in contact.
    pub contact_pairs: usize,
    /// Number of contact constraints.
    pub contact_conditions: usize,
    /// Number of tangential constraints, those with friction.
    pub conditions_with_friction: usize,
    /// Number of ranks.
    pub ranks: usize,
    /// Number of threads of each rank.
    pub threads: usize,
    /// Reason for the choice of the solver of contact constraints, as text.
    pub interface_choice: &'a str,
}

/// A load step that begins.
#[derive(Clone, Debug, Serialize)]
pub struct Step<'a> {
    /// The number, from 1.
    pub step: usize,
    /// Number of load steps.
    pub steps: usize,
    /// The name.
    pub name: &'a str,
    /// The time on the load path.
    pub time: f64,
    /// The bodies and contacts that are absent in this step.
    #[serde(skip)]
    pub absent: Vec<String>,
    /// Estimated time of this load step and the following ones (s); none before the first one is solved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds_left: Option<f64>,
}

/// Estimated cost of a solution.
#[derive(Clone, Debug, Serialize)]
pub struct Costs<'a> {
    /// Memory of all ranks (bytes).
    pub memory_bytes: f64,
    /// Memory of the largest rank (bytes).
    pub largest_rank_memory_bytes: f64,
    /// Memory available on their hosts (bytes).
    pub available_bytes: f64,
    /// Arithmetic of all ranks (flop).
    pub flops: f64,
    /// Arithmetic of the busiest rank (flop).
    pub busiest_rank_flops: f64,
    /// Reason for the choice of the solver of contact constraints, as text.
    pub interface_choice: &'a str,
    /// Estimated number of coarse unknowns of the iterative interface solver; none with the direct one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coarse_dofs: Option<usize>,
}

/// The end of a run.
#[derive(Clone, Debug, Serialize)]
pub struct Finished<'a> {
    /// The exit code of the program.
    pub exit_code: u8,
    /// The result file.
    pub result: String,
    /// Reason why the sweeps ended, as text.
    pub reason: &'a str,
    /// The report.
    pub report: &'a Report,
    /// The problem, for the units of the numbers.
    #[serde(skip)]
    pub catalog: &'a Catalog,
}

/// A line of the log; `event` names its kind. Numbers that aren't finite are `null`.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum Event<'a> {
    /// The problem, and the ranks and threads that solve it.
    Problem(&'a Summary<'a>),
    /// The settings of the run.
    Settings {
        /// The settings, as in the report.
        settings: &'a Settings,
        /// The origin of each setting.
        settings_from: &'a Origins,
    },
    /// The start of a phase of the run.
    Phase {
        /// The name.
        phase: &'static str,
        /// Number of its steps, if known.
        #[serde(skip_serializing_if = "Option::is_none")]
        steps: Option<usize>,
        /// Time since the start of the run (s).
        seconds: f64,
    },
    /// The start of a load step, if the problem has any.
    Step(&'a Step<'a>),
    /// Progress of a phase, once a second.
    Progress {
        /// The name of the phase.
        phase: &'static str,
        /// Fraction done of the phase, or of the iterative solution of a linear system in it.
        done: f64,
        /// Time since the start of the run (s).
        seconds: f64,
        /// Estimated remaining time (s).
        #[serde(skip_serializing_if = "Option::is_none")]
        seconds_left: Option<f64>,
    },
    /// The end of a sweep.
    Sweep(&'a SweepRecord),
    /// A warning.
    Warning {
        /// Text of the warning.
        message: &'a str,
    },
    /// Estimated cost of a solution; with `--check` it replaces `finished`.
    Check(&'a Costs<'a>),
    /// The end of the run, with its results written.
    Finished(&'a Finished<'a>),
    /// The failure of the run; on stderr.
    Error {
        /// The exit code of the program.
        exit_code: u8,
        /// The message: place of the failure and expectation.
        message: &'a str,
    },
}

impl Event<'_> {
    /// Writes the event as a line of JSON.
    ///
    /// # Errors
    /// `out` can't be written.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        let line = serde_json::to_string(self)? + "\n";
        // One write for the whole line, because a launcher may write at the same time.
        out.write_all(line.as_bytes())
    }
}

/// Prints the error with which the program ends, and its `exit_code`.
pub fn error(log: LogFormat, exit_code: u8, message: &str) {
    match log {
        LogFormat::Text => message::error(message),
        // An error in printing the error can't be reported.
        LogFormat::Json => {
            let _ = Event::Error { exit_code, message }.write(stderr());
        }
    }
}

/// Prints a warning.
pub fn warning(log: LogFormat, message: &str) {
    match log {
        LogFormat::Text => message::warning(message),
        LogFormat::Json => {
            let _ = Event::Warning { message }.write(stderr());
        }
    }
}

/// Turns colours off in all output, unless the environment forces them.
pub fn without_colours() {
    let forced = env::var_os("CLICOLOR_FORCE").is_some_and(|value| value != "0");
    if !forced {
        ColorChoice::Never.write_global();
    }
}
