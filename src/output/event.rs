//! What `--log json` prints: one JSON object in each line.

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;

use super::report::Report;
use crate::settings::Settings;
use crate::settings::origin::Origins;

/// One line of the log; `event` names its kind. Numbers that aren't finite are `null`.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum Event<'a> {
    /// What is to be solved, and on what.
    Problem {
        /// Version of the program.
        version: &'static str,
        /// The problem file.
        problem: String,
        /// Title of the scene.
        title: &'a str,
        /// Number of degrees of freedom.
        dofs: usize,
        /// Number of those on Γ.
        interface_dofs: usize,
        /// Number of subdomains.
        subdomains: usize,
        /// Number of pairs, or groups, in contact.
        contact_pairs: usize,
        /// Number of contact conditions.
        contact_conditions: usize,
        /// Number of ranks.
        ranks: usize,
        /// Number of threads of each rank.
        threads: usize,
    },
    /// How it is to be solved.
    Settings {
        /// The settings, as in the report.
        settings: &'a Settings,
        /// What settled each.
        settings_from: &'a Origins,
    },
    /// The run comes to another phase.
    Phase {
        /// Its name.
        phase: &'static str,
        /// Number of its steps, where that is known.
        #[serde(skip_serializing_if = "Option::is_none")]
        steps: Option<usize>,
        /// Since the run began (s).
        seconds: f64,
    },
    /// A load step begins, where the problem has any.
    Step {
        /// Its number, from 1.
        step: usize,
        /// Number of all.
        steps: usize,
        /// Its name.
        name: &'a str,
        /// What it stands at on the axis of time.
        time: f64,
    },
    /// A sweep is done.
    Sweep {
        /// Its number; 0 is the bilateral start.
        sweep: usize,
        /// Relative residual of the interface problem.
        residual: f64,
        /// Number of closed contact conditions.
        active: usize,
        /// Number of conditions that opened or closed in it; the start has none.
        changed: Option<usize>,
        /// Since the sweeps began (s).
        seconds: f64,
    },
    /// What the user should know.
    Warning {
        /// In words.
        message: &'a str,
    },
    /// What solving would take; in place of `finished` where it was `--check`.
    Check {
        /// Memory of all ranks (bytes).
        memory_bytes: f64,
        /// Memory of the largest rank (bytes).
        largest_rank_memory_bytes: f64,
        /// Memory that their hosts have left (bytes).
        available_bytes: f64,
        /// Arithmetic of all ranks (flop).
        flops: f64,
        /// Arithmetic of the busiest rank (flop).
        busiest_rank_flops: f64,
    },
    /// The run has ended and its results are written.
    Finished {
        /// What the program ends with.
        exit_code: u8,
        /// The result file.
        result: String,
        /// Why the sweeps ended, in words.
        reason: &'a str,
        /// The report.
        report: &'a Report,
    },
    /// The run has failed; on stderr.
    Error {
        /// What the program ends with.
        exit_code: u8,
        /// Where, and what was expected.
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

/// A path as text, whatever its bytes.
pub fn shown(path: &Path) -> String {
    path.display().to_string()
}
