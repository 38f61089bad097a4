//! The command line.

pub mod result_path;

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::Parser;
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use self::result_path::default_result_path;
use crate::error::Failure;
use crate::plan::cluster::Merging;
use crate::sweep::{Method, SweepSettings};

/// Solves unilateral contact problems by domain decomposition after J. Daněk.
#[derive(Clone, Debug, PartialEq, Parser, Serialize, JsonSchema)]
#[schemars(description = "The options of a run.")]
#[command(
    version,
    after_help = "Examples:\n  contact-dd-partition --example granite -n 8 -o granite.h5\n  \
                  mpirun -n 2 contact-dd-mpi granite.h5\n  \
                  mpirun -n 4 contact-dd-mpi problem.h5 -o out.vtkhdf --report report.json\n  \
                  contact-dd-mpi --check problem.h5\n\n\
                  Exit codes: 0 converged, 2 bad input, 3 not converged (results are written), \
                  4 a body can move freely, 5 the output can't be written, 6 interrupted by a signal, 1 anything else."
)]
pub struct Settings {
    /// Problem file, made by contact-dd-partition.
    #[serde(serialize_with = "as_text")]
    #[schemars(with = "String")]
    pub problem: PathBuf,
    /// Result file [default: the problem's name with the extension vtkhdf].
    #[arg(short, long, value_name = "FILE")]
    #[serde(serialize_with = "as_optional_text")]
    #[schemars(with = "Option<String>")]
    pub output: Option<PathBuf>,
    /// Write the report as JSON, too.
    #[arg(long, value_name = "FILE")]
    #[serde(serialize_with = "as_optional_text")]
    #[schemars(with = "Option<String>")]
    pub report: Option<PathBuf>,
    /// How the interface problem is solved.
    #[arg(long, value_enum, default_value_t = Method::Newton)]
    pub method: Method,
    /// Residual of the interface problem, relative to the terms it is a sum of, at which sweeps end.
    #[arg(long, default_value_t = 1e-10, value_parser = positive)]
    pub tolerance: f64,
    /// Most sweeps [default: depends on the method].
    #[arg(long, value_name = "N")]
    pub max_sweeps: Option<usize>,
    /// Relaxation of picard [default: found automatically; 1 is the paper's (18) to the letter].
    #[arg(long, value_name = "THETA", value_parser = positive)]
    pub relaxation: Option<f64>,
    /// Threads of each rank.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: u16,
    /// Write a checkpoint after every N sweeps, too, and not only where a signal stops them.
    #[arg(long, value_name = "N")]
    pub checkpoint_every: Option<NonZeroUsize>,
    /// Go on from the last checkpoint of the same run, if there is one.
    #[arg(long)]
    pub restart: bool,
    /// Leave stresses out: neither recovered nor written.
    #[arg(long)]
    pub no_stress: bool,
    /// Validate the problem file and say what the scene holds, without solving.
    #[arg(long)]
    pub check: bool,
    /// Print nothing but warnings and errors.
    #[arg(short, long)]
    pub quiet: bool,
}

impl Settings {
    /// The result file.
    pub fn result_path(&self) -> PathBuf {
        self.output
            .clone()
            .unwrap_or_else(|| default_result_path(&self.problem))
    }

    /// The same with the name of the result file.
    #[must_use]
    pub fn resolved(&self) -> Self {
        Self {
            output: Some(self.result_path()),
            ..self.clone()
        }
    }

    /// Checks that the results don't replace the problem.
    ///
    /// # Errors
    /// One of the outputs is the problem file or the other output.
    pub fn check_paths(&self) -> Result<(), Failure> {
        let result = self.result_path();
        let outputs = [
            ("--output", Some(&result)),
            ("--report", self.report.as_ref()),
        ];
        for (option, path) in outputs {
            if path.is_some_and(|path| same_file(path, &self.problem)) {
                return Err(Failure::input(format!(
                    "{option} {}: that is the problem file; expected another name",
                    self.problem.display()
                )));
            }
        }
        if self
            .report
            .as_ref()
            .is_some_and(|report| same_file(report, &result))
        {
            return Err(Failure::input(format!(
                "--report {}: that is the result file; expected another name",
                result.display()
            )));
        }
        Ok(())
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

    /// What becomes of contact when Schur complements are merged.
    pub fn merging(&self) -> Merging {
        self.method.merging()
    }

    /// The settings as they were resolved, by name, for people.
    pub fn in_words(&self) -> Vec<(&'static str, String)> {
        let mut list = vec![
            ("method", self.method.name().to_string()),
            ("tolerance", format!("{:e}", self.tolerance)),
        ];
        if let Some(n) = self.max_sweeps {
            list.push(("sweeps", format!("at most {n}")));
        }
        if let Some(theta) = self.relaxation {
            list.push(("relaxation", theta.to_string()));
        }
        if let Some(n) = self.checkpoint_every {
            list.push(("checkpoint", format!("every {n} sweeps")));
        }
        if self.no_stress {
            list.push(("stress", "left out".to_string()));
        }
        list.push(("result", self.result_path().display().to_string()));
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

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err("expected a positive number".into()),
    }
}
