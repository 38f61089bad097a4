//! The law of friction of a contact in a scene.

use serde::Deserialize;
use serde::de::{Deserializer, Error};

use super::number::Number;
use crate::contact_point::Law;

/// The bound of tangential forces; nonnegative numbers, or expressions of position.
#[derive(Clone, Debug, PartialEq)]
pub enum Friction {
    /// `tresca`: bound of Tresca friction (Pa).
    Given {
        /// The bound (Pa).
        bound: Number,
    },
    /// `friction` and optionally `cohesion`: Coulomb or Mohr-Coulomb friction.
    Coulomb {
        /// Coefficient of friction.
        coefficient: Number,
        /// Cohesion (Pa).
        cohesion: Option<Number>,
    },
}

impl Friction {
    /// The law from these keys of a contact; `None` without any of them.
    ///
    /// # Errors
    /// Keys that exclude each other.
    pub fn new(
        coefficient: Option<Number>,
        cohesion: Option<Number>,
        bound: Option<Number>,
    ) -> Result<Option<Self>, String> {
        match (coefficient, cohesion, bound) {
            (None, None, None) => Ok(None),
            (Some(_), _, Some(_)) => Err(
                "'friction' (Coulomb's) and 'tresca' (Tresca's) are both there; expected one of them"
                    .into(),
            ),
            (None, Some(_), _) => Err(
                "'cohesion' stands beside 'friction', which is missing; 'tresca' is a bound by itself"
                    .into(),
            ),
            (None, None, Some(bound)) => Ok(Some(Self::Given { bound })),
            (Some(coefficient), cohesion, None) => Ok(Some(Self::Coulomb {
                coefficient,
                cohesion,
            })),
        }
    }

    /// The error in the law for `dim` dimensions, and its key.
    pub(super) fn fault(&self, dim: usize) -> Option<(&'static str, String)> {
        let numbers = match self {
            Self::Given { bound } => [Some(("tresca", bound)), None],
            Self::Coulomb {
                coefficient,
                cohesion,
            } => [
                Some(("friction", coefficient)),
                cohesion.as_ref().map(|cohesion| ("cohesion", cohesion)),
            ],
        };
        numbers
            .into_iter()
            .flatten()
            .find_map(|(key, number)| Some((key, number.fault(dim)?)))
    }

    /// The law at a point (m).
    ///
    /// # Errors
    /// The key and its value there, which isn't finite and nonnegative.
    pub fn at(&self, point: [f64; 3]) -> Result<Law, String> {
        let value = |key: &str, number: &Number| {
            let value = number.at(point).and_then(|value| match value >= 0.0 {
                true => Ok(value),
                false => Err(number.unexpected(value, point, LEAST)),
            });
            value.map_err(|reason| format!("{key}: {reason}"))
        };
        Ok(match self {
            Self::Given { bound } => Law::given(value("tresca", bound)?),
            Self::Coulomb {
                coefficient,
                cohesion,
            } => Law::coulomb(
                value("friction", coefficient)?,
                (cohesion.as_ref()).map_or(Ok(0.0), |cohesion| value("cohesion", cohesion))?,
            ),
        })
    }
}

/// The valid range of its numbers.
const LEAST: &str = "0 or more";

/// Reads a nonnegative number; an expression is checked when it is evaluated.
pub(super) fn bound<'de, D>(deserializer: D) -> Result<Option<Number>, D::Error>
where
    D: Deserializer<'de>,
{
    match Number::deserialize(deserializer)? {
        Number::Constant(value) if value < 0.0 => {
            Err(D::Error::custom(format!("it is {value}; expected {LEAST}")))
        }
        number => Ok(Some(number)),
    }
}
