//! Springs between bodies and the ground, and between points.

use serde::{Deserialize, Deserializer};

use super::condition::Names;
use super::contact::contact_name;
use super::number::{Constant, Number, Vector};
use super::place;
use crate::element::geometry::length;

/// A spring to the ground, or between two points.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "SpringKeys")]
pub enum AnySpring {
    /// Spring to the ground.
    ToGround(Spring),
    /// Between points.
    Between(SpringBetween),
}

/// A spring between two points, or between the average displacements of two groups.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringBetween {
    /// Name, by default that of its ends.
    pub name: Option<String>,
    /// The ends.
    pub ends: [Names; 2],
    /// Force per relative displacement.
    pub stiffness: BetweenStiffness,
}

/// The stiffness of a spring between points (N/m).
#[derive(Clone, Debug, PartialEq)]
pub enum BetweenStiffness {
    /// Along the line between its ends.
    Axial(f64),
    /// Along the axes.
    Axes(Vector),
}

/// Springs to the ground at points, or an elastic foundation under a side.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// The groups of facets or points that it supports.
    pub on: Names,
    /// Force per displacement, on sides also per area.
    pub stiffness: SpringStiffness,
}

/// The stiffness of a spring: of every point (N/m), or per area of a side (N/m³).
#[derive(Clone, Debug, PartialEq)]
pub enum SpringStiffness {
    /// Along the axes.
    Axes(Vector),
    /// Along the normal of a side, and along all its tangents.
    Foundation {
        /// Along the normal.
        normal: Number,
        /// Along the tangents; zero if missing.
        tangential: Option<Number>,
    },
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of on, and stiffness or normal and tangential, or of between, name, and stiffness or axial"
)]
struct SpringKeys {
    on: Option<Names>,
    #[serde(default, deserialize_with = "place::exactly")]
    between: Option<[Names; 2]>,
    #[serde(default, deserialize_with = "optional_name")]
    name: Option<String>,
    stiffness: Option<Vector>,
    axial: Option<Constant>,
    normal: Option<Number>,
    tangential: Option<Number>,
}

fn optional_name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<String>, D::Error> {
    contact_name(deserializer).map(Some)
}

impl TryFrom<SpringKeys> for AnySpring {
    type Error = &'static str;

    fn try_from(keys: SpringKeys) -> Result<Self, Self::Error> {
        let to_ground =
            "expected 'stiffness' along the axes, or of a side 'normal' and perhaps 'tangential'";
        match (keys.on, keys.between) {
            (Some(on), None) if keys.axial.is_none() && keys.name.is_none() => {
                let stiffness = match (keys.stiffness, keys.normal, keys.tangential) {
                    (Some(stiffness), None, None) => SpringStiffness::Axes(stiffness),
                    (None, Some(normal), tangential) => {
                        SpringStiffness::Foundation { normal, tangential }
                    }
                    _ => return Err(to_ground),
                };
                Ok(Self::ToGround(Spring { on, stiffness }))
            }
            (None, Some(ends)) if keys.normal.is_none() && keys.tangential.is_none() => {
                let stiffness = match (keys.stiffness, keys.axial) {
                    (Some(stiffness), None) => BetweenStiffness::Axes(stiffness),
                    (None, Some(Constant(k))) => BetweenStiffness::Axial(k),
                    _ => {
                        return Err(
                            "expected 'stiffness' along the axes, or 'axial' along the line between the points",
                        );
                    }
                };
                Ok(Self::Between(SpringBetween {
                    name: keys.name,
                    ends,
                    stiffness,
                }))
            }
            (Some(_), None) => Err(to_ground),
            _ => {
                Err("expected 'on' with what holds it to the ground, or 'between' with two points")
            }
        }
    }
}

