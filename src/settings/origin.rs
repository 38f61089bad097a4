//! Where every setting came from.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;

/// What settled a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, schemars::JsonSchema)]
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

/// Where each setting came from, by its name in the report.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, schemars::JsonSchema)]
#[serde(transparent)]
pub struct Origins(BTreeMap<&'static str, Origin>);

impl Origins {
    /// What the command line says of a setting, else what the problem file does.
    pub(super) fn choose<T: Clone>(
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

    /// Where the setting called `name` came from.
    pub fn of(&self, name: &str) -> Origin {
        self.0.get(name).copied().unwrap_or(Origin::Default)
    }
}
