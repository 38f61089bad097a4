//! Contacts in a scene: given by their sides, or by bodies between which they are detected. Side a is the slave side,
//! side b the master side.

use serde::Deserialize;
use serde::de::{Deserializer, Error};

use super::compliance::ContactStiffness;
use super::condition::{Names, Obstacle};
use super::friction::{self, Friction};
use super::number::{Constant, ConstantVector, Number};
use crate::name;

/// A table `[[contact]]`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Keys")]
pub enum Declaration {
    /// A contact.
    Contact(Contact),
    /// Contacts wherever bodies touch.
    Between(Between),
}

impl Declaration {
    /// The name of the contact, or the prefix of the names of detected contacts.
    pub fn name(&self) -> &str {
        match self {
            Self::Contact(contact) => &contact.name,
            Self::Between(between) => &between.name,
        }
    }

    /// The contact, if it is given by its sides.
    pub fn contact(&self) -> Option<&Contact> {
        match self {
            Self::Contact(contact) => Some(contact),
            Self::Between(_) => None,
        }
    }

    /// The prescribed gap (m), the law of friction, and the stiffness.
    pub(super) fn laws(
        &self,
    ) -> (
        Option<&Number>,
        Option<&Friction>,
        Option<&ContactStiffness>,
    ) {
        let (gap, friction, stiffness) = match self {
            Self::Contact(of) => (&of.gap, &of.friction, &of.stiffness),
            Self::Between(of) => (&of.gap, &of.friction, &of.stiffness),
        };
        (gap.as_ref(), friction.as_ref(), stiffness.as_ref())
    }
}

/// Γ_c: two sides in possible contact, or one side and a rigid obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Name, also of a group in the result file.
    pub name: String,
    /// Side a.
    pub side_a: Names,
    /// Partner of side a.
    pub partner: Partner,
    /// The discretization of two sides; `None` for an automatic choice by their nodes.
    pub pairing: Option<Pairing>,
    /// The displacement of the obstacle (m); `None` if it moves at most in steps.
    pub motion: Option<ConstantVector>,
    /// The gap that replaces the geometric one (m).
    pub gap: Option<Number>,
    /// The distance up to which gaps, and all overlaps, are closed (m); `None` keeps them as measured.
    pub adjust: Option<f64>,
    /// True if negative gaps are intended.
    pub interference: bool,
    /// Law of friction; `None` for frictionless contact.
    pub friction: Option<Friction>,
    /// The contact stiffness; `None` for hard contact.
    pub stiffness: Option<ContactStiffness>,
    /// True if gaps are relative to the undeformed bodies, even if the contact is added in a load step.
    pub absolute: bool,
    /// Reach of a tie; `None` for sides that may open.
    pub tie: Option<TieReach>,
}

impl Contact {
    /// Its sides, a single one with an obstacle.
    pub fn sides(&self) -> impl Iterator<Item = &Names> {
        let side_b = match &self.partner {
            Partner::Side(names) => Some(names),
            Partner::Obstacle(_) => None,
        };
        std::iter::once(&self.side_a).chain(side_b)
    }
}

/// The part of two sides that a tie joins, and the position in which it does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TieReach {
    /// The distance up to which nodes are tied (m); `None` for a fraction of the size of facets.
    pub tolerance: Option<f64>,
    /// True if nodes are moved onto the other side, so that tied sides have no gap.
    pub adjust: bool,
}

/// The partner of side a of a contact.
#[derive(Clone, Debug, PartialEq)]
pub enum Partner {
    /// Side b.
    Side(Names),
    /// A rigid obstacle.
    Obstacle(Obstacle),
}

/// The discretization of a contact between two sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pairing {
    /// Node-to-node: a constraint for every node of side a and the opposite node of side b.
    Nodes,
    /// Mortar: a constraint for every node of side a and the opposite part of side b, weighted by dual Lagrange
    /// multipliers.
    Mortar,
}

