//! Quantities: what a user wants to know of the solution, by a name.

use serde::Deserialize;

use super::number::{ConstantVector, OR_IN_SPACE, expected_components};
use crate::element::geometry::length;
use crate::quantity::QuantityKind;

/// A quantity of the solution.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Keys")]
pub struct Quantity {
    /// Name.
    pub name: String,
    /// Kind of the quantity.
    pub of: Target,
}

/// Kinds of quantities.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// The displacement of a node.
    Displacement {
        /// The node.
        at: Place,
        /// The direction.
        along: ConstantVector,
    },
    /// The mean of a stress over a body.
    MeanStress {
        /// Name of the body.
        body: String,
        /// The component.
        component: StressComponent,
    },
    /// Reaction on the bodies of all conditions on a group.
    Reaction {
        /// Name of the group.
        on: String,
        /// The direction.
        along: ConstantVector,
    },
    /// The force that a contact exerts on side a.
    ContactForce {
        /// Name of the contact.
        contact: String,
        /// The direction; `None` for the sum of normal forces.
        along: Option<ConstantVector>,
    },
    /// The mean or the largest pressure of a contact.
    Pressure {
        /// Name of the contact.
        contact: String,
        /// Which of them.
        kind: QuantityKind,
    },
    /// The gap that is left at a point of a contact.
    Opening {
        /// Name of the contact.
        contact: String,
        /// The node of the point.
        at: Place,
    },
    /// The elastic energy of all bodies.
    Energy,
}

/// A node: the nearest to a point, or by its tag.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// The point (m).
    Point(ConstantVector),
    /// The tag.
    Node(i64),
}

/// A component of a stress, by its place in results: XX YY ZZ XY YZ XZ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StressComponent {
    /// σ_xx.
    Xx,
    /// σ_yy.
    Yy,
    /// σ_zz.
    Zz,
    /// σ_xy.
    Xy,
    /// σ_yz.
    Yz,
    /// σ_xz.
    Xz,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Displacement,
    MeanStress,
    Reaction,
    ContactForce,
    MeanPressure,
    LargestPressure,
    Opening,
    Energy,
}

#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "expected a direction: \"x\", \"y\", \"z\", \"normal\" or a vector of numbers"
)]
enum Direction {
    Axis(Axis),
    Vector(ConstantVector),
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Axis {
    X,
    Y,
    Z,
    Normal,
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of name, kind, at, node, direction, contact, body, on and component"
)]
struct Keys {
    name: String,
    kind: Kind,
    at: Option<ConstantVector>,
    node: Option<i64>,
    direction: Option<Direction>,
    contact: Option<String>,
    body: Option<String>,
    on: Option<String>,
    component: Option<StressComponent>,
}

/// A unit vector; its dimension is 0 where it is one of the first two axes, which any space has.
fn unit(direction: Direction) -> Result<Option<ConstantVector>, &'static str> {
    let axis = |dim, k: usize| ConstantVector {
        dim,
        value: std::array::from_fn(|i| f64::from(i == k)),
    };
    Ok(Some(match direction {
        Direction::Axis(Axis::X) => axis(0, 0),
        Direction::Axis(Axis::Y) => axis(0, 1),
        Direction::Axis(Axis::Z) => axis(3, 2),
        Direction::Axis(Axis::Normal) => return Ok(None),
        Direction::Vector(vector) => {
            let size = length(vector.value);
            if size == 0.0 {
                return Err("the zero vector has no direction");
            }
            ConstantVector {
                value: vector.value.map(|c| c / size),
                ..vector
            }
        }
    }))
}

impl TryFrom<Keys> for Quantity {
    type Error = &'static str;

    fn try_from(keys: Keys) -> Result<Self, Self::Error> {
        let along = keys.direction.map(unit).transpose()?;
        let place = match (keys.at, keys.node) {
            (Some(point), None) => Some(Place::Point(point)),
            (None, Some(node)) => Some(Place::Node(node)),
            (None, None) => None,
            (Some(_), Some(_)) => {
                return Err("'at' and 'node' are both there; expected one of them");
            }
        };
        let rest = (keys.contact, keys.body, keys.on, keys.component);
        let of = match (keys.kind, place, along, rest) {
            (Kind::Displacement, Some(at), Some(Some(along)), (None, None, None, None)) => {
                Target::Displacement { at, along }
            }
            (Kind::Displacement, ..) => {
                return Err(
                    "a displacement has 'direction', an axis or a vector, and 'at' or 'node'",
                );
            }
            (Kind::MeanStress, None, None, (None, Some(body), None, Some(component))) => {
                Target::MeanStress { body, component }
            }
            (Kind::MeanStress, ..) => return Err("a mean stress has 'body' and 'component'"),
            (Kind::Reaction, None, Some(Some(along)), (None, None, Some(on), None)) => {
                Target::Reaction { on, along }
            }
            (Kind::Reaction, ..) => {
                return Err("a reaction has 'on' and 'direction', an axis or a vector");
            }
            (Kind::ContactForce, None, along, (Some(contact), None, None, None)) => {
                let along = along.flatten();
                Target::ContactForce { contact, along }
            }
            (Kind::ContactForce, ..) => {
                return Err("a contact force has 'contact' and perhaps 'direction'");
            }
            (Kind::MeanPressure, None, None, (Some(contact), None, None, None)) => {
                let kind = QuantityKind::MeanPressure;
                Target::Pressure { contact, kind }
            }
            (Kind::LargestPressure, None, None, (Some(contact), None, None, None)) => {
                let kind = QuantityKind::LargestPressure;
                Target::Pressure { contact, kind }
            }
            (Kind::MeanPressure | Kind::LargestPressure, ..) => {
                return Err("a pressure has 'contact'");
            }
            (Kind::Opening, Some(at), None, (Some(contact), None, None, None)) => {
                Target::Opening { contact, at }
            }
            (Kind::Opening, ..) => return Err("an opening has 'contact', and 'at' or 'node'"),
            (Kind::Energy, None, None, (None, None, None, None)) => Target::Energy,
            (Kind::Energy, ..) => {
                return Err("an energy has no other key; it is that of all bodies");
            }
        };
        let name = keys.name;
        Ok(Self { name, of })
    }
}

impl Quantity {
    /// The key that space of `dim` dimensions has no place for, and why.
    pub(super) fn fault(&self, dim: usize) -> Option<(&'static str, String)> {
        let (at, along) = match &self.of {
            Target::Displacement { at, along } => (Some(at), Some(along)),
            Target::Reaction { along, .. } => (None, Some(along)),
            Target::ContactForce { along, .. } => (None, along.as_ref()),
            Target::Opening { at, .. } => (Some(at), None),
            Target::MeanStress { component, .. } => {
                let is_spatial = matches!(component, StressComponent::Yz | StressComponent::Xz);
                let fault = format!("a plane scene has no such shear{OR_IN_SPACE}");
                return (dim == 2 && is_spatial).then_some(("component", fault));
            }
            Target::Pressure { .. } | Target::Energy => (None, None),
        };
        let point = match at {
            Some(Place::Point(point)) => Some(point),
            _ => None,
        };
        let wrong = |vector: &&ConstantVector| vector.dim != dim && vector.dim != 0;
        (point.filter(wrong).map(|_| "at"))
            .or(along.filter(wrong).map(|_| "direction"))
            .map(|key| (key, expected_components(dim)))
    }
}
