//! A small problem with everything in it.

use contact_dd_partition::problem::Problem;

use crate::support::blocks::Blocks;
use crate::support::scenes::model;
use crate::support::solver::problem;
use crate::support::sorts::sort;

const SCENE: &str = "
title = 'Everything'
plane = 'strain'
solver = {method = 'anderson', tolerance = 1e-9, max_sweeps = 99, relaxation = 0.5, no_stress = false}
materials.rock = {young = 20e9, poisson = 0.22}
materials.steel = {young = 210e9, poisson = 0.3}
bodies.base = {material = 'rock', body_force = [0.0, -25e3]}
bodies.middle = {material = 'steel', initial_stress = [1e5, 0, '1e5*x', 0], thermal = {expansion = 1e-5, temperature = 20}}
bodies.top.material = 'rock'
[[displacement]]
on = 'base left'
x = 0.0
y = 1e-4
[[bilateral]]
on = ['middle left', 'top left']
[[pressure]]
on = 'top top'
value = '1e6*(2-x)'
[[contact]]
name = 'matching'
sides = ['middle bottom', 'base top']
gap = -1e-4
friction = 0.4
cohesion = '1e4*x'
[[contact]]
name = 'mortar'
sides = ['top bottom', 'middle top']
[[contact]]
name = 'table'
sides = ['base bottom']
tresca = 1e5
obstacle = { point = [0.0, -1e-4], normal = [0.0, 1.0] }
[[quantity]]
name = 'corner'
kind = 'displacement'
at = [0, 3]
direction = [1, 1]
[[quantity]]
name = 'mean'
kind = 'mean_stress'
body = 'middle'
component = 'xx'
[[quantity]]
name = 'mouth'
kind = 'opening'
contact = 'matching'
at = [2, 1]
[[quantity]]
name = 'support'
kind = 'reaction'
on = 'base left'
direction = 'x'
[[step]]
name = 'half'
scale = 0.5
remove = 'table'
[[step]]
add = ['table', 'top']
[[step.pressure]]
on = 'top top'
value = 1e6
";

/// Three blocks of quadratic cells of all kinds on a table, in matching and mortar contact, two of
/// three with friction, with supports, forces in two load steps in which a body and a contact come, a hierarchy, settings, quantities and a warning.
pub fn everything() -> Problem {
    let mesh = Blocks::new()
        .rectangle("base", [0.0, 2.0], [0.0, 1.0], [7, 3])
        .rectangle("middle", [0.0, 2.0], [1.0, 2.0], [7, 3])
        .rectangle("top", [0.0, 1.5], [2.0, 3.0], [5, 3])
        .mesh;
    let problem = problem(
        &model(SCENE, sort("triangle6, quad8 and quad9").of(&mesh)),
        Some(6),
    );
    let catalog = &problem.catalog;
    assert!(catalog.interface_nodes > 0 && catalog.hierarchy.parent.len() > 6);
    assert!(!catalog.warnings.is_empty() && catalog.contacts.len() == 3);
    problem
}
