//! Contact with rigid obstacles.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use contact_dd_partition::model::Model;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::model;
use crate::support::solution::Solution;
use crate::support::solver::solve;
use crate::support::statics::{area, balanced, reaction};

/// Body force downwards [N/m³].
const WEIGHT: f64 = 25e3;

/// A scene of one body, `block`, with `rest` appended.
fn scene(force: [f64; 2], rest: &str) -> String {
    format!(
        "plane = 'strain'
        materials.rock = {{young = 20e9, poisson = 0.22}}
        bodies.block = {{material = 'rock', body_force = [{}, {}]}}
        {rest}",
        force[0], force[1]
    )
}

/// A contact of `sides` of the block, in quotation marks, with an obstacle.
fn contact(name: &str, sides: &[&str], obstacle: &str) -> String {
    let sides: Vec<String> = sides.iter().map(|s| format!("'block {s}'")).collect();
    format!(
        "[[contact]]
        name = '{name}'
        sides = [[{}]]
        obstacle = {{{obstacle}}}\n",
        sides.join(", ")
    )
}

const OUTLINE: [&str; 4] = ["bottom", "right", "top", "left"];

/// A square standing on its corner in a groove of two perpendicular walls, tilted by `tilt`.
fn groove(force: [f64; 2], tilt: f64, sides: [&[&str]; 2]) -> (Model, [[f64; 2]; 2]) {
    let (sin, cos) = tilt.sin_cos();
    let turned = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
    let corners = [[0.0, 0.0], [1.0, 1.0], [0.0, 2.0], [-1.0, 1.0]].map(turned);
    let normals = [[-1.0, 1.0], [1.0, 1.0]].map(turned);
    let walls = ["right", "left"].into_iter().zip(sides).zip(normals);
    let walls: String = walls
        .map(|((name, sides), [x, y])| {
            contact(name, sides, &format!("point = [0, 0], normal = [{x}, {y}]"))
        })
        .collect();
    let mesh = Blocks::new().quadrilateral("block", corners, [8, 8]).mesh;
    (model(&scene(force, &walls), mesh), normals)
}

/// Components of a force on a body that two walls with these normals carry.
fn shares(normals: [[f64; 2]; 2], force: [f64; 2]) -> [f64; 2] {
    let [[a, b], [c, d]] = normals;
    let determinant = a * d - b * c;
    [
        (force[1] * c - force[0] * d) / determinant,
        (force[0] * b - force[1] * a) / determinant,
    ]
}

/// Fails unless the walls `right` and `left` carry `load` along their normals.
#[track_caller]
fn rests_on(solution: &Solution, normals: [[f64; 2]; 2], load: [f64; 2], slack: f64) {
    let parts = shares(normals, load);
    for ((name, normal), part) in ["right", "left"].into_iter().zip(normals).zip(parts) {
        assert!(part > 0.0);
        let found = reaction(&solution.contacts[name]);
        for k in 0..2 {
            close(found[k], part * normal[k], slack * load[0].hypot(load[1]));
        }
    }
}

#[test]
fn a_block_in_a_groove_leans_on_both_walls() {
    for (force, tilt) in [([0.0, -WEIGHT], 0.0), ([9e3, -WEIGHT], 0.2)] {
        let (model, normals) = groove(force, tilt, [&["bottom"], &["left"]]);
        let reference = Monolithic::new(&model);
        for count in [1, 2, 5] {
            let solution = solve(&model, count);
            compare(&model, &reference, &solution);
            rests_on(&solution, normals, force.map(|f| 2.0 * f), 1e-11);
            // The corner touches both walls.
            let [right, left] = ["right", "left"].map(|name| -> BTreeSet<i64> {
                let points = solution.contacts[name].iter();
                points.map(|point| point.tags[0]).collect()
            });
            assert_eq!(right.intersection(&left).count(), 1);
            if count == 1 {
                assert_eq!(solution.report["contact_pairs"], 1);
                assert_eq!(solution.report["interface_dofs"], 0);
            }
        }
    }
}

#[test]
fn a_whole_outline_may_be_a_side() {
    let force = [3e3, -WEIGHT];
    let (faces, normals) = groove(force, 0.1, [&["bottom"], &["left"]]);
    let (outline, _) = groove(force, 0.1, [&OUTLINE, &OUTLINE]);
    let (first, second) = (solve(&faces, 4), solve(&outline, 4));
    rests_on(&second, normals, force.map(|f| 2.0 * f), 1e-11);
    let slack = 1e-9 * first.largest_displacement();
    for (tag, u) in &first.displacement {
        for (a, b) in u.iter().zip(second.displacement[tag]) {
            close(*a, b, slack);
        }
    }
}

