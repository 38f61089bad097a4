//! The events of a run, of which the log is made: one JSON object in each line for programs, lines of text for people;
//! errors and warnings in whichever format the log has.

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
    /// Number of those on Γ.
    pub interface_dofs: usize,
    /// Number of subdomains.
    pub subdomains: usize,
    /// Number of pairs, or groups, in contact.
    pub contact_pairs: usize,
    /// Number of contact conditions.
    pub contact_conditions: usize,
    /// Number of those with friction.
    pub conditions_with_friction: usize,
    /// Number of ranks.
    pub ranks: usize,
    /// Number of threads of each rank.
    pub threads: usize,
    /// Reason for the choice of the solver of contact conditions, in words.
    pub interface_choice: &'a str,
}

/// A load step that begins.
#[derive(Clone, Debug, Serialize)]
pub struct Step<'a> {
    /// The number, from 1.
    pub step: usize,
    /// Number of all.
    pub steps: usize,
    /// The name.
    pub name: &'a str,
    /// The time on the load path.
    pub time: f64,
    /// The bodies and contacts that are absent in it.
    #[serde(skip)]
    pub absent: Vec<String>,
    /// Time that it and those to come take, about (s); none before the first one is solved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds_left: Option<f64>,
}

/// Estimated cost of solving.
#[derive(Clone, Debug, Serialize)]
pub struct Costs<'a> {
    /// Memory of all ranks (bytes).
    pub memory_bytes: f64,
    /// Memory of the largest rank (bytes).
    pub largest_rank_memory_bytes: f64,
    /// Memory that their hosts have left (bytes).
    pub available_bytes: f64,
    /// Arithmetic of all ranks (flop).
    pub flops: f64,
    /// Arithmetic of the busiest rank (flop).
    pub busiest_rank_flops: f64,
    /// Reason for the choice of the solver of contact conditions, in words.
    pub interface_choice: &'a str,
    /// Unknowns of the coarse problem of the iterative interface solver, about; none where it is direct.
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
    /// Reason for which the sweeps ended, in words.
    pub reason: &'a str,
    /// The report.
    pub report: &'a Report,
    /// The problem, whose units its numbers have.
    #[serde(skip)]
    pub catalog: &'a Catalog,
}

/// One line of the log; `event` names its kind. Numbers that aren't finite are `null`.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum Event<'a> {
    /// The problem, and the ranks and threads that solve it.
    Problem(&'a Summary<'a>),
    /// The settings of the run.
    Settings {
        /// The settings, as in the report.
        settings: &'a Settings,
        /// The origin of each.
        settings_from: &'a Origins,
    },
    /// The run comes to another phase.
    Phase {
        /// The name.
        phase: &'static str,
        /// Number of its steps, where that is known.
        #[serde(skip_serializing_if = "Option::is_none")]
        steps: Option<usize>,
        /// Since the run began (s).
        seconds: f64,
    },
    /// A load step begins, where the problem has any.
    Step(&'a Step<'a>),
    /// So much of a phase is done, once a second.
    Progress {
        /// The name.
        phase: &'static str,
        /// The share of it, or of the linear system that is iterated in it.
        done: f64,
        /// Since the run began (s).
        seconds: f64,
        /// Time that the rest of it takes, about (s).
        #[serde(skip_serializing_if = "Option::is_none")]
        seconds_left: Option<f64>,
    },
    /// A sweep is done.
    Sweep(&'a SweepRecord),
    /// A warning.
    Warning {
        /// Text of the warning.
        message: &'a str,
    },
    /// Estimated cost of solving; in place of `finished` where it was `--check`.
    Check(&'a Costs<'a>),
    /// The run has ended and its results are written.
    Finished(&'a Finished<'a>),
    /// The run has failed; on stderr.
    Error {
        /// The exit code of the program.
        exit_code: u8,
        /// Place, and expectation.
        message: &'a str,
    },
}

impl Event<'_> {
    /// Writes the event as a line.
    ///
    /// # Errors
    /// `out` can't be written.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        let line = serde_json::to_string(self)? + "\n";
        // In one piece: a launcher may be speaking, too.
        out.write_all(line.as_bytes())
    }
}

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