/// Contacts wherever bodies touch, with common properties.
#[derive(Clone, Debug, PartialEq)]
pub struct Between {
    /// Prefix of their names.
    pub name: String,
    /// The bodies.
    pub bodies: Chosen,
    /// Gap up to which facets that face each other belong to a contact (m); `None` for touching facets, with a
    /// tolerance for facets that approximate curves.
    pub within: Option<f64>,
    /// Pairing as in [`Contact`].
    pub pairing: Option<Pairing>,
    /// Gap as in [`Contact`].
    pub gap: Option<Number>,
    /// Interference as in [`Contact`].
    pub interference: bool,
    /// Friction as in [`Contact`].
    pub friction: Option<Friction>,
    /// Stiffness as in [`Contact`].
    pub stiffness: Option<ContactStiffness>,
}

impl Between {
    /// The contact `name` between two detected sides.
    pub fn contact(&self, name: String, [side_a, side_b]: [Names; 2]) -> Contact {
        Contact {
            name,
            side_a,
            partner: Partner::Side(side_b),
            motion: None,
            pairing: self.pairing,
            gap: self.gap.clone(),
            adjust: None,
            interference: self.interference,
            friction: self.friction.clone(),
            stiffness: self.stiffness.clone(),
            absolute: false,
            tie: None,
        }
    }
}

/// The bodies between which contacts are detected.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(from = "Names")]
pub enum Chosen {
    /// Any two bodies, and self-contact.
    All,
    /// Any two of several bodies, and self-contact of these.
    Named(Names),
}

impl From<Names> for Chosen {
    fn from(names: Names) -> Self {
        match names.iter().eq(["all"]) {
            true => Self::All,
            false => Self::Named(names),
        }
    }
}

impl Chosen {
    /// The names of the bodies; empty for all.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let names = match self {
            Self::All => None,
            Self::Named(names) => Some(names),
        };
        names.into_iter().flat_map(Names::iter)
    }

    /// True if contacts between bodies of these names are detected.
    pub fn has(&self, a: &str, b: &str) -> bool {
        let Self::Named(names) = self else {
            return true;
        };
        let is_named = |body: &str| names.iter().any(|name| name == body);
        is_named(a) && is_named(b) && (a != b || names.iter().count() == 1)
    }
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of name, sides or between, within, pairing, gap, adjust, interference, obstacle, motion, friction, \
                 cohesion, tresca, stiffness and absolute"
)]
struct Keys {
    #[serde(deserialize_with = "contact_name")]
    name: String,
    sides: Option<Vec<Names>>,
    between: Option<Chosen>,
    #[serde(default, deserialize_with = "distance")]
    within: Option<f64>,
    pairing: Option<Pairing>,
    gap: Option<Number>,
    #[serde(default, deserialize_with = "adjustment")]
    adjust: Option<f64>,
    #[serde(default)]
    interference: bool,
    obstacle: Option<Obstacle>,
    motion: Option<ConstantVector>,
    #[serde(default, deserialize_with = "friction::bound")]
    friction: Option<Number>,
    #[serde(default, deserialize_with = "friction::bound")]
    cohesion: Option<Number>,
    #[serde(default, deserialize_with = "friction::bound")]
    tresca: Option<Number>,
    stiffness: Option<ContactStiffness>,
    #[serde(default)]
    absolute: bool,
}

