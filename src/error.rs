//! How a run can fail, and the exit code that says so.

use std::process::ExitCode;

use contact_dd_partition::error::{InputError, OutputError};
use serde::{Deserialize, Serialize};

/// What a failed run ends with; the same on all ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub enum FailureKind {
    /// Anything that has no code of its own.
    #[default]
    Internal = 1,
    /// Bad usage or bad input.
    Input = 2,
    /// The scene has no equilibrium: a free rigid motion with load along it.
    IllPosed = 4,
    /// The output can't be written.
    Output = 5,
    /// A signal asked the run to stop.
    Interrupted = 6,
}

/// A failed run: one message, one exit code.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    /// What it ends with.
    pub kind: FailureKind,
    /// Where, and what was expected.
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

    /// A run that was asked to stop.
    pub fn interrupted(message: impl Into<String>) -> Self {
        Self::new(FailureKind::Interrupted, message)
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
