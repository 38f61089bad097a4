//! A quarter of a plate with a hole under tension, without contact.
//!
//! Kirsch's plate, with finite width: the largest stress at the hole is some 3.14 times the tension.

use std::f64::consts::FRAC_PI_4;

use super::Shape;
use super::pattern::Pattern;
use super::squares::Square;

pub(super) const ABOUT: &str = "a quarter of a plate with a hole under tension, without contact";
pub(super) const SUBDOMAINS: usize = 4;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Radius of the hole and half the side of the plate (m).
const RADIUS: f64 = 0.01;
const HALF: f64 = 0.05;

/// Size of the outermost cells over that of the innermost ones.
const GRADING: f64 = 6.0;

fn squares() -> Vec<Square> {
    let pattern = Pattern::Grid(24, 12);
    vec![
        Square::new(
            "plate",
            pattern,
            eighth,
            [Some("horizontal axis"), Some("right"), None, Some("hole")],
        )
        .curved(),
        // The mirror image is exact to the last bit, so that nodes lie exactly on the axis.
        Square::new(
            "plate",
            pattern,
            |[s, t]| {
                let [x, y] = eighth([s, 1.0 - t]);
                [y, x]
            },
            [None, Some("top"), Some("vertical axis"), Some("hole")],
        )
        .curved(),
    ]
}

/// An eighth of the plate, from the hole (s = 0) to the right side (s = 1), from the horizontal
/// axis (t = 0) to the diagonal (t = 1).
fn eighth([s, t]: [f64; 2]) -> [f64; 2] {
    let along = (GRADING.powf(s) - 1.0) / (GRADING - 1.0);
    let (sin, cos) = (FRAC_PI_4 * t).sin_cos();
    let (inner, outer) = ([RADIUS * cos, RADIUS * sin], [HALF, HALF * t]);
    [0, 1].map(|i| inner[i] * (1.0 - along) + outer[i] * along)
}
