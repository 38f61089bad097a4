//! Extreme numbers: a solution, or the reason why there is none.

use contact_dd_partition::model::Model;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solver::{Case, solve};

const PRESSURE: f64 = 1e5;

/// A block on another one, under pressure and shear, with these stiffnesses and this Poisson's ratio.
fn stacked([lower, upper]: [f64; 2], poisson: f64, law: &str, push: f64) -> Model {
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 0.3], [4, 2])
        .rectangle("upper", [0.0, 1.0], [0.3, 0.6], [4, 2]);
    let text = format!(
        "plane = 'strain'
        large_strains = true
        materials.low = {{young = {lower:e}, poisson = {poisson}}}
        materials.up = {{young = {upper:e}, poisson = {poisson}}}
        bodies.lower.material = 'low'
        bodies.upper.material = 'up'
        displacement = [{{on = 'lower bottom', x = 0.0, y = 0.0}}]
        pressure = [{{on = 'upper top', value = {PRESSURE:e}}}]
        traction = [{{on = 'upper top', value = [{push:e}, 0.0]}}]
        contact = [{{name = 'joint', sides = ['upper bottom', 'lower top'], gap = 0.0{law}}}]"
    );
    model(&text, blocks.mesh)
}

#[test]
fn what_presses_is_held_by_any_friction() {
    for push in [0.0, 3e4] {
        let of = |friction: f64| {
            let law = format!(", friction = {friction:e}");
            let solution = solve(&stacked([1e9; 2], 0.2, &law, push), 2);
            let normal: f64 = solution.points().map(|p| p.force).sum();
            close(normal, PRESSURE, 1e-10 * PRESSURE);
            let along: f64 = solution.points().map(|p| p.tangential_force[0]).sum();
            close(along, -push, 1e-10 * PRESSURE);
            solution.points().map(|p| p.force).collect::<Vec<f64>>()
        };
        // All points stick above some coefficient.
        let (some, most) = (of(1e2), of(1e12));
        for (a, b) in some.iter().zip(&most) {
            close(*a, *b, 1e-9 * PRESSURE);
        }
    }
}

/// The bulk stiffness is 1e15 times the shear stiffness: the forces are pure round-off, and nothing slides.
#[test]
fn what_round_off_makes_of_a_scene_is_not_said_to_slide() {
    let model = stacked([1e9; 2], 0.499999999999999, ", friction = 0.5", 1e4);
    let ended = Case::of(&model, 2).run(&[]);
    assert_eq!(ended.code(), 3, "{}", ended.stderr);
    assert!(!ended.stderr.contains("can't hold"), "{}", ended.stderr);
    assert!(
        ended.stderr.contains("too badly conditioned"),
        "{}",
        ended.stderr
    );
}

#[test]
fn stiffnesses_that_digits_do_not_tell_apart_are_the_reason_that_is_said() {
    for (law, push) in [(", friction = 0.5", 1e4), ("", 0.0)] {
        let model = stacked([1e-3, 1e12], 0.2, law, push);
        let ended = Case::of(&model, 2).run(&[]);
        assert!([2, 3].contains(&ended.code()), "{law}: {}", ended.stderr);
        let reasons = ["the largest stiffness, of 'up'", "too badly conditioned"];
        let is_said = reasons.iter().any(|reason| ended.stderr.contains(reason));
        assert!(is_said, "{law}: {}", ended.stderr);
    }
}
