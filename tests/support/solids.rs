//! Meshes of boxes in space, with cells of every kind.

use std::collections::HashMap;

use contact_dd_partition::element::ElementKind::{
    self, Hexahedron8, Hexahedron20, Hexahedron27, Tetrahedron4, Tetrahedron10,
};
use contact_dd_partition::mesh::Mesh;

use super::random::Random;

/// All kinds of cells in space.
pub const SOLIDS: [ElementKind; 5] = [
    Tetrahedron4,
    Tetrahedron10,
    Hexahedron8,
    Hexahedron20,
    Hexahedron27,
];

/// The corners between the first and the seventh of a hexahedron on the six paths along its edges: six tetrahedra.
const WAYS: [[usize; 2]; 6] = [[1, 2], [2, 3], [3, 7], [7, 4], [4, 5], [5, 1]];

/// Positions of the nodes of the cells in a hexahedron, from 0 to 2 in each direction.
fn cells_in_hexahedron(kind: ElementKind) -> Vec<Vec<[usize; 3]>> {
    let at = |xi: &[f64; 3]| xi.map(|c| (c + 1.0) as usize);
    let corners: Vec<[usize; 3]> = Hexahedron8.node_coordinates().iter().map(at).collect();
    if kind.corners() == 8 {
        return vec![kind.node_coordinates().iter().map(at).collect()];
    }
    let tetrahedron = |[a, b]: [usize; 2]| {
        let ends = [0, a, b, 6].map(|corner| corners[corner]);
        let place = |xi: &[f64; 3]| {
            let shares = Tetrahedron4.shape(*xi);
            [0, 1, 2].map(|k| {
                let sum: f64 = shares
                    .iter()
                    .zip(ends)
                    .map(|(share, end)| share * end[k] as f64)
                    .sum();
                sum as usize
            })
        };
        kind.node_coordinates().iter().map(place).collect()
    };
    WAYS.map(tetrahedron).to_vec()
}

/// The image of the unit cube under `map` in `n` cells, or groups of six tetrahedra, in each direction: the group of
/// cells `name`, and its faces `name x0`, `name x1`, `name y0`, ….
pub fn solid(
    name: &str,
    kind: ElementKind,
    n: [usize; 3],
    map: impl Fn([f64; 3]) -> [f64; 3],
) -> Mesh {
    let mut mesh = Mesh {
        dim: 3,
        ..Mesh::default()
    };
    let mut known: HashMap<[usize; 3], u32> = HashMap::new();
    let cells = cells_in_hexahedron(kind);
    let last = n.map(|n| 2 * n);
    for i in 0..n[0] * n[1] * n[2] {
        let first = [i % n[0], i / n[0] % n[1], i / n[0] / n[1]];
        for cell in &cells {
            let places: Vec<[usize; 3]> = cell
                .iter()
                .map(|place| [0, 1, 2].map(|k| 2 * first[k] + place[k]))
                .collect();
            let nodes: Vec<u32> = (places.iter())
                .map(|&place| {
                    *known.entry(place).or_insert_with(|| {
                        mesh.points
                            .push(map([0, 1, 2].map(|k| place[k] as f64 / last[k] as f64)));
                        mesh.points.len() as u32 - 1
                    })
                })
                .collect();
            for (facet, local) in kind.facets() {
                for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
                    for (end, coordinate) in [0, last[axis]].into_iter().enumerate() {
                        if local.iter().all(|&node| places[node][axis] == coordinate) {
                            let group = mesh
                                .groups
                                .entry(format!("{name} {letter}{end}"))
                                .or_default();
                            group.dim = 2;
                            group.members.push(mesh.facets.len() as u32);
                            let of_facet: Vec<u32> =
                                local.iter().map(|&node| nodes[node]).collect();
                            mesh.facets.push(*facet, &of_facet);
                        }
                    }
                }
            }
            let group = mesh.groups.entry(name.into()).or_default();
            group.dim = 3;
            group.members.push(mesh.cells.len() as u32);
            mesh.cells.push(kind, &nodes);
        }
    }
    mesh.node_tags = (1..=mesh.points.len() as i64).collect();
    mesh.cell_tags = (1..=mesh.cells.len() as i64).collect();
    mesh
}

/// The box between two corners.
pub fn between(low: [f64; 3], high: [f64; 3]) -> impl Fn([f64; 3]) -> [f64; 3] {
    move |x| [0, 1, 2].map(|k| low[k] * (1.0 - x[k]) + high[k] * x[k])
}

/// A rotation about a general axis.
pub fn turned([x, y, z]: [f64; 3]) -> [f64; 3] {
    let [x, y] = [0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y];
    let [y, z] = [
        28.0 / 53.0 * y - 45.0 / 53.0 * z,
        45.0 / 53.0 * y + 28.0 / 53.0 * z,
    ];
    [x, y, z]
}

/// The mesh with all nodes moved by a map.
pub fn moved(mut mesh: Mesh, to: impl Fn([f64; 3]) -> [f64; 3]) -> Mesh {
    for point in &mut mesh.points {
        *point = to(*point);
    }
    mesh
}

/// The mesh with nodes inside the unit cube moved a little, so that edges of quadratic cells become curved.
pub fn shaken(mut mesh: Mesh, amount: f64) -> Mesh {
    let mut random = Random::new(7);
    for point in &mut mesh.points {
        let is_inner = point.iter().all(|c| (1e-9..1.0 - 1e-9).contains(c));
        if is_inner {
            point
                .iter_mut()
                .for_each(|c| *c += amount * random.signed());
        }
    }
    mesh
}
