//! Initial stress and thermal strain of a body.

use serde::Deserialize;

use super::material::PlaneState;
use super::number::{Constant, Number, OR_IN_SPACE};

/// σ_0, a number for each component (Pa).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct InitialStress(Vec<Number>);

impl InitialStress {
    /// The error in the stress for `dim` dimensions.
    pub(super) fn fault(&self, dim: usize, plane: Option<PlaneState>) -> Option<String> {
        let (count, order) = match plane {
            None => (6, "xx, yy, zz, yz, xz, xy"),
            Some(PlaneState::Stress) => (3, "xx, yy, xy"),
            Some(_) => (4, "xx, yy, zz, xy"),
        };
        match self.0.len() == count {
            true => self.0.iter().find_map(|number| number.fault(dim)),
            false => {
                let or_in_space = plane.map_or("", |_| OR_IN_SPACE);
                Some(format!("expected {count} numbers, {order}{or_in_space}"))
            }
        }
    }

    /// Value at a point, in the order of results: XX YY ZZ XY YZ XZ (Pa).
    ///
    /// # Errors
    /// An expression that isn't finite there.
    pub fn at(&self, point: [f64; 3]) -> Result<[f64; 6], String> {
        let places: &[usize] = match self.0.len() {
            3 => &[0, 1, 3],
            4 => &[0, 1, 2, 3],
            _ => &[0, 1, 2, 4, 5, 3],
        };
        let mut stress = [0.0; 6];
        for (&place, number) in places.iter().zip(&self.0) {
            stress[place] = number.at(point)?;
        }
        Ok(stress)
    }

    /// True if it is uniform.
    pub fn is_constant(&self) -> bool {
        self.0.iter().all(Number::is_constant)
    }
}

/// Thermal strain of a body.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of expansion and temperature"
)]
pub struct Thermal {
    /// Coefficient of thermal expansion (1/K).
    pub expansion: Constant,
    /// Temperature relative to the strain-free state (K).
    pub temperature: Number,
}
