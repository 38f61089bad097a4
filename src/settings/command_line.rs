//! The command line.

use std::num::NonZeroU16;
use std::path::PathBuf;

use clap::{Args, CommandFactory, Parser, ValueEnum, ValueHint};
use contact_dd_partition::explanation::Explanation;
use contact_dd_partition::manual::{Answer, Document, Manual};
use contact_dd_partition::solver::SolverSettings;
use serde::Serialize;

/// Text of the manual in addition to the options.
pub const MANUAL: Manual = Manual {
    examples: &[
        (
            "mpirun -n 2 contact-dd-mpi problem.h5",
            "solves a problem on 2 ranks; the result is problem.vtkhdf",
        ),
        (
            "contact-dd-mpi --check problem.h5",
            "validates a problem file and estimates memory and arithmetic of a run",
        ),
        (
            "mpirun -n 4 contact-dd-mpi problem.h5 -o out.vtkhdf --report report.json",
            "names the result and writes a report in JSON, too",
        ),
        (
            "srun contact-dd-mpi problem.h5 --log json",
            "solves in a batch job whose log a program reads",
        ),
    ],
    exit_codes: &[
        ("0", "converged"),
        (
            "2",
            "bad usage or bad input; the message says where and what was expected",
        ),
        ("3", "not converged; results are written and flagged"),
        (
            "4",
            "ill-posed: a body is free to move under its load; the message names body and motion",
        ),
        ("5", "the output can't be written"),
        ("6", "stopped by SIGTERM, SIGINT or SIGUSR1"),
        ("1", "anything else"),
    ],
    files: &[
        (
            "problem.h5",
            "the problem, made by contact-dd-partition or by a program of yours",
        ),
        (
            "problem.vtkhdf",
            "the result, for ParaView and h5py; it gets its name when it is complete",
        ),
    ],
    environment: &[
        ("NO_COLOR", "no colours, not even on a terminal"),
        ("CLICOLOR_FORCE", "colours wherever the output goes"),
    ],
    see_also: "contact-dd-partition",
};

/// Solves unilateral contact problems by domain decomposition after J. Daněk
#[derive(Clone, Debug, PartialEq, Parser)]
#[command(name = "contact-dd-mpi", version, max_term_width = 100,
          override_usage = "contact-dd-mpi [OPTIONS] PROBLEM\n       mpirun -n N contact-dd-mpi [OPTIONS] PROBLEM",
          after_help = MANUAL.in_short(), after_long_help = MANUAL.at_length())]
pub struct CommandLine {
    /// Problem file, made by contact-dd-partition
    #[arg(value_name = "PROBLEM", value_hint = ValueHint::FilePath,
          required_unless_present_any = ["generate", "explain"])]
    problem: Option<PathBuf>,

    /// The settings of the solution.
    #[command(flatten)]
    pub solver: SolverSettings,

    /// The settings of the run.
    #[command(flatten)]
    pub run: RunSettings,

    /// Validate the problem file, estimate memory (bytes) and arithmetic (flops) of a run, and exit
    #[arg(long, help_heading = "Running")]
    pub check: bool,

    /// Print the man page or completions for a shell
    #[arg(
        long,
        value_name = "KIND",
        exclusive = true,
        help_heading = "Documentation"
    )]
    generate: Option<Document>,

    /// Explain a message by its name, given in brackets at its end
    #[arg(
        long,
        value_name = "NAME",
        exclusive = true,
        help_heading = "Documentation"
    )]
    explain: Option<String>,
}

/// Options of a run; `None` for those that aren't given.
#[derive(Clone, Debug, Default, PartialEq, Args)]
pub struct RunSettings {
    /// Result file [default: the problem's stem + .vtkhdf]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath,
          help_heading = "Output")]
    pub output: Option<PathBuf>,

    /// Write the report to a file in JSON, too
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Output")]
    pub report: Option<PathBuf>,

    /// Format of the output [default: text]
    #[arg(long, value_name = "FORMAT", value_enum, help_heading = "Output")]
    pub log: Option<LogFormat>,

    /// Print warnings and errors only
    #[arg(short, long, help_heading = "Output")]
    pub quiet: bool,

    /// Continue a stopped run after its last finished load step
    #[arg(long, help_heading = "Running")]
    pub restart: bool,

    /// With friction: solve again from other starting points, and report whether there is another solution
    #[arg(long, help_heading = "Running")]
    pub second_start: bool,

    /// Solve the cases of a study instead, and write a table of their quantities
    #[arg(long, value_name = "CASES.json", value_hint = ValueHint::FilePath, help_heading = "Running",
          conflicts_with_all = ["restart", "report", "second_start", "check"])]
    pub study: Option<PathBuf>,

    /// Solver of the linear interface problem, for --method newton [default: the faster one, by an estimate]
    #[arg(long, value_name = "NAME", value_enum, help_heading = "Solving")]
    pub interface: Option<InterfaceMethod>,

    /// Threads of each rank [default: 1]
    #[arg(long, value_name = "N", value_parser = threads, help_heading = "Running")]
    pub threads: Option<NonZeroU16>,
}

/// Solver of the linear interface problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum InterfaceMethod {
    /// By factorization, merged up to the root
    Direct,
    /// By conjugate gradients between clusters of subdomains
    Iterative,
}

/// Format of the log.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, schemars::JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum LogFormat {
    /// Text for people
    #[default]
    Text,
    /// One JSON object in each line
    Json,
}

/// Parses a number of threads.
///
/// # Errors
/// It isn't a whole number above 0, or too large.
fn threads(text: &str) -> Result<NonZeroU16, String> {
    (text.parse()).map_err(|_| format!("expected a whole number from 1 to {}", u16::MAX))
}

impl CommandLine {
    /// Parses the arguments of this program.
    ///
    /// # Errors
    /// The arguments ask for no run, or are invalid: the answer to print.
    pub fn of_this_program() -> Result<Self, Answer> {
        let command_line = Self::try_parse().map_err(|error| Answer::of(&error))?;
        if let Some(document) = command_line.generate {
            return Err(Answer::Text(MANUAL.write(document, Self::command())));
        }
        match &command_line.explain {
            Some(name) => Err(match Explanation::named(name) {
                Ok(explanation) => Answer::Text(explanation.text()),
                Err(error) => Answer::Refusal(error.to_string()),
            }),
            None => Ok(command_line),
        }
    }

    /// The problem file.
    pub fn problem(&self) -> PathBuf {
        // The parser requires one whenever a run needs it.
        self.problem.clone().unwrap_or_default()
    }
}

impl LogFormat {
    /// The log format of the program's arguments, even if these are invalid otherwise.
    pub fn of_this_program() -> Self {
        let words: Vec<String> = std::env::args_os()
            .map(|word| word.to_string_lossy().into_owned())
            .collect();
        let json = words.windows(2).any(|two| two == ["--log", "json"])
            || words.iter().any(|word| word == "--log=json");
        match json {
            true => Self::Json,
            false => Self::Text,
        }
    }
}
