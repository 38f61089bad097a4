//! Activation and deactivation against exact solutions.

use super::solved;
use crate::support::blocks::{Blocks, joined};
use crate::support::scenes::model;
use crate::support::solution::Solution;
use crate::support::solver::solve_steps;
use crate::support::sorts::sort;

/// A bar of two layers under its weight, the second one added on the first: exact.
#[test]
fn a_bar_built_in_layers_settles_as_it_should() {
    let text = "
        plane = 'strain'
        materials.fill = {young = 20e6, poisson = 0.0}
        bodies.first = {material = 'fill', body_force = [0.0, -20e3]}
        bodies.second = {material = 'fill', body_force = [0.0, -20e3]}
        [[bilateral]]
        on = ['first bottom', 'first left', 'second left']
        [[contact]]
        name = 'joint'
        sides = ['second bottom', 'first top']
        [[step]]
        [[step]]
        add = 'second'";
    let blocks = Blocks::new()
        .rectangle("first", [0.0, 1.0], [0.0, 2.0], [4, 8])
        .rectangle("second", [0.0, 1.0], [2.0, 3.0], [4, 4]);
    let model = model(text, sort("quad4").of(&blocks.mesh));
    let steps = solved(&model, 4, &[]);
    let (weight, young) = (20e3, 20e6);
    // The first layer, of height 2, under its weight and the weight above, at y.
    let first = |y: f64, on: f64| -(weight * (2.0 * y - 0.5 * y * y) + on * y) / young;
    let second = |y: f64| {
        let h = y - 2.0;
        first(2.0, weight) - first(2.0, 0.0) - weight * (h - 0.5 * h * h) / young
    };
    for (tag, x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
        let is_first = *tag <= 5 * 9;
        let exact = match is_first {
            true => [first(x[1], 0.0), first(x[1], weight)],
            false => [0.0, second(x[1])],
        };
        for (step, exact) in steps.iter().zip(exact) {
            let found = step.displacement[tag][1];
            assert!((found - exact).abs() <= 1e-12, "{x:?}: {found} {exact}");
        }
    }
}

/// A tunnel in stressed ground: nothing moves before the core is excavated, the ground converges by Lamé's solution,
/// the lining installed then carries none of that, and its share of later loads.
#[test]
fn a_lining_carries_what_comes_after_it() {
    let text = "
        plane = 'strain'
        materials.rock = {young = 1e9, poisson = 0.3}
        materials.concrete = {young = 30e9, poisson = 0.2}
        bodies.rock = {material = 'rock', initial_stress = [-1e6, -1e6, -1e6, 0.0]}
        bodies.core = {material = 'rock', initial_stress = [-1e6, -1e6, -1e6, 0.0]}
        bodies.lining.material = 'concrete'
        [[displacement]]
        on = 'rock right'
        x = 0.0
        y = 0.0
        [[contact]]
        name = 'face'
        sides = [['core bottom', 'core right', 'core top', 'core left'], 'rock left']
        [[contact]]
        name = 'extrados'
        sides = ['lining right', 'rock left']
        [[step]]
        [[step]]
        remove = 'core'
        [[step]]
        add = 'lining'
        [[step]]
        scale = {initial_stress = 1.5}";
    let core = Blocks::new().disc("core", [0.0, 0.0], 1.0, 16);
    let ring = |name, radii, n| Blocks::new().ring(name, radii, n).mesh;
    let rings = joined(
        ring("rock", [1.0, 3.0], [16, 64]),
        ring("lining", [0.8, 1.0], [4, 64]),
    );
    let model = model(text, sort("quad4").of(&joined(core.mesh, rings)));
    let steps = solve_steps(&model, 6);
    let (p, a, b, c) = (1e6, 1.0f64, 3.0f64, 0.8f64);
    let (young, poisson) = (1e9, 0.3);
    let shear = young / (2.0 * (1.0 + poisson));
    // Displacement per pressure: of the ground when a pressure is removed, and of the lining when it is applied.
    let ground = (1.0 / a - a / (b * b))
        / (2.0 * shear * (1.0 / (a * a) + 1.0 / ((1.0 - 2.0 * poisson) * b * b)));
    let lining = 1.2 / 30e9 * a * (0.6 * a * a + c * c) / (a * a - c * c);
    assert!(steps[0].largest_displacement() <= 1e-12 * p * ground);
    let pressure = |step: &Solution, contact: &str| {
        let points = &step.contacts[contact];
        points.iter().map(|point| point.pressure).sum::<f64>() / points.len() as f64
    };
    assert!((pressure(&steps[0], "face") / p - 1.0).abs() < 2e-3);
    let convergence = steps[1].largest_displacement();
    assert!(
        (convergence / (p * ground) - 1.0).abs() < 5e-3,
        "{convergence}"
    );
    assert!(pressure(&steps[2], "extrados") <= 1e-9 * p);
    let share = 0.5 * p * ground / (ground + lining);
    let found = pressure(&steps[3], "extrados");
    assert!((found / share - 1.0).abs() < 1e-2, "{found} {share}");
}