/// A disc of radius 1 m that touches walls of 30° and 45° on its sides, and the walls' normals.
fn disc_in_a_groove() -> (Model, [[f64; 2]; 2]) {
    let normals = [120_f64, 45.0].map(|angle| {
        let (sin, cos) = angle.to_radians().sin_cos();
        [cos, sin]
    });
    let walls: String = ["right", "left"]
        .into_iter()
        .zip(normals)
        .map(|(name, [x, y])| {
            let wall = format!("point = [{}, {}], normal = [{x}, {y}]", -x, -y);
            contact(name, &OUTLINE, &wall)
        })
        .collect();
    let mesh = Blocks::new().disc("block", [0.0, 0.0], 1.0, 12).mesh;
    (model(&scene([0.0, -WEIGHT], &walls), mesh), normals)
}

#[track_caller]
fn disc_rests(count: usize) {
    let (model, normals) = disc_in_a_groove();
    let load = [0.0, -WEIGHT * area(&model.mesh, "block")];
    rests_on(&solve(&model, count), normals, load, 1e-11);
}

#[test]
fn a_disc_in_a_groove_touches_each_wall_in_a_point() {
    disc_rests(1);
}

#[track_caller]
fn pushes_both_alike(count: usize) {
    // The upper wall overlaps the disc by 1e-4 m.
    let walls = [
        contact("low", &OUTLINE, "point = [0, -1], normal = [0, 1]"),
        contact("high", &OUTLINE, "point = [0, 0.9999], normal = [0, -1]"),
    ];
    let mesh = Blocks::new().disc("block", [0.0, 0.0], 1.0, 8).mesh;
    let solution = solve(&model(&scene([0.0, 0.0], &walls.concat()), mesh), count);
    let [low, high] = ["low", "high"].map(|name| reaction(&solution.contacts[name]));
    assert!(low[1] > 1e5, "{low:?}");
    close(low[1], -high[1], 1e-10 * low[1]);
}

#[test]
fn a_disc_squeezed_between_walls_pushes_both_alike() {
    pushes_both_alike(1);
}

/// A block of 4 m on circles of radius 1 m below these positions, with this body force.
fn on_circles(places: &[f64], force: [f64; 2]) -> Model {
    let circles: String = (places.iter())
        .map(|x| {
            let circle = format!("center = [{x}, -1], radius = 1");
            contact(&format!("at {x}"), &["bottom"], &circle)
        })
        .collect();
    let mesh = Blocks::new().rectangle("block", [-2.0, 2.0], [0.0, 1.0], [16, 6]);
    model(&scene(force, &circles), mesh.mesh)
}

#[track_caller]
fn obeys_the_lever(count: usize) {
    let solution = solve(&on_circles(&[-1.0, 1.5], [0.0, -WEIGHT]), count);
    let load = 4.0 * WEIGHT;
    for (name, part) in [("at -1", 0.6), ("at 1.5", 0.4)] {
        let found = reaction(&solution.contacts[name])[1];
        close(found, part * load, 1e-10 * load);
    }
}

#[test]
fn a_block_on_two_circles_obeys_the_lever() {
    obeys_the_lever(1);
}

#[test]
fn bodies_that_may_roll_are_as_accurate_in_several_subdomains() {
    disc_rests(4);
    pushes_both_alike(4);
    obeys_the_lever(4);
}

#[test]
fn a_block_on_three_circles_rests_on_them() {
    // Nothing holds the block sideways. In one subdomain it moves some 10⁴ times as far as it deforms, which limits the
    // accuracy of forces.
    for (count, slack) in [(1, 1e-9), (4, 1e-12)] {
        let solution = solve(&on_circles(&[-1.0, 0.0, 1.0], [0.0, -WEIGHT]), count);
        let total = reaction(solution.points());
        balanced(total, [0.0, 4.0 * WEIGHT, 0.0], slack * WEIGHT);
    }
}

/// Fails unless the solution of a model with linearly dependent constraints is the reference's with exactly its closed
/// constraints, which are all in compression there, with no other constraint violated.
#[track_caller]
fn solves(model: &Model, solution: &Solution) {
    let mut closed = model.clone();
    for contact in &mut closed.contacts {
        let mut points = solution.contacts[&contact.name].iter();
        (contact.points).retain(|_| points.next().unwrap().closed);
    }
    let reference = Monolithic::new(&closed);
    let difference = reference.energy_difference(&solution.dofs(model));
    // Bodies move some 10⁵ times as far as they deform.
    assert!(difference <= 1e-7, "energy difference {difference:e}");
    assert!(reference.forces.iter().all(|&force| force > 0.0));
    let found = solution.points().map(|point| point.force).sum::<f64>();
    let expected = reference.forces.iter().sum::<f64>();
    close(found, expected, 1e-9 * expected);
    assert!(solution.points().all(|point| point.gap >= 0.0));
    solution.check_certificate();
}

