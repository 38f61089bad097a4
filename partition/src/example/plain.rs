//! A quarter of a plate with a hole under tension: no contact at all.
//!
//! Kirsch's plate, of finite width: the largest stress at the hole is some 3.14 times the tension.

use std::f64::consts::FRAC_PI_4;

use super::Example;
use super::blocks::Patch;
use super::pattern::Pattern;

pub(super) const EXAMPLE: Example = Example {
    name: "plain",
    about: "a quarter of a plate with a hole under tension, without contact",
    subdomains: 4,
    scene: include_str!("plain.toml"),
    patches,
};

/// Radius of the hole and half the side of the plate [m].
const RADIUS: f64 = 0.01;
const HALF: f64 = 0.05;

/// Size of the outermost cells over that of the innermost ones.
const GRADING: f64 = 6.0;

fn patches() -> Vec<Patch> {
    vec![
        sector(
            0.0,
            [[HALF, 0.0], [HALF, HALF]],
            [Some("horizontal axis"), Some("right"), None, Some("hole")],
        ),
        sector(
            FRAC_PI_4,
            [[HALF, HALF], [0.0, HALF]],
            [None, Some("top"), Some("vertical axis"), Some("hole")],
        ),
    ]
}

/// An eighth of the plate from `angle` on, between the hole and a straight outer side.
fn sector(angle: f64, outer: [[f64; 2]; 2], sides: [Option<&'static str>; 4]) -> Patch {
    Patch {
        body: "plate",
        map: Box::new(move |[s, t]| {
            let along = (GRADING.powf(s) - 1.0) / (GRADING - 1.0);
            let (sin, cos) = (angle + FRAC_PI_4 * t).sin_cos();
            let inner = [RADIUS * cos, RADIUS * sin];
            [0, 1].map(|i| {
                let outer = outer[0][i] * (1.0 - t) + outer[1][i] * t;
                inner[i] * (1.0 - along) + outer * along
            })
        }),
        pattern: Pattern::Grid(24, 12),
        sides,
    }
}
