//! Tetrahedra: N and ∂N/∂ξ on 0 ≤ ξ, η, ζ, ξ + η + ζ ≤ 1.

use super::ElementKind::{Triangle3, Triangle6};
use super::definition::{CellRules, Definition, Domain};
use super::reference::ReferenceElement;

/// Corners, then the middles of the edges.
const NODES: &[[f64; 3]; 10] = &[
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.5, 0.0, 0.5],
    [0.0, 0.5, 0.5],
];

/// The corners at the ends of each edge.
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Gradients of the barycentric coordinates.
const SLOPES: [[f64; 3]; 4] = [
    [-1.0, -1.0, -1.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

/// The barycentric coordinates.
fn shares([r, s, t]: [f64; 3]) -> [f64; 4] {
    [1.0 - r - s - t, r, s, t]
}

/// A linear tetrahedron: N = (1 − ξ − η − ζ, ξ, η, ζ).
pub static TETRAHEDRON4: ReferenceElement = ReferenceElement::new(Definition {
    name: "tetrahedron of 4 nodes",
    domain: Domain::Tetrahedron,
    node_coordinates: NODES.split_at(4).0,
    shape: |xi| shares(xi).to_vec(),
    gradients: |_| SLOPES.to_vec(),
    facets: &[
        (Triangle3, &[0, 2, 1]),
        (Triangle3, &[0, 1, 3]),
        (Triangle3, &[1, 2, 3]),
        (Triangle3, &[0, 3, 2]),
    ],
    reversed: &[0, 2, 1, 3],
    vtk: 10,
    rules: Some(CellRules {
        stiffness: 0,
        stress: 1,
        constant_load: 1,
        cubic_load: 4,
    }),
});

/// A quadratic tetrahedron of ten nodes.
pub static TETRAHEDRON10: ReferenceElement = ReferenceElement::new(Definition {
    name: "tetrahedron of 10 nodes",
    domain: Domain::Tetrahedron,
    node_coordinates: NODES,
    shape: |xi| {
        let l = shares(xi);
        let corners = l.iter().map(|&l| l * (2.0 * l - 1.0));
        let edges = EDGES.iter().map(|&[a, b]| 4.0 * l[a] * l[b]);
        corners.chain(edges).collect()
    },
    gradients: |xi| {
        let l = shares(xi);
        let corners = (0..4).map(|a| SLOPES[a].map(|slope| (4.0 * l[a] - 1.0) * slope));
        let edges = EDGES.iter().map(|&[a, b]| {
            [0, 1, 2].map(|axis| 4.0 * (l[b] * SLOPES[a][axis] + l[a] * SLOPES[b][axis]))
        });
        corners.chain(edges).collect()
    },
    facets: &[
        (Triangle6, &[0, 2, 1, 6, 5, 4]),
        (Triangle6, &[0, 1, 3, 4, 8, 7]),
        (Triangle6, &[1, 2, 3, 5, 9, 8]),
        (Triangle6, &[0, 3, 2, 7, 9, 6]),
    ],
    reversed: &[0, 2, 1, 3, 6, 5, 4, 7, 9, 8],
    vtk: 24,
    rules: Some(CellRules {
        stiffness: 3,
        stress: 2,
        constant_load: 5,
        cubic_load: 5,
    }),
});
