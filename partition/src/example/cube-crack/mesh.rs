//! The granite block in space: two inclined edge cracks that end inside the block, across it and along its depth.

use super::Shape;
use super::cubes::Cube;
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
/// Along the depth: the plane of symmetry, the end of the cracks, the end of the block (m).
const DEPTHS: [f64; 3] = [0.0, 3.0, 5.0];
/// Cells across the three columns, along the two parts of the depth, and from the line to either end.
const CELLS: ([usize; 3], [usize; 2], usize) = ([5, 6, 5], [5, 3], 6);

fn cubes() -> Vec<Cube> {
    let parts = (0..3).flat_map(|column| (0..2).map(move |part| (column, part)));
    parts
        .flat_map(|(column, part)| [cube(column, part, false), cube(column, part, true)])
        .collect()
}

/// A column, in a part of the depth, below or above the line.
fn cube(column: usize, part: usize, upper: bool) -> Cube {
    let [[left, start], [right, end]] = [LINE[column], LINE[column + 1]];
    let [near, far] = [DEPTHS[part], DEPTHS[part + 1]];
    let map = move |[s, t, r]: [f64; 3]| {
        let line = start * (1.0 - s) + end * s;
        let height = match upper {
            false => r * line,
            true => line * (1.0 - r) + HEIGHT * r,
        };
        [
            left * (1.0 - s) + right * s,
            near * (1.0 - t) + far * t,
            height,
        ]
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
    let (columns, depths, rows) = CELLS;
    Cube::new(
        "block",
        [columns[column], depths[part], rows],
        map,
        [across, along, up],
    )
}
