//! Three blocks on top of each other, the upper two held only by contact: a semi-coercive problem.
//!
//! All loads are vertical, so that the two upper blocks may slide freely but aren't driven to.

use super::Shape;
use super::pattern::Pattern;
use super::squares::{Square, quadrilateral};

pub(super) const ABOUT: &str =
    "three blocks held by contact alone under gravity and an eccentric pressure";
pub(super) const SUBDOMAINS: usize = 6;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Half of the blocks' widths, from below (m).
const HALF_WIDTHS: [f64; 3] = [2.0, 1.5, 1.0];

/// Cells per metre.
const CELLS: f64 = 8.0;

fn squares() -> Vec<Square> {
    let mut squares = block("lower block", 0, "ground", "lower joint below");
    squares.extend(block(
        "middle block",
        1,
        "lower joint above",
        "upper joint below",
    ));
    let [.., width] = HALF_WIDTHS;
    squares.push(rectangle(
        "upper block",
        [-width, width],
        2,
        [Some("upper joint above"), None, Some("loaded"), None],
    ));
    squares
}

/// A block in three columns: the middle one is as wide as the block above.
fn block(body: &'static str, level: usize, bottom: &'static str, top: &'static str) -> Vec<Square> {
    let (outer, inner) = (HALF_WIDTHS[level], HALF_WIDTHS[level + 1]);
    let columns = [[-outer, -inner], [-inner, inner], [inner, outer]];
    columns
        .into_iter()
        .enumerate()
        .map(|(i, ends)| {
            let top = (i == 1).then_some(top);
            rectangle(body, ends, level, [Some(bottom), None, top, None])
        })
        .collect()
}

fn rectangle(
    body: &'static str,
    [left, right]: [f64; 2],
    level: usize,
    sides: [Option<&'static str>; 4],
) -> Square {
    let (low, high) = (level as f64, level as f64 + 1.0);
    let columns = ((right - left) * CELLS).round() as usize;
    let map = quadrilateral([[left, low], [right, low], [right, high], [left, high]]);
    Square::new(body, Pattern::Grid(columns, CELLS as usize), map, sides)
}
