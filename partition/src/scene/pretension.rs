//! Pretensions of bolts, by force or by shortening, which steps change and lock.

use serde::Deserialize;

use super::condition::Names;
use super::contact::contact_name;
use super::number::{Constant, ConstantVector};

/// The tightening of a bolt at a cut through it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Keys")]
pub struct Pretension {
    /// Name.
    pub name: String,
    /// The groups of facets between cells of the bolt that form the cut.
    pub on: Names,
    /// The direction in which it is tightened, by default the average normal of the cut.
    pub direction: Option<ConstantVector>,
    /// The force or shortening, unless a step changes it.
    pub own: Tightening,
}

/// The force or shortening of a bolt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tightening {
    /// The force across the cut (N).
    Force(f64),
    /// The length removed at the cut (m).
    Shortening(f64),
    /// The shortening reached in the step before locking, under this force (N).
    Locked(f64),
}

/// A change of a pretension in a step.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "StepKeys")]
pub enum PretensionChange {
    /// Another force (N), which unlocks the shortening.
    Force(f64),
    /// Another shortening (m).
    Shortening(f64),
    /// The shortening is kept from this step on.
    Lock,
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of name, on, direction, and force or shortening"
)]
struct Keys {
    #[serde(deserialize_with = "contact_name")]
    name: String,
    on: Names,
    direction: Option<ConstantVector>,
    force: Option<Constant>,
    shortening: Option<Constant>,
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of force, shortening or lock"
)]
struct StepKeys {
    force: Option<Constant>,
    shortening: Option<Constant>,
    #[serde(default)]
    lock: bool,
}

impl TryFrom<Keys> for Pretension {
    type Error = &'static str;

    fn try_from(keys: Keys) -> Result<Self, Self::Error> {
        let own = match (keys.force, keys.shortening) {
            (Some(Constant(force)), None) => Tightening::Force(force),
            (None, Some(Constant(shortening))) => Tightening::Shortening(shortening),
            _ => return Err("expected either 'force' or 'shortening'"),
        };
        if (keys.direction.as_ref()).is_some_and(|direction| direction.value == [0.0; 3]) {
            return Err("expected a 'direction' that isn't zero");
        }
        Ok(Self {
            name: keys.name,
            on: keys.on,
            direction: keys.direction,
            own,
        })
    }
}

impl TryFrom<StepKeys> for PretensionChange {
    type Error = &'static str;

    fn try_from(keys: StepKeys) -> Result<Self, Self::Error> {
        match (keys.force, keys.shortening, keys.lock) {
            (Some(Constant(force)), None, false) => Ok(Self::Force(force)),
            (None, Some(Constant(shortening)), false) => Ok(Self::Shortening(shortening)),
            (None, None, true) => Ok(Self::Lock),
            _ => Err("expected one of 'force', 'shortening' and 'lock = true'"),
        }
    }
}

impl Pretension {
    /// The name of the equation that holds its shortening.
    pub fn hold(&self) -> String {
        format!("{} held", self.name)
    }
}
