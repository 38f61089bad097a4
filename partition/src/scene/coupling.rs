//! Couplings of a side, or of points, to a reference point.

use serde::Deserialize;

use super::condition::Names;
use super::contact::contact_name;
use super::number::{Constant, ConstantVector, OR_IN_SPACE, expected_components};
use crate::element::geometry::{advance, cross, difference, dot, unit};

/// Components of the motion of a reference point, and their keys: translations, then rotations.
pub const COMPONENTS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Nodes that follow a reference point, with its forces, moments and prescribed motion.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(from = "CouplingKeys")]
pub struct Coupling {
    /// Name.
    pub name: String,
    /// The coupled groups of facets or points.
    pub on: Names,
    /// The reference point (m).
    pub point: ConstantVector,
    /// Kind of coupling: rigid, in some directions, or distributing.
    pub kind: CouplingKind,
    /// The coupled directions; empty for all.
    pub directions: Vec<ConstantVector>,
    /// The axis of cylindrical directions, which are then radial, hoop and axial.
    pub axis: Option<Axis>,
    /// Loads and prescribed motions of the point.
    pub loads: CouplingLoads,
}

/// An axis through a point.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of point and direction")]
pub struct Axis {
    /// The point (m).
    pub point: ConstantVector,
    /// The direction.
    pub direction: ConstantVector,
}

impl Axis {
    /// The vector with radial, hoop and axial components at a position; `None` on the axis, unless it is axial.
    pub fn vector(&self, components: [f64; 3], x: [f64; 3]) -> Option<[f64; 3]> {
        let along = unit(self.direction.value)?;
        let arm = difference(x, self.point.value);
        let arm = advance(arm, -dot(arm, along), along);
        if components[..2] == [0.0; 2] {
            return Some(along.map(|c| components[2] * c));
        }
        let radial = unit(arm)?;
        let parts = components
            .into_iter()
            .zip([radial, cross(along, radial), along]);
        Some(parts.fold([0.0; 3], |sum, (component, axis)| {
            advance(sum, component, axis)
        }))
    }
}

/// The kind of coupling.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CouplingKind {
    /// The nodes move rigidly with the point.
    #[default]
    Rigid,
    /// The point moves with the average motion of the nodes; its forces are distributed over them, and they may deform.
    Distributing,
}

/// Loads and prescribed motions of a reference point; in a step they replace those of the scene.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    default,
    expecting = "a table of force, moment, x, y, z, rx, ry and rz"
)]
pub struct CouplingLoads {
    /// Force (N).
    pub force: Option<ConstantVector>,
    /// Moment about the point (N m).
    pub moment: Option<Moment>,
    x: Option<Constant>,
    y: Option<Constant>,
    z: Option<Constant>,
    rx: Option<Constant>,
    ry: Option<Constant>,
    rz: Option<Constant>,
}

/// A moment: in the plane a number, in space a vector.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected a number in the plane, three in space")]
pub enum Moment {
    /// About z.
    Plane(Constant),
    /// About x, y and z.
    Space([Constant; 3]),
}

impl Moment {
    /// The components (N m).
    pub fn value(&self) -> [f64; 3] {
        match self {
            Self::Plane(Constant(about_z)) => [0.0, 0.0, *about_z],
            Self::Space(components) => [0, 1, 2].map(|k| components[k].0),
        }
    }
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of name, on, point, kind, directions, axis, force, moment, x, y, z, rx, ry and rz"
)]
struct CouplingKeys {
    #[serde(deserialize_with = "contact_name")]
    name: String,
    on: Names,
    point: ConstantVector,
    #[serde(default)]
    kind: CouplingKind,
    #[serde(default)]
    directions: Vec<ConstantVector>,
    axis: Option<Axis>,
    force: Option<ConstantVector>,
    moment: Option<Moment>,
    x: Option<Constant>,
    y: Option<Constant>,
    z: Option<Constant>,
    rx: Option<Constant>,
    ry: Option<Constant>,
    rz: Option<Constant>,
}

impl From<CouplingKeys> for Coupling {
    fn from(keys: CouplingKeys) -> Self {
        Self {
            name: keys.name,
            on: keys.on,
            point: keys.point,
            kind: keys.kind,
            directions: keys.directions,
            axis: keys.axis,
            loads: CouplingLoads {
                force: keys.force,
                moment: keys.moment,
                x: keys.x,
                y: keys.y,
                z: keys.z,
                rx: keys.rx,
                ry: keys.ry,
                rz: keys.rz,
            },
        }
    }
}

impl CouplingLoads {
    /// The prescribed components of the motion (m, rad), in the order of [`COMPONENTS`].
    pub fn prescribed(&self) -> [Option<f64>; 6] {
        let all = [&self.x, &self.y, &self.z, &self.rx, &self.ry, &self.rz];
        all.map(|component| component.as_ref().map(|Constant(value)| *value))
    }

    /// The invalid key for `dim` dimensions, and the reason.
    pub(super) fn fault(&self, dim: usize) -> Option<(&'static str, String)> {
        let wrong_force = self.force.as_ref().filter(|force| force.dim != dim);
        if wrong_force.is_some() {
            return Some(("force", expected_components(dim)));
        }
        let expected = match (&self.moment, dim) {
            (Some(Moment::Space(_)), 2) => {
                Some(format!("a plane scene has one number{OR_IN_SPACE}"))
            }
            (Some(Moment::Plane(_)), 3) => Some("a scene in space has three components".into()),
            _ => None,
        };
        if let Some(expected) = expected {
            return Some(("moment", expected));
        }
        let given = self.prescribed().into_iter().zip(COMPONENTS);
        let mut beside =
            given.filter(|(value, key)| value.is_some() && ["z", "rx", "ry"].contains(key));
        let (_, key) = beside.next().filter(|_| dim == 2)?;
        Some((key, format!("a plane scene has no '{key}'{OR_IN_SPACE}")))
    }
}
