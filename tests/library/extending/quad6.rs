//! An element that the program doesn't have: a quadrilateral that is quadratic along ξ and linear
//! along η, to lead from quadratic cells to linear ones.

use contact_dd_partition::element::ElementKind::{Line2, Line3};
use contact_dd_partition::element::lines::{lagrange, lagrange_slope};
use contact_dd_partition::element::reference::Domain;
use contact_dd_partition::element::reference::{CellRules, Definition, ReferenceElement};

/// Corners, then the middles of the edges η = −1 and η = 1.
const NODES: &[[f64; 3]; 6] = &[
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0],
];

/// N_i = l_i(ξ) ½ (1 + η_i η), l_i quadratic.
pub static QUAD6: ReferenceElement = ReferenceElement::new(Definition {
    name: "quadrilateral of 6 nodes",
    domain: Domain::Square,
    node_coordinates: NODES,
    shape: |[s, t, _]| {
        let nodes = NODES.iter();
        nodes
            .map(|&[a, b, _]| lagrange(a, s) * 0.5 * (1.0 + b * t))
            .collect()
    },
    gradients: |[s, t, _]| {
        let nodes = NODES.iter();
        nodes
            .map(|&[a, b, _]| {
                [
                    lagrange_slope(a, s) * 0.5 * (1.0 + b * t),
                    lagrange(a, s) * 0.5 * b,
                    0.0,
                ]
            })
            .collect()
    },
    facets: &[
        (Line3, &[0, 1, 4]),
        (Line2, &[1, 2]),
        (Line3, &[2, 3, 5]),
        (Line2, &[3, 0]),
    ],
    reversed: &[3, 2, 1, 0, 5, 4],
    vtk: 30,
    rules: Some(CellRules {
        stiffness: 4,
        stress: 3,
        constant_load: 5,
        cubic_load: 5,
    }),
});