impl SpringBetween {
    /// The stiffness along unit vectors, for an axial one along the line from the second to the first of its ends,
    /// whose difference is `apart`; up to `round_off` they coincide (m).
    ///
    /// # Errors
    /// A stiffness that is negative or not a number there, zero stiffness, or coincident ends.
    pub fn along(&self, apart: [f64; 3], round_off: f64) -> Result<Vec<([f64; 3], f64)>, String> {
        let all = match &self.stiffness {
            BetweenStiffness::Axial(_) if length(apart) <= round_off => {
                return Err(
                    "its ends lie at one place; expected 'stiffness' along the axes".into(),
                );
            }
            BetweenStiffness::Axial(k) => vec![(apart.map(|x| x / length(apart)), *k)],
            BetweenStiffness::Axes(stiffness) if !stiffness.is_constant() => {
                return Err("its stiffness depends on the place; expected numbers".into());
            }
            BetweenStiffness::Axes(stiffness) => {
                let axis = |k: usize| [0, 1, 2].map(|i| f64::from(u8::from(i == k)));
                let all = stiffness.at(apart)?.into_iter().enumerate();
                all.map(|(k, stiffness)| (axis(k), stiffness)).collect()
            }
        };
        for &(_, k) in &all {
            not_negative(k)?;
        }
        let all: Vec<_> = all.into_iter().filter(|&(_, k)| k > 0.0).collect();
        match all.is_empty() {
            false => Ok(all),
            true => Err("its stiffness is 0; expected more".into()),
        }
    }

    /// The name in results.
    pub fn title(&self) -> String {
        let [a, b] = self
            .ends
            .each_ref()
            .map(|of| of.to_string().replace(['\'', '/'], ""));
        self.name.clone().unwrap_or_else(|| format!("{a} to {b}"))
    }

    /// The invalid key for `dim` dimensions, and the reason.
    fn fault(&self, dim: usize) -> Option<(&'static str, String)> {
        match &self.stiffness {
            BetweenStiffness::Axes(axes) => axes.fault(dim).map(|fault| ("stiffness", fault)),
            BetweenStiffness::Axial(_) => None,
        }
    }
}

impl AnySpring {
    /// The groups at both of its ends.
    pub fn groups(&self) -> impl Iterator<Item = &Names> {
        let (one, both) = match self {
            Self::ToGround(spring) => (Some(&spring.on), &[][..]),
            Self::Between(spring) => (None, &spring.ends[..]),
        };
        one.into_iter().chain(both)
    }

    /// The invalid key for `dim` dimensions, and the reason.
    pub(super) fn fault(&self, dim: usize) -> Option<(&'static str, String)> {
        match self {
            Self::ToGround(spring) => spring.stiffness.fault(dim),
            Self::Between(spring) => spring.fault(dim),
        }
    }
}

impl SpringStiffness {
    /// The matrix k at a point whose outward normal is `n`.
    ///
    /// # Errors
    /// A stiffness that is negative or not a number there.
    pub fn at(&self, point: [f64; 3], n: [f64; 3]) -> Result<[[f64; 3]; 3], String> {
        let mut k = [[0.0; 3]; 3];
        match self {
            Self::Axes(stiffness) => {
                for (axis, value) in stiffness.at(point)?.into_iter().enumerate() {
                    k[axis][axis] = not_negative(value)?;
                }
            }
            Self::Foundation { normal, tangential } => {
                let normal = not_negative(normal.at(point)?)?;
                let tangential = match tangential {
                    Some(tangential) => not_negative(tangential.at(point)?)?,
                    None => 0.0,
                };
                for (row, of_row) in k.iter_mut().enumerate() {
                    for (column, k) in of_row.iter_mut().enumerate() {
                        let along = n[row] * n[column];
                        let across = f64::from(row == column) - along;
                        *k = normal * along + tangential * across;
                    }
                }
            }
        }
        Ok(k)
    }

    /// The invalid key for `dim` dimensions, and the reason.
    fn fault(&self, dim: usize) -> Option<(&'static str, String)> {
        match self {
            Self::Axes(stiffness) => stiffness.fault(dim).map(|fault| ("stiffness", fault)),
            Self::Foundation { normal, tangential } => {
                let tangential = tangential.as_ref().and_then(|number| number.fault(dim));
                (normal.fault(dim).map(|fault| ("normal", fault)))
                    .or(tangential.map(|fault| ("tangential", fault)))
            }
        }
    }
}

fn not_negative(value: f64) -> Result<f64, String> {
    match value >= 0.0 {
        true => Ok(value),
        false => Err(format!("a stiffness of {value}; expected at least 0")),
    }
}
