//! The settings of a run.
//!
//! [`command_line`] parses options; the problem file may hold settings, too, over which options take precedence.
//! [`Origins`] records the origin of each.

pub mod command_line;

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use contact_dd_partition::solver::{Method, Positive, SolverSettings};
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use self::command_line::{CommandLine, InterfaceMethod, LogFormat};
use crate::error::Failure;
use crate::plan::choice::SolverRequest;

/// Relative residual of the interface problem at which sweeps end.
pub const DEFAULT_TOLERANCE: f64 = 1e-10;

/// The settings of a run, as the report shows them: `None` if the method decides.
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
    /// Further destination of the report.
    #[serde(serialize_with = "as_optional_text")]
    #[schemars(with = "Option<String>")]
    pub report: Option<PathBuf>,
    /// Method for the interface problem.
    pub method: Method,
    /// Relative residual of the interface problem below which sweeps stop.
    pub tolerance: f64,
    /// Most sweeps.
    pub max_sweeps: Option<usize>,
    /// Relaxation of picard; 1 is the paper's (18) to the letter.
    pub relaxation: Option<f64>,
    /// Solver of the linear interface problem; by default the faster one.
    pub interface: Option<InterfaceMethod>,
    /// Threads of each rank.
    pub threads: u16,
    /// True if stresses are left out: neither recovered nor written.
    pub no_stress: bool,
    /// True to continue after the load steps that a stopped run finished.
    pub restart: bool,
    /// True to look for another solution where there is friction.
    pub second_start: bool,
    /// True to validate the problem file and solve nothing.
    pub check: bool,
    /// True to print nothing but warnings and errors.
    pub quiet: bool,
    /// Format of the log.
    pub log: LogFormat,
    /// Origin of each of these.
    #[serde(skip)]
    pub from: Origins,
}

impl Settings {
    /// The settings of the command line, else those of the problem file, else the defaults.
    pub fn new(command_line: &CommandLine, problem: &SolverSettings) -> Self {
        let mut from = Origins::default();
        let CommandLine { solver, run, .. } = command_line;
        let tolerance = from.choose("tolerance", &solver.tolerance, &problem.tolerance);
        let relaxation = from.choose("relaxation", &solver.relaxation, &problem.relaxation);
        let path = command_line.problem();
        Self {
            method: from
                .choose("method", &solver.method, &problem.method)
                .unwrap_or(Method::Newton),
            tolerance: tolerance.map_or(DEFAULT_TOLERANCE, Positive::value),
            max_sweeps: from.choose("max_sweeps", &solver.max_sweeps, &problem.max_sweeps),
            relaxation: relaxation.map(Positive::value),
            no_stress: from
                .choose("no_stress", &solver.no_stress, &problem.no_stress)
                .unwrap_or(false),
            output: from
                .choose("output", &run.output, &None)
                .unwrap_or_else(|| match run.study {
                    Some(_) => path.with_extension("study.json"),
                    None => default_result_path(&path),
                }),
            report: from.choose("report", &run.report, &None),
            log: from.choose("log", &run.log, &None).unwrap_or_default(),
            quiet: from
                .choose("quiet", &run.quiet.then_some(true), &None)
                .unwrap_or(false),
            interface: from.choose("interface", &run.interface, &None),
            threads: from
                .choose("threads", &run.threads, &None)
                .map_or(1, u16::from),
            restart: run.restart,
            second_start: run.second_start,
            check: command_line.check,
            problem: path,
            from,
        }
    }

    /// Checks that no output would overwrite an input or another output.
    ///
    /// # Errors
    /// One of the outputs is the problem file or the other output.
    pub fn check_paths(&self) -> Result<(), Failure> {
        let refuse = |option: &str, path: &Path, what: &str| {
            let path = path.display();
            let message =
                format!("{option} {path}: that is the {what} file; expected another name");
            Err(Failure::input(message))
        };
        if same_file(&self.output, &self.problem) {
            return refuse("--output", &self.problem, "problem");
        }
        match &self.report {
            Some(report) if same_file(report, &self.problem) => {
                refuse("--report", &self.problem, "problem")
            }
            Some(report) if same_file(report, &self.output) => refuse("--report", report, "result"),
            _ => Ok(()),
        }
    }

    /// The settings of the sweeps.
    pub fn sweeps(&self) -> SweepSettings {
        SweepSettings {
            method: self.method,
            tolerance: self.tolerance,
            max_sweeps: self.max_sweeps,
            relaxation: self.relaxation,
            second_start: self.second_start,
        }
    }

