//! Numbers of a scene: constants, and expressions of position.

use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};

use super::expression::Expression;
use crate::magnitude;

/// A finite number, or an expression of x, y and z.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// A constant.
    Constant(f64),
    /// An expression of position.
    Varying(Expression),
}

impl Number {
    /// Value at a point (m).
    ///
    /// # Errors
    /// An expression that isn't finite there.
    pub fn at(&self, point: [f64; 3]) -> Result<f64, String> {
        match self {
            Self::Constant(value) => Ok(*value),
            Self::Varying(expression) => {
                let value = expression.value(point);
                magnitude::check(value).map_err(|expected| self.unexpected(value, point, &expected))
            }
        }
    }

    /// True if it is independent of position.
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }

    /// The error in the number for `dim` dimensions.
    pub(super) fn fault(&self, dim: usize) -> Option<String> {
        match self {
            Self::Varying(expression) if dim == 2 => {
                (expression.fault_in_plane()).map(|fault| format!("{fault}{OR_IN_SPACE}"))
            }
            _ => None,
        }
    }

    /// The message that its `value` at a point isn't the `expected` one.
    pub(super) fn unexpected(&self, value: f64, point: [f64; 3], expected: &str) -> String {
        let [x, y, z] = point;
        match self {
            Self::Constant(_) => format!("{value:e}; expected {expected}"),
            Self::Varying(expression) if expression.is_constant() => {
                format!("'{}' is {value:e}; expected {expected}", expression.text())
            }
            Self::Varying(expression) => {
                let text = expression.text();
                let z = match z == 0.0 && !expression.has_z() {
                    true => String::new(),
                    false => format!(", z = {z}"),
                };
                format!("'{text}' is {value:e} at x = {x}, y = {y}{z}; expected {expected}")
            }
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberVisitor;
        impl Visitor<'_> for NumberVisitor {
            type Value = Number;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a number or an expression of x, y and z in quotes")
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Number, E> {
                Ok(Number::Constant(value as f64))
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Number, E> {
                match magnitude::check(value) {
                    Ok(value) => Ok(Number::Constant(value)),
                    Err(expected) => Err(E::custom(format!("{value:e} isn't {expected}"))),
                }
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Number, E> {
                let expression = Expression::parse(text).map_err(E::custom)?;
                if !expression.is_constant() {
                    return Ok(Number::Varying(expression));
                }
                let number = Number::Varying(expression);
                number.at([0.0; 3]).map(Number::Constant).map_err(E::custom)
            }
        }
        deserializer.deserialize_any(NumberVisitor)
    }
}

/// A finite number independent of position; an expression without x, y and z is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Number")]
pub struct Constant(pub f64);

impl TryFrom<Number> for Constant {
    type Error = String;

    fn try_from(number: Number) -> Result<Self, String> {
        match number {
            Number::Constant(value) => Ok(Self(value)),
            Number::Varying(expression) => Err(format!(
                "'{}' depends on the place; expected a constant",
                expression.text()
            )),
        }
    }
}

impl Constant {
    /// Reads a number for which `holds` is true; the message for others begins with `what` and ends with the `expected`
    /// value.
    pub(super) fn checked<'de, D: Deserializer<'de>>(
        deserializer: D,
        holds: impl Fn(f64) -> bool,
        what: &str,
        expected: &str,
    ) -> Result<f64, D::Error> {
        let Self(value) = Self::deserialize(deserializer)?;
        match holds(value) {
            true => Ok(value),
            false => Err(D::Error::custom(format!(
                "{what} is {}; expected {expected}",
                magnitude::plain(value)
            ))),
        }
    }
}

/// A vector of two or three numbers.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Vec<Number>")]
pub struct Vector(Vec<Number>);

impl TryFrom<Vec<Number>> for Vector {
    type Error = String;

    fn try_from(components: Vec<Number>) -> Result<Self, String> {
        match components.len() {
            2 | 3 => Ok(Self(components)),
            count => Err(format!(
                "a vector of {count} components; expected one for each direction of space, and in numbers a decimal point"
            )),
        }
    }
}

impl Vector {
    /// Number of its components.
    pub fn dim(&self) -> usize {
        self.0.len()
    }

    /// The error in the vector for `dim` dimensions.
    pub(super) fn fault(&self, dim: usize) -> Option<String> {
        match self.dim() == dim {
            true => self.0.iter().find_map(|number| number.fault(dim)),
            false => Some(expected_components(dim)),
        }
    }

    /// Value at a point (m), with zero for a missing third component.
    ///
    /// # Errors
    /// An expression that isn't finite there.
    pub fn at(&self, point: [f64; 3]) -> Result<[f64; 3], String> {
        let mut value = [0.0; 3];
        for (component, number) in value.iter_mut().zip(&self.0) {
            *component = number.at(point)?;
        }
        Ok(value)
    }

    /// True if it is uniform.
    pub fn is_constant(&self) -> bool {
        self.0.iter().all(Number::is_constant)
    }
}

/// Advice on 'plane' for a value with the dimension of space.
pub(super) const OR_IN_SPACE: &str = "; where the mesh is one of space, 'plane' is left out";

/// Expectation of a vector, as text.
pub(super) fn expected_components(dim: usize) -> String {
    match dim {
        2 => format!("a plane scene has vectors of two components{OR_IN_SPACE}"),
        _ => "a scene in space has vectors of three components".into(),
    }
}

/// A uniform vector.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Vector")]
pub struct ConstantVector {
    /// Number of its components.
    pub dim: usize,
    /// Value, with zero for a missing third component.
    pub value: [f64; 3],
}

impl TryFrom<Vector> for ConstantVector {
    type Error = String;

    fn try_from(vector: Vector) -> Result<Self, String> {
        let dim = vector.dim();
        let mut value = [0.0; 3];
        for (component, number) in value.iter_mut().zip(vector.0) {
            *component = Constant::try_from(number)?.0;
        }
        Ok(Self { dim, value })
    }
}
