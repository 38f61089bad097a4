//! Files of Gmsh itself with quadrilaterals and quadratic cells; `kinds/make.py` says of what.

use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind::{self, *};
use contact_dd_partition::mesh::{Mesh, gmsh};

pub fn read(name: &str) -> Mesh {
    let dir = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/library/gmsh/kinds");
    gmsh::read(&dir.join(format!("{name}.msh"))).unwrap()
}

pub const FORMS: [&str; 4] = ["4.1-ascii", "4.1-binary", "2.2-ascii", "2.2-binary"];
const CASES: [(&str, [ElementKind; 3]); 3] = [
    ("linear", [Quad4, Triangle3, Line2]),
    ("eight", [Quad8, Triangle6, Line3]),
    ("nine", [Quad9, Triangle6, Line3]),
];

#[test]
fn quadrilaterals_and_quadratic_cells_are_read_in_every_form() {
    for (name, [quadrilateral, triangle, line]) in CASES {
        let mut first = None;
        for form in FORMS {
            let mut mesh = read(&format!("{name}-{form}"));
            let count = |kind| mesh.cells.iter().filter(|&(k, _)| k == kind).count();
            assert_eq!(
                [count(quadrilateral), count(triangle)],
                [6, 12],
                "{name} {form}"
            );
            assert_eq!(mesh.cells.len(), 18);
            assert!((0..18).all(|cell| mesh.measure(cell) > 0.0));
            let area: f64 = (0..18).map(|cell| mesh.measure(cell)).sum();
            let slack = if line == Line3 { 1e-3 } else { 0.05 };
            assert!((area - 0.75 * PI).abs() < slack, "{name} {form}: {area}");
            for (side, radius) in [("inner", 1.0), ("outer", 2.0)] {
                let members = &mesh.groups[side].members;
                assert_eq!(members.len(), 6);
                for &facet in members {
                    assert_eq!(mesh.facets.kind(facet as usize), line);
                    for &node in mesh.facets.nodes_of(facet as usize) {
                        let [x, y, _] = mesh.points[node as usize];
                        assert!((x.hypot(y) - radius).abs() < 1e-8, "{x} {y}");
                    }
                }
            }
            for x in mesh.points.iter_mut().flatten() {
                *x = (*x * 1e12).round() / 1e12 + 0.0;
            }
            // In 2.2 Gmsh numbers elements anew, in another order; ASCII has 16 digits.
            let mut cells: Vec<_> = mesh.cells.iter().map(|(k, n)| (k, n.to_vec())).collect();
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
fn nodes_on_edges_lie_in_the_middle_of_their_ends() {
    for (name, _) in CASES {
        let mesh = read(&format!("{name}-4.1-ascii"));
        for (kind, nodes) in mesh.cells.iter() {
            let at = |i: usize| mesh.points[nodes[i] as usize];
            for (_, local) in kind.facets().iter().filter(|(_, local)| local.len() == 3) {
                let [a, b, middle] = [0, 1, 2].map(|i| at(local[i]));
                // The arcs of 15° bulge by a share of 0.033 of their length.
                let far = (0..2).map(|i| (middle[i] - 0.5 * (a[i] + b[i])).abs());
                let chord = (a[0] - b[0]).hypot(a[1] - b[1]);
                assert!(far.fold(0.0, f64::max) < 0.05 * chord, "{kind:?}");
            }
        }
    }
}

#[test]
fn quadratic_cells_are_written_and_read_back_bit_by_bit() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("mesh.msh");
    for (name, _) in CASES {
        let mut mesh = read(&format!("{name}-4.1-binary"));
        gmsh::write(&mesh, &path).unwrap();
        let mut back = gmsh::read(&path).unwrap();
        let facets = |mesh: &Mesh| mesh.facets.len();
        assert_eq!(facets(&back), facets(&mesh));
        for group in mesh.groups.keys() {
            assert_eq!(
                back.groups[group].members.len(),
                mesh.groups[group].members.len()
            );
        }
        (mesh.facets, back.facets) = Default::default();
        mesh.groups.clear();
        back.groups.clear();
        assert_eq!(back, mesh);
    }
}
