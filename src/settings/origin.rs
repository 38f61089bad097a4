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
    /// The file of `--settings`.
    #[serde(rename = "settings file")]
    SettingsFile,
    /// `/settings` of the problem file.
    #[serde(rename = "problem file")]
    ProblemFile,
    /// Nobody.
    #[serde(rename = "default")]
    Default,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::CommandLine => "command line",
            Self::SettingsFile => "settings file",
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
    /// Takes the first that says something of a setting: the command line, the settings file, the
    /// problem file.
    pub(super) fn choose<T: Clone>(
        &mut self,
        name: &'static str,
        said: [&Option<T>; 3],
    ) -> Option<T> {
        let origins = [
            Origin::CommandLine,
            Origin::SettingsFile,
            Origin::ProblemFile,
        ];
        let mut said = said.into_iter().zip(origins);
        let found = said.find_map(|(value, origin)| Some((value.clone()?, origin)));
        let origin = found
            .as_ref()
            .map_or(Origin::Default, |(_, origin)| *origin);
        self.0.insert(name, origin);
        found.map(|(value, _)| value)
    }

    /// Where the setting called `name` came from.
    pub fn of(&self, name: &str) -> Origin {
        self.0.get(name).copied().unwrap_or(Origin::Default)
    }
}
