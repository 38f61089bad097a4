//! Position of an instance of a part.

use super::blocks::{Block, Source};
use crate::element::geometry::{cross, difference, length};
use crate::error::InputError;

pub(super) type Point = [f64; 3];

/// Length of a component of a turned direction that is round-off, as of the cosine of a right angle.
const ROUND_OFF: f64 = 1e-15;

/// A translation, and a rotation about the axis through two points.
#[derive(Clone, Copy)]
pub(crate) struct Position {
    shift: Point,
    /// Two points on the axis and the angle (rad).
    turn: Option<(Point, Point, f64)>,
}

impl Position {
    /// The position of an `*INSTANCE`, whose angle is in degrees.
    pub(crate) fn read(source: &Source, block: &Block) -> Result<Self, InputError> {
        let mut rows = Vec::new();
        for data in &block.data {
            let items = source.items(data);
            let row = items
                .map(|item| source.real(data.place, item, "a number of a shift or a rotation"));
            rows.push((data.place, row.collect::<Result<Vec<_>, _>>()?));
        }
        let mut shift = [0.0; 3];
        if let Some((_, row)) = rows.first() {
            for (to, from) in shift.iter_mut().zip(row) {
                *to = *from;
            }
        }
        let turn = match rows.get(1) {
            None => None,
            Some((place, row)) => match row[..] {
                [a, b, c, d, e, f, angle] if [a, b, c] != [d, e, f] => {
                    Some(([a, b, c], [d, e, f], angle.to_radians()))
                }
                _ => {
                    let message =
                        "expected two points on the axis of the rotation and its angle, 7 numbers";
                    return Err(source.error(*place, message));
                }
            },
        };
        Ok(Self { shift, turn })
    }

    /// Position of a point of the part.
    pub(crate) fn of(&self, point: [f64; 3]) -> [f64; 3] {
        let shifted = [0, 1, 2].map(|k| point[k] + self.shift[k]);
        self.turn
            .map_or(shifted, |(a, b, angle)| turned(shifted, a, b, angle))
    }

    /// A unit vector of the part, as the instance has it.
    pub(crate) fn direction(&self, along: [f64; 3]) -> [f64; 3] {
        let Some((a, b, angle)) = self.turn else {
            return along;
        };
        let along = turned(along, [0.0; 3], difference(b, a), angle);
        along.map(|component| {
            if component.abs() > ROUND_OFF {
                component
            } else {
                0.0
            }
        })
    }

    /// True if the instance is turned.
    pub(crate) fn is_turned(&self) -> bool {
        self.turn.is_some_and(|(.., angle)| angle != 0.0)
    }
}

/// A point rotated about the axis from `a` to `b` (Rodrigues).
fn turned(point: Point, a: Point, b: Point, angle: f64) -> Point {
    let axis = difference(b, a).map(|component| component / length(difference(b, a)));
    let arm = difference(point, a);
    let across = cross(axis, arm);
    let along: f64 = (0..3).map(|k| axis[k] * arm[k]).sum();
    let (sin, cos) = angle.sin_cos();
    [0, 1, 2].map(|k| a[k] + arm[k] * cos + across[k] * sin + axis[k] * along * (1.0 - cos))
}
