//! Every increment of various scenes is right according to the judge of random scenes.

use contact_dd_partition::model::Model;

use crate::support::blocks::Blocks;
use crate::support::comparison::judged;
use crate::support::scenes::{BODIES, model};
use crate::support::solver::solve_steps;
use crate::support::sorts::sort;
use crate::support::uneven::block;

/// Pressure, and a shear that changes its sign.
const LOADS: &str = "
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
[[pressure]]
on = 'upper top'
value = '1e6*(1.6-0.9*x)'
[[traction]]
on = 'upper top'
value = [1.2e5, 0.0]
";
const STEPS: &str = "
[[step]]
scale = { traction = 0.0 }
[[step]]
[[step]]
scale = { traction = -1.0 }
[[step]]
scale = { traction = 0.4, pressure = 0.4 }
";

/// Fails unless all increments of the scene are right; returns the number of slipping points in each.
#[track_caller]
fn agrees(model: &Model, count: usize) -> Vec<usize> {
    let solutions = solve_steps(model, count);
    let findings = judged(model, &solutions);
    assert!(findings.faults().is_empty(), "{:?}", findings.faults());
    assert!(findings.difference <= Some(1e-11), "{findings:?}");
    solutions
        .iter()
        .map(|solution| solution.slipping())
        .collect()
}

fn scene(law: &str, steps: &str) -> String {
    format!(
        "{BODIES}{LOADS}
        [[contact]]
        name = 'joint'
        sides = ['upper bottom', 'lower top']
        {law}
        {steps}"
    )
}

fn matching() -> Blocks {
    Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [12, 6])
        .rectangle("upper", [0.5, 1.5], [1.0, 1.5], [6, 3])
}

fn uneven() -> Blocks {
    let lower = block(Blocks::new(), "lower", [0.0, 2.0], [0.0, 1.0], [7, 4], 3);
    block(lower, "upper", [0.4, 1.6], [1.0, 1.5], [9, 3], 4)
}

#[test]
fn matching_nodes_with_coulombs_friction_are_right() {
    for law in [
        "friction = 0.2",
        "friction = 0.3\ncohesion = '2e4*x'",
        "friction = 0.25\ngap = '1e-6*x^2'",
    ] {
        for steps in ["", STEPS] {
            let slipping = agrees(&model(&scene(law, steps), matching().mesh), 5);
            assert!(slipping.iter().any(|&slipping| slipping > 0), "{law}");
        }
    }
}

#[test]
fn matching_nodes_with_given_friction_are_right() {
    for law in ["tresca = 2e5", "tresca = '1.3e5*(0.5+x)'"] {
        for steps in ["", STEPS] {
            let slipping = agrees(&model(&scene(law, steps), matching().mesh), 5);
            assert!(slipping.iter().any(|&slipping| slipping > 0), "{law}");
        }
    }
}

#[test]
fn nodes_that_do_not_match_are_right() {
    for law in ["friction = 0.25", "tresca = 2e5"] {
        for steps in ["", STEPS] {
            let slipping = agrees(&model(&scene(law, steps), uneven().mesh), 4);
            assert!(slipping.iter().any(|&slipping| slipping > 0), "{law}");
        }
    }
}

#[test]
fn quadratic_cells_are_right() {
    for name in ["triangle6", "quad9"] {
        for mesh in [matching().mesh, uneven().mesh] {
            let mesh = sort(name).of(&mesh);
            let slipping = agrees(&model(&scene("friction = 0.25", STEPS), mesh), 4);
            assert!(slipping.iter().any(|&slipping| slipping > 0));
        }
    }
}

/// A block between a floor and a lid that it barely touches; Tresca friction also acts without contact.
#[test]
fn obstacles_with_friction_are_right() {
    for law in ["friction = 0.3", "tresca = 8e3"] {
        let text = format!(
            "plane = 'strain'
            materials.rock = {{young = 2e9, poisson = 0.22}}
            bodies.block = {{material = 'rock', body_force = [0.0, -25e3]}}
            [[traction]]
            on = 'block right'
            value = [4e3, '8e4*(y-0.4)']
            [[contact]]
            name = 'floor'
            sides = ['block bottom']
            obstacle = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}
            {law}
            [[contact]]
            name = 'lid'
            sides = ['block top']
            obstacle = {{ point = [0.0, 1.0], normal = [0.0, -1.0] }}
            gap = '2e-6*(1-x)'
            {law}
            [[step]]
            scale = {{ traction = -0.5 }}
            [[step]]
            [[step]]
            scale = {{ traction = -0.8, body_force = 1.2 }}"
        );
        let mesh = Blocks::new()
            .rectangle("block", [0.0, 1.0], [0.0, 1.0], [6, 6])
            .mesh;
        let slipping = agrees(&model(&text, mesh), 4);
        assert!(slipping.iter().any(|&slipping| slipping > 0), "{law}");
    }
}
