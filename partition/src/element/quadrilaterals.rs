//! Quadrilaterals: N and ∂N/∂ξ on −1 ≤ ξ, η ≤ 1.

use super::ElementKind::{self, Line2, Line3};
use super::definition::{CellRules, Definition, Domain};
use super::lines::{lagrange, lagrange_slope};
use super::reference::ReferenceElement;

/// Corners, the middles of the edges, the center.
const NODES: &[[f64; 3]; 9] = &[
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];

const CURVED_EDGES: &[(ElementKind, &[usize])] = &[
    (Line3, &[0, 1, 4]),
    (Line3, &[1, 2, 5]),
    (Line3, &[2, 3, 6]),
    (Line3, &[3, 0, 7]),
];

/// A value for each of the first `count` nodes, as a function of its coordinates.
fn each<T>(count: usize, value: impl Fn([f64; 2]) -> T) -> Vec<T> {
    let nodes = NODES[..count].iter();
    nodes.map(|&[a, b, _]| value([a, b])).collect()
}

/// A bilinear quadrilateral of four nodes: N_i = ¼ (1 + ξ_i ξ)(1 + η_i η).
pub static QUAD4: ReferenceElement = ReferenceElement::new(Definition {
    name: "quadrilateral of 4 nodes",
    domain: Domain::Square,
    node_coordinates: NODES.split_at(4).0,
    shape: |[s, t, _]| each(4, |[a, b]| 0.25 * (1.0 + a * s) * (1.0 + b * t)),
    gradients: |[s, t, _]| {
        each(4, |[a, b]| {
            [0.25 * a * (1.0 + b * t), 0.25 * b * (1.0 + a * s), 0.0]
        })
    },
    facets: &[
        (Line2, &[0, 1]),
        (Line2, &[1, 2]),
        (Line2, &[2, 3]),
        (Line2, &[3, 0]),
    ],
    reversed: &[0, 3, 2, 1],
    vtk: 9,
    rules: Some(CellRules {
        stiffness: 3,
        stress: 1,
        constant_load: 2,
        cubic_load: 5,
    }),
});

/// A quadratic quadrilateral of eight nodes, the serendipity element.
pub static QUAD8: ReferenceElement = ReferenceElement::new(Definition {
    name: "quadrilateral of 8 nodes",
    domain: Domain::Square,
    node_coordinates: NODES.split_at(8).0,
    shape: |[s, t, _]| each(8, |node| serendipity(node, [s, t])),
    gradients: |[s, t, _]| each(8, |node| serendipity_gradient(node, [s, t])),
    facets: CURVED_EDGES,
    reversed: &[0, 3, 2, 1, 7, 6, 5, 4],
    vtk: 23,
    rules: QUADRATIC_RULES,
});

/// A biquadratic quadrilateral of nine nodes.
pub static QUAD9: ReferenceElement = ReferenceElement::new(Definition {
    name: "quadrilateral of 9 nodes",
    domain: Domain::Square,
    node_coordinates: NODES,
    shape: |[s, t, _]| each(9, |[a, b]| lagrange(a, s) * lagrange(b, t)),
    gradients: |[s, t, _]| {
        each(9, |[a, b]| {
            let (n_s, n_t) = (lagrange(a, s), lagrange(b, t));
            [lagrange_slope(a, s) * n_t, n_s * lagrange_slope(b, t), 0.0]
        })
    },
    facets: CURVED_EDGES,
    reversed: &[0, 3, 2, 1, 7, 6, 5, 4, 8],
    vtk: 28,
    rules: QUADRATIC_RULES,
});

const QUADRATIC_RULES: Option<CellRules> = Some(CellRules {
    stiffness: 5,
    stress: 3,
    constant_load: 5,
    cubic_load: 6,
});

/// The serendipity function of the node at (a, b) of a quadrilateral of eight nodes.
fn serendipity([a, b]: [f64; 2], [s, t]: [f64; 2]) -> f64 {
    match (a == 0.0, b == 0.0) {
        (true, _) => 0.5 * (1.0 - s * s) * (1.0 + b * t),
        (_, true) => 0.5 * (1.0 + a * s) * (1.0 - t * t),
        _ => 0.25 * (1.0 + a * s) * (1.0 + b * t) * (a * s + b * t - 1.0),
    }
}

fn serendipity_gradient([a, b]: [f64; 2], [s, t]: [f64; 2]) -> [f64; 3] {
    match (a == 0.0, b == 0.0) {
        (true, _) => [-s * (1.0 + b * t), 0.5 * b * (1.0 - s * s), 0.0],
        (_, true) => [0.5 * a * (1.0 - t * t), -t * (1.0 + a * s), 0.0],
        _ => [
            0.25 * a * (1.0 + b * t) * (2.0 * a * s + b * t),
            0.25 * b * (1.0 + a * s) * (2.0 * b * t + a * s),
            0.0,
        ],
    }
}
