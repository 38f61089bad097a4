//! Two cylinders pressed together and sheared back and forth: partial slip after Cattaneo and Mindlin.
//!
//! Each cylinder is meshed only around the contact, as a rectangle that is wide compared with the contact; the
//! cylinders' shape enters through the gap. Nodes match; cells are of equal size in the contact region and grow away
//! from it.

use super::Shape;
use super::pattern::Pattern;
use super::squares::Square;

pub(super) const ABOUT: &str =
    "two cylinders pressed and pushed to and fro, partial slip, exact answer known";
pub(super) const SUBDOMAINS: usize = 8;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Height of the rectangles, half of their width (mm).
const SIZE: f64 = 10.0;

/// Half the width of the region of the smallest cells, larger than that of the contact (mm).
const FINE: f64 = 1.0;

/// Width of the feet at both ends, where the lower rectangle is held (mm).
const FOOT: f64 = 0.5;

/// Columns of a foot, between it and the smallest cells, of the smallest cells, and the mirror image; and rows.
const COLUMNS: [usize; 5] = [1, 8, 20, 8, 1];
const ROWS: usize = 12;

/// A function from 0 to 1 with so small a slope at first that cells grow smoothly from the smallest ones.
fn slow_start(s: f64) -> f64 {
    (4.0 * s).sinh() / 4.0_f64.sinh()
}

/// Positions of the columns of a part.
fn across(part: usize, s: f64) -> f64 {
    let between = |s: f64| FINE + (SIZE - FOOT - FINE) * slow_start(s);
    match part {
        0 => FOOT * s - SIZE,
        1 => -between(1.0 - s),
        2 => FINE * (2.0 * s - 1.0),
        3 => between(s),
        _ => SIZE - FOOT * (1.0 - s),
    }
}

fn squares() -> Vec<Square> {
    let mut squares = Vec::new();
    for (part, columns) in COLUMNS.into_iter().enumerate() {
        let at = |end: usize, name: &'static str| (part == end).then_some(name);
        let grid = Pattern::Grid(columns, ROWS);
        let bottom = match part {
            0 => "left foot",
            4 => "right foot",
            _ => "bottom",
        };
        squares.push(Square::new(
            "lower",
            grid,
            move |[s, t]| [across(part, s), 0.0 - SIZE * slow_start(1.0 - t)],
            [
                Some(bottom),
                at(4, "lower right"),
                Some("lower face"),
                at(0, "lower left"),
            ],
        ));
        squares.push(Square::new(
            "upper",
            grid,
            move |[s, t]| [across(part, s), SIZE * slow_start(t)],
            [
                Some("upper face"),
                at(4, "upper right"),
                Some("top"),
                at(0, "upper left"),
            ],
        ));
    }
    squares
}
