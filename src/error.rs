//! Failures of a run, and their exit codes.

use std::path::Path;
use std::process::ExitCode;

use contact_dd_partition::error::{InputError, OutputError};
use serde::{Deserialize, Serialize};

/// The failure in which a run ends; the same on all ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub enum FailureKind {
    /// Failure that has no code of its own.
    #[default]
    Internal = 1,
    /// Bad usage or bad input.
    Input = 2,
    /// The scene has no equilibrium: a free rigid motion with load along it.
    IllPosed = 4,
    /// The output can't be written.
    Output = 5,
    /// A signal requested the end of the run.
    Interrupted = 6,
}

/// A failed run: message and exit code.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    /// The kind of the failure, which decides the exit code.
    pub kind: FailureKind,
    /// The message: place of the failure and expectation.
    pub message: String,
}

impl Failure {
    fn new(kind: FailureKind, message: impl Into<String>) -> Self {
        let message = message.into();
        Self { kind, message }
    }

    /// A failure without an exit code of its own.
    pub fn internal(message: impl Into<String>) -> Self {
        Self::new(FailureKind::Internal, message)
    }

    /// Bad usage or bad input.
    pub fn input(message: impl Into<String>) -> Self {
        Self::new(FailureKind::Input, message)
    }

    /// A scene without equilibrium.
    pub fn ill_posed(message: impl Into<String>) -> Self {
        Self::new(FailureKind::IllPosed, message)
    }

    /// A run that was stopped by a signal.
    pub fn interrupted(message: impl Into<String>) -> Self {
        Self::new(FailureKind::Interrupted, message)
    }

    /// The failure of an interrupted run, extended by where a restart continues: after `k` of `all` load steps, whose
    /// results are in `kept`. Any other failure is unchanged.
    pub fn after(mut self, k: usize, all: usize, kept: &Path) -> Self {
        if self.kind == FailureKind::Interrupted {
            let kept = kept.display();
            self.message += &match k {
                0 => ", before a result was written".to_owned(),
                k => format!(
                    ", after {k} of {all} load steps: {kept} has their results; the same command with --restart goes on \
                     after them"
                ),
            };
        }
        self
    }

    /// The process's exit code.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(self.kind as u8)
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::input(error.to_string())
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Self::new(FailureKind::Output, error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_of_an_interrupted_run_says_how_to_continue() {
        let after = |k| Failure::interrupted("interrupted").after(k, 5, Path::new("x.unfinished"));
        assert_eq!(after(0).message, "interrupted, before a result was written");
        let message = after(2).message;
        assert!(message.starts_with("interrupted, after 2 of 5 load steps: x.unfinished has"));
        assert!(message.contains("--restart"));
        let other = Failure::ill_posed("free");
        assert_eq!(other.clone().after(2, 5, Path::new("x")), other);
    }
}
