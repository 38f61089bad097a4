//! Couplings of a side to a reference point.

mod partial;

use contact_dd_partition::element::ElementKind::{Hexahedron8, Tetrahedron10};
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;
use serde_json::Value;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve, solve_steps};
use crate::support::sorts::SORTS;

const PLANE: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
bodies.block = {material = 'rock'}
[[displacement]]
on = 'block bottom'
x = 0.0
y = 0.0
";

const SPACE: &str = "
materials.rock = {young = 20e9, poisson = 0.22}
bodies.block = {material = 'rock'}
[[displacement]]
on = 'block z0'
x = 0.0
y = 0.0
z = 0.0
";

fn plane() -> Mesh {
    Blocks::new()
        .rectangle("block", [0.0, 0.6], [0.0, 1.5], [4, 7])
        .mesh
}

fn coupling(on: &str, point: &[f64], keys: &str) -> String {
    format!("[[coupling]]\nname = 'grip'\non = '{on}'\npoint = {point:?}\n{keys}\n")
}

/// A resultant in the report: force and moment.
fn resultant(of: &Value) -> [f64; 6] {
    let number = |list: &str, k: usize| of[list][k].as_f64().unwrap();
    std::array::from_fn(|k| {
        if k < 3 {
            number("force", k)
        } else {
            number("moment", k - 3)
        }
    })
}

/// Fails unless two solutions have the same displacements at common nodes.
#[track_caller]
fn same(one: &Solution, other: &Solution, slack: f64) {
    let scale = one.largest_displacement();
    for (tag, v) in &other.displacement {
        let u = one.displacement[tag];
        (0..3).for_each(|k| close(u[k], v[k], slack * scale));
    }
}

/// A motion of the point moves the side like displacements linear in the position, with the same forces.
#[test]
fn a_rigid_motion_in_the_plane_is_that_of_prescribed_displacements() {
    let (rx, ry, turn) = (0.9, 1.7, 3e-5);
    let prescribed = format!(
        "[[displacement]]\non = 'block top'\nx = '1e-5 - {turn:?}*(y - {ry:?})'\ny = '-2e-5 + {turn:?}*(x - {rx:?})'\n"
    );
    let keys = format!("x = 1e-5\ny = -2e-5\nrz = {turn:?}");
    for sort in SORTS {
        let mesh = sort.of(&plane());
        let expected = solve(&model(&format!("{PLANE}{prescribed}"), mesh.clone()), 1);
        for count in [1, 5] {
            let text = format!("{PLANE}{}", coupling("block top", &[rx, ry], &keys));
            let solution = solve(&model(&text, mesh.clone()), count);
            same(&solution, &expected, 1e-10);
            let [found, of_nodes] =
                [&solution, &expected].map(|of| resultant(&of.report["reactions"][1]));
            let scale = of_nodes.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
            (0..6).for_each(|k| close(found[k], of_nodes[k], 1e-8 * scale));
            assert_eq!(
                solution.report["reactions"][1]["support"],
                "coupling 'grip'"
            );
        }
    }
}

