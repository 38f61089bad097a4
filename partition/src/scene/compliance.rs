//! The stiffness of a compliant contact.

use serde::Deserialize;

use super::number::Number;

/// The stiffness of a compliant contact: pressure per overlap, and shear stress per tangential displacement of sticking
/// points (N/m³); positive numbers, or expressions of position.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of normal and perhaps tangential"
)]
pub struct ContactStiffness {
    /// Along the normal.
    pub normal: Number,
    /// Along the tangents; `None` if sticking points don't move.
    pub tangential: Option<Number>,
}

impl ContactStiffness {
    /// The error in the stiffness for `dim` dimensions.
    pub(super) fn fault(&self, dim: usize) -> Option<String> {
        let numbers = std::iter::once(&self.normal).chain(&self.tangential);
        numbers.into_iter().find_map(|number| number.fault(dim))
    }

    /// The stiffness along the normal and along the tangents at a point (m), 0 for rigid.
    ///
    /// # Errors
    /// The key and its value there, which isn't a positive number.
    pub fn at(&self, point: [f64; 3]) -> Result<[f64; 2], String> {
        let value = |key: &str, number: &Number| {
            let value = number.at(point).and_then(|value| match value > 0.0 {
                true => Ok(value),
                false => Err(number.unexpected(value, point, "more than 0")),
            });
            value.map_err(|reason| format!("{key}: {reason}"))
        };
        let tangential = self.tangential.as_ref();
        Ok([
            value("normal", &self.normal)?,
            tangential.map_or(Ok(0.0), |number| value("tangential", number))?,
        ])
    }
}
