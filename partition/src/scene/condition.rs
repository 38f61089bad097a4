//! Bodies, supports, loads and obstacles in a scene.

use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};

use super::initial::{InitialStress, Thermal};
use super::number::{Constant, ConstantVector, Number, OR_IN_SPACE, Vector, expected_components};

/// Names of physical groups: one, or a list without repetition.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Names(Vec<String>);

impl Names {
    /// The names in the order in which they were given.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(String::as_str)
    }
}

impl From<String> for Names {
    fn from(name: String) -> Self {
        Self(vec![name])
    }
}

impl std::fmt::Display for Names {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        for (i, name) in self.iter().enumerate() {
            write!(f, "{}'{name}'", if i == 0 { "" } else { ", " })?;
        }
        Ok(())
    }
}

impl<'de> Deserialize<'de> for Names {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NamesVisitor;
        impl<'de> Visitor<'de> for NamesVisitor {
            type Value = Names;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("the name of a physical group or a list of names")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Names, E> {
                Ok(Names(vec![name.to_owned()]))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Names, A::Error> {
                let mut names = Vec::new();
                while let Some(name) = list.next_element::<String>()? {
                    if names.contains(&name) {
                        return Err(A::Error::custom(format!("'{name}' stands here twice")));
                    }
                    names.push(name);
                }
                if names.is_empty() {
                    return Err(A::Error::custom("an empty list; expected names of groups"));
                }
                Ok(Names(names))
            }
        }
        deserializer.deserialize_any(NamesVisitor)
    }
}

/// A body: groups of cells of one material.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of material, body_force, initial_stress, thermal and integration"
)]
pub struct Body {
    /// Name of its material.
    pub material: String,
    /// Force per volume (N/m³).
    pub body_force: Option<Vector>,
    /// Initial stress (Pa).
    pub initial_stress: Option<InitialStress>,
    /// Thermal expansion.
    pub thermal: Option<Thermal>,
    /// Integration of its quadratic quadrilaterals and hexahedra.
    #[serde(default)]
    pub integration: Integration,
}

/// Integration of the stiffness of quadratic quadrilaterals and hexahedra.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Integration {
    /// Three points in each direction.
    #[default]
    Full,
    /// Two points in each direction.
    Reduced,
}

impl Body {
    /// True with initial stress or thermal stress.
    pub fn has_initial_stress(&self) -> bool {
        self.initial_stress.is_some() || self.thermal.is_some()
    }
}

