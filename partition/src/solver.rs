//! Settings of the solver that the author of a problem chose: `[solver]` of a scene, `/settings` of
//! a problem file, and the options of contact-dd-mpi of the same names.

use std::fmt;
use std::str::FromStr;

use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};

/// The method by which U is found on Γ.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Newton: S_0 + S_CON is inverted, contact constraints included.
    Newton,
    /// Accelerated chord: S_0 + S_CON' of the bilateral problem is inverted.
    Anderson,
    /// The paper's successive approximations (18): S_0 is inverted.
    Picard,
}

impl Method {
    /// The name on the command line, in files and in the report.
    pub fn name(self) -> &'static str {
        match self {
            Self::Newton => "newton",
            Self::Anderson => "anderson",
            Self::Picard => "picard",
        }
    }
}

/// A finite number above 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "f64")]
pub struct Positive(f64);

impl Positive {
    /// The number.
    pub fn value(self) -> f64 {
        self.0
    }
}

impl TryFrom<f64> for Positive {
    type Error = String;

    fn try_from(value: f64) -> Result<Self, String> {
        match value > 0.0 && value.is_finite() {
            true => Ok(Self(value)),
            false => Err(format!("{value}: expected a positive number")),
        }
    }
}

impl FromStr for Positive {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let value = text.parse::<f64>().ok();
        let value = value.and_then(|value| Self::try_from(value).ok());
        value.ok_or_else(|| "expected a positive number".into())
    }
}

impl fmt::Display for Positive {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::LowerExp::fmt(&self.0, f)
    }
}

/// Parses the number of an option that counts.
///
/// # Errors
/// It isn't a whole number.
pub fn count<N: FromStr>(text: &str) -> Result<N, String> {
    (text.parse()).map_err(|_| "expected a whole number, 0 or more".into())
}

/// Parses the value of an option that is true without a value.
///
/// # Errors
/// It is neither `true` nor `false`.
pub fn parse_flag(text: &str) -> Result<bool, String> {
    // A parser with possible values would make shells complete them where a file name is expected.
    text.parse().map_err(|_| "expected true or false".into())
}

/// Settings of the solver that the author of a problem chose; `None` for the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Args, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[command(next_help_heading = "Solving")]
pub struct SolverSettings {
    /// Method for the interface problem [default: newton]
    #[arg(long, value_enum, value_name = "NAME")]
    pub method: Option<Method>,

    /// Stop when the relative residual of the interface problem is below X [default: 1e-10]
    #[arg(long, value_name = "X")]
    pub tolerance: Option<Positive>,

    /// Largest number of sweeps [default: 20 for newton, up to 500 for anderson, 2000 for picard]
    #[arg(long, value_name = "N", value_parser = count::<usize>)]
    pub max_sweeps: Option<usize>,

    /// Relaxation factor of picard; 1 is equation (18) of the paper [default: found automatically]
    #[arg(long, value_name = "THETA")]
    pub relaxation: Option<Positive>,

    /// Neither recover nor write stresses [default: false]
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true,
          default_missing_value = "true", value_parser = parse_flag)]
    pub no_stress: Option<bool>,
}

impl SolverSettings {
    /// The names of all of them, in files.
    pub const NAMES: [&str; 5] = [
        "method",
        "tolerance",
        "max_sweeps",
        "relaxation",
        "no_stress",
    ];

    /// True if no option is set.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl fmt::Display for SolverSettings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            method,
            tolerance,
            max_sweeps,
            relaxation,
            no_stress,
        } = self;
        let values = [
            method.map(|method| method.name().to_owned()),
            tolerance.map(|tolerance| tolerance.to_string()),
            max_sweeps.map(|count| count.to_string()),
            relaxation.map(|theta| theta.value().to_string()),
            no_stress.map(|left_out| left_out.to_string()),
        ];
        let entries = Self::NAMES.iter().zip(values);
        let entries = entries.filter_map(|(name, value)| Some(format!("{name} = {}", value?)));
        f.write_str(&entries.collect::<Vec<_>>().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_are_those_of_a_file() {
        let file = serde_json::to_value(SolverSettings::default()).unwrap();
        let fields: Vec<&str> = file
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        let mut names = SolverSettings::NAMES;
        names.sort_unstable();
        assert_eq!(fields, names);
    }

    #[test]
    fn a_positive_number_is_above_zero_and_finite() {
        assert_eq!("1e-8".parse(), Ok(Positive(1e-8)));
        for text in ["0", "-1", "nan", "inf", "1e-400", "x", ""] {
            assert!(text.parse::<Positive>().is_err(), "{text}");
        }
    }
}
