//! Ties: sides that are joined whatever the sign of the force between them.

use serde::Deserialize;

use super::condition::Names;
use super::contact::{Contact, Pairing, Partner, TieReach, contact_name, distance};

/// A tie of two sides.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Keys")]
pub struct Tie {
    /// Name, also of a group in the result file.
    pub name: String,
    /// Side a and side b.
    pub sides: [Names; 2],
    /// The discretization of the sides; `None` for an automatic choice by their nodes.
    pub pairing: Option<Pairing>,
    /// The nodes of the sides that are tied.
    pub reach: TieReach,
}

impl Tie {
    /// The tie as a contact of its sides that neither opens nor slips.
    pub fn contact(&self) -> Contact {
        let [side_a, side_b] = self.sides.clone();
        Contact {
            name: self.name.clone(),
            side_a,
            partner: Partner::Side(side_b),
            pairing: self.pairing,
            gap: None,
            adjust: None,
            interference: true,
            friction: None,
            motion: None,
            stiffness: None,
            absolute: false,
            tie: Some(self.reach),
        }
    }
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of name, sides, tolerance, adjust and pairing"
)]
struct Keys {
    #[serde(deserialize_with = "contact_name")]
    name: String,
    sides: Vec<Names>,
    pairing: Option<Pairing>,
    #[serde(default, deserialize_with = "distance")]
    tolerance: Option<f64>,
    #[serde(default)]
    adjust: bool,
}

impl TryFrom<Keys> for Tie {
    type Error = String;

    fn try_from(keys: Keys) -> Result<Self, String> {
        let count = keys.sides.len();
        let Ok([a, b]) = <[Names; 2]>::try_from(keys.sides) else {
            return Err(format!("the number of 'sides' is {count}; expected 2"));
        };
        if let Some(name) = a.iter().find(|name| b.iter().any(|other| other == *name)) {
            return Err(format!("'{name}' is on both 'sides'"));
        }
        Ok(Self {
            name: keys.name,
            sides: [a, b],
            pairing: keys.pairing,
            reach: TieReach {
                tolerance: keys.tolerance,
                adjust: keys.adjust,
            },
        })
    }
}
