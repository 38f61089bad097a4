//! A closed inclined crack in a wide plate, which slips without friction.
//!
//! The plate is rotated so that the crack lies along x. Of the far-field stress σ at the angle ψ to the crack, the
//! crack transmits the pressure σ sin²ψ but not the shear stress σ sinψ cosψ.

use super::Shape;
use super::pattern::Pattern;
use super::squares::Square;

pub(super) const ABOUT: &str = "a closed inclined crack in a wide plate, exact answer known";
pub(super) const SUBDOMAINS: usize = 6;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Half the side of the plate (m); half the length of the crack is 1 m.
const HALF: f64 = 20.0;

/// Columns beside the crack and along it, and rows on each side of it.
const COLUMNS: [usize; 3] = [12, 24, 12];
const ROWS: usize = 16;

fn squares() -> Vec<Square> {
    // Cells grow away from the tips and from the crack.
    let away = |t: f64, size: f64| size * (0.02 * t + 0.98 * t.powi(3));
    let x = move |column: usize, s: f64| match column {
        0 => -1.0 - away(1.0 - s, HALF - 1.0),
        1 if s < 0.5 => (2.0 * s).powi(2) - 1.0,
        1 => 1.0 - (2.0 - 2.0 * s).powi(2),
        _ => 1.0 + away(s, HALF - 1.0),
    };
    let mut squares = Vec::new();
    for (column, cells) in COLUMNS.into_iter().enumerate() {
        let outer = |at: usize, name: &'static str| (column == at).then_some(name);
        for is_above in [false, true] {
            let crack = match is_above {
                false => outer(1, "crack lower"),
                true => outer(1, "crack upper"),
            };
            let (bottom, top) = match is_above {
                false => (Some("bottom"), crack),
                true => (crack, Some("top")),
            };
            let map = move |[s, t]: [f64; 2]| match is_above {
                false => [x(column, s), 0.0 - away(1.0 - t, HALF)],
                true => [x(column, s), away(t, HALF)],
            };
            let sides = [bottom, outer(2, "right"), top, outer(0, "left")];
            squares.push(Square::new("plate", Pattern::Grid(cells, ROWS), map, sides));
        }
    }
    squares
}
