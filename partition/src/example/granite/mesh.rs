//! A loaded granite block with two edge cracks: the problem of Daněk's paper.
//!
//! Boundary 1-2-8-4-3-5-1 of the square, counter-clockwise from the lower left corner; cracks 5-6 from the left and 7-8
//! from the right, whose tips 6 and 7 belong to both sides. The horizontal mesh line at mid-height follows 5-6-7-8, and
//! cells are half as large on both sides of it.

use super::Shape;
use super::pattern::Pattern;
use super::squares::{Square, quadrilateral};

pub(super) const ABOUT: &str = "a loaded granite block with two edge cracks, the paper's problem";
pub(super) const SUBDOMAINS: usize = 8;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Side of the block (m).
const SIDE: f64 = 10.0;

/// The points 5, 6, 7 and 8 (m).
const LINE: [[f64; 2]; 4] = [[0.0, 6.5], [3.0, 5.0], [7.0, 5.0], [10.0, 6.5]];

/// Coarse columns under each of 5-6, 6-7, 7-8; there are twice as many along the line.
const COLUMNS: [usize; 3] = [12, 16, 12];

/// Rows of the coarse and of the fine band on each side of the line.
const ROWS: (usize, usize) = (15, 7);

/// End of the coarse band and start of the fine one, as fractions of the distance to the line.
const BANDS: (f64, f64) = (0.768, 0.818);

fn squares() -> Vec<Square> {
    let mut squares = Vec::new();
    for (column, ends) in LINE.windows(2).enumerate() {
        let coarse = COLUMNS[column];
        for upper in [false, true] {
            let bands = [
                (0.0, BANDS.0, Pattern::Grid(coarse, ROWS.0)),
                (BANDS.0, BANDS.1, Pattern::Refining(coarse)),
                (BANDS.1, 1.0, Pattern::Grid(2 * coarse, ROWS.1)),
            ];
            for (from, to, pattern) in bands {
                squares.push(band(column, [ends[0], ends[1]], upper, [from, to], pattern));
            }
        }
    }
    squares
}

/// The part of a column between two fractions of the distance from the outside to the line.
fn band(
    column: usize,
    line: [[f64; 2]; 2],
    upper: bool,
    fractions: [f64; 2],
    pattern: Pattern,
) -> Square {
    let height = |[x, y]: [f64; 2], fraction: f64| match upper {
        false => [x, fraction * y],
        true => [x, SIDE - fraction * (SIDE - y)],
    };
    let (outer, inner) = (fractions[0], fractions[1]);
    let [left, right] = line;
    let outside = (outer == 0.0).then_some(if upper { "top" } else { "bottom" });
    let inside = match (inner == 1.0, column) {
        (true, 0) if upper => Some("left crack upper"),
        (true, 0) => Some("left crack lower"),
        (true, 2) if upper => Some("right crack upper"),
        (true, 2) => Some("right crack lower"),
        _ => None,
    };
    let left_side = (column == 0).then_some(if upper { "upper left" } else { "lower left" });
    let right_side = (column == 2).then_some(if upper { "upper right" } else { "lower right" });
    let pattern = match (upper, pattern) {
        (true, Pattern::Refining(columns)) => Pattern::Coarsening(columns),
        _ => pattern,
    };
    let (low, high, below, above) = match upper {
        true => (inner, outer, inside, outside),
        false => (outer, inner, outside, inside),
    };
    let corners = [(left, low), (right, low), (right, high), (left, high)];
    let corners = corners.map(|(point, fraction)| height(point, fraction));
    let sides = [below, right_side, above, left_side];
    Square::new("block", pattern, quadrilateral(corners), sides)
}
