//! Three square blocks on top of each other, the upper two held by contact alone: semi-coercive.

use super::Shape;
use super::cubes::Cube;
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

/// Cells per metre.
const CELLS: f64 = 4.0;

fn cubes() -> Vec<Cube> {
    let blocks = [
        ("lower block", ["ground", "lower joint below"]),
        ("middle block", ["lower joint above", "upper joint below"]),
        ("upper block", ["upper joint above", "loaded"]),
    ];
    let block = |(level, (body, up)): (usize, (&str, [&'static str; 2]))| {
        let half = HALF_WIDTHS[level];
        let map = move |[s, t, r]: [f64; 3]| {
            [
                (2.0 * s - 1.0) * half,
                (2.0 * t - 1.0) * half,
                level as f64 + r,
            ]
        };
        let cells = [2.0 * half, 2.0 * half, 1.0].map(|size| (size * CELLS) as usize);
        Cube::new(body, cells, map, [[None; 2], [None; 2], up.map(Some)])
    };
    blocks.into_iter().enumerate().map(block).collect()
}
