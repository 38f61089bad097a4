//! The plate of Raous, pressed on a rigid floor and from the side: it opens, slips and sticks.
//!
//! By symmetry, one half is modelled.

use super::Shape;
use super::pattern::Pattern;
use super::squares::{Square, quadrilateral};

pub(super) const ABOUT: &str =
    "a plate on a rigid floor that opens, slips and sticks, a benchmark of friction";
pub(super) const SUBDOMAINS: usize = 4;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Side of the square (m).
const SIDE: f64 = 0.04;

/// Cells along a side.
const CELLS: usize = 32;

fn squares() -> Vec<Square> {
    let corners = [[0.0, 0.0], [SIDE, 0.0], [SIDE, SIDE], [0.0, SIDE]];
    let sides = ["base", "axis", "top", "side"].map(Some);
    vec![Square::new(
        "plate",
        Pattern::Grid(CELLS, CELLS),
        quadrilateral(corners),
        sides,
    )]
}
