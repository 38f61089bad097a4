//! Linear equations between displacements.

use serde::{Deserialize, Deserializer};

use super::condition::Names;
use super::contact::contact_name;
use super::coupling::Coupling;
use super::number::{Constant, OR_IN_SPACE};
use super::suggest;

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
    /// Force per difference of the sum from its value, for a spring (N/m); the equation holds exactly without it.
    pub stiffness: Option<Constant>,
}

/// A multiple of a displacement or a rotation.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of at or coupling, component and factor"
)]
pub struct Term {
    /// A point, or a group whose average displacement it is.
    pub at: Option<Names>,
    /// The coupling whose reference point it is of, instead.
    pub coupling: Option<String>,
    /// The component of the motion.
    pub component: Component,
    /// The factor.
    #[serde(default = "one")]
    pub factor: f64,
}

/// A component of a displacement, or of the rotation of a reference point; in the order of the components of a coupling.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Component {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// About x.
    Rx,
    /// About y.
    Ry,
    /// About z.
    Rz,
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
    if terms
        .iter()
        .any(|term| term.at.is_some() == term.coupling.is_some())
    {
        return wrong("expected either 'at' or 'coupling' in a term");
    }
    match terms
        .iter()
        .all(|term| term.factor.is_finite() && term.factor != 0.0)
    {
        true => Ok(terms),
        false => wrong("expected factors that are finite numbers and not 0"),
    }
}

impl Equation {
    /// The invalid key for `dim` dimensions, and the reason.
    pub(super) fn fault(
        &self,
        dim: usize,
        couplings: &[Coupling],
    ) -> Option<(&'static str, String)> {
        if let Some(Constant(k)) = self.stiffness.as_ref().filter(|k| k.0 <= 0.0) {
            return Some((
                "stiffness",
                format!("the stiffness is {k}; expected more than 0"),
            ));
        }
        let known = || couplings.iter().map(|of| &of.name[..]);
        let wrong = |term: &Term| match (&term.coupling, term.component) {
            (_, Component::Z) if dim == 2 => Some(format!("a plane scene has no 'z'{OR_IN_SPACE}")),
            (_, Component::Rx | Component::Ry) if dim == 2 => Some(format!(
                "a plane scene has rotations about z only{OR_IN_SPACE}"
            )),
            (None, Component::Rx | Component::Ry | Component::Rz) => Some(
                "points have no rotations; expected 'coupling', whose reference point has".into(),
            ),
            (Some(name), _) if known().all(|other| other != name) => {
                let hint = suggest::hint_and_known(name, known());
                Some(format!("there is no coupling '{name}'{hint}"))
            }
            _ => None,
        };
        Some(("terms", self.terms.iter().find_map(wrong)?))
    }
}