#[test]
fn a_block_pushed_over_five_circles_leans_on_some() {
    let (push, places) = (0.17 * WEIGHT, [-1.3, -0.7, 0.1, 0.6, 1.2]);
    let model = on_circles(&places, [push, -WEIGHT]);
    for count in [1, 2, 4] {
        let solution = solve(&model, count);
        solves(&model, &solution);
        let total = reaction(solution.points());
        balanced(
            [total[0], total[1], 0.0],
            [-4.0 * push, 4.0 * WEIGHT, 0.0],
            1e-9 * WEIGHT,
        );
    }
}

/// Average pressure of a ring under internal pressure 1 MPa on its close-fitting rigid circle, over the exact one.
fn ring_in_a_circle(cells: usize) -> f64 {
    let (inner, outer, poisson) = (0.5, 1.0, 0.22);
    let mesh = (Blocks::new().ring("block", [inner, outer], [cells, 8 * cells])).mesh;
    let circle = format!("center = [0, 0], radius = {outer}, inside = true");
    let text = scene(
        [0.0, 0.0],
        &format!(
            "[[pressure]]\non = 'block left'\nvalue = 1e6\n{}",
            contact("circle", &["right"], &circle)
        ),
    );
    let solution = solve(&model(&text, mesh), 4);
    assert_eq!(solution.closed(), 8 * cells);
    // σ_r = A (1 + (1 − 2ν) b²/r²), as u_r = 0 at r = b; σ_r = −p at r = a.
    let stiff = 1.0 - 2.0 * poisson;
    let exact = 1e6 * (1.0 + stiff) / (1.0 + stiff * (outer / inner).powi(2));
    let force: f64 = solution.points().map(|point| point.force).sum();
    force / (TAU * outer) / exact
}

#[test]
fn a_ring_in_a_circle_is_lames() {
    let errors = [3, 6, 12].map(|cells| (ring_in_a_circle(cells) - 1.0).abs());
    assert!(errors[1] < 0.3 * errors[0], "{errors:?}");
    assert!(errors[2] < 0.3 * errors[1], "{errors:?}");
    assert!(errors[2] < 3e-3, "{errors:?}");
}

#[test]
fn a_body_between_a_wall_and_another_body_leans_on_both() {
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [12, 6])
        .rectangle("block", [0.0, 1.0], [1.0, 2.0], [6, 6]);
    let text = scene(
        [-8e3, -WEIGHT],
        &format!(
            "bodies.lower.material = 'rock'
            [[displacement]]
            on = 'lower bottom'
            x = 0.0
            y = 0.0
            [[contact]]
            name = 'joint'
            sides = ['block bottom', 'lower top']
            {}{}",
            contact("wall", &["left"], "point = [0, 0], normal = [1, 0]"),
            contact("far", &["right"], "center = [9, 1], radius = 2"),
        ),
    );
    let model = model(&text, blocks.mesh);
    let reference = Monolithic::new(&model);
    for count in [2, 5] {
        let solution = solve(&model, count);
        compare(&model, &reference, &solution);
        close(reaction(&solution.contacts["wall"])[0], 8e3, 1e-7);
        close(reaction(&solution.contacts["joint"])[1], WEIGHT, 1e-7);
    }
}

/// The last interior unknown and the first normal jump may be two components of one node, but are no more related than
/// others.
#[test]
fn a_strip_under_a_plane_is_balanced_whatever_its_length() {
    for columns in 1..=9 {
        let length = columns as f64;
        let mesh = Blocks::new().rectangle("strip", [0.0, length], [0.0, 1.0], [columns, 1]);
        let text = "
            plane = 'strain'
            materials.rock = {young = 20e9, poisson = 0.2}
            bodies.strip.material = 'rock'
            displacement = [{on = 'strip left', x = 0.0, y = 0.0}]
            traction = [{on = 'strip bottom', value = [0.0, 1e6]}]
            [[contact]]
            name = 'ceiling'
            sides = ['strip top']
            obstacle = {point = [0.0, 1.0], normal = [0.0, -1.0]}";
        let solution = solve(&model(text, mesh.mesh), 1);
        let equilibrium = solution.report["certificate"]["equilibrium"]
            .as_f64()
            .unwrap();
        assert!(equilibrium < 1e-14, "{columns}: {equilibrium:e}");
    }
}
