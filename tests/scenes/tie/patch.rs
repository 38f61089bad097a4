//! A uniform stress is transferred exactly.

use contact_dd_partition::element::ElementKind::{Hexahedron8, Tetrahedron4};

use crate::support::blocks::{Blocks, joined};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{SOLIDS, between, moved, solid};
use crate::support::solution::Solution;
use crate::support::solver::solve;
use crate::support::sorts::SORTS;

use super::{ROCK, WELD};

const YOUNG: f64 = 20e9;
const POISSON: f64 = 0.22;

/// Fails unless displacements have the constant `gradient`.
#[track_caller]
fn is_linear(solution: &Solution, points: &[([f64; 3], i64)], gradient: [[f64; 3]; 3]) {
    let scale = solution.largest_displacement();
    for (x, tag) in points {
        let u = solution.displacement[tag];
        for (u, row) in u.iter().zip(gradient) {
            let exact: f64 = row.iter().zip(x).map(|(g, x)| g * x).sum();
            close(*u, exact, 1e-10 * scale);
        }
    }
}

/// The strain of an isotropic stress in space.
fn strain(stress: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let trace: f64 = (0..3).map(|k| stress[k][k]).sum();
    let of = |i: usize, j: usize| {
        let own = (1.0 + POISSON) * stress[i][j];
        (own - if i == j { POISSON * trace } else { 0.0 }) / YOUNG
    };
    std::array::from_fn(|i| std::array::from_fn(|j| of(i, j)))
}

fn applied(stress: [[f64; 3]; 3], normal: [f64; 3]) -> [f64; 3] {
    let size = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
    stress.map(|row| row.iter().zip(normal).map(|(s, n)| s * n / size).sum())
}

/// `displacement` tables of a linear field.
fn held(on: &str, gradient: [[f64; 3]; 3], dim: usize) -> String {
    let mut text = format!("[[displacement]]\non = '{on}'\n");
    for (name, row) in ["x", "y", "z"].iter().zip(gradient).take(dim) {
        text += &format!("{name} = '{:?}*x + {:?}*y", row[0], row[1]);
        text += &if dim == 3 {
            format!(" + {:?}*z'\n", row[2])
        } else {
            "'\n".into()
        };
    }
    text
}

fn pulled(on: &[&str], stress: [[f64; 3]; 3], normal: [f64; 3], dim: usize) -> String {
    let value = applied(stress, normal);
    format!("[[traction]]\non = {on:?}\nvalue = {:?}\n", &value[..dim])
}

#[test]
fn in_the_plane_whatever_the_cells_are() {
    let slope = 0.3;
    let corners = |low: f64, high: f64| {
        [
            [0.0, low],
            [1.0, low + slope],
            [1.0, high + slope],
            [0.0, high],
        ]
    };
    let mesh = Blocks::new()
        .quadrilateral("lower", corners(0.0, 1.0), [3, 4])
        .quadrilateral("upper", corners(1.0, 2.5), [5, 3])
        .mesh;
    // In plane strain the third stress follows from the others.
    let mut stress = [[3e6, 1e6, 0.0], [1e6, -2e6, 0.0], [0.0, 0.0, 0.0]];
    stress[2][2] = POISSON * (stress[0][0] + stress[1][1]);
    let gradient = strain(stress);
    for sides in ["'upper bottom', 'lower top'", "'lower top', 'upper bottom'"] {
        let text = [
            ROCK.to_owned(),
            format!("[[tie]]\nname = 'weld'\nsides = [{sides}]\n"),
            held("lower bottom", gradient, 2),
            pulled(&["upper top"], stress, [-slope, 1.0, 0.0], 2),
            pulled(&["lower right", "upper right"], stress, [1.0, 0.0, 0.0], 2),
            pulled(&["lower left", "upper left"], stress, [-1.0, 0.0, 0.0], 2),
        ]
        .concat();
        for sort in SORTS {
            let model = model(&text, sort.of(&mesh));
            let nodes = model.mesh.points.iter().copied();
            let points: Vec<_> = nodes.zip(model.mesh.node_tags.iter().copied()).collect();
            is_linear(&solve(&model, 6), &points, gradient);
        }
    }
}

/// A tube under axial tension: u_y = ε y, u_x = −ν ε x.
#[test]
fn around_an_axis() {
    let mesh = Blocks::new()
        .rectangle("lower", [1.0, 2.0], [0.0, 1.0], [3, 4])
        .rectangle("upper", [1.0, 2.0], [1.0, 2.5], [5, 3])
        .mesh;
    let pull = 4e6;
    let text = format!(
        "{}{WELD}[[displacement]]\non = 'lower bottom'\ny = 0.0\n[[traction]]\non = 'upper top'\nvalue = [0.0, {pull}]\n",
        ROCK.replace("strain", "axisymmetric")
    );
    let along = pull / YOUNG;
    let gradient = [[-POISSON * along, 0.0, 0.0], [0.0, along, 0.0], [0.0; 3]];
    for sort in SORTS {
        let model = model(&text, sort.of(&mesh));
        let nodes = model.mesh.points.iter().copied();
        let points: Vec<_> = nodes.zip(model.mesh.node_tags.iter().copied()).collect();
        is_linear(&solve(&model, 5), &points, gradient);
    }
}

#[test]
fn in_space_whatever_the_cells_are() {
    let sheared = |[x, y, z]: [f64; 3]| [x + 0.1 * y, y, z + 0.2 * x + 0.1 * y];
    let stress = [[3e6, 1e6, 0.5e6], [1e6, -2e6, -1e6], [0.5e6, -1e6, 1e6]];
    let gradient = strain(stress);
    // Normals of the transformed faces.
    let [x, y, z] = [[1.0, -0.1, 0.0], [0.0, 1.0, 0.0], [-0.2, -0.08, 1.0]];
    let back = |n: [f64; 3]| n.map(|c| -c);
    let text = [
        "materials.rock = {young = 20e9, poisson = 0.22}\nbodies.lower.material = 'rock'\nbodies.upper.material = 'rock'\n"
            .to_owned(),
        "[[tie]]\nname = 'weld'\nsides = ['upper z0', 'lower z1']\n".to_owned(),
        held("lower z0", gradient, 3),
        pulled(&["upper z1"], stress, z, 3),
        pulled(&["lower x1", "upper x1"], stress, x, 3),
        pulled(&["lower x0", "upper x0"], stress, back(x), 3),
        pulled(&["lower y1", "upper y1"], stress, y, 3),
        pulled(&["lower y0", "upper y0"], stress, back(y), 3),
    ]
    .concat();
    for kind in SOLIDS {
        let fine = [Tetrahedron4, Hexahedron8].contains(&kind);
        let [n, m] = if fine {
            [[3, 3, 2], [4, 2, 3]]
        } else {
            [[2, 2, 1], [3, 1, 2]]
        };
        let lower = solid("lower", kind, n, between([0.0; 3], [1.0; 3]));
        let upper = solid("upper", kind, m, between([0.0, 0.0, 1.0], [1.0, 1.0, 2.0]));
        let mesh = moved(joined(lower, upper), sheared);
        let model = model(&text, mesh);
        let nodes = model.mesh.points.iter().copied();
        let points: Vec<_> = nodes.zip(model.mesh.node_tags.iter().copied()).collect();
        is_linear(&solve(&model, 6), &points, gradient);
    }
}
