//! Axisymmetric scenes.

mod contact;

use std::f64::consts::PI;

use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use crate::support::blocks::{Blocks, jittered};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solver::{Case, problem, solve};
use crate::support::sorts::{SORTS, sort};

const YOUNG: f64 = 20e9;
const POISSON: f64 = 0.25;

const BODY: &str = "
plane = 'axisymmetric'
materials.rock = {young = 20e9, poisson = 0.25}
bodies.ring.material = 'rock'
";

fn rectangle(name: &str, x: [f64; 2], y: [f64; 2], n: [usize; 2]) -> Mesh {
    Blocks::new().rectangle(name, x, y, n).mesh
}

/// u_r = a r, u_y = b y under uniform tractions on each face.
#[test]
fn a_uniform_strain_is_exact_on_and_off_the_axis_in_all_cells() {
    let (a, b) = (3e-5, -5e-5);
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    let lambda = 2.0 * shear * POISSON / (1.0 - 2.0 * POISSON);
    let radial = lambda * (2.0 * a + b) + 2.0 * shear * a;
    let axial = lambda * (2.0 * a + b) + 2.0 * shear * b;
    for inner in [0.0, 0.5] {
        let mesh = rectangle("ring", [inner, inner + 1.0], [0.0, 1.0], [6, 5]);
        for sort in SORTS {
            let mut text = format!(
                "{BODY}
[[bilateral]]
on = 'ring bottom'
[[pressure]]
on = 'ring right'
value = {}
[[traction]]
on = 'ring top'
value = [0.0, {axial}]\n",
                -radial
            );
            if inner > 0.0 {
                text += &format!("[[pressure]]\non = 'ring left'\nvalue = {}\n", -radial);
            }
            let mesh = jittered(sort.of(&jittered(mesh.clone(), 0.03, 3)), 0.01, 4);
            let model = model(&text, mesh);
            for count in [1, 4] {
                let solution = solve(&model, count);
                let stress = [radial, axial, radial, 0.0, 0.0, 0.0];
                solution.check_stress(stress, 1e-10 * axial.abs());
                for (tag, x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
                    let u = solution.displacement[tag];
                    close(u[0], a * x[0], 1e-10 * a);
                    close(u[1], b * x[1], 1e-10 * a);
                }
                // The force of the floor is that on the disc above it.
                let reaction = &solution.report["reactions"][0]["force"];
                let area = PI * ((inner + 1.0).powi(2) - inner * inner);
                close(
                    reaction[1].as_f64().unwrap(),
                    -axial * area,
                    1e-10 * axial.abs() * area,
                );
                assert_eq!(reaction[0].as_f64(), Some(0.0));
            }
        }
    }
}

/// A thick shell of radii 1 and 2 under an internal pressure p: a cylinder between smooth plates, or a sphere, of which
/// a quarter is rotated around the axis.
fn lame(sphere: bool, name: &str, n: usize) -> [f64; 2] {
    let p = 1e6;
    let mapped = Blocks::new().mapped("ring", [n, n], |[s, t]| match sphere {
        false => [1.0 + s, t],
        // Counter-clockwise from the floor to the axis.
        true => {
            let angle = 0.5 * PI * t;
            [(1.0 + s) * angle.cos(), (1.0 + s) * angle.sin()]
        }
    });
    let sort = sort(name);
    let mut mesh = sort.of(&mapped.mesh);
    if sphere && sort.is_quadratic {
        // Nodes on edges are moved onto the spheres through the ends.
        for point in &mut mesh.points {
            let [x, y, _] = *point;
            let (r, cell) = (x.hypot(y), 1.0 / n as f64);
            let layer = (2.0 * (r - 1.0) / cell).round() * 0.5 * cell + 1.0;
            *point = [x * layer / r, y * layer / r, 0.0];
        }
    }
    let text = format!(
        "{BODY}
[[pressure]]
on = 'ring left'
value = {p}
[[bilateral]]
on = [{}]
",
        if sphere {
            "'ring bottom'"
        } else {
            "'ring bottom', 'ring top'"
        }
    );
    let model = model(&text, mesh);
    let solution = solve(&model, 3);
    let power = if sphere { 3 } else { 2 };
    let (mut displacement, mut stress) = (0.0_f64, 0.0_f64);
    for (tag, &[x, y, _]) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
        let r = if sphere { x.hypot(y) } else { x };
        let c = p / (2.0_f64.powi(power) - 1.0);
        let far = (2.0 / r).powi(power);
        let (exact, hoop) = match sphere {
            true => (
                c * r * ((1.0 - 2.0 * POISSON) + 0.5 * (1.0 + POISSON) * far) / YOUNG,
                c * (1.0 + 0.5 * far),
            ),
            false => (
                c * r * (1.0 + POISSON) * ((1.0 - 2.0 * POISSON) + far) / YOUNG,
                c * (1.0 + far),
            ),
        };
        let u = solution.displacement[tag];
        let along = if sphere {
            (u[0] * x + u[1] * y) / r
        } else {
            u[0]
        };
        displacement = displacement.max((along / exact - 1.0).abs());
        stress = stress.max((solution.nodal_stress[tag][2] / hoop - 1.0).abs());
    }
    [displacement, stress]
}

