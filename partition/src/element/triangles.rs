//! Triangles: N and ∂N/∂ξ on 0 ≤ ξ, η, ξ + η ≤ 1.

use super::ElementKind::{Line2, Line3};
use super::definition::{CellRules, Definition, Domain};
use super::reference::ReferenceElement;

/// Corners, then the middles of the edges.
const NODES: &[[f64; 3]; 6] = &[
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
];

/// A linear triangle: N = (1 − ξ − η, ξ, η).
pub static TRIANGLE3: ReferenceElement = ReferenceElement::new(Definition {
    name: "triangle of 3 nodes",
    domain: Domain::Triangle,
    node_coordinates: NODES.split_at(3).0,
    shape: |[s, t, _]| vec![1.0 - s - t, s, t],
    gradients: |_| vec![[-1.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    facets: &[(Line2, &[0, 1]), (Line2, &[1, 2]), (Line2, &[2, 0])],
    reversed: &[0, 2, 1],
    vtk: 5,
    rules: Some(CellRules {
        stiffness: 0,
        stress: 1,
        constant_load: 1,
        cubic_load: 5,
    }),
});

/// A quadratic triangle of six nodes.
pub static TRIANGLE6: ReferenceElement = ReferenceElement::new(Definition {
    name: "triangle of 6 nodes",
    domain: Domain::Triangle,
    node_coordinates: NODES,
    shape: |[s, t, _]| {
        let r = 1.0 - s - t;
        vec![
            r * (2.0 * r - 1.0),
            s * (2.0 * s - 1.0),
            t * (2.0 * t - 1.0),
            4.0 * r * s,
            4.0 * s * t,
            4.0 * t * r,
        ]
    },
    gradients: |[s, t, _]| {
        let r = 1.0 - s - t;
        vec![
            [1.0 - 4.0 * r, 1.0 - 4.0 * r, 0.0],
            [4.0 * s - 1.0, 0.0, 0.0],
            [0.0, 4.0 * t - 1.0, 0.0],
            [4.0 * (r - s), -4.0 * s, 0.0],
            [4.0 * t, 4.0 * s, 0.0],
            [-4.0 * t, 4.0 * (r - t), 0.0],
        ]
    },
    facets: &[
        (Line3, &[0, 1, 3]),
        (Line3, &[1, 2, 4]),
        (Line3, &[2, 0, 5]),
    ],
    reversed: &[0, 2, 1, 5, 4, 3],
    vtk: 22,
    rules: Some(CellRules {
        stiffness: 4,
        stress: 2,
        constant_load: 4,
        cubic_load: 5,
    }),
});
