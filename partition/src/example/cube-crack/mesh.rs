//! The granite block in space: two inclined edge cracks that end inside the block, both across it and along its depth.

use super::Shape;
use super::cubes::{Cube, along};
use crate::element::ElementKind;

pub(super) const ABOUT: &str = "the granite block in space, with cracks that end inside it";
pub(super) const SUBDOMAINS: usize = 8;
pub(super) const SHAPE: Shape = Shape::Cubes {
    cubes,
    kind: ElementKind::Hexahedron8,
};

/// Height of the block (m).
const HEIGHT: f64 = 10.0;
/// Start and end of the left crack, end and start of the right one: across and up (m).
const LINE: [[f64; 2]; 4] = [[0.0, 6.5], [3.0, 5.0], [7.0, 5.0], [10.0, 6.5]];
/// Grid lines, graded towards the fronts of the cracks: across the three columns (fractions of each), along the depth
/// from the plane of symmetry to the end of the cracks and on to the end of the block (m), and from either end up or
/// down to the line (fractions of the distance).
const COLUMNS: [&[f64]; 3] = [
    &[0.0, 0.22, 0.44, 0.64, 0.81, 0.93, 1.0],
    &[0.0, 0.07, 0.2, 0.37, 0.5, 0.63, 0.8, 0.93, 1.0],
    &[0.0, 0.07, 0.19, 0.36, 0.56, 0.78, 1.0],
];
const DEPTHS: [&[f64]; 2] = [&[0.0, 0.7, 1.4, 2.0, 2.45, 2.8, 3.0], &[3.0, 3.2, 3.7, 5.0]];
const ROWS: [f64; 8] = [0.0, 0.2, 0.4, 0.58, 0.74, 0.87, 0.95, 1.0];

fn cubes() -> Vec<Cube> {
    let parts = (0..3).flat_map(|column| (0..2).map(move |part| (column, part)));
    parts
        .flat_map(|(column, part)| [cube(column, part, false), cube(column, part, true)])
        .collect()
}

/// A column in a part of the depth, below or above the line.
fn cube(column: usize, part: usize, upper: bool) -> Cube {
    let [[left, start], [right, end]] = [LINE[column], LINE[column + 1]];
    let map = move |[s, t, r]: [f64; 3]| {
        let s = along(COLUMNS[column], s);
        let line = start * (1.0 - s) + end * s;
        let height = match upper {
            false => along(&ROWS, r) * line,
            true => {
                let part = along(&ROWS, 1.0 - r);
                line * part + HEIGHT * (1.0 - part)
            }
        };
        [left * (1.0 - s) + right * s, along(DEPTHS[part], t), height]
    };
    let crack = match (column, part, upper) {
        (0, 0, false) => Some("left crack lower"),
        (0, 0, true) => Some("left crack upper"),
        (2, 0, false) => Some("right crack lower"),
        (2, 0, true) => Some("right crack upper"),
        _ => None,
    };
    let across = match (column, upper) {
        (0, true) => [Some("upper left"), None],
        (2, false) => [None, Some("lower right")],
        _ => [None, None],
    };
    let along = [(part == 0).then_some("middle"), None];
    let up = match upper {
        false => [Some("bottom"), crack],
        true => [crack, Some("top")],
    };
    let lines = [COLUMNS[column].len(), DEPTHS[part].len(), ROWS.len()];
    Cube::new(
        "block",
        lines.map(|count| count - 1),
        map,
        [across, along, up],
    )
}
