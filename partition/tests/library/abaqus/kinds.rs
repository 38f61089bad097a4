//! Every type of element, as the manuals of Abaqus and CalculiX number nodes and faces.

use super::{read, tags};

/// A shape: its volume, its corners, and for every face its plane ξ·a = b.
struct Shape {
    measure: f64,
    corners: &'static [[f64; 3]],
    /// The ends of the edges in whose middles the further nodes of the quadratic type are.
    edges: &'static [[usize; 2]],
    faces: &'static [([f64; 3], f64)],
}

const TRIANGLE: Shape = Shape {
    measure: 0.5,
    corners: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    edges: &[[1, 2], [2, 3], [3, 1]],
    faces: &[
        ([0.0, 1.0, 0.0], 0.0),
        ([1.0, 1.0, 0.0], 1.0),
        ([1.0, 0.0, 0.0], 0.0),
    ],
};

const SQUARE: Shape = Shape {
    measure: 1.0,
    corners: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ],
    edges: &[[1, 2], [2, 3], [3, 4], [4, 1]],
    faces: &[
        ([0.0, 1.0, 0.0], 0.0),
        ([1.0, 0.0, 0.0], 1.0),
        ([0.0, 1.0, 0.0], 1.0),
        ([1.0, 0.0, 0.0], 0.0),
    ],
};

const TETRAHEDRON: Shape = Shape {
    measure: 1.0 / 6.0,
    corners: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ],
    edges: &[[1, 2], [2, 3], [3, 1], [1, 4], [2, 4], [3, 4]],
    faces: &[
        ([0.0, 0.0, 1.0], 0.0),
        ([0.0, 1.0, 0.0], 0.0),
        ([1.0, 1.0, 1.0], 1.0),
        ([1.0, 0.0, 0.0], 0.0),
    ],
};

const CUBE: Shape = Shape {
    measure: 1.0,
    corners: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ],
    edges: &[
        [1, 2],
        [2, 3],
        [3, 4],
        [4, 1],
        [5, 6],
        [6, 7],
        [7, 8],
        [8, 5],
        [1, 5],
        [2, 6],
        [3, 7],
        [4, 8],
    ],
    faces: &[
        ([0.0, 0.0, 1.0], 0.0),
        ([0.0, 0.0, 1.0], 1.0),
        ([0.0, 1.0, 0.0], 0.0),
        ([1.0, 0.0, 0.0], 1.0),
        ([0.0, 1.0, 0.0], 1.0),
        ([1.0, 0.0, 0.0], 0.0),
    ],
};

#[test]
fn every_type_has_the_nodes_and_the_faces_of_the_manual() {
    for (types, shape, quadratic) in [
        (&["CPE3", "CPS3", "CAX3", "CPS3H"][..], TRIANGLE, false),
        (&["CPE6", "CPS6", "CAX6", "CPE6MH"], TRIANGLE, true),
        (
            &["CPE4", "CPS4", "CAX4", "CPE4R", "CPS4I", "CAX4RH"],
            SQUARE,
            false,
        ),
        (&["CPE8", "CPS8", "CAX8", "CPS8R"], SQUARE, true),
        (&["C3D4", "C3D4H"], TETRAHEDRON, false),
        (&["C3D10", "C3D10M", "C3D10HS"], TETRAHEDRON, true),
        (&["C3D8", "C3D8R", "c3d8i"], CUBE, false),
        (&["C3D20", "C3D20R", "C3D20RH"], CUBE, true),
    ] {
        let dim = if types[0].starts_with("C3D") { 3 } else { 2 };
        let mut local = shape.corners.to_vec();
        if quadratic {
            local.extend(shape.edges.iter().map(|edge| {
                let [a, b] = edge.map(|corner| shape.corners[corner - 1]);
                [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]))
            }));
        }
        // A skew image, of the volume 2·3·1.5 in space and 2·3 in the plane.
        let image = |[x, y, z]: [f64; 3]| [2.0 * x + 0.3 * y + 0.2 * z, 3.0 * y + 0.4 * z, 1.5 * z];
        let scale = if dim == 3 { 9.0 } else { 6.0 };
        for name in types {
            let mut deck = String::from("*NODE\n");
            for (i, at) in local.iter().enumerate() {
                let [x, y, z] = image(*at);
                deck += &format!("{}, {x}, {y}, {z}\n", 10 + i);
            }
            let nodes: Vec<String> = (0..local.len()).map(|i| (10 + i).to_string()).collect();
            deck += &format!("*ELEMENT, TYPE={name}, ELSET=E\n5");
            for (i, node) in nodes.iter().enumerate() {
                deck += if i == 15 { ",\n" } else { ", " };
                deck += node;
            }
            deck += "\n";
            for number in 1..=shape.faces.len() {
                deck += &format!("*SURFACE, NAME=F{number}\nE, S{number}\n");
            }
            let mesh = read(&deck).unwrap();
            assert_eq!(mesh.dim, dim, "{name}");
            let measure = mesh.measure(0);
            assert!(
                (measure - scale * shape.measure).abs() < 1e-12,
                "{name}: {measure}"
            );
            for (number, (a, b)) in (1..).zip(shape.faces) {
                let on_face = |at: &[f64; 3]| (0..3).map(|k| at[k] * a[k]).sum::<f64>() == *b;
                let expected: Vec<i64> = (10..)
                    .zip(&local)
                    .filter(|(_, at)| on_face(at))
                    .map(|(tag, _)| tag)
                    .collect();
                assert_eq!(
                    tags(&mesh, &format!("F{number}")),
                    [expected],
                    "{name}, S{number}"
                );
            }
        }
    }
}
