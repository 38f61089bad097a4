//! Settings in a file: options by name, in TOML.

use std::path::Path;

use contact_dd_partition::error::InputError;
use contact_dd_partition::scene::place::located;
use contact_dd_partition::scene::suggest::hint_and_known;
use contact_dd_partition::solver::SolverSettings;
use contact_dd_partition::source;
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, Deserializer};

use super::command_line::RunSettings;

/// What a file settles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SettingsFile {
    /// Of the solution.
    pub solver: SolverSettings,
    /// Of the run.
    pub run: RunSettings,
}

impl SettingsFile {
    /// Reads a file.
    ///
    /// # Errors
    /// What is wrong with it, with line and key.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let read = source::text(path, "settings in TOML").and_then(|text| Self::parse(&text));
        read.map_err(|error| error.in_file(path))
    }

    /// Parses the text of a file.
    ///
    /// # Errors
    /// What is wrong with it, with line and key.
    pub fn parse(text: &str) -> Result<Self, InputError> {
        let table = DeTable::parse(text).map_err(|error| located(text, &error))?;
        let span = table.span();
        let table = table.into_inner();
        let is_known = |name: &str| known().any(|known| known == name);
        let unknown = table.keys().filter(|key| !is_known(key.get_ref()));
        if let Some(key) = unknown.min_by_key(|key| key.span().start) {
            return Err(refuse(text, key.span().start, key.get_ref()));
        }
        let (solver, run) = (table.into_iter())
            .partition(|(key, _)| SolverSettings::NAMES.contains(&key.get_ref().as_ref()));
        Ok(Self {
            solver: of_table(text, Spanned::new(span.clone(), solver))?,
            run: of_table(text, Spanned::new(span, run))?,
        })
    }
}

fn of_table<T: DeserializeOwned>(text: &str, table: Spanned<DeTable>) -> Result<T, InputError> {
    T::deserialize(Deserializer::from(table)).map_err(|error| located(text, &error))
}

/// The names of all settings.
fn known() -> impl Iterator<Item = &'static str> {
    SolverSettings::NAMES.into_iter().chain(RunSettings::NAMES)
}

/// The error about a name that isn't known.
fn refuse(text: &str, start: usize, name: &str) -> InputError {
    let line = text[..start].matches('\n').count() + 1;
    let hint = hint_and_known(name, known());
    InputError::new(format!("line {line}: unknown key '{name}'{hint}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::command_line::LogFormat;
    use contact_dd_partition::solver::Method;

    #[test]
    fn a_file_says_what_options_say() {
        let file = SettingsFile::parse(
            "method = 'anderson'\ntolerance = 1\nno_stress = true\nlog = 'json'\nthreads = 3\n",
        )
        .unwrap();
        assert_eq!(file.solver.method, Some(Method::Anderson));
        assert_eq!(file.solver.tolerance.map(|x| x.value()), Some(1.0));
        assert_eq!(file.solver.no_stress, Some(true));
        assert_eq!(file.run.log, Some(LogFormat::Json));
        assert_eq!(file.run.threads.map(u16::from), Some(3));
        assert_eq!(SettingsFile::parse("").unwrap(), SettingsFile::default());
    }

    #[test]
    fn what_is_wrong_is_said_with_line_and_key() {
        for (text, words) in [
            ("\ntolerence = 1e-8", ["line 2", "did you mean 'tolerance'"]),
            ("max-sweeps = 3", ["line 1", "did you mean 'max_sweeps'"]),
            (
                "\n\ntolerance = -1",
                ["line 3: tolerance", "expected a positive"],
            ),
            (
                "tolerance = '1e-8'",
                ["line 1: tolerance", "string \"1e-8\""],
            ),
            (
                "method = 'newtn'",
                ["line 1: method", "did you mean 'newton'"],
            ),
            ("threads = 0", ["line 1: threads", "nonzero"]),
            ("threads = 70000", ["line 1: threads", "70000"]),
            ("max_sweeps = 1.5", ["line 1: max_sweeps", "1.5"]),
            ("quiet = 1", ["line 1: quiet", "expected a boolean"]),
            ("checkpoint_every = -1", ["line 1: checkpoint_every", "-1"]),
            ("quiet = true\nquiet = true", ["line 2", "duplicate key"]),
            (
                "[solver]\nmethod = 'newton'",
                ["line 1", "unknown key 'solver'"],
            ),
            ("method", ["line 1", ""]),
        ] {
            let message = SettingsFile::parse(text).unwrap_err().to_string();
            for word in words {
                assert!(message.contains(word), "{text:?}: {message}");
            }
        }
    }

    #[test]
    fn the_names_are_those_of_the_options() {
        let said = serde_json::to_value(RunSettings::default()).unwrap();
        let mut said: Vec<String> = said.as_object().unwrap().keys().cloned().collect();
        let mut names = RunSettings::NAMES.to_vec();
        said.sort_unstable();
        names.sort_unstable();
        assert_eq!(said, names);
    }
}
