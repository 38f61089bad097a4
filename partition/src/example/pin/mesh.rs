//! A plate that hangs on a pin, which protrudes on both sides and rests in a fork: a quarter of both by symmetry.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::Shape;
use super::cubes::Cube;
use crate::element::ElementKind;

pub(super) const ABOUT: &str =
    "a pin with clearance in a plate and a fork, curved hexahedra that don't match";
pub(super) const SUBDOMAINS: usize = 8;
pub(super) const SHAPE: Shape = Shape::Cubes {
    cubes,
    kind: ElementKind::Hexahedron27,
};

/// Radii of pin and hole (mm).
const PIN: f64 = 10.0;
const HOLE: f64 = 10.05;
/// Half of the edge of the square in the middle of the pin (mm).
const CORE: f64 = 5.0;
/// Half of the plate's width, and the position of its loaded end (mm).
const WIDTH: f64 = 30.0;
const END: f64 = 60.0;
/// Half of the plate's thickness, the beginning of the fork and the end of the pin (mm).
const DEPTHS: [f64; 4] = [0.0, 10.0, 11.0, 21.0];
/// Cells of the pin along these depths, along an eighth of its circumference, and between square and circle.
const OF_PIN: ([usize; 3], usize, usize) = ([2, 1, 3], 3, 2);
/// Cells of the plate through its thickness, along an eighth of the hole, from there outwards, and to its end.
const OF_PLATE: (usize, usize, usize, usize) = (2, 4, 3, 2);

type Point = [f64; 2];

fn between(a: Point, b: Point, part: f64) -> Point {
    [0, 1].map(|k| a[k] * (1.0 - part) + b[k] * part)
}

fn on_circle(radius: f64, angle: f64) -> Point {
    [radius * angle.cos(), radius * angle.sin()]
}

/// The three pieces between half the edge of a square of side 2·`edge` and half a circle: the cube's axis along the
/// circumference, and the points on square and circle. Arguments are the position along either and the fraction of the
/// distance from one to the other.
type Around = [(usize, fn(f64, f64, f64) -> [Point; 2]); 3];

const AROUND: Around = [
    (1, |edge, radius, t| {
        [[edge, edge * t], on_circle(radius, FRAC_PI_4 * t)]
    }),
    (0, |edge, radius, s| {
        let angle = FRAC_PI_4 + FRAC_PI_2 * (1.0 - s);
        [[edge * (2.0 * s - 1.0), edge], on_circle(radius, angle)]
    }),
    (1, |edge, radius, t| {
        let angle = 2.0 * FRAC_PI_2 - FRAC_PI_4 * t;
        [[-edge, edge * t], on_circle(radius, angle)]
    }),
];

fn cubes() -> Vec<Cube> {
    let mut cubes = Vec::new();
    let (along, eighth, out) = OF_PIN;
    for (layer, &cells) in along.iter().enumerate() {
        let (low, high) = (DEPTHS[layer], DEPTHS[layer + 1]);
        let depth = [
            (layer == 0).then_some("z = 0"),
            (layer == 2).then_some("pin end"),
        ];
        let round = [Some("pin in the plate"), None, Some("pin in the fork")][layer];
        let z = move |r: f64| low * (1.0 - r) + high * r;
        cubes.push(Cube::new(
            "pin",
            [2 * eighth, eighth, cells],
            move |[s, t, r]| [CORE * (2.0 * s - 1.0), CORE * t, z(r)],
            [[None; 2], [Some("y = 0"), None], depth],
        ));
        for (axis, place) in AROUND {
            let map = move |x: [f64; 3]| {
                let [from, to] = place(CORE, PIN, x[axis]);
                let [u, v] = between(from, to, x[1 - axis]);
                [u, v, z(x[2])]
            };
            cubes.push(Cube::new(
                "pin",
                around(axis, [eighth, out, cells]),
                map,
                sides(axis, [None, round], depth),
            ));
        }
    }
    let (deep, eighth, out, to_end) = OF_PLATE;
    let depth = [Some("z = 0"), None];
    for (piece, (axis, place)) in AROUND.into_iter().enumerate() {
        let map = move |x: [f64; 3]| {
            let [to, from] = place(WIDTH, HOLE, x[axis]);
            let part = x[1 - axis];
            let [u, v] = between(from, to, part * (0.6 + 0.4 * part));
            [u, v, DEPTHS[1] * x[2]]
        };
        let edge = (piece > 0).then_some("plate edge");
        cubes.push(Cube::new(
            "plate",
            around(axis, [eighth, out, deep]),
            map,
            sides(axis, [Some("hole"), edge], depth),
        ));
    }
    cubes.push(Cube::new(
        "plate",
        [to_end, eighth, deep],
        |[s, t, r]| [WIDTH + (END - WIDTH) * s, WIDTH * t, DEPTHS[1] * r],
        [[None, Some("pulled")], [Some("y = 0"), None], depth],
    ));
    cubes.into_iter().map(Cube::curved).collect()
}

/// Cells of a piece along an eighth of the circumference, radially and along the depth.
fn around(axis: usize, [eighth, out, deep]: [usize; 3]) -> [usize; 3] {
    match axis {
        0 => [2 * eighth, out, deep],
        _ => [out, eighth, deep],
    }
}

/// Groups of a piece; radial lines begin at the plane of symmetry.
fn sides(
    axis: usize,
    across: [Option<&'static str>; 2],
    depth: [Option<&'static str>; 2],
) -> [[Option<&'static str>; 2]; 3] {
    match axis {
        0 => [[None; 2], across, depth],
        _ => [across, [Some("y = 0"), None], depth],
    }
}