    /// The warning of a setting given for this run that its method doesn't use.
    pub fn unused(&self) -> Option<String> {
        let is_asked_for = self.from.of("relaxation") == Origin::CommandLine;
        (is_asked_for && self.method != Method::Picard).then(|| {
            format!(
                "--relaxation goes with --method picard; {} doesn't use it",
                self.method.name()
            )
        })
    }

    /// The user's choices of solvers.
    pub fn solver_request(&self) -> SolverRequest {
        let interface = self.interface;
        SolverRequest {
            method: self.method,
            iterative: interface.map(|method| method == InterfaceMethod::Iterative),
            second_start: self.second_start,
        }
    }

    /// The settings by name, as text; those that differ from the default with their origin.
    pub fn in_words(&self) -> Vec<(&'static str, String)> {
        let entry = |title, name: &str, value: String| match self.from.of(name) {
            Origin::Default => (title, value),
            origin => (title, format!("{value} ({origin})")),
        };
        let mut list = vec![
            entry("method", "method", self.method.name().to_owned()),
            entry("tolerance", "tolerance", format!("{:e}", self.tolerance)),
        ];
        if let Some(n) = self.max_sweeps {
            list.push(entry("sweeps", "max_sweeps", format!("at most {n}")));
        }
        if let Some(theta) = self.relaxation {
            list.push(entry("relaxation", "relaxation", theta.to_string()));
        }
        if self.no_stress {
            list.push(entry("stress", "no_stress", "left out".to_owned()));
        }
        if let Some(report) = &self.report {
            list.push(entry("report", "report", report.display().to_string()));
        }
        list.push(entry("result", "output", self.output.display().to_string()));
        list
    }
}

/// The settings of the sweeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepSettings {
    /// Method.
    pub method: Method,
    /// Residual, relative to the terms that it is a sum of, at which sweeps end.
    pub tolerance: f64,
    /// Most sweeps; `None` for the method's own limit.
    pub max_sweeps: Option<usize>,
    /// θ of `picard`; `None` to find one.
    pub relaxation: Option<f64>,
    /// True to look for another solution where there is friction.
    pub second_start: bool,
}

/// The origin of a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub enum Origin {
    /// The command line.
    #[serde(rename = "command line")]
    CommandLine,
    /// `/settings` of the problem file.
    #[serde(rename = "problem file")]
    ProblemFile,
    /// Neither.
    #[serde(rename = "default")]
    Default,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::CommandLine => "command line",
            Self::ProblemFile => "problem file",
            Self::Default => "default",
        })
    }
}

/// Origin of each setting, by its name in the report.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Origins(BTreeMap<&'static str, Origin>);

impl Origins {
    /// The value of a setting from the command line, else from the problem file.
    fn choose<T: Clone>(
        &mut self,
        name: &'static str,
        command_line: &Option<T>,
        problem_file: &Option<T>,
    ) -> Option<T> {
        let origin = match (command_line, problem_file) {
            (Some(_), _) => Origin::CommandLine,
            (None, Some(_)) => Origin::ProblemFile,
            (None, None) => Origin::Default,
        };
        self.0.insert(name, origin);
        command_line.clone().or_else(|| problem_file.clone())
    }

    /// Origin of the setting called `name`.
    pub fn of(&self, name: &str) -> Origin {
        self.0.get(name).copied().unwrap_or(Origin::Default)
    }
}

/// Default result file for `problem`: the same stem with the extension `vtkhdf`.
///
/// A problem file with this extension gets a result file of another name, so that it isn't overwritten.
fn default_result_path(problem: &Path) -> PathBuf {
    let result = problem.with_extension("vtkhdf");
    match result == problem {
        true => problem.with_extension("result.vtkhdf"),
        false => result,
    }
}

/// True if two paths name the same file.
fn same_file(a: &Path, b: &Path) -> bool {
    a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// A path as text, even if it isn't valid Unicode.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_result_lies_beside_its_problem() {
        for (problem, result) in [
            ("demo/problem.h5", "demo/problem.vtkhdf"),
            ("problem", "problem.vtkhdf"),
            ("granite.8.h5", "granite.8.vtkhdf"),
            ("granite.vtkhdf", "granite.result.vtkhdf"),
        ] {
            assert_eq!(default_result_path(Path::new(problem)), Path::new(result));
        }
    }
}
