//! Reduced integration of quadratic cells: uniform stress, stress-free thermal expansion in cells of any shape, and the
//! resultant of a weight.

use contact_dd_partition::element::ElementKind::Hexahedron20;
use contact_dd_partition::mesh::Mesh;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::solid;
use crate::support::solver::solve;
use crate::support::sorts::sort;

/// Cells with curved edges, or affine ones.
fn meshes(curvature: f64) -> [(Mesh, &'static str, &'static str); 2] {
    let bent = move |[x, y, z]: [f64; 3]| {
        [
            x + 0.2 * y + curvature * y * z,
            y - 0.1 * x + curvature * x * (1.0 - x),
            z + 0.3 * x - curvature * x * y,
        ]
    };
    let space = solid("cube", Hexahedron20, [2, 2, 2], bent);
    let plane = Blocks::new().rectangle("cube", [0.0, 1.0], [0.0, 1.0], [3, 2]);
    let mut plane = sort("quad8").of(&plane.mesh);
    for x in &mut plane.points {
        let [a, b, _] = *x;
        *x = [
            a + curvature * b * b,
            b - curvature * a * a + 0.2 * a * b,
            0.0,
        ];
    }
    [
        (space, "'cube x0'", ""),
        (plane, "'cube left'", "plane = 'stress'\n"),
    ]
}

fn scene(head: &str, body: &str, rest: &str) -> String {
    format!(
        "{head}materials.m = {{young = 2e5, poisson = 0.3}}
        bodies.cube = {{material = 'm', integration = 'reduced', {body}}}
        {rest}\n"
    )
}

#[test]
fn linear_displacements_pass_through_affine_cells() {
    for (mesh, _, head) in meshes(0.0) {
        let dim = mesh.dim;
        let (sides, components) = match dim {
            3 => (
                "['cube x0', 'cube x1', 'cube y0', 'cube y1', 'cube z0', 'cube z1']",
                3,
            ),
            _ => ("['cube left', 'cube right', 'cube bottom', 'cube top']", 2),
        };
        let slopes = [
            [1e-4, 2e-4, -5e-4],
            [-3e-4, 4e-4, 6e-4],
            [7e-4, -8e-4, 9e-4],
        ];
        let mut held = format!("[[displacement]]\non = {sides}\n");
        for (name, row) in ["x", "y", "z"].iter().zip(slopes).take(components) {
            let terms = ["x", "y", "z"].iter().zip(row).take(components);
            let terms: Vec<String> = terms.map(|(x, slope)| format!("({slope})*{x}")).collect();
            held += &format!("{name} = '{}'\n", terms.join(" + "));
        }
        let model = model(&scene(head, "", &held), mesh);
        let solution = solve(&model, 2);
        for (tag, x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
            for (row, u) in slopes.iter().zip(solution.displacement[tag]).take(dim) {
                let exact: f64 = row.iter().zip(x).map(|(s, x)| s * x).sum();
                close(u, exact, 1e-14);
            }
        }
    }
}

/// A body with free thermal expansion has no stress in cells of any shape, as loads are integrated like the stiffness.
#[test]
fn cells_of_any_shape_expand_without_stress() {
    for (mesh, side, head) in meshes(0.15) {
        let dim = mesh.dim;
        let corners: Vec<usize> = (0..mesh.points.len()).collect();
        let heat = "thermal = {expansion = 1e-5, temperature = 100}";
        // Held where the expansion about the origin has no component: only points, along normals.
        let axes = ["x", "y", "z"].iter().take(dim);
        let held: String = axes.map(|x| format!("{x} = '1e-3*{x}'\n")).collect();
        let model = model(
            &scene(
                head,
                heat,
                &format!("[[displacement]]\non = {side}\n{held}"),
            ),
            mesh,
        );
        let solution = solve(&model, 2);
        for node in corners {
            let (tag, x) = (model.mesh.node_tags[node], model.mesh.points[node]);
            for (u, x) in solution.displacement[&tag].iter().zip(x).take(dim) {
                close(*u, 1e-3 * x, 1e-13);
            }
        }
        for (_, stress) in &solution.cells {
            assert!(stress.iter().all(|s| s.abs() < 1e-7), "{stress:?}");
        }
    }
}

#[test]
fn a_weight_is_borne_by_what_holds_it() {
    for (mesh, side, head) in meshes(0.0) {
        let dim = mesh.dim;
        let force = if dim == 3 { "[0, 0, -3]" } else { "[0, -3]" };
        let held: String = ["x = 0\n", "y = 0\n", "z = 0\n"][..dim].concat();
        let rest = format!("[[displacement]]\non = {side}\n{held}");
        let model = model(&scene(head, &format!("body_force = {force}"), &rest), mesh);
        let kind = model.mesh.cells.iter().next().map(|(kind, _)| kind);
        assert!(kind.is_some_and(|kind| kind.reduced_points().is_some()));
        let volume: f64 = (model.mesh.cells.iter())
            .map(|(kind, nodes)| {
                let at: Vec<_> = nodes
                    .iter()
                    .map(|&n| model.mesh.points[n as usize])
                    .collect();
                kind.measure(&at)
            })
            .sum();
        let solution = solve(&model, 2);
        let reaction = &solution.report["reactions"][0]["force"];
        close(reaction[dim - 1].as_f64().unwrap(), 3.0 * volume, 1e-9);
    }
}
