//! Uniform compression through an inclined contact: the patch test.
//!
//! Under equal pressure p from above and from the right the stress is −p I in the plane for any inclination, and u = −p
//! (1+ν)(1−2ν)/E · (x, y).

use super::Shape;
use super::pattern::Pattern;
use super::squares::{Square, quadrilateral};

pub(super) const ABOUT: &str =
    "two blocks in uniform compression through an inclined contact, exact answer known";
pub(super) const SUBDOMAINS: usize = 4;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

fn squares() -> Vec<Square> {
    let (left, right) = ([0.0, 0.8], [2.0, 1.2]);
    let pattern = Pattern::Grid(16, 8);
    vec![
        Square::new(
            "lower",
            pattern,
            quadrilateral([[0.0, 0.0], [2.0, 0.0], right, left]),
            ["bottom", "right", "lower face", "left"].map(Some),
        ),
        Square::new(
            "upper",
            pattern,
            quadrilateral([left, right, [2.0, 2.0], [0.0, 2.0]]),
            ["upper face", "right", "top", "left"].map(Some),
        ),
    ]
}
