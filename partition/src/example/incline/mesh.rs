//! A block on a slope below the friction angle: it stays, and every node of its base sticks.
//!
//! The slope rises by 7 in 24, so that sin α = 7/25 and cos α = 24/25.

use super::Shape;
use super::pattern::Pattern;
use super::squares::{Square, quadrilateral};

pub(super) const ABOUT: &str = "a block on a slope, held by friction alone, exact answer known";
pub(super) const SUBDOMAINS: usize = 4;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// The block along the slope and across it (m).
const SIZE: [f64; 2] = [3.0, 1.0];

fn squares() -> Vec<Square> {
    let [long, high] = SIZE.map(|size| size / 25.0);
    let on_slope =
        |along: f64, across: f64| [24.0 * along - 7.0 * across, 7.0 * along + 24.0 * across];
    let corners = [(0.0, 0.0), (long, 0.0), (long, high), (0.0, high)];
    let corners = corners.map(|(along, across)| on_slope(along, across));
    let sides = ["base", "upper face", "top", "lower face"].map(Some);
    vec![Square::new(
        "block",
        Pattern::Grid(24, 8),
        quadrilateral(corners),
        sides,
    )]
}