#[test]
fn thick_cylinders_and_spheres_converge_to_lame() {
    for sphere in [false, true] {
        for (name, orders, most) in [
            ("triangle3", [1.6, 0.9], 2e-2),
            ("quad4", [1.6, 0.9], 2e-2),
            ("triangle6", [2.7, 1.7], 1e-3),
            ("quad8", [2.7, 1.7], 1e-3),
            ("quad9", [2.7, 1.7], 1e-3),
        ] {
            let [coarse, fine] = [6, 12].map(|n| lame(sphere, name, n));
            for k in 0..2 {
                let order = (coarse[k] / fine[k]).log2();
                assert!(
                    order > orders[k],
                    "{name}, {sphere}, {k}: order {order}, {fine:?}"
                );
            }
            assert!(fine[0] < most, "{name}: {fine:?}");
        }
    }
}

#[test]
fn a_free_ring_has_no_motion_but_along_the_axis() {
    let scene = |loads: &str| {
        let mesh = rectangle("ring", [1.0, 2.0], [0.0, 1.0], [4, 4]);
        model(&format!("{BODY}{loads}"), mesh)
    };
    let inside = "[[pressure]]\non = 'ring left'\nvalue = 1e6\n";
    let solution = solve(&scene(inside), 2);
    let warnings = solution.report["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(
        warnings[0]
            .as_str()
            .unwrap()
            .contains("translation along (0.0000, 1.0000)")
    );
    let mean: f64 = solution.displacement.values().map(|u| u[1]).sum();
    close(mean, 0.0, 1e-12 * solution.largest_displacement());
    let ended = Case::of(
        &scene("[[traction]]\non = 'ring top'\nvalue = [0, 1e5]\n"),
        2,
    )
    .run(&[]);
    assert_eq!(ended.code(), 4, "{}", ended.stderr);
    let expected = "body 'ring' is under-constrained: its rigid-body motion, translation along (0.0000, 1.0000)";
    assert!(ended.stderr.contains(expected), "{}", ended.stderr);
}

#[test]
fn the_axis_is_no_place_to_cross_or_to_leave() {
    let refused = |text: &str, x: [f64; 2]| {
        let text = format!("mesh = 'here.msh'\n{BODY}{text}");
        let scene = Scene::parse(&text).unwrap();
        let mesh = rectangle("ring", x, [0.0, 1.0], [4, 4]);
        Model::new(&scene, mesh)
            .err()
            .map(|e| e.to_string())
            .unwrap_or_default()
    };
    let across = refused("", [-0.5, 1.0]);
    assert!(
        across.contains("body 'ring': node 1 lies at x = -0.5; expected x ≥ 0"),
        "{across}"
    );
    let left = refused("[[displacement]]\non = 'ring left'\nx = 1e-3\n", [0.0, 1.0]);
    assert!(
        left.contains("axis of symmetry prescribes 0 for the displacement along (1, 0, 0)"),
        "{left}"
    );
    let contact = "[[contact]]\nname = 'c'\nsides = ['ring left']\nobstacle = {point = [0, 0], normal = [1, 0]}\n";
    let on_axis = refused(contact, [0.0, 1.0]);
    assert!(
        on_axis.contains("lies on the axis; expected sides off it"),
        "{on_axis}"
    );
    assert_eq!(refused("", [-1e-14, 1.0]), "");
}

#[test]
fn a_problem_file_has_no_node_on_the_other_side_of_the_axis() {
    let mesh = rectangle("ring", [0.0, 1.0], [0.0, 1.0], [4, 4]);
    let mut problem = problem(&model(BODY, mesh), Some(2));
    problem.subdomains[1].points[0][0] = -0.01;
    let ended = Case::new(&problem).run(&[]);
    assert_eq!(ended.code(), 2, "{}", ended.stderr);
    assert!(
        ended.stderr.contains("x = -0.01; expected a radius ≥ 0"),
        "{}",
        ended.stderr
    );
}

/// Lamé: u = A r + B/r with σ_r = 0 on the outer face, in plane strain; the inner face is displaced outwards.
#[test]
fn a_ring_that_supports_widen_is_that_of_lame() {
    let (inner, outer, poisson, moved) = (1.0_f64, 2.0_f64, 0.3, 1e-3);
    let blocks = Blocks::new().rectangle("ring", [inner, outer], [0.0, 0.25], [24, 4]);
    let text = format!(
        "plane = 'axisymmetric'
        materials.steel = {{young = 2e11, poisson = {poisson}}}
        bodies.ring.material = 'steel'
        [[displacement]]
        on = 'ring left'
        x = {moved}
        [[displacement]]
        on = ['ring bottom', 'ring top']
        y = 0"
    );
    let shape = |r: f64| (1.0 - 2.0 * poisson) * r + outer * outer / r;
    let exact = |r: f64| moved * shape(r) / shape(inner);
    for name in ["quad9", "triangle6"] {
        let model = model(&text, sort(name).of(&blocks.mesh));
        let solution = solve(&model, 3);
        for (tag, x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
            close(solution.displacement[tag][0], exact(x[0]), 1e-5 * moved);
        }
    }
}
