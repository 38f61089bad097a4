//! Line contact: a cylinder on its mirror image, by symmetry a quarter of it on a rigid plane.
//!
//! A square represents the half-plane of Hertz's theory: the tractions of the half-plane act on its artificial boundary
//! (McEwen; K. L. Johnson, *Contact Mechanics*), so that only the mesh separates the solution from the theory. The mesh
//! is graded towards the end of the contact, where the pressure vanishes like a square root.

use std::f64::consts::PI;

use super::Shape;
use super::pattern::Pattern;
use super::squares::Square;

pub(super) const ABOUT: &str = "line contact of two cylinders, graded mesh, exact answer known";
pub(super) const SUBDOMAINS: usize = 4;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Side of the square (m).
const SIDE: f64 = 2.0;

/// The size of cells grows with the distance from the end of the contact to this power minus one.
const GRADING: f64 = 1.6;

/// Columns under the contact and beside it, and rows.
const COLUMNS: [usize; 2] = [10, 8];
const ROWS: usize = 14;

fn squares() -> Vec<Square> {
    // a² = 4 P R / (π E*) with P = 10, R = 8 and E* = 200 / (1 − 0.3²).
    let half_width = (1.456 / PI).sqrt();
    let down = |t: f64| 0.0 - SIDE * (1.0 - t).powf(GRADING);
    let beside = SIDE - half_width;
    vec![
        Square::new(
            "cylinder",
            Pattern::Grid(COLUMNS[0], ROWS),
            move |[s, t]| [half_width * (1.0 - (1.0 - s).powf(GRADING)), down(t)],
            [Some("bottom"), None, Some("top"), Some("axis")],
        ),
        Square::new(
            "cylinder",
            Pattern::Grid(COLUMNS[1], ROWS),
            move |[s, t]| [half_width + beside * s.powf(GRADING), down(t)],
            [Some("bottom"), Some("right"), Some("top"), None],
        ),
    ]
}
