//! Cyclic symmetry: sectors of a ring, with the same solution in each, rotated.

use serde::Deserialize;

use super::condition::Names;
use super::contact::contact_name;
use super::number::ConstantVector;

/// The two sides at which a sector meets its neighbours.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Keys")]
pub struct Cyclic {
    /// Name.
    pub name: String,
    /// A side, and its image under the rotation by one sector.
    pub sides: [Names; 2],
    /// A point of the axis (m).
    pub point: ConstantVector,
    /// Direction of the axis; z in the plane.
    pub axis: Option<ConstantVector>,
    /// Number of sectors of the ring.
    pub sectors: u32,
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of name, sides, point, axis and sectors"
)]
struct Keys {
    #[serde(deserialize_with = "contact_name")]
    name: String,
    sides: Vec<Names>,
    point: ConstantVector,
    axis: Option<ConstantVector>,
    sectors: u32,
}

impl TryFrom<Keys> for Cyclic {
    type Error = String;

    fn try_from(keys: Keys) -> Result<Self, String> {
        let count = keys.sides.len();
        let Ok(sides) = <[Names; 2]>::try_from(keys.sides) else {
            return Err(format!("the number of 'sides' is {count}; expected 2"));
        };
        if keys.sectors < 2 {
            return Err(format!(
                "'sectors' is {}; expected at least 2",
                keys.sectors
            ));
        }
        if (keys.axis.as_ref()).is_some_and(|axis| axis.value == [0.0; 3]) {
            return Err("expected an 'axis' that isn't zero".into());
        }
        Ok(Self {
            name: keys.name,
            sides,
            point: keys.point,
            axis: keys.axis,
            sectors: keys.sectors,
        })
    }
}
