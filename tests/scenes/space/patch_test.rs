//! The patch test of MacNeal and Harder, "A proposed standard set of problems to test finite element accuracy", Finite
//! Elements in Analysis and Design 1 (1985): a cube of seven hexahedra, one of which has a negative Jacobian at a
//! corner, with linear displacements prescribed on its faces.

use std::fmt::Write as _;

use contact_dd_partition::mesh;

use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solver::solve;

/// The inner nodes.
const INNER: [[f64; 3]; 8] = [
    [0.249, 0.342, 0.192],
    [0.826, 0.288, 0.288],
    [0.850, 0.649, 0.263],
    [0.273, 0.750, 0.230],
    [0.320, 0.186, 0.643],
    [0.677, 0.305, 0.683],
    [0.788, 0.693, 0.644],
    [0.165, 0.745, 0.702],
];

/// The faces of a hexahedron, counter-clockwise seen from outside.
const FACES: [[usize; 4]; 6] = [
    [0, 3, 2, 1],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

/// The deck; the corners of the cube have the numbers 9 to 16, in the order of the inner nodes.
fn deck() -> String {
    let corner = |i: usize| [[0, 1, 1, 0][i % 4], [0, 0, 1, 1][i % 4], i / 4].map(|c| c as f64);
    let points = INNER.into_iter().chain((0..8).map(corner));
    let mut deck = String::from("*NODE\n");
    for (tag, [x, y, z]) in (1..).zip(points) {
        writeln!(deck, "{tag}, {x}, {y}, {z}").unwrap();
    }
    deck += "*ELEMENT, TYPE=C3D8, ELSET=cube\n1, 1, 2, 3, 4, 5, 6, 7, 8\n";
    for (tag, face) in (2..).zip(FACES) {
        let [a, b, c, d] = face.map(|i| i + 1);
        let [e, f, g, h] = face.map(|i| i + 9);
        writeln!(deck, "{tag}, {a}, {b}, {c}, {d}, {e}, {f}, {g}, {h}").unwrap();
    }
    deck + "*NSET, NSET=faces\n9, 10, 11, 12, 13, 14, 15, 16\n"
}

#[test]
fn linear_displacements_are_exact_in_the_hexahedra_of_macneal_and_harder() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("patch.inp");
    std::fs::write(&path, deck()).unwrap();
    let mesh = mesh::read(&path).unwrap();
    let printed = mesh.warnings.join("\n");
    assert!(
        printed.contains("is folded: its Jacobian is -"),
        "{printed}"
    );
    let text = "
materials.a = {young = 1e6, poisson = 0.25}
bodies.cube.material = 'a'
[[displacement]]
on = 'faces'
x = '1e-3*(2*x+y+z)/2'
y = '1e-3*(x+2*y+z)/2'
z = '1e-3*(x+y+2*z)/2'
";
    let model = model(text, mesh);
    for count in [1, 2] {
        let solution = solve(&model, count);
        for (tag, [x, y, z]) in (1..).zip(INNER) {
            let expected = [2.0 * x + y + z, x + 2.0 * y + z, x + y + 2.0 * z];
            for (u, expected) in solution.displacement[&tag].iter().zip(expected) {
                close(*u, 0.5e-3 * expected, 1e-15);
            }
        }
        for (_, stress) in &solution.cells {
            let expected = [2000.0, 2000.0, 2000.0, 400.0, 400.0, 400.0];
            for (found, expected) in stress.iter().zip(expected) {
                close(*found, expected, 1e-8);
            }
        }
    }
}
