//! Three rollers of steel between two plates of aluminium, pressed unevenly.
//!
//! No nodes match: plates and rollers have meshes of their own, graded towards where they touch. What
//! a roller carries below it carries above, all three what presses on the upper plate, and the largest
//! pressure of each contact follows by Hertz from its own force.

use std::f64::consts::FRAC_PI_4;

use super::pattern::Pattern;
use super::squares::Square;
use super::{Example, Shape};

pub(super) const EXAMPLE: Example = Example {
    name: "rollers",
    about: "three rollers between two plates, curved contact of meshes that don't match",
    subdomains: 8,
    scene: include_str!("scene.toml"),
    shape: Shape::Squares(squares),
};

/// Radius of the rollers (m).
const RADIUS: f64 = 0.05;

/// Distance of their axes (m).
const APART: f64 = 0.12;

/// Height of the plates and what they have beyond the outer axes (m).
const HEIGHT: f64 = 0.08;
const BEYOND: f64 = 0.08;

/// Cells along a quarter of a roller, from its outside to its core, and between contacts of a plate
/// and across it.
const QUARTER: usize = 20;
const INWARD: usize = 12;
const BETWEEN: usize = 18;
const ACROSS: usize = 14;

/// A roller and the groups of its contacts.
struct Roller {
    body: &'static str,
    x: f64,
    /// Side of the lower plate, lowest quarter, uppermost quarter, side of the upper plate.
    sides: [&'static str; 4],
}

const ROLLERS: [Roller; 3] = [
    Roller {
        body: "left roller",
        x: -APART,
        sides: [
            "lower plate under left",
            "left roller below",
            "left roller above",
            "upper plate over left",
        ],
    },
    Roller {
        body: "middle roller",
        x: 0.0,
        sides: [
            "lower plate under middle",
            "middle roller below",
            "middle roller above",
            "upper plate over middle",
        ],
    },
    Roller {
        body: "right roller",
        x: APART,
        sides: [
            "lower plate under right",
            "right roller below",
            "right roller above",
            "upper plate over right",
        ],
    },
];

/// From 0 to 1, slowly at first.
fn slow_start(s: f64) -> f64 {
    (4.2 * s).sinh() / 4.2_f64.sinh()
}

fn squares() -> Vec<Square> {
    let ends = [-APART - BEYOND, APART + BEYOND];
    let mut squares = Vec::new();
    for (i, roller) in ROLLERS.iter().enumerate() {
        let half = 0.5 * APART;
        let left = if i == 0 { ends[0] } else { roller.x - half };
        let right = if i == 2 { ends[1] } else { roller.x + half };
        for (edge, is_right) in [(left, false), (right, true)] {
            squares.extend(plate(roller, edge, is_right));
        }
        squares.extend(disc(roller));
    }
    squares
}

/// Both plates from the axis of a roller to `edge`.
fn plate(roller: &Roller, edge: f64, is_right: bool) -> [Square; 2] {
    let axis = roller.x;
    let is_end = edge.abs() > APART;
    let piece = |body, face: f64, outer: f64, sides| Square {
        body,
        map: Box::new(move |[s, t]: [f64; 2]| {
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
        }),
        pattern: Pattern::Grid(BETWEEN, ACROSS),
        is_curved: false,
        sides,
    };
    let end = |name: &'static str, of: bool| (is_end && is_right == of).then_some(name);
    let [below, .., above] = roller.sides;
    let faces = [0.0, 2.0 * RADIUS];
    [
        piece(
            "lower plate",
            faces[0],
            faces[0] - HEIGHT,
            [
                Some("bottom"),
                end("right", true),
                Some(below),
                end("left", false),
            ],
        ),
        piece(
            "upper plate",
            faces[1],
            faces[1] + HEIGHT,
            [
                Some(above),
                end("right", true),
                Some("top"),
                end("left", false),
            ],
        ),
    ]
}

/// A roller: a core and four squares around it.
fn disc(roller: &Roller) -> Vec<Square> {
    let (axis, body) = (roller.x, roller.body);
    let core = 0.45 * RADIUS;
    // From −1 to 1, slowly in the middle.
    let along = |s: f64| {
        let w = 2.0 * s - 1.0;
        w.signum() * slow_start(w.abs())
    };
    let [_, below, above, _] = roller.sides;
    let mut squares: Vec<Square> = [Some(below), None, Some(above), None]
        .into_iter()
        .enumerate()
        .map(|(quarter, outer)| {
            // Quarter by quarter counter-clockwise, as seen from the axis downwards.
            let turn = move |[x, y]: [f64; 2]| match quarter {
                0 => [axis + x, RADIUS + y],
                1 => [axis - y, RADIUS + x],
                2 => [axis - x, RADIUS - y],
                _ => [axis + y, RADIUS - x],
            };
            Square {
                body,
                map: Box::new(move |[s, t]: [f64; 2]| {
                    let w = along(s);
                    let (sin, cos) = (FRAC_PI_4 * w).sin_cos();
                    let inward = slow_start(t);
                    let between = |p: f64, q: f64| p * (1.0 - inward) + q * inward;
                    turn([
                        between(RADIUS * sin, core * w),
                        between(-RADIUS * cos, -core),
                    ])
                }),
                pattern: Pattern::Grid(QUARTER, INWARD),
                is_curved: true,
                sides: [outer, None, None, None],
            }
        })
        .collect();
    squares.push(Square {
        body,
        map: Box::new(move |[s, t]: [f64; 2]| [axis + core * along(s), RADIUS + core * along(t)]),
        pattern: Pattern::Grid(QUARTER, QUARTER),
        is_curved: true,
        sides: [None; 4],
    });
    squares
}
