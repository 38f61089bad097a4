//! Points and lines, the facets of the plane: N and ∂N/∂ξ on −1 ≤ ξ ≤ 1.

use super::ElementKind::Point1;
use super::definition::{Definition, Domain};
use super::reference::ReferenceElement;

/// A single node.
pub static POINT1: ReferenceElement = ReferenceElement::new(Definition {
    name: "point",
    domain: Domain::Point,
    node_coordinates: &[[0.0; 3]],
    shape: |_| vec![1.0],
    gradients: |_| vec![[0.0; 3]],
    facets: &[],
    reversed: &[0],
    vtk: 1,
    rules: None,
});

/// A straight line of two nodes.
pub static LINE2: ReferenceElement = ReferenceElement::new(Definition {
    name: "line of 2 nodes",
    domain: Domain::Line,
    node_coordinates: &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    shape: |[s, ..]| vec![0.5 * (1.0 - s), 0.5 * (1.0 + s)],
    gradients: |_| vec![[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]],
    facets: ENDS,
    reversed: &[1, 0],
    vtk: 3,
    rules: None,
});

/// A quadratic line: two ends, then the middle node.
pub static LINE3: ReferenceElement = ReferenceElement::new(Definition {
    name: "line of 3 nodes",
    domain: Domain::Line,
    node_coordinates: &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]],
    shape: |[s, ..]| ENDS_AND_MIDDLE.map(|a| lagrange(a, s)).to_vec(),
    gradients: |[s, ..]| {
        ENDS_AND_MIDDLE
            .map(|a| [lagrange_slope(a, s), 0.0, 0.0])
            .to_vec()
    },
    facets: ENDS,
    reversed: &[1, 0, 2],
    vtk: 21,
    rules: None,
});

const ENDS: &[(super::ElementKind, &[usize])] = &[(Point1, &[0]), (Point1, &[1])];
const ENDS_AND_MIDDLE: [f64; 3] = [-1.0, 1.0, 0.0];

/// The quadratic Lagrange polynomial that is 1 at `a` and 0 at the others of −1, 0, 1.
pub fn lagrange(a: f64, x: f64) -> f64 {
    match a == 0.0 {
        true => (1.0 - x) * (1.0 + x),
        false => 0.5 * x * (x + a),
    }
}

/// Its derivative.
pub fn lagrange_slope(a: f64, x: f64) -> f64 {
    match a == 0.0 {
        true => -2.0 * x,
        false => x + 0.5 * a,
    }
}
