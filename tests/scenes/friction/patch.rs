//! States represented exactly by every mesh: sticking joints, and joints with uniform slip.

use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, joined};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solution::Solution;
use crate::support::solver::solve;
use crate::support::sorts::{SORTS, Sort, sort};
use crate::support::uneven::block;

const PRESSURE: f64 = 1e6;

fn stacked(sort: Sort) -> Blocks {
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [8, 4])
        .rectangle("upper", [0.0, 2.0], [1.0, 2.0], [8, 4]);
    Blocks {
        mesh: sort.of(&blocks.mesh),
    }
}

/// A joint that can't slip has no effect: the mesh with merged nodes has the same displacements.
#[test]
fn a_joint_that_sticks_is_glued() {
    let scene = "
        plane = 'strain'
        materials.steel = {young = 210e9, poisson = 0.3}
        materials.rock = {young = 20e9, poisson = 0.22}
        bodies.lower.material = 'rock'
        bodies.upper.material = 'steel'
        [[displacement]]
        on = 'lower bottom'
        x = 0.0
        y = 0.0
        [[pressure]]
        on = 'upper top'
        value = '1e6*(1.2-0.2*x)'
        [[traction]]
        on = 'upper right'
        value = [-2e4, 1e4]\n";
    for sort in SORTS {
        let blocks = stacked(sort);
        let glued = blocks.clone().glued(|_, y| (y - 1.0).abs() < 1e-9);
        let glued = solve(&model(scene, glued.mesh), 4);
        for law in [
            "friction = 20.0",
            "tresca = 1e9",
            "friction = 0.1\ncohesion = 1e9",
        ] {
            let text = format!(
                "{scene}
                [[contact]]
                name = 'joint'
                sides = ['upper bottom', 'lower top']
                gap = 0.0
                {law}"
            );
            let stuck = solve(&model(&text, blocks.mesh.clone()), 4);
            assert_eq!(
                (stuck.closed(), stuck.slipping()),
                (stuck.points().count(), 0),
                "{}",
                sort.name
            );
            let size = glued.largest_displacement();
            let same = blocks.clone().glued(|_, y| (y - 1.0).abs() < 1e-9).mesh;
            let expected = places(&same, &glued);
            for (place, u) in places(&blocks.mesh, &stuck) {
                let (_, one) = expected.iter().find(|(at, _)| *at == place).unwrap();
                for (a, b) in u.iter().zip(one) {
                    close(*a, *b, 1e-12 * size);
                }
            }
        }
    }
}

/// Displacements by position.
fn places(mesh: &Mesh, solution: &Solution) -> Vec<([i64; 2], [f64; 3])> {
    let nodes = mesh.points.iter().zip(&mesh.node_tags);
    nodes
        .map(|(p, tag)| {
            (
                [p[0], p[1]].map(|c| (c * 1e7).round() as i64),
                solution.displacement[tag],
            )
        })
        .collect()
}

const YOUNG: f64 = 20e9;
const POISSON: f64 = 0.25;

/// Displacement of a body in uniform plane strain under σ_yy = −p, σ_xy = τ, σ_xx = 0, except for a rigid-body motion:
/// c y + e x along x, d y along y.
fn uniform(shear: f64) -> [f64; 3] {
    let modulus = YOUNG / (1.0 - POISSON * POISSON);
    let across = POISSON / (1.0 - POISSON);
    let g = YOUNG / (2.0 * (1.0 + POISSON));
    [shear / g, across * PRESSURE / modulus, -PRESSURE / modulus]
}

