//! Cells with incompatible modes: uniform stress in cells of any shape, and bending with one cell across a beam.

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::{Formulation, Material};

use crate::support::blocks::{Blocks, jittered};
use crate::support::scenes::model;
use crate::support::solids::{between, moved, shaken, solid};
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve};
use crate::support::sorts::sort;

const YOUNG: f64 = 2e5;
/// Length of the beam, whose cross section is a square of 1 m.
const LENGTH: f64 = 10.0;

/// The mesh with incompatible modes in all cells.
fn bending(mesh: Mesh) -> Mesh {
    Mesh {
        has_modes: vec![true; mesh.cells.len()],
        ..mesh
    }
}

/// Cells along the beam, one across.
fn beam(cells: usize) -> Mesh {
    let ends = between([0.0, -0.5, -0.5], [LENGTH, 0.5, 0.5]);
    solid("beam", Hexahedron8, [cells, 1, 1], ends)
}

/// The beam fixed at one end, pushed sideways at the other with 1 N.
fn pushed(push: [f64; 3]) -> String {
    format!(
        "materials.m = {{young = {YOUNG}, poisson = 0}}
        bodies.beam.material = 'm'
        [[displacement]]
        on = 'beam x0'
        x = 0
        y = 0
        z = 0
        [[traction]]
        on = 'beam x1'
        value = {push:?}\n"
    )
}

/// The deflection of the end by Timoshenko's theory, with a shear correction factor of 5/6.
fn deflection() -> f64 {
    let inertia = 1.0 / 12.0;
    LENGTH.powi(3) / (3.0 * YOUNG * inertia) + LENGTH / (5.0 / 6.0 * 0.5 * YOUNG)
}

#[test]
fn a_uniform_stress_passes_through_cells_of_any_shape() {
    let solid = shaken(solid("cube", Hexahedron8, [3, 3, 3], |x| x), 0.2);
    let plane = Blocks::new().rectangle("cube", [0.0, 1.0], [0.0, 1.0], [4, 4]);
    let plane = sort("quad4").of(&plane.mesh);
    let plane = jittered(plane, 0.06, 5);
    let slopes =
        [[0.1, 0.2, -0.5], [-0.3, 0.4, 0.6], [0.7, -0.8, 0.9]].map(|row| row.map(|s| 1e-3 * s));
    for mesh in [solid, plane] {
        let dim = mesh.dim;
        let (sides, head) = match dim {
            3 => (
                "['cube x0', 'cube x1', 'cube y0', 'cube y1', 'cube z0', 'cube z1']",
                "",
            ),
            _ => (
                "['cube left', 'cube right', 'cube bottom', 'cube top']",
                "plane = 'strain'\n",
            ),
        };
        let mut text = format!(
            "{head}materials.m = {{young = {YOUNG}, poisson = 0.3}}
            bodies.cube.material = 'm'
            [[displacement]]
            on = {sides}\n"
        );
        for (name, row) in ["x", "y", "z"].iter().zip(slopes).take(dim) {
            let terms = ["x", "y", "z"].iter().zip(row).take(dim);
            let terms: Vec<String> = terms.map(|(x, slope)| format!("({slope})*{x}")).collect();
            text += &format!("{name} = '{}'\n", terms.join(" + "));
        }
        let model = model(&text, bending(mesh));
        let has_modes = |m: &Material| m.formulation == Formulation::IncompatibleModes;
        assert!(model.materials.iter().any(has_modes));
        let solution = solve(&model, 2);
        for (tag, x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
            for (row, u) in slopes.iter().zip(solution.displacement[tag]).take(dim) {
                let exact: f64 = row.iter().zip(x).map(|(s, x)| s * x).sum();
                assert!((u - exact).abs() < 1e-15, "{u} {exact}");
            }
        }
        let first = solution.cells[0].1;
        for (_, stress) in &solution.cells {
            for (s, t) in stress.iter().zip(first) {
                assert!((s - t).abs() < 1e-9, "{s} {t}");
            }
        }
    }
}

#[test]
fn a_beam_of_one_cell_across_bends_as_by_the_theory_of_beams() {
    let [plain, with] = [beam(10), bending(beam(10))].map(|mesh| {
        let solution = solve(&model(&pushed([0.0, 0.0, -1.0]), mesh), 2);
        solution.largest_displacement() / deflection()
    });
    assert!(plain < 0.8, "{plain}");
    assert!((with - 1.0).abs() < 0.01, "{with}");
    // In the plane; with ν = 0 plane stress and plane strain coincide.
    let plane = Blocks::new().rectangle("beam", [0.0, LENGTH], [-0.5, 0.5], [10, 1]);
    let plane = bending(sort("quad4").of(&plane.mesh));
    let text = pushed([0.0, -1.0, 0.0])
        .replace("'beam x0'", "'beam left'")
        .replace("'beam x1'", "'beam right'")
        .replace("[0.0, -1.0, 0.0]", "[0.0, -1.0]")
        .replace("z = 0\n", "\n");
    let text = format!("plane = 'strain'\n{text}");
    let depth = solve(&model(&text, plane), 2).largest_displacement() / deflection();
    assert!((depth - 1.0).abs() < 0.01, "{depth}");
}

/// Rotated about two axes, by angles of 3-4-5 and 5-12-13 triangles.
fn turned([x, y, z]: [f64; 3]) -> [f64; 3] {
    let [x, y] = [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y];
    let [y, z] = [(12.0 * y - 5.0 * z) / 13.0, (5.0 * y + 12.0 * z) / 13.0];
    [x, y, z]
}

#[test]
fn a_turned_beam_bends_as_much() {
    let push = [0.0, 0.3, -1.0];
    let straight = solve(&model(&pushed(push), bending(beam(6))), 2);
    let mesh = bending(moved(beam(6), turned));
    let other = solve(&model(&pushed(turned(push)), mesh), 3);
    let far = straight.largest_displacement();
    for (tag, u) in &straight.displacement {
        for (a, b) in turned(*u).iter().zip(other.displacement[tag]) {
            assert!((a - b).abs() < 1e-10 * far, "{a} {b}");
        }
    }
}

/// Stress of pure bending, σ = −M z/I, which is uniform in no cell.
#[test]
fn stresses_of_bending_are_linear_across_one_cell() {
    let text = pushed([0.0; 3]).replace("[0.0, 0.0, 0.0]", "['12*z', 0, 0]");
    let solution = solve(&model(&text, bending(beam(8))), 2);
    let mesh = beam(8);
    for (tag, x) in mesh.node_tags.iter().zip(&mesh.points) {
        let [xx, others @ ..] = solution.nodal_stress[tag];
        assert!((xx - 12.0 * x[2]).abs() < 1e-8, "{x:?} {xx}");
        assert!(others.iter().all(|s| s.abs() < 1e-8), "{others:?}");
    }
    let error = solution.report["error_estimate"]["relative"]
        .as_f64()
        .unwrap();
    assert!(error < 1e-6, "{error}");
    solution.check_certificate();
}

#[test]
fn cells_with_modes_are_the_same_on_any_number_of_ranks() {
    let mesh = shaken(solid("beam", Hexahedron8, [6, 2, 2], |x| x), 0.1);
    let case = Case::of(&model(&pushed([0.2, 0.0, -1.0]), bending(mesh)), 5);
    let solutions = [1, 2, 3].map(|ranks| {
        let ended = case.run_on(ranks, &[]);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        Solution::read(&case.result())
    });
    for other in &solutions[1..] {
        assert_eq!(solutions[0].displacement, other.displacement);
        assert_eq!(solutions[0].nodal_stress, other.nodal_stress);
    }
}
