//! Named quantities of interest.

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
    /// The average of a stress over a body.
    MeanStress {
        /// Name of the body.
        body: String,
        /// The component.
        component: StressComponent,
    },
    /// Reaction on the bodies of all boundary conditions on a group.
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
    /// The moment about an axis that a contact exerts on side a.
    ContactMoment {
        /// Name of the contact.
        contact: String,
        /// A point of the axis.
        about: ConstantVector,
        /// The direction of the axis in space; z in the plane.
        axis: Option<ConstantVector>,
    },
    /// The average or the largest pressure of a contact.
    Pressure {
        /// Name of the contact.
        contact: String,
        /// Average or largest pressure.
        kind: QuantityKind,
        /// The smoothing length of the largest pressure (m); 0 without smoothing.
        over: f64,
    },
    /// A stress intensity factor of a crack tip, or its energy release rate.
    CrackTip {
        /// Name of the tip.
        tip: String,
        /// Stress intensity factor or energy release rate.
        kind: QuantityKind,
    },
    /// The remaining gap at a point of a contact.
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

/// A component of a stress, by its index in results: XX YY ZZ XY YZ XZ.
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

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Displacement,
    MeanStress,
    Reaction,
    ContactForce,
    ContactMoment,
    MeanPressure,
    LargestPressure,
    Opening,
    Energy,
    #[serde(rename = "k_i")]
    OpeningIntensity,
    #[serde(rename = "k_ii")]
    SlidingIntensity,
    EnergyReleaseRate,
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
    expecting = "a table of name, kind, at, node, direction, contact, body, on, component, about, over and tip"
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
    about: Option<ConstantVector>,
    over: Option<f64>,
    tip: Option<String>,
}

/// The keys besides name and kind that no kind has taken yet.
#[derive(Default, PartialEq)]
struct Given {
    place: Option<Place>,
    /// The direction; the inner `None` is the normal direction.
    along: Option<Option<ConstantVector>>,
    contact: Option<String>,
    body: Option<String>,
    on: Option<String>,
    component: Option<StressComponent>,
    about: Option<ConstantVector>,
    over: Option<f64>,
    tip: Option<String>,
}

/// A unit vector; its dimension is 0 for one of the first two axes, which is valid in any dimension.
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

impl Given {
    /// Takes the keys of a kind; `None` if a required one is missing.
    fn take(&mut self, kind: Kind) -> Option<Target> {
        Some(match kind {
            Kind::Displacement => Target::Displacement {
                at: self.place.take()?,
                along: self.along.take()??,
            },
            Kind::MeanStress => Target::MeanStress {
                body: self.body.take()?,
                component: self.component.take()?,
            },
            Kind::Reaction => Target::Reaction {
                on: self.on.take()?,
                along: self.along.take()??,
            },
            Kind::ContactForce => Target::ContactForce {
                contact: self.contact.take()?,
                along: self.along.take().flatten(),
            },
            Kind::ContactMoment => Target::ContactMoment {
                contact: self.contact.take()?,
                about: self.about.take()?,
                axis: match self.along.take() {
                    Some(axis) => Some(axis?),
                    None => None,
                },
            },
            Kind::MeanPressure => Target::Pressure {
                contact: self.contact.take()?,
                kind: QuantityKind::MeanPressure,
                over: 0.0,
            },
            Kind::LargestPressure => Target::Pressure {
                contact: self.contact.take()?,
                kind: QuantityKind::LargestPressure,
                over: self.over.take().unwrap_or(0.0),
            },
            Kind::Opening => Target::Opening {
                contact: self.contact.take()?,
                at: self.place.take()?,
            },
            Kind::Energy => Target::Energy,
            Kind::OpeningIntensity => self.of_tip(QuantityKind::OpeningIntensity)?,
            Kind::SlidingIntensity => self.of_tip(QuantityKind::SlidingIntensity)?,
            Kind::EnergyReleaseRate => self.of_tip(QuantityKind::EnergyReleaseRate)?,
        })
    }

    fn of_tip(&mut self, kind: QuantityKind) -> Option<Target> {
        let tip = self.tip.take()?;
        Some(Target::CrackTip { tip, kind })
    }
}

impl Kind {
    /// The keys of this kind of quantity, in words.
    fn expected(self) -> &'static str {
        match self {
            Self::Displacement => {
                "a displacement has 'direction', an axis or a vector, and 'at' or 'node'"
            }
            Self::MeanStress => "a mean stress has 'body' and 'component'",
            Self::Reaction => "a reaction has 'on' and 'direction', an axis or a vector",
            Self::ContactForce => "a contact force has 'contact' and perhaps 'direction'",
            Self::ContactMoment => {
                "a contact moment has 'contact' and 'about', a point, in space also 'direction', an axis or a vector"
            }
            Self::MeanPressure => "a mean pressure has 'contact'",
            Self::LargestPressure => "a largest pressure has 'contact' and perhaps 'over'",
            Self::Opening => "an opening has 'contact', and 'at' or 'node'",
            Self::Energy => "an energy has no other key; it is that of all bodies",
            Self::OpeningIntensity | Self::SlidingIntensity => {
                "a stress intensity factor has 'tip', the name of a crack tip"
            }
            Self::EnergyReleaseRate => "an energy release rate has 'tip', the name of a crack tip",
        }
    }
}

impl TryFrom<Keys> for Quantity {
    type Error = &'static str;

    fn try_from(keys: Keys) -> Result<Self, Self::Error> {
        let place = match (keys.at, keys.node) {
            (Some(point), None) => Some(Place::Point(point)),
            (None, Some(node)) => Some(Place::Node(node)),
            (None, None) => None,
            (Some(_), Some(_)) => {
                return Err("'at' and 'node' are both there; expected one of them");
            }
        };
        if keys
            .over
            .is_some_and(|over| !(over > 0.0 && over.is_finite()))
        {
            return Err("'over' is a length; expected a number above 0");
        }
        let mut given = Given {
            place,
            along: keys.direction.map(unit).transpose()?,
            contact: keys.contact,
            body: keys.body,
            on: keys.on,
            component: keys.component,
            about: keys.about,
            over: keys.over,
            tip: keys.tip,
        };
        let of = given.take(keys.kind).filter(|_| given == Given::default());
        let of = of.ok_or(keys.kind.expected())?;
        let name = keys.name;
        Ok(Self { name, of })
    }
}

impl Quantity {
    /// The key that is invalid in `dim` dimensions, and the reason.
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
            Target::ContactMoment { about, axis, .. } => {
                let fault = match (dim, axis) {
                    (2, Some(_)) => "in the plane a moment is one about z; expected no direction",
                    (3, None) => {
                        "the axis of a moment is missing; expected \"x\", \"y\", \"z\" or a vector"
                    }
                    _ if about.dim != dim => return Some(("about", expected_components(dim))),
                    _ => "",
                };
                if !fault.is_empty() {
                    return Some(("direction", fault.into()));
                }
                (None, axis.as_ref())
            }
            Target::Pressure { .. } | Target::Energy | Target::CrackTip { .. } => (None, None),
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
