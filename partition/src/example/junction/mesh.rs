//! Four blocks and three contacts that meet at one point.
//!
//! An oblique contact runs through the square; a vertical and a horizontal one start at its centre and divide the part
//! above it into a block on the left, one above and a wedge on the right. Under 1 MPa from the right and from above the
//! pressure is 1 MPa on every contact, and the displacement has no jumps: u = −p (1+ν)(1−2ν)/E · (x+5, y+5).

use super::Shape;
use super::pattern::Pattern;
use super::squares::{Square, quadrilateral};

pub(super) const ABOUT: &str =
    "four blocks and three contacts that meet in one point, exact answer known";
pub(super) const SUBDOMAINS: usize = 4;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Half of the square's side (m).
const HALF: f64 = 5.0;

/// Height of the oblique contact at the left side, and its depth at the right one (m).
const RISE: f64 = 3.0;

/// Cells along each contact from the centre on; even.
const CELLS: usize = 10;

const MIDDLE: [f64; 2] = [0.0, 0.0];

fn squares() -> Vec<Square> {
    let grid = Pattern::Grid(CELLS, CELLS);
    let block = |body, corners, sides| Square::new(body, grid, quadrilateral(corners), sides);
    let (west, east) = ([-HALF, RISE], [HALF, -RISE]);
    let mut squares = vec![
        block(
            "base",
            [[-HALF, -HALF], [0.0, -HALF], MIDDLE, west],
            [Some("bottom"), None, Some("oblique lower"), Some("left")],
        ),
        block(
            "base",
            [[0.0, -HALF], [HALF, -HALF], east, MIDDLE],
            [Some("bottom"), Some("right"), Some("oblique lower"), None],
        ),
        block(
            "left block",
            [west, MIDDLE, [0.0, HALF], [-HALF, HALF]],
            [
                Some("oblique upper"),
                Some("vertical left"),
                Some("top"),
                Some("left"),
            ],
        ),
        block(
            "right block",
            [MIDDLE, [HALF, 0.0], [HALF, HALF], [0.0, HALF]],
            [
                Some("horizontal upper"),
                Some("right"),
                Some("top"),
                Some("vertical right"),
            ],
        ),
    ];
    squares.extend(wedge(east));
    squares
}

/// The wedge, a triangle of three quadrilaterals that meet at its centroid.
fn wedge(east: [f64; 2]) -> [Square; 3] {
    let corners = [MIDDLE, east, [HALF, 0.0]];
    let sides = ["oblique upper", "right", "horizontal lower"];
    let between = |p: [f64; 2], q: [f64; 2]| [0, 1].map(|i| 0.5 * (p[i] + q[i]));
    let centre = [0, 1].map(|i| corners.iter().map(|c| c[i]).sum::<f64>() / 3.0);
    [0, 1, 2].map(|k| {
        let (corner, next, last) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
        Square::new(
            "wedge",
            Pattern::Grid(CELLS / 2, CELLS / 2),
            quadrilateral([corner, between(corner, next), centre, between(last, corner)]),
            [Some(sides[k]), None, None, Some(sides[(k + 2) % 3])],
        )
    })
}
