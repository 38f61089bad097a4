//! Local directions of a deck: `*ORIENTATION` of materials, `*TRANSFORM` of nodes.

use crate::element::geometry::{cross, difference, dot, length};
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Data, Position, Source};
use crate::name;

type Vector = [f64; 3];

/// Unit vectors along local axes.
pub(super) type Axes = [Vector; 3];

/// A local system of coordinates.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum System {
    /// Axes that are the same everywhere.
    Rectangular(Axes),
    /// Radial, hoop and axial directions, for the axis through two points.
    Cylindrical(Vector, Vector),
}

impl System {
    /// The system of an `*ORIENTATION`, possibly rotated about one of its axes.
    pub(super) fn of_material(source: &Source, block: &Block) -> Result<Self, InputError> {
        let definition = block.parameter("DEFINITION").unwrap_or("COORDINATES");
        if !definition.eq_ignore_ascii_case("COORDINATES") {
            let message = format!(
                "*ORIENTATION of DEFINITION={} isn't read; expected coordinates of points",
                name::shown(definition)
            );
            return Err(source.error(block.place, message));
        }
        let system = block.parameter("SYSTEM").unwrap_or("RECTANGULAR");
        let found = Self::read(source, block, system)?;
        let Some(data) = block.data.get(1) else {
            return Ok(found);
        };
        let row = numbers(source, data, "an axis and an angle")?;
        match (found, &row[..]) {
            (Self::Rectangular(axes), &[axis, angle, ..]) if [1.0, 2.0, 3.0].contains(&axis) => {
                Ok(Self::Rectangular(turned(axes, axis as usize - 1, angle)))
            }
            (_, &[_] | &[]) => Ok(found),
            (_, &[_, 0.0, ..]) => Ok(found),
            _ => Err(source.error(
                data.place,
                "expected the number of an axis, 1 to 3, of a rectangular system, and an angle",
            )),
        }
    }

    /// The system of a `*TRANSFORM`.
    pub(super) fn of_nodes(source: &Source, block: &Block) -> Result<Self, InputError> {
        Self::read(source, block, block.parameter("TYPE").unwrap_or("R"))
    }

    fn read(source: &Source, block: &Block, system: &str) -> Result<Self, InputError> {
        let points = match block.data.first() {
            Some(data) => numbers(source, data, "the coordinates of points")?,
            None => Vec::new(),
        };
        Self::of_points(source, block, &points, system)
    }

    /// The system of the coordinates of two points, or three.
    pub(super) fn of_points(
        source: &Source,
        block: &Block,
        points: &[f64],
        system: &str,
    ) -> Result<Self, InputError> {
        let refuse = |message: String| Err(source.error(block.place, message));
        let &[a, b, c, d, e, f, ref rest @ ..] = points else {
            return refuse(format!(
                "*{} has no two points; expected 6 coordinates in the line behind it",
                block.keyword
            ));
        };
        let origin: Vector = match *rest {
            [x, y, z] => [x, y, z],
            _ if rest.iter().all(|&number| number == 0.0) => [0.0; 3],
            _ => {
                return refuse(format!(
                    "*{} has {} coordinates; expected 6 or 9, with points in numbers, not commas",
                    block.keyword,
                    points.len()
                ));
            }
        };
        let (a, b) = ([a, b, c], [d, e, f]);
        match system
            .chars()
            .next()
            .map(|letter| letter.to_ascii_uppercase())
        {
            Some('R') => {
                let (first, second) = (difference(a, origin), difference(b, origin));
                let third = cross(first, second);
                if length(third) <= 1e-12 * length(first) * length(second) {
                    return refuse(format!(
                        "the points of *{} lie on a line; expected a plane",
                        block.keyword
                    ));
                }
                let axes = [first, cross(third, first), third];
                Ok(Self::Rectangular(axes.map(unit)))
            }
            Some('C') if a != b => Ok(Self::Cylindrical(a, b)),
            _ => refuse(format!(
                "*{} of the system {} isn't read; expected rectangular or cylindrical coordinates",
                block.keyword,
                name::shown(system)
            )),
        }
    }

    /// The system of a part, as an instance has it.
    pub(super) fn placed(&self, position: &Position) -> Self {
        match *self {
            Self::Rectangular(axes) => Self::Rectangular(axes.map(|axis| position.direction(axis))),
            Self::Cylindrical(a, b) => Self::Cylindrical(position.of(a), position.of(b)),
        }
    }

    /// The axes at a point.
    pub(super) fn at(&self, point: Vector) -> Axes {
        match *self {
            Self::Rectangular(axes) => axes,
            Self::Cylindrical(a, b) => {
                let axis = unit(difference(b, a));
                let arm = difference(point, a);
                let along = dot(arm, axis);
                let out = [0, 1, 2].map(|k| arm[k] - along * axis[k]);
                let out = match length(out) > 1e-12 * length(arm) {
                    true => unit(out),
                    // On the axis any radial direction is valid.
                    false => unit(cross(axis, least(axis))),
                };
                [out, cross(axis, out), axis]
            }
        }
    }
}

/// The numbers of a line of data.
pub(super) fn numbers(source: &Source, data: &Data, what: &str) -> Result<Vec<f64>, InputError> {
    let items = source.items(data);
    items
        .map(|item| source.real(data.place, item, what))
        .collect()
}

fn unit(vector: Vector) -> Vector {
    let norm = length(vector);
    vector.map(|component| component / norm)
}

/// The coordinate axis with the smallest component along a direction.
pub(super) fn least(direction: Vector) -> Vector {
    let mut axis = [0.0; 3];
    let smallest = (0..3).min_by(|&i, &j| direction[i].abs().total_cmp(&direction[j].abs()));
    axis[smallest.unwrap_or_default()] = 1.0;
    axis
}

/// Axes rotated about one of themselves by an angle in degrees.
fn turned(axes: Axes, about: usize, angle: f64) -> Axes {
    let (sin, cos) = angle.to_radians().sin_cos();
    let (next, last) = ((about + 1) % 3, (about + 2) % 3);
    let mut turned = axes;
    for k in 0..3 {
        turned[next][k] = cos * axes[next][k] + sin * axes[last][k];
        turned[last][k] = cos * axes[last][k] - sin * axes[next][k];
    }
    turned
}