#[test]
fn a_rigid_motion_in_space_is_that_of_prescribed_displacements() {
    let point = [0.2, 0.5, 1.3];
    let (p, t) = ([1e-5, -2e-5, 3e-5], [2e-5, 1e-5, 4e-5]);
    let [x, y, z] = ["x", "y", "z"].map(|c| c.to_owned());
    let arm = |axis: &str, k: usize| format!("({axis} - {:?})", point[k]);
    let (x, y, z) = (arm(&x, 0), arm(&y, 1), arm(&z, 2));
    let prescribed = format!(
        "[[displacement]]\non = 'block z1'\nx = '{:?} + {:?}*{z} - {:?}*{y}'\ny = '{:?} + {:?}*{x} - {:?}*{z}'\nz = '{:?} + {:?}*{y} - {:?}*{x}'\n",
        p[0], t[1], t[2], p[1], t[2], t[0], p[2], t[0], t[1]
    );
    let keys = format!(
        "x = {:?}\ny = {:?}\nz = {:?}\nrx = {:?}\nry = {:?}\nrz = {:?}",
        p[0], p[1], p[2], t[0], t[1], t[2]
    );
    for (kind, n) in [(Hexahedron8, [3, 2, 3]), (Tetrahedron10, [1, 1, 2])] {
        let mesh = solid("block", kind, n, between([0.0; 3], [0.6, 0.4, 1.0]));
        let expected = solve(&model(&format!("{SPACE}{prescribed}"), mesh.clone()), 1);
        for count in [1, 4] {
            let text = format!("{SPACE}{}", coupling("block z1", &point, &keys));
            let solution = solve(&model(&text, mesh.clone()), count);
            same(&solution, &expected, 1e-10);
            let [found, of_nodes] =
                [&solution, &expected].map(|of| resultant(&of.report["reactions"][1]));
            let scale = of_nodes.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
            (0..6).for_each(|k| close(found[k], of_nodes[k], 1e-8 * scale));
        }
    }
}

/// The support at the other end carries the force and the moment of the point, for every kind of coupling.
#[test]
fn forces_and_moments_balance() {
    for kind in ["rigid", "distributing"] {
        let keys = format!("kind = '{kind}'\nforce = [2e5, -3e5]\nmoment = 1.5e5");
        let text = format!("{PLANE}{}", coupling("block top", &[0.9, 1.7], &keys));
        for count in [1, 5] {
            let solution = solve(&model(&text, plane()), count);
            let found = resultant(&solution.report["reactions"][0]);
            let moment = 1.5e5 + 0.9 * -3e5 - 1.7 * 2e5;
            for (found, given) in found.into_iter().zip([2e5, -3e5, 0.0, 0.0, 0.0, moment]) {
                close(found, -given, 1e-9 * 5e5);
            }
        }
        let keys = format!("kind = '{kind}'\nforce = [2e5, -3e5, 1e5]\nmoment = [1e5, -2e5, 3e5]");
        let text = format!("{SPACE}{}", coupling("block z1", &[0.2, 0.5, 1.3], &keys));
        let mesh = solid(
            "block",
            Hexahedron8,
            [3, 2, 3],
            between([0.0; 3], [0.6, 0.4, 1.0]),
        );
        for count in [1, 4] {
            let solution = solve(&model(&text, mesh.clone()), count);
            let found = resultant(&solution.report["reactions"][0]);
            let (r, f, m) = ([0.2, 0.5, 1.3], [2e5, -3e5, 1e5], [1e5, -2e5, 3e5]);
            for k in 0..3 {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                close(found[k], -f[k], 1e-9 * 5e5);
                close(
                    found[3 + k],
                    -(m[k] + r[i] * f[j] - r[j] * f[i]),
                    1e-9 * 1e6,
                );
            }
        }
    }
}

/// A distributed force at the centre is a uniform traction, and allows the side to deform.
#[test]
fn a_distributed_force_in_the_middle_is_a_uniform_traction() {
    let loaded = "[[traction]]\non = 'block top'\nvalue = [1e6, -2e6]\n";
    for sort in SORTS {
        let mesh = sort.of(&plane());
        let expected = solve(&model(&format!("{PLANE}{loaded}"), mesh.clone()), 1);
        let keys = "kind = 'distributing'\nforce = [0.6e6, -1.2e6]";
        let text = format!("{PLANE}{}", coupling("block top", &[0.3, 1.5], keys));
        for count in [1, 4] {
            same(&solve(&model(&text, mesh.clone()), count), &expected, 1e-9);
        }
    }
}

