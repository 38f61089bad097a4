//! Length, area or volume of a cell, with the sign of its orientation.

use crate::element::ElementKind;

/// Signed measure of a straight element; positive where its nodes are in the order of the
/// reference element.
pub(super) fn measure(kind: ElementKind, nodes: &[u32], points: &[[f64; 3]]) -> f64 {
    let p = |i: usize| points[nodes[i] as usize];
    match kind {
        ElementKind::Point1 => 1.0,
        ElementKind::Line2 => {
            let (a, b) = (p(0), p(1));
            (0..3).map(|i| (b[i] - a[i]).powi(2)).sum::<f64>().sqrt()
        }
        ElementKind::Triangle3 => {
            let (a, b, c) = (p(0), p(1), p(2));
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
            0.5 * (u[0] * v[1] - u[1] * v[0])
        }
    }
}
