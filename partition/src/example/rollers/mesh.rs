//! Three rollers of steel between two plates of aluminium, under a non-uniform pressure.
//!
//! Meshes don't match: plates and rollers have separate meshes, graded towards the contacts. A roller transmits the
//! same force above and below, all three transmit the load on the upper plate, and the largest pressure of each contact
//! follows from its force by Hertz.

use std::f64::consts::FRAC_PI_4;

use super::Shape;
use super::pattern::Pattern;
use super::squares::Square;

pub(super) const ABOUT: &str =
    "three rollers between two plates, curved contact of meshes that don't match";
pub(super) const SUBDOMAINS: usize = 8;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Radius of the rollers (m).
const RADIUS: f64 = 0.05;

/// Distance of their axes (m).
const APART: f64 = 0.12;

/// Height of the plates and their overhang beyond the outer axes (m).
const HEIGHT: f64 = 0.08;
const BEYOND: f64 = 0.08;

/// Cells along a quarter of a roller, from its outside to its core, and between contacts of a plate and across it.
const QUARTER: usize = 20;
const INWARD: usize = 12;
const BETWEEN: usize = 18;
const ACROSS: usize = 14;

/// Position of each roller, and of its axis (m).
const ROLLERS: [(&str, f64); 3] = [("left", -APART), ("middle", 0.0), ("right", APART)];

/// A function from 0 to 1 with a small slope at first.
fn slow_start(s: f64) -> f64 {
    (4.2 * s).sinh() / 4.2_f64.sinh()
}

fn squares() -> Vec<Square> {
    let ends = [-APART - BEYOND, APART + BEYOND];
    let mut squares = Vec::new();
    for (i, (place, axis)) in ROLLERS.into_iter().enumerate() {
        let half = 0.5 * APART;
        let left = if i == 0 { ends[0] } else { axis - half };
        let right = if i == 2 { ends[1] } else { axis + half };
        for (edge, is_right) in [(left, false), (right, true)] {
            squares.extend(plates(place, axis, edge, is_right));
        }
        squares.extend(disc(place, axis));
    }
    squares
}

/// The two plates from the axis of the roller at `place` to `edge`.
fn plates(place: &str, axis: f64, edge: f64, is_right: bool) -> [Square; 2] {
    let is_end = edge.abs() > APART;
    let piece = |body, face: f64, outer: f64, sides| {
        let map = move |[s, t]: [f64; 2]| {
            // Exact at both ends, so that neighbours have the same nodes.
            let between = |p: f64, q: f64, w: f64| p * (1.0 - w) + q * w;
            let x = match is_right {
                true => between(axis, edge, slow_start(s)),
                false => between(axis, edge, slow_start(1.0 - s)),
            };
            let y = match outer < face {
                true => between(face, outer, slow_start(1.0 - t)),
                false => between(face, outer, slow_start(t)),
            };
            [x, y]
        };
        Square::new(body, Pattern::Grid(BETWEEN, ACROSS), map, sides)
    };
    let left = (is_end && !is_right).then_some("left");
    let right = (is_end && is_right).then_some("right");
    let below = format!("lower plate under {place}");
    let above = format!("upper plate over {place}");
    let faces = [0.0, 2.0 * RADIUS];
    [
        piece(
            "lower plate",
            faces[0],
            faces[0] - HEIGHT,
            [Some("bottom"), right, Some(&below), left],
        ),
        piece(
            "upper plate",
            faces[1],
            faces[1] + HEIGHT,
            [Some(&above), right, Some("top"), left],
        ),
    ]
}

/// The roller at `place`: a core and four squares around it.
fn disc(place: &str, axis: f64) -> Vec<Square> {
    let body = format!("{place} roller");
    let core = 0.45 * RADIUS;
    // From −1 to 1, with a small slope in the middle.
    let along = |s: f64| {
        let w = 2.0 * s - 1.0;
        w.signum() * slow_start(w.abs())
    };
    let [below, above] = ["below", "above"].map(|side| format!("{body} {side}"));
    let mut squares: Vec<Square> = [Some(below), None, Some(above), None]
        .into_iter()
        .enumerate()
        .map(|(quarter, outer)| {
            // Quarter by quarter counter-clockwise, relative to the axis, from the bottom.
            let turn = move |[x, y]: [f64; 2]| match quarter {
                0 => [axis + x, RADIUS + y],
                1 => [axis - y, RADIUS + x],
                2 => [axis - x, RADIUS - y],
                _ => [axis + y, RADIUS - x],
            };
            let map = move |[s, t]: [f64; 2]| {
                let w = along(s);
                let (sin, cos) = (FRAC_PI_4 * w).sin_cos();
                let inward = slow_start(t);
                let between = |p: f64, q: f64| p * (1.0 - inward) + q * inward;
                turn([
                    between(RADIUS * sin, core * w),
                    between(-RADIUS * cos, -core),
                ])
            };
            let sides = [outer.as_deref(), None, None, None];
            Square::new(&body, Pattern::Grid(QUARTER, INWARD), map, sides).curved()
        })
        .collect();
    let map = move |[s, t]: [f64; 2]| [axis + core * along(s), RADIUS + core * along(t)];
    let grid = Pattern::Grid(QUARTER, QUARTER);
    squares.push(Square::new(&body, grid, map, [None; 4]).curved());
    squares
}
