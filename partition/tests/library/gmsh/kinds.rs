//! Files written by Gmsh with cells of every kind, made by `kinds/make.py` and `kinds/make3d.py`.

use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind::{self, *};
use contact_dd_partition::element::geometry::{difference, length};
use contact_dd_partition::mesh::topology::Topology;
use contact_dd_partition::mesh::{Mesh, gmsh};

fn read(name: &str) -> Mesh {
    let dir = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/library/gmsh/kinds");
    gmsh::read(&dir.join(format!("{name}.msh"))).unwrap()
}

const FORMS: [&str; 4] = ["4.1-ascii", "4.1-binary", "2.2-ascii", "2.2-binary"];

/// File, kinds of cells and facets, and how far area or volume are off at most.
const CASES: [(&str, &[ElementKind], ElementKind, f64); 8] = [
    ("linear", &[Quad4, Triangle3], Line2, 0.05),
    ("eight", &[Quad8, Triangle6], Line3, 1e-3),
    ("nine", &[Quad9, Triangle6], Line3, 1e-3),
    ("tetrahedra-4", &[Tetrahedron4], Triangle3, 0.2),
    ("tetrahedra-10", &[Tetrahedron10], Triangle6, 0.02),
    ("hexahedra-8", &[Hexahedron8], Quad4, 0.2),
    ("hexahedra-20", &[Hexahedron20], Quad8, 0.02),
    ("hexahedra-27", &[Hexahedron27], Quad9, 0.02),
];

#[test]
fn cells_of_every_kind_are_read_in_every_form() {
    for (name, kinds, facet, slack) in CASES {
        let mut first = None;
        for form in FORMS {
            let mut mesh = read(&format!("{name}-{form}"));
            assert_eq!(mesh.dim, kinds[0].dim());
            let has = |kind: &ElementKind| mesh.cells.iter().any(|(of_cell, _)| of_cell == *kind);
            assert!(kinds.iter().all(has), "{name} {form}");
            assert!(mesh.cells.iter().all(|(kind, _)| kinds.contains(&kind)));
            let cells = 0..mesh.cells.len();
            let sizes: Vec<f64> = cells.map(|cell| mesh.measure(cell)).collect();
            assert!(sizes.iter().all(|&size| size > 0.0), "{name} {form}");
            let size: f64 = sizes.iter().sum();
            assert!((size - 0.75 * PI).abs() < slack, "{name} {form}: {size}");
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
            // In 2.2 Gmsh numbers elements anew, in another order; ASCII has 16 digits.
            let mut cells: Vec<_> = mesh.cells.iter().map(|(k, n)| (k, n.to_vec())).collect();
            cells.sort();
            let found = (mesh.points, mesh.node_tags, mesh.facets, cells);
            let first = first.get_or_insert_with(|| found.clone());
            assert_eq!(first, &found, "{name} {form}");
        }
    }
}

#[test]
fn nodes_on_edges_and_faces_lie_in_the_middle_of_their_corners() {
    for (name, ..) in CASES {
        let mesh = read(&format!("{name}-4.1-ascii"));
        for (kind, nodes) in mesh.cells.iter() {
            // Where the linear map of the corners has it.
            let linear = match (kind.dim(), kind.corners()) {
                (2, 3) => Triangle3,
                (2, _) => Quad4,
                (_, 4) => Tetrahedron4,
                _ => Hexahedron8,
            };
            let at: Vec<[f64; 3]> = nodes.iter().map(|&n| mesh.points[n as usize]).collect();
            let corners = &at[..kind.corners()];
            let size = length(difference(corners[0], corners[1]));
            let places = at.iter().zip(kind.node_coordinates());
            for (local, (x, xi)) in places.enumerate().skip(corners.len()) {
                let way = difference(*x, linear.position(corners, *xi));
                // Arcs of up to 45° bulge by a share of 0.1 of their length.
                assert!(length(way) < 0.2 * size, "{kind:?} {local}: {way:?}");
            }
        }
    }
}

#[test]
fn cells_of_every_kind_are_written_and_read_back_bit_by_bit() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("mesh.msh");
    for (name, ..) in CASES {
        let mut mesh = read(&format!("{name}-4.1-binary"));
        gmsh::write(&mesh, &path).unwrap();
        let mut back = gmsh::read(&path).unwrap();
        assert_eq!(back.facets.len(), mesh.facets.len());
        for (name, group) in &mesh.groups {
            assert_eq!(back.groups[name].members.len(), group.members.len());
        }
        // Facets may come in another order.
        (mesh.facets, back.facets) = Default::default();
        mesh.groups.clear();
        back.groups.clear();
        assert_eq!(back, mesh);
    }
}
