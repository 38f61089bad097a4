//! Linear equations between displacements.

use serde::{Deserialize, Deserializer};

use super::condition::Names;
use super::contact::contact_name;

/// The equation Σ factor · displacement = value.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Equation {
    /// Name, also of a group in the result file; equations may share it.
    #[serde(default = "unnamed", deserialize_with = "contact_name")]
    pub name: String,
    /// The terms, at least one.
    #[serde(deserialize_with = "terms")]
    pub terms: Vec<Term>,
    /// The sum (m).
    #[serde(default)]
    pub value: f64,
    /// True if displacements are absolute, even if the equation is added in a load step.
    #[serde(default)]
    pub absolute: bool,
}

/// A multiple of a displacement.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of at, component and factor")]
pub struct Term {
    /// A point, or a group whose average displacement it is.
    pub at: Names,
    /// The component of the displacement.
    pub component: Component,
    /// The factor.
    #[serde(default = "one")]
    pub factor: f64,
}

/// A component of a displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Component {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
}

fn one() -> f64 {
    1.0
}

fn unnamed() -> String {
    "equations".into()
}

fn terms<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Term>, D::Error> {
    let terms = Vec::<Term>::deserialize(deserializer)?;
    let wrong = |reason: &str| Err(serde::de::Error::custom(reason.to_owned()));
    if terms.is_empty() {
        return wrong("expected a term at least");
    }
    match terms
        .iter()
        .all(|term| term.factor.is_finite() && term.factor != 0.0)
    {
        true => Ok(terms),
        false => wrong("expected factors that are finite numbers and not 0"),
    }
}
