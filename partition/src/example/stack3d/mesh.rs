//! Three square blocks on top of each other, the upper two held only by contact: a semi-coercive problem.

use super::Shape;
use super::cubes::{Cube, along};
use crate::element::ElementKind;

pub(super) const ABOUT: &str =
    "three square blocks in space held by contact alone, six free motions";
pub(super) const SUBDOMAINS: usize = 6;
pub(super) const SHAPE: Shape = Shape::Cubes {
    cubes,
    kind: ElementKind::Hexahedron8,
};

/// Half of the blocks' widths, from below (m).
const HALF_WIDTHS: [f64; 3] = [2.0, 1.5, 1.0];

/// Grid lines from the middle outwards, refined at the edges of the upper block (m).
const ACROSS: [f64; 10] = [0.0, 0.4, 0.7, 0.87, 0.95, 1.0, 1.06, 1.2, 1.5, 2.0];
/// Grid lines of each block upwards, refined at the upper joint (m).
const UPWARDS: [&[f64]; 3] = [
    &[0.0, 0.5, 1.0],
    &[1.0, 1.4, 1.7, 1.87, 1.95, 2.0],
    &[2.0, 2.06, 2.18, 2.45, 3.0],
];

fn cubes() -> Vec<Cube> {
    let blocks = [
        ("lower block", ["ground", "lower joint below"]),
        ("middle block", ["lower joint above", "upper joint below"]),
        ("upper block", ["upper joint above", "loaded"]),
    ];
    let block = |(level, (body, up)): (usize, (&str, [&'static str; 2]))| {
        let outwards = (ACROSS.iter().copied()).take_while(|&line| line <= HALF_WIDTHS[level]);
        let inwards: Vec<f64> = outwards.clone().skip(1).map(|line| -line).collect();
        let across: Vec<f64> = inwards.into_iter().rev().chain(outwards).collect();
        let upwards = UPWARDS[level];
        let cells = [across.len() - 1, across.len() - 1, upwards.len() - 1];
        let map =
            move |[s, t, r]: [f64; 3]| [along(&across, s), along(&across, t), along(upwards, r)];
        Cube::new(body, cells, map, [[None; 2], [None; 2], up.map(Some)])
    };
    blocks.into_iter().enumerate().map(block).collect()
}