/// Two blocks, the upper one under pressure, with its top displaced by an additional `by`; the solution is the uniform
/// stress with the shear that `law` allows, and uniform slip by `by`.
fn slipping(mesh: Mesh, law: &str, shear: f64, by: f64, sides: &str) -> Model {
    let [c, e, d] = uniform(shear);
    let text = format!(
        "plane = 'strain'
        materials.rock = {{young = {YOUNG}, poisson = {POISSON}}}
        bodies.lower.material = 'rock'
        bodies.upper.material = 'rock'
        [[displacement]]
        on = 'lower bottom'
        x = '({e:e})*x'
        y = 0.0
        [[displacement]]
        on = 'upper top'
        x = '({e:e})*x+({:e})'
        y = {:e}
        [[traction]]
        on = ['lower left', 'upper left']
        value = [0.0, {:e}]
        [[traction]]
        on = ['lower right', 'upper right']
        value = [0.0, {shear:e}]
        [[contact]]
        name = 'joint'
        sides = [{sides}]
        gap = 0.0
        {law}",
        2.0 * c + by,
        2.0 * d,
        -shear,
    );
    model(&text, mesh)
}

/// Fails unless every point slips by `by` against the shear.
#[track_caller]
fn slips_evenly(model: &Model, shear: f64, by: f64, upper_is_a: bool) {
    let solution = solve(model, 4);
    let points = &solution.contacts["joint"];
    for (point, condition) in points.iter().zip(&model.contacts[0].points) {
        assert!(point.closed && point.slipping, "{point:?}");
        close(point.pressure, PRESSURE, 1e-10 * PRESSURE);
        // Friction on the upper side acts backwards.
        let force = if upper_is_a { -shear } else { shear };
        close(
            point.tangential_force[0],
            force * condition.area,
            1e-10 * shear.abs() * condition.area,
        );
        close(
            point.tangential_force[1],
            0.0,
            1e-10 * shear.abs() * condition.area,
        );
        let slip = if upper_is_a { by } else { -by };
        close(point.slip[0], slip, 1e-10 * by.abs());
    }
    let [c, e, d] = uniform(shear);
    let size = solution.largest_displacement();
    for (p, tag) in model.mesh.points.iter().zip(&model.mesh.node_tags) {
        let u = solution.displacement[tag];
        close(u[1], d * p[1], 1e-11 * size);
        let is_upper = p[1] > 1.0 + 1e-9;
        if is_upper || p[1] < 1.0 - 1e-9 {
            let rigid = if is_upper { by } else { 0.0 };
            close(u[0], e * p[0] + c * p[1] + rigid, 1e-11 * size);
        }
    }
}

#[test]
fn an_evenly_slipping_joint_is_exact_in_all_cells() {
    for sort in SORTS {
        for (law, share) in [
            ("friction = 0.3", 0.3),
            ("tresca = 2e5", 0.2),
            ("friction = 0.1\ncohesion = 5e4", 0.15),
        ] {
            for sign in [1.0, -1.0] {
                let (shear, by) = (sign * share * PRESSURE, sign * 1e-3);
                let sides = "'upper bottom', 'lower top'";
                slips_evenly(
                    &slipping(stacked(sort).mesh, law, shear, by, sides),
                    shear,
                    by,
                    true,
                );
            }
        }
    }
}

#[test]
fn an_evenly_slipping_joint_is_exact_where_nodes_do_not_match() {
    for (lower, upper) in [
        ("triangle3", "quad4"),
        ("quad9", "triangle6"),
        ("quad8", "triangle3"),
    ] {
        let place = |name, y, n, name_of: &str| {
            let blocks = block(Blocks::new(), name, [0.0, 2.0], y, [n, 3], n as u64);
            sort(name_of).of(&blocks.mesh)
        };
        let mesh = joined(
            place("lower", [0.0, 1.0], 4, lower),
            place("upper", [1.0, 2.0], 7, upper),
        );
        let (shear, by) = (0.3 * PRESSURE, 1e-3);
        for (sides, upper_is_a) in [
            ("'upper bottom', 'lower top'", true),
            ("'lower top', 'upper bottom'", false),
        ] {
            let model = slipping(mesh.clone(), "friction = 0.3", shear, by, sides);
            slips_evenly(&model, shear, by, upper_is_a);
        }
    }
}