/// Some components of a motion may be prescribed and others free: a guided end doesn't rotate and carries a moment.
#[test]
fn a_rotation_is_prescribed_by_itself_and_goes_with_the_steps() {
    let keys = "force = [1e5, 0.0]\nrz = 0.0";
    let steps = "[[step]]\n[[step]]\ncoupling.grip = { rz = 1e-5, force = [2e5, 0.0] }\n[[step]]\nscale = { force = 0.5 }\n";
    let text = format!("{PLANE}{}{steps}", coupling("block top", &[0.3, 1.5], keys));
    let solutions = solve_steps(&model(&text, plane()), 4);
    let top = |solution: &Solution, model: &Model, x: f64| {
        let mut nodes = model.mesh.points.iter().zip(&model.mesh.node_tags);
        let (_, tag) = nodes
            .find(|(p, _)| (p[0] - x).abs() < 1e-9 && (p[1] - 1.5).abs() < 1e-9)
            .unwrap();
        solution.displacement[tag]
    };
    let model = model(&text, plane());
    for (solution, turn) in solutions.iter().zip([0.0, 1e-5, 0.0]) {
        let [left, right] = [0.0, 0.6].map(|x| top(solution, &model, x));
        let scale = solution.largest_displacement();
        close(right[1] - left[1], 0.6 * turn, 1e-9 * scale);
        close(right[0], left[0], 1e-9 * scale);
        assert!(left[0] > 0.0);
    }
    let [first, last] = [&solutions[0], &solutions[2]].map(Solution::largest_displacement);
    close(last, 0.5 * first, 1e-9 * first);
}

/// A free block held only by a coupling, pressed on a wall with friction.
fn pressed() -> String {
    "
materials.rock = {young = 20e9, poisson = 0.22}
bodies.block = {material = 'rock'}
[[contact]]
name = 'wall'
sides = ['block z0']
obstacle = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
friction = 0.3
"
    .to_owned()
        + &coupling(
            "block z1",
            &[0.3, 0.2, 1.4],
            "x = 0.0\ny = 0.0\nz = -1e-5\nrx = 0.0\nry = 0.0\nrz = 0.0",
        )
        + "[[step]]\n[[step]]\ncoupling.grip = { x = 2e-5, rz = 1e-5 }\n"
}

#[test]
fn ranks_and_solvers_make_no_difference() {
    let mesh = solid(
        "block",
        Hexahedron8,
        [4, 3, 5],
        between([0.0; 3], [0.6, 0.4, 1.0]),
    );
    let case = Case::in_clusters(&model(&pressed(), mesh), 6, 3);
    let ended = case.run(&[]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let steps = Solution::steps(&case.result());
    steps.iter().for_each(Solution::check_certificate);
    assert!(steps[1].slipping() > 0);
    case.is_the_same_on_all_ranks_and_by_iteration(1e-8);
}

#[test]
fn what_couples_nothing_is_refused() {
    let of = |text: &str| {
        let text = format!("mesh = 'm'\n{text}");
        match Scene::parse(&text) {
            Err(error) => error.to_string(),
            Ok(scene) => Model::new(&scene, plane()).unwrap_err().to_string(),
        }
    };
    let top = |keys: &str| format!("{PLANE}{}", coupling("block top", &[0.3, 1.5], keys));
    for (text, expected) in [
        (
            top("moment = [0.0, 0.0, 1.0]"),
            "a plane scene has one number",
        ),
        (top("force = [1.0, 2.0, 3.0]"), "vectors of two components"),
        (top("rx = 1.0"), "a plane scene has no 'rx'"),
        (
            top("[[step]]\ncoupling.grip = { x = 1.0 }"),
            "expected 'x' in [[coupling]], too",
        ),
        (
            top("[[step]]\ncoupling.grap = { x = 1.0 }"),
            "there is no coupling 'grap'",
        ),
        (
            top("") + &coupling("block left", &[0.0, 0.0], ""),
            "there is another 'grip' already",
        ),
        (
            format!("{PLANE}{}", coupling("block tip", &[0.0, 0.0], "")),
            "no physical group 'block tip'",
        ),
        (
            PLANE.replace("strain", "axisymmetric") + &coupling("block top", &[0.3, 1.5], ""),
            "no couplings around an axis",
        ),
    ] {
        let error = of(&text);
        assert!(error.contains(expected), "{error}");
    }
}
