//! A quarter of a tunnel: rock, the core to be excavated, and the lining installed afterwards.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::Shape;
use super::pattern::Pattern;
use super::squares::{Square, quadrilateral};

pub(super) const ABOUT: &str =
    "a tunnel in stressed rock, dug and lined in load steps, excavation by Kirsch";
pub(super) const SUBDOMAINS: usize = 6;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Radius of the tunnel, thickness of its lining, and half the side of the rock (m).
const RADIUS: f64 = 3.0;
const LINING: f64 = 0.5;
const HALF: f64 = 60.0;

/// Cells along an eighth of the circle, radially outwards and inwards, and through the lining.
const ALONG: usize = 12;
const OUTWARD: usize = 24;
const INWARD: usize = 6;
const THROUGH: usize = 3;

/// Side of the square in the middle of the core, relative to the radius.
const MIDDLE: f64 = 0.5;

/// Size of the outermost cells over that of the innermost ones.
const GRADING: f64 = 40.0;

fn squares() -> Vec<Square> {
    let outward = Pattern::Grid(OUTWARD, ALONG);
    let inward = Pattern::Grid(INWARD, ALONG);
    let middle = MIDDLE * RADIUS;
    let corners = [[0.0, 0.0], [middle, 0.0], [middle, middle], [0.0, middle]];
    let grid = Pattern::Grid(ALONG, ALONG);
    let lining = [
        Some("lining, horizontal axis"),
        Some("extrados"),
        Some("lining, vertical axis"),
        Some("intrados"),
    ];
    let [horizontal, vertical] = ["rock, horizontal axis", "rock, vertical axis"].map(Some);
    let [at_side, at_crown] = ["core, horizontal axis", "core, vertical axis"].map(Some);
    let (wall, face) = (Some("wall"), Some("face"));
    let ring = Pattern::Grid(THROUGH, 2 * ALONG);
    vec![
        Square::new(
            "rock",
            outward,
            rock,
            [horizontal, Some("right"), None, wall],
        )
        .curved(),
        Square::new(
            "rock",
            outward,
            mirrored(rock),
            [None, Some("top"), vertical, wall],
        )
        .curved(),
        Square::new("core", inward, core, [at_side, face, None, None]).curved(),
        Square::new("core", inward, mirrored(core), [None, face, at_crown, None]).curved(),
        Square::new(
            "core",
            grid,
            quadrilateral(corners),
            [at_side, None, None, at_crown],
        ),
        Square::new("lining", ring, of_lining, lining).curved(),
    ]
}

/// Mirror image in the diagonal, exact to the last bit.
fn mirrored(map: fn([f64; 2]) -> [f64; 2]) -> impl Fn([f64; 2]) -> [f64; 2] {
    move |[s, t]| {
        let [x, y] = map([s, 1.0 - t]);
        [y, x]
    }
}

/// An eighth of the rock, from the tunnel (s = 0) to the right side (s = 1), from the horizontal axis (t = 0) to the
/// diagonal (t = 1).
fn rock([s, t]: [f64; 2]) -> [f64; 2] {
    let along = (GRADING.powf(s) - 1.0) / (GRADING - 1.0);
    let [inner, outer] = [on_circle(RADIUS, FRAC_PI_4 * t), [HALF, HALF * t]];
    [0, 1].map(|i| inner[i] * (1.0 - along) + outer[i] * along)
}

/// An eighth of the core, from the square in its middle (s = 0) to the circle.
fn core([s, t]: [f64; 2]) -> [f64; 2] {
    let middle = MIDDLE * RADIUS;
    let [inner, outer] = [[middle, middle * t], on_circle(RADIUS, FRAC_PI_4 * t)];
    [0, 1].map(|i| inner[i] * (1.0 - s) + outer[i] * s)
}

/// A quarter of the lining, from the inside (s = 0) to the rock, from the horizontal axis (t = 0) to the vertical one.
fn of_lining([s, t]: [f64; 2]) -> [f64; 2] {
    let radius = RADIUS - LINING * (1.0 - s);
    match t <= 0.5 {
        true => on_circle(radius, FRAC_PI_2 * t),
        false => {
            let [x, y] = on_circle(radius, FRAC_PI_2 * (1.0 - t));
            [y, x]
        }
    }
}

fn on_circle(radius: f64, angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [radius * cos, radius * sin]
}
