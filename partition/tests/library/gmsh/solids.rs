//! Files of Gmsh itself with solid cells; `kinds/make3d.py` says of what.

use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind::{self, *};
use contact_dd_partition::element::geometry::{difference, length};
use contact_dd_partition::mesh::topology::Topology;
use contact_dd_partition::mesh::{Mesh, gmsh};

use super::kinds::{FORMS, read};

/// File, kinds of cells and facets, number of cells, and how far the volume is off at most.
const CASES: [(&str, ElementKind, ElementKind, f64); 5] = [
    ("tetrahedra-4", Tetrahedron4, Triangle3, 0.2),
    ("tetrahedra-10", Tetrahedron10, Triangle6, 0.02),
    ("hexahedra-8", Hexahedron8, Quad4, 0.2),
    ("hexahedra-20", Hexahedron20, Quad8, 0.02),
    ("hexahedra-27", Hexahedron27, Quad9, 0.02),
];

#[test]
fn solid_cells_are_read_in_every_form() {
    for (name, kind, facet, slack) in CASES {
        let mut first = None;
        for form in FORMS {
            let mut mesh = read(&format!("{name}-{form}"));
            assert_eq!(mesh.dim, 3);
            assert!(mesh.cells.iter().all(|(of_cell, _)| of_cell == kind));
            let volumes: Vec<f64> = (0..mesh.cells.len())
                .map(|cell| mesh.measure(cell))
                .collect();
            assert!(volumes.iter().all(|&volume| volume > 0.0), "{name} {form}");
            let volume: f64 = volumes.iter().sum();
            assert!(
                (volume - 0.75 * PI).abs() < slack,
                "{name} {form}: {volume}"
            );
            let topology = Topology::new(&mesh);
            for (side, radius) in [("inner", 1.0), ("outer", 2.0)] {
                let members = &mesh.groups[side].members;
                assert!(!members.is_empty());
                for &member in members {
                    assert_eq!(mesh.facets.kind(member as usize), facet);
                    let nodes = mesh.facets.nodes_of(member as usize);
                    for &node in nodes {
                        let [x, y, _] = mesh.points[node as usize];
                        assert!((x.hypot(y) - radius).abs() < 1e-7, "{x} {y}");
                    }
                    // The cell has the same nodes, in an order that begins elsewhere.
                    let [one] = topology.cells_at(nodes)[..] else {
                        panic!("{name}: a facet of no cell or of two");
                    };
                    let (mut of_cell, mut listed) = (one.nodes(&mesh.cells), nodes.to_vec());
                    of_cell.sort_unstable();
                    listed.sort_unstable();
                    assert_eq!(of_cell, listed);
                }
            }
            for x in mesh.points.iter_mut().flatten() {
                *x = (*x * 1e12).round() / 1e12 + 0.0;
            }
            let mut cells: Vec<_> = mesh.cells.iter().map(|(_, n)| n.to_vec()).collect();
            cells.sort();
            let found = (mesh.points, mesh.node_tags, mesh.facets, cells);
            assert_eq!(
                first.get_or_insert_with(|| found.clone()),
                &found,
                "{name} {form}"
            );
        }
    }
}

#[test]
fn nodes_on_edges_and_faces_lie_in_the_middle_of_their_corners() {
    for (name, ..) in CASES {
        let mesh = read(&format!("{name}-4.1-ascii"));
        for (kind, nodes) in mesh.cells.iter() {
            let straight: Vec<[f64; 3]> = kind.node_coordinates().to_vec();
            for (local, &xi) in straight.iter().enumerate().skip(kind.corners()) {
                // Where the linear map of the corners has it.
                let linear = match kind {
                    Tetrahedron10 => Tetrahedron4,
                    _ => Hexahedron8,
                };
                let corners: Vec<_> = (0..kind.corners())
                    .map(|i| mesh.points[nodes[i] as usize])
                    .collect();
                let way = difference(
                    mesh.points[nodes[local] as usize],
                    linear.position(&corners, xi),
                );
                // Arcs of up to 45° bulge by a share of 0.1 of their length.
                let size = length(difference(corners[0], corners[1]));
                assert!(length(way) < 0.2 * size, "{kind:?} {local}: {way:?}");
            }
        }
    }
}

#[test]
fn solid_cells_are_written_and_read_back_bit_by_bit() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("mesh.msh");
    for (name, ..) in CASES {
        let mesh: Mesh = read(&format!("{name}-4.1-binary"));
        gmsh::write(&mesh, &path).unwrap();
        let back = gmsh::read(&path).unwrap();
        assert_eq!(
            (back.points, back.cells, back.facets.len()),
            (mesh.points, mesh.cells, mesh.facets.len())
        );
    }
}