impl Keys {
    /// Refuses keys that require another key.
    fn check(&self) -> Result<(), String> {
        let sticks = self.friction.is_some() || self.tresca.is_some();
        let has_tangential = |stiffness: &ContactStiffness| stiffness.tangential.is_some();
        if !sticks && self.stiffness.as_ref().is_some_and(has_tangential) {
            return Err(
                "'tangential' is the stiffness of sticking; expected 'friction' or 'tresca' beside it".into(),
            );
        }
        if self.motion.is_some() && self.obstacle.is_none() {
            return Err(
                "'motion' is of an 'obstacle', which is missing; a body moves by [[displacement]]"
                    .into(),
            );
        }
        if self.absolute && self.between.is_some() {
            return Err("'absolute' is of two sides; expected no 'between' beside it".into());
        }
        if self.within.is_some() && self.between.is_none() && self.sides.is_some() {
            return Err("'within' stands beside 'between', which is missing".into());
        }
        if self.adjust.is_some() && (self.gap.is_some() || self.between.is_some()) {
            return Err(
                "'adjust' closes gaps of the mesh; expected no 'gap' and no 'between' beside it"
                    .into(),
            );
        }
        Ok(())
    }
}

impl TryFrom<Keys> for Declaration {
    type Error = String;

    fn try_from(keys: Keys) -> Result<Self, String> {
        keys.check()?;
        let friction = Friction::new(keys.friction, keys.cohesion, keys.tresca)?;
        let sides = match (keys.between, keys.sides) {
            (Some(_), Some(_)) => {
                return Err("'between' finds the sides; expected no 'sides' beside it".into());
            }
            (Some(_), None) if keys.obstacle.is_some() => {
                return Err("'between' is of bodies; expected no 'obstacle' beside it".into());
            }
            (Some(bodies), None) => {
                return Ok(Self::Between(Between {
                    name: keys.name,
                    bodies,
                    within: keys.within,
                    pairing: keys.pairing,
                    gap: keys.gap,
                    interference: keys.interference,
                    friction,
                    stiffness: keys.stiffness,
                }));
            }
            (None, None) => {
                return Err("expected its two 'sides', or the bodies 'between' which it is".into());
            }
            (None, Some(sides)) => sides,
        };
        let (side_a, partner) = side_and_partner(sides, keys.obstacle, keys.pairing)?;
        Ok(Self::Contact(Contact {
            name: keys.name,
            side_a,
            partner,
            motion: keys.motion,
            pairing: keys.pairing,
            gap: keys.gap,
            adjust: keys.adjust,
            interference: keys.interference,
            friction,
            stiffness: keys.stiffness,
            absolute: keys.absolute,
            tie: None,
        }))
    }
}

/// The first of the `sides` and its partner: the second side or an `obstacle`.
fn side_and_partner(
    sides: Vec<Names>,
    obstacle: Option<Obstacle>,
    pairing: Option<Pairing>,
) -> Result<(Names, Partner), String> {
    let count = sides.len();
    let mut sides = sides.into_iter();
    Ok(match (sides.next(), sides.next(), sides.next(), obstacle) {
        (Some(a), Some(b), None, None) => {
            if let Some(name) = a.iter().find(|name| b.iter().any(|other| other == *name)) {
                return Err(format!("'{name}' is on both 'sides'"));
            }
            (a, Partner::Side(b))
        }
        (Some(_), None, None, Some(_)) if pairing.is_some() => {
            return Err("'pairing' is of two sides; expected none beside an 'obstacle'".into());
        }
        (Some(a), None, None, Some(obstacle)) => (a, Partner::Obstacle(obstacle)),
        _ => {
            return Err(format!(
                "the number of 'sides' is {count}; expected 2, or 1 beside an 'obstacle'"
            ));
        }
    })
}

pub(super) fn contact_name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let name = String::deserialize(deserializer)?;
    match name::check_contact(&name) {
        Ok(()) => Ok(name),
        Err(reason) => Err(D::Error::custom(format!(
            "'{}' {reason}",
            name::shown(&name)
        ))),
    }
}

fn adjustment<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    let is_one = |value| value >= 0.0;
    Constant::checked(deserializer, is_one, "the distance", "at least 0").map(Some)
}

pub(super) fn distance<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<f64>, D::Error> {
    let is_positive = |value| value > 0.0;
    Constant::checked(deserializer, is_positive, "the distance", "more than 0").map(Some)
}
