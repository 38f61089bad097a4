//! Bodies that friction holds, and bodies that slide off.

use contact_dd_partition::model::Model;

use crate::support::blocks::Blocks;
use crate::support::process::Ended;
use crate::support::scenes::model;
use crate::support::solver::Case;

/// A wide block on a plane at `angle` to the horizontal, under its own weight; `law` is that of its base.
fn incline(angle: f64, body_force: [f64; 2], law: &str, n: [usize; 2]) -> Model {
    let (sin, cos) = angle.sin_cos();
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 0.5], [0.0, 0.5]];
    let turned = corners.map(|[x, y]| [cos * x - sin * y, sin * x + cos * y]);
    let text = format!(
        "plane = 'strain'
        materials.rock = {{young = 20e9, poisson = 0.22}}
        bodies.block = {{material = 'rock', body_force = [{:e}, {:e}]}}
        [[contact]]
        name = 'base'
        sides = ['block bottom']
        {law}
        obstacle = {{point = [0.0, 0.0], normal = [{:e}, {cos:e}]}}",
        body_force[0], body_force[1], -sin
    );
    model(&text, Blocks::new().quadrilateral("block", turned, n).mesh)
}

fn run(model: &Model, count: usize) -> Ended {
    Case::of(model, count).run(&[])
}

#[track_caller]
fn slides(ended: &Ended, name: &str) {
    assert_eq!(ended.code(), 4, "{}{}", ended.stdout, ended.stderr);
    let [error] = ended.errors()[..] else {
        panic!("{}", ended.stderr);
    };
    assert!(error.contains(&format!("'{name}' slides along")), "{error}");
}

const WEIGHT: f64 = 26e3;

/// Gravity turned against a level plane, and a plane turned against gravity.
fn inclines(slope: f64, law: &str, n: [usize; 2]) -> [Model; 2] {
    [
        incline(0.0, [WEIGHT * slope, -WEIGHT], law, n),
        incline(-slope.atan(), [0.0, -WEIGHT], law, n),
    ]
}

#[test]
fn a_block_slides_down_a_plane_that_is_steeper_than_its_friction_angle() {
    for (friction, n) in [(0.1, [4, 2]), (0.6, [40, 10]), (2.5, [7, 30])] {
        let law = format!("friction = {friction}");
        for model in inclines(friction * (1.0 + 1e-12), &law, n) {
            for count in [1, 3] {
                slides(&run(&model, count), "block");
            }
        }
    }
}

#[test]
fn a_block_slides_that_pulls_more_than_given_friction_and_cohesion_hold() {
    // The base is 2 m long, the block 1 m² in area: it weighs 26 kN.
    let pulls = |force: f64, law| run(&incline(0.0, [force, -WEIGHT], law, [8, 2]), 2);
    slides(&pulls(2e4 * (1.0 + 1e-12), "tresca = 1e4"), "block");
    let law = "friction = 0.5\ncohesion = 1e4";
    slides(&pulls(3.3e4 * (1.0 + 1e-12), law), "block");
}
