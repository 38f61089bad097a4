//! What was said of a run, by whom: the command line goes before the settings file, that one before
//! the problem file, and all before the defaults.

use std::path::PathBuf;

use contact_dd_partition::error::InputError;
use contact_dd_partition::solver::{Method, Positive, SolverSettings};

use super::command_line::{CommandLine, LogFormat};
use super::file::SettingsFile;
use super::origin::Origins;
use super::result_path::default_result_path;
use super::{DEFAULT_TOLERANCE, Settings};

/// The command line, and the settings file that it names.
#[derive(Clone, Debug)]
pub struct Given {
    command_line: CommandLine,
    file: SettingsFile,
}

impl Given {
    /// Reads the settings file, if there is one.
    ///
    /// # Errors
    /// What is wrong with the file, with line and key.
    pub fn read(command_line: CommandLine) -> Result<Self, InputError> {
        let file = match &command_line.settings {
            Some(path) => SettingsFile::read(path)?,
            None => SettingsFile::default(),
        };
        Ok(Self { command_line, file })
    }

    /// The problem file.
    pub fn problem(&self) -> PathBuf {
        self.command_line.problem()
    }

    /// What is printed.
    pub fn log(&self) -> LogFormat {
        let said = [self.command_line.run.log, self.file.run.log];
        said.into_iter().flatten().next().unwrap_or_default()
    }

    /// The settings, where the problem file asks for those of `problem`.
    pub fn resolve(&self, problem: &SolverSettings) -> Settings {
        let mut from = Origins::default();
        let CommandLine { solver, run, .. } = &self.command_line;
        let SettingsFile {
            solver: file,
            run: run_file,
        } = &self.file;
        let method = [&solver.method, &file.method, &problem.method];
        let tolerance = [&solver.tolerance, &file.tolerance, &problem.tolerance];
        let max_sweeps = [&solver.max_sweeps, &file.max_sweeps, &problem.max_sweeps];
        let relaxation = [&solver.relaxation, &file.relaxation, &problem.relaxation];
        let no_stress = [&solver.no_stress, &file.no_stress, &problem.no_stress];
        let output = [&run.output, &run_file.output, &None];
        let report = [&run.report, &run_file.report, &None];
        let log = [&run.log, &run_file.log, &None];
        let quiet = [&run.quiet, &run_file.quiet, &None];
        let threads = [&run.threads, &run_file.threads, &None];
        Settings {
            method: from.choose("method", method).unwrap_or(Method::Newton),
            tolerance: from
                .choose("tolerance", tolerance)
                .map_or(DEFAULT_TOLERANCE, Positive::value),
            max_sweeps: from.choose("max_sweeps", max_sweeps),
            relaxation: from.choose("relaxation", relaxation).map(Positive::value),
            no_stress: from.choose("no_stress", no_stress).unwrap_or(false),
            output: from
                .choose("output", output)
                .unwrap_or_else(|| default_result_path(&self.problem())),
            report: from.choose("report", report),
            log: from.choose("log", log).unwrap_or_default(),
            quiet: from.choose("quiet", quiet).unwrap_or(false),
            threads: from.choose("threads", threads).map_or(1, u16::from),
            check: self.command_line.check,
            settings: self.command_line.settings.clone(),
            problem: self.problem(),
            from,
        }
    }
}
