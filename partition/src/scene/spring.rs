//! Springs between bodies and the ground.

use serde::Deserialize;

use super::condition::Names;
use super::number::{Number, Vector};

/// Springs to the ground at points, or an elastic foundation under a side.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "SpringKeys")]
pub struct Spring {
    /// The groups of facets or points that it holds.
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
        /// Along the tangents; none where it is left out.
        tangential: Option<Number>,
    },
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of on, and stiffness or normal and tangential"
)]
struct SpringKeys {
    on: Names,
    stiffness: Option<Vector>,
    normal: Option<Number>,
    tangential: Option<Number>,
}

impl TryFrom<SpringKeys> for Spring {
    type Error = &'static str;

    fn try_from(keys: SpringKeys) -> Result<Self, Self::Error> {
        let stiffness = match (keys.stiffness, keys.normal, keys.tangential) {
            (Some(stiffness), None, None) => SpringStiffness::Axes(stiffness),
            (None, Some(normal), tangential) => SpringStiffness::Foundation { normal, tangential },
            _ => {
                return Err(
                    "expected 'stiffness' along the axes, or of a side 'normal' and perhaps \
                            'tangential'",
                );
            }
        };
        Ok(Self {
            on: keys.on,
            stiffness,
        })
    }
}

impl SpringStiffness {
    /// The matrix k at a point whose outward normal is `n`.
    ///
    /// # Errors
    /// A stiffness that is less than 0 or no number there.
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

    /// The key that is wrong in space of `dim` dimensions, and why.
    pub(super) fn fault(&self, dim: usize) -> Option<(&'static str, String)> {
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
