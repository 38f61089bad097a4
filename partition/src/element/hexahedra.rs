//! Hexahedra: N and ∂N/∂ξ on −1 ≤ ξ, η, ζ ≤ 1.

use super::ElementKind::{self, Quad4, Quad8, Quad9};
use super::definition::{CellRules, Definition, Domain};
use super::lines::{lagrange, lagrange_slope};
use super::reference::ReferenceElement;

/// Corners, the middles of the edges, the middles of the faces, the center.
const NODES: &[[f64; 3]; 27] = &[
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, -1.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, 0.0],
];

/// The nodes of each face in the order of a quadrilateral of nine nodes.
const FACES: [[usize; 9]; 6] = [
    [0, 3, 2, 1, 11, 10, 9, 8, 24],
    [0, 1, 5, 4, 8, 17, 12, 16, 22],
    [1, 2, 6, 5, 9, 18, 13, 17, 21],
    [2, 3, 7, 6, 10, 19, 14, 18, 23],
    [3, 0, 4, 7, 11, 16, 15, 19, 20],
    [4, 5, 6, 7, 12, 13, 14, 15, 25],
];

/// Mirror image with ξ and η swapped.
const REVERSED: &[usize; 27] = &[
    0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17, 22, 23, 20, 21, 24, 25,
    26,
];

/// The faces with the first `count` of their nodes.
const fn faces(kind: ElementKind, count: usize) -> [(ElementKind, &'static [usize]); 6] {
    let mut faces: [(ElementKind, &[usize]); 6] = [(kind, &[]); 6];
    let mut face = 0;
    while face < 6 {
        faces[face].1 = FACES[face].split_at(count).0;
        face += 1;
    }
    faces
}

/// A value for each of the first `count` nodes, as a function of its coordinates.
fn each<T>(count: usize, value: impl Fn([f64; 3]) -> T) -> Vec<T> {
    NODES[..count].iter().map(|&node| value(node)).collect()
}

/// The gradient of f(ξ) g(η) h(ζ) from the values and slopes of the factors.
fn product_slope(values: [f64; 3], slopes: [f64; 3]) -> [f64; 3] {
    [
        slopes[0] * values[1] * values[2],
        values[0] * slopes[1] * values[2],
        values[0] * values[1] * slopes[2],
    ]
}

/// A trilinear hexahedron of eight nodes: N_i = ⅛ (1 + ξ_i ξ)(1 + η_i η)(1 + ζ_i ζ).
pub static HEXAHEDRON8: ReferenceElement = ReferenceElement::new(Definition {
    name: "hexahedron of 8 nodes",
    domain: Domain::Cube,
    node_coordinates: NODES.split_at(8).0,
    shape: |xi| each(8, |node| linear(node, xi).iter().product()),
    gradients: |xi| {
        each(8, |node| {
            product_slope(linear(node, xi), node.map(|a| 0.5 * a))
        })
    },
    facets: &faces(Quad4, 4),
    reversed: REVERSED.split_at(8).0,
    vtk: 12,
    rules: Some(CellRules {
        stiffness: 3,
        stress: 1,
        constant_load: 3,
        cubic_load: 6,
    }),
});

/// A quadratic hexahedron of twenty nodes, the serendipity element.
pub static HEXAHEDRON20: ReferenceElement = ReferenceElement::new(Definition {
    name: "hexahedron of 20 nodes",
    domain: Domain::Cube,
    node_coordinates: NODES.split_at(20).0,
    shape: |xi| each(20, |node| serendipity(node, xi)),
    gradients: |xi| each(20, |node| serendipity_gradient(node, xi)),
    facets: &faces(Quad8, 8),
    reversed: REVERSED.split_at(20).0,
    vtk: 25,
    rules: QUADRATIC_RULES,
});

/// A triquadratic hexahedron of twenty-seven nodes.
pub static HEXAHEDRON27: ReferenceElement = ReferenceElement::new(Definition {
    name: "hexahedron of 27 nodes",
    domain: Domain::Cube,
    node_coordinates: NODES,
    shape: |xi| each(27, |node| quadratic(node, xi).iter().product()),
    gradients: |xi| {
        each(27, |node| {
            let slopes = [0, 1, 2].map(|axis| lagrange_slope(node[axis], xi[axis]));
            product_slope(quadratic(node, xi), slopes)
        })
    },
    facets: &faces(Quad9, 9),
    reversed: REVERSED,
    vtk: 29,
    rules: QUADRATIC_RULES,
});

const QUADRATIC_RULES: Option<CellRules> = Some(CellRules {
    stiffness: 5,
    stress: 3,
    constant_load: 7,
    cubic_load: 7,
});

fn linear(node: [f64; 3], xi: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| 0.5 * (1.0 + node[axis] * xi[axis]))
}

fn quadratic(node: [f64; 3], xi: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| lagrange(node[axis], xi[axis]))
}

/// The factors of the serendipity function of a node on an edge, which is parallel to the axis where its coordinate is
/// 0.
fn on_edge(a: f64, x: f64) -> f64 {
    match a == 0.0 {
        true => lagrange(a, x),
        false => 0.5 * (1.0 + a * x),
    }
}

fn on_edge_slope(a: f64, x: f64) -> f64 {
    match a == 0.0 {
        true => lagrange_slope(a, x),
        false => 0.5 * a,
    }
}

/// True if the node at these coordinates is a corner.
fn is_corner(node: [f64; 3]) -> bool {
    node.iter().all(|&a| a != 0.0)
}

/// ξ_i ξ + η_i η + ζ_i ζ − 2.
fn beyond_corner(node: [f64; 3], xi: [f64; 3]) -> f64 {
    node[0] * xi[0] + node[1] * xi[1] + node[2] * xi[2] - 2.0
}

/// The serendipity function of a node of a hexahedron of twenty nodes.
fn serendipity(node: [f64; 3], xi: [f64; 3]) -> f64 {
    match is_corner(node) {
        true => linear(node, xi).iter().product::<f64>() * beyond_corner(node, xi),
        false => (0..3).map(|axis| on_edge(node[axis], xi[axis])).product(),
    }
}

fn serendipity_gradient(node: [f64; 3], xi: [f64; 3]) -> [f64; 3] {
    if is_corner(node) {
        let values = linear(node, xi);
        let slopes = product_slope(values, node.map(|a| 0.5 * a));
        let (product, beyond) = (values.iter().product::<f64>(), beyond_corner(node, xi));
        return [0, 1, 2].map(|axis| slopes[axis] * beyond + product * node[axis]);
    }
    product_slope(
        [0, 1, 2].map(|axis| on_edge(node[axis], xi[axis])),
        [0, 1, 2].map(|axis| on_edge_slope(node[axis], xi[axis])),
    )
}