/// Γ_u: prescribed displacements. A component left out is free.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "DisplacementKeys")]
pub struct Displacement {
    /// The groups on which it is prescribed.
    pub on: Names,
    /// u_x, u_y, u_z (m).
    pub components: [Option<Number>; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of on, x, y and z")]
struct DisplacementKeys {
    on: Names,
    x: Option<Number>,
    y: Option<Number>,
    z: Option<Number>,
}

impl TryFrom<DisplacementKeys> for Displacement {
    type Error = &'static str;

    fn try_from(keys: DisplacementKeys) -> Result<Self, Self::Error> {
        let components = [keys.x, keys.y, keys.z];
        if components.iter().all(Option::is_none) {
            return Err("it prescribes nothing; expected at least one of 'x', 'y' and 'z'");
        }
        Ok(Self {
            on: keys.on,
            components,
        })
    }
}

/// Γ_o: u·n = 0.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of on")]
pub struct Bilateral {
    /// The groups on which it holds.
    pub on: Names,
}

/// Γ_τ: a force per area.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of on and value")]
pub struct Traction {
    /// The groups on which it acts.
    pub on: Names,
    /// τ (N/m²).
    pub value: Vector,
}

/// Γ_τ: a force per area along the normal.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of on and value")]
pub struct Pressure {
    /// The groups on which it acts.
    pub on: Names,
    /// Pressure, positive where it pushes into the body (N/m²).
    pub value: Number,
}

/// Forces on nodes.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "ForceKeys")]
pub struct Force {
    /// The groups of facets or points on whose nodes it acts.
    pub on: Names,
    /// Size of the force, and its distribution over the nodes.
    pub amount: ForceAmount,
}

/// A force on several nodes.
#[derive(Clone, Debug, PartialEq)]
pub enum ForceAmount {
    /// The sum of all nodal forces (N), distributed like a uniform traction on facets, equally on points.
    Total(ConstantVector),
    /// The force on every node (N).
    Each(Vector),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of on, and total or each")]
struct ForceKeys {
    on: Names,
    total: Option<ConstantVector>,
    each: Option<Vector>,
}

impl TryFrom<ForceKeys> for Force {
    type Error = &'static str;

    fn try_from(keys: ForceKeys) -> Result<Self, Self::Error> {
        let amount = match (keys.total, keys.each) {
            (Some(total), None) => ForceAmount::Total(total),
            (None, Some(each)) => ForceAmount::Each(each),
            _ => {
                return Err(
                    "expected 'total', the sum of forces, or 'each', the force on every node",
                );
            }
        };
        Ok(Self {
            on: keys.on,
            amount,
        })
    }
}

impl ForceAmount {
    /// The key of the force, and the reason if it is invalid in `dim` dimensions.
    pub(super) fn fault(&self, dim: usize) -> (&'static str, Option<String>) {
        match self {
            Self::Total(total) => (
                "total",
                (total.dim != dim).then(|| expected_components(dim)),
            ),
            Self::Each(each) => ("each", each.fault(dim)),
        }
    }
}

/// A rigid obstacle.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "ObstacleKeys")]
pub enum Obstacle {
    /// The half-space behind a flat wall.
    HalfSpace {
        /// A point on the wall (m).
        point: ConstantVector,
        /// Direction out of the obstacle towards the body, of any nonzero length.
        normal: ConstantVector,
    },
    /// A circle, in space a sphere.
    Ball {
        /// Centre (m).
        center: ConstantVector,
        /// Radius (m).
        radius: f64,
        /// True if bodies are kept inside instead of outside.
        inside: bool,
    },
    /// A cylinder of infinite length.
    Cylinder {
        /// A point on its axis (m).
        point: ConstantVector,
        /// Direction of its axis, of any nonzero length.
        axis: ConstantVector,
        /// Radius (m).
        radius: f64,
        /// True if bodies are kept inside instead of outside.
        inside: bool,
    },
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of point and normal, of center and radius, or of point, axis and radius"
)]
struct ObstacleKeys {
    point: Option<ConstantVector>,
    #[serde(default, deserialize_with = "direction")]
    normal: Option<ConstantVector>,
    center: Option<ConstantVector>,
    #[serde(default, deserialize_with = "direction")]
    axis: Option<ConstantVector>,
    #[serde(default, deserialize_with = "radius")]
    radius: Option<f64>,
    inside: Option<bool>,
}

impl TryFrom<ObstacleKeys> for Obstacle {
    type Error = &'static str;

    fn try_from(keys: ObstacleKeys) -> Result<Self, Self::Error> {
        let inside = keys.inside.unwrap_or(false);
        let obstacle = match (keys.point, keys.normal, keys.center, keys.axis, keys.radius) {
            (Some(point), Some(normal), None, None, None) if keys.inside.is_none() => {
                Self::HalfSpace { point, normal }
            }
            (None, None, Some(center), None, Some(radius)) => Self::Ball {
                center,
                radius,
                inside,
            },
            (Some(point), None, None, Some(axis), Some(radius)) => Self::Cylinder {
                point,
                axis,
                radius,
                inside,
            },
            _ => {
                return Err("expected 'point' and 'normal' (a straight wall), \
                            'center', 'radius' and perhaps 'inside' (a circle or sphere), \
                            or 'point', 'axis', 'radius' and perhaps 'inside' (a cylinder)");
            }
        };
        match &obstacle {
            Self::HalfSpace { point, normal } if point.dim != normal.dim => {
                Err("'point' and 'normal' have different numbers of components")
            }
            Self::Cylinder { point, axis, .. } if point.dim != axis.dim => {
                Err("'point' and 'axis' have different numbers of components")
            }
            _ => Ok(obstacle),
        }
    }
}

impl Obstacle {
    /// The error in the obstacle for `dim` dimensions.
    pub(super) fn fault(&self, dim: usize) -> Option<String> {
        let own = match self {
            Self::HalfSpace { point, .. } => point.dim,
            Self::Ball { center, .. } => center.dim,
            Self::Cylinder { .. } if dim == 2 => {
                return Some(format!(
                    "a plane scene has no cylinder; expected a circle{OR_IN_SPACE}"
                ));
            }
            Self::Cylinder { point, .. } => point.dim,
        };
        (own != dim).then(|| expected_components(dim))
    }
}

fn direction<'de, D>(deserializer: D) -> Result<Option<ConstantVector>, D::Error>
where
    D: Deserializer<'de>,
{
    let vector = ConstantVector::deserialize(deserializer)?;
    match vector.value == [0.0; 3] {
        true => Err(D::Error::custom("the zero vector has no direction")),
        false => Ok(Some(vector)),
    }
}

fn radius<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Constant::checked(
        deserializer,
        |value| value > 0.0,
        "the radius",
        "more than 0",
    )
    .map(Some)
}
