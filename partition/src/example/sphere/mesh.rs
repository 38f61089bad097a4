//! Point contact: a ball squeezed between two plates, by symmetry an eighth of it on a rigid plane.
//!
//! A cube around the centre and three pieces between its faces and the surface; cells are small around the pole.

use std::f64::consts::FRAC_PI_4;

use super::Shape;
use super::cubes::Cube;
use crate::element::ElementKind;
use crate::element::geometry::length;

pub(super) const ABOUT: &str =
    "point contact of a ball with a plate, graded hexahedra, theory of Hertz";
pub(super) const SUBDOMAINS: usize = 8;
pub(super) const SHAPE: Shape = Shape::Cubes {
    cubes,
    kind: ElementKind::Hexahedron20,
};

/// Radius of the ball (m).
const RADIUS: f64 = 8.0;
/// Edge of the cube around the centre (m).
const CORE: f64 = 3.6;
/// Cells along an edge that ends at the pole, along the others, and from the cube to the surface.
const CELLS: [usize; 3] = [6, 2, 5];
/// Size of the first cells at the pole, relative to uniform cells.
const FIRST: f64 = 0.28;

/// The fraction of a length after the fraction `s` of its cells, of nearly uniform size under the contact and growing
/// beyond it.
fn graded(s: f64) -> f64 {
    FIRST * s + (1.0 - FIRST) * s.powi(5)
}

/// The position at the fraction `r` of the distance from a point `on` the surface of the unit cube to the sphere.
fn between(on: [f64; 3], r: f64) -> [f64; 3] {
    let direction = on.map(|c| (FRAC_PI_4 * c).tan());
    // Inside the cube it has no effect.
    let far = length(direction).max(1.0);
    let out = 1.0 - graded(1.0 - r);
    let [x, y, down] = direction.map(|c| c * (CORE + out * (RADIUS / far - CORE)));
    [x, y, RADIUS - down]
}

fn cubes() -> Vec<Cube> {
    let [fine, coarse, out] = CELLS;
    let [x, y, middle] = [Some("x = 0"), Some("y = 0"), Some("equator")];
    let core = |[s, t, r]: [f64; 3]| between([graded(s), graded(t), r], 0.0);
    let pole = |[s, t, r]: [f64; 3]| between([graded(s), graded(t), 1.0], r);
    let along_x = |[t, u, r]: [f64; 3]| between([1.0, graded(t), u], r);
    let along_y = |[s, u, r]: [f64; 3]| between([graded(s), 1.0, u], r);
    let sides = |a, b, c| [[a, None], [b, None], c];
    let cubes = [
        Cube::new(
            "ball",
            [fine, fine, coarse],
            core,
            sides(x, y, [middle, None]),
        ),
        Cube::new(
            "ball",
            [fine, fine, out],
            pole,
            sides(x, y, [None, Some("pole")]),
        ),
        Cube::new(
            "ball",
            [fine, coarse, out],
            along_x,
            sides(y, middle, [None; 2]),
        ),
        Cube::new(
            "ball",
            [fine, coarse, out],
            along_y,
            sides(x, middle, [None; 2]),
        ),
    ];
    cubes.into_iter().map(Cube::curved).collect()
}
