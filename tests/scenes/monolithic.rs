//! Domain decomposition compared with a single system for the whole mesh.

use std::collections::BTreeSet;

use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, jittered, shuffled};
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::{
    BODIES, JOINT, LOAD, SUPPORTS, built_in, built_in_model, model, two_block_scene, two_blocks,
};
use crate::support::solver::solve;

/// Solves `model` in `count` subdomains and fails unless displacement, forces, pressures, gaps and status are those of
/// the reference. Returns the number of closed constraints.
#[track_caller]
fn agrees(model: &Model, count: usize) -> usize {
    let solution = solve(model, count);
    compare(model, &Monolithic::new(model), &solution);
    solution.closed()
}

#[test]
fn granite_is_the_monolithic_solution() {
    let closed = agrees(&built_in_model("granite", 0), 8);
    assert_eq!(closed, 31);
}

/// So many constraints that fixed active sets are solved one after the other; the certificate checks the whole problem.
#[test]
fn many_conditions_are_solved_for_by_fixed_active_sets() {
    let solution = solve(&built_in_model("wall", 1), 33);
    let sweeps = solution.sweeps();
    assert!((3..=12).contains(&sweeps), "{sweeps}");
    let closed = solution.closed();
    assert!(0 < closed && closed < solution.points().count());
    solution.check_certificate();
}

#[test]
fn pairs_are_not_evaluated_again_where_nothing_changed() {
    let report = solve(&built_in_model("granite", 0), 8).report;
    let skipped = report["skipped"].as_array().unwrap();
    let mut texts = skipped.iter().filter_map(|text| text.as_str());
    assert!(texts.any(|text| text.starts_with("updates of pairs: ")));
}

#[test]
fn jittered_and_shuffled_granite_is_the_monolithic_solution() {
    let (text, mesh) = built_in("granite", 0);
    let (mesh, _) = shuffled(&jittered(mesh, 0.03, 5), 6);
    agrees(&model(text, mesh), 8);
}

#[test]
fn two_blocks_that_open_on_one_side_are_the_monolithic_solution() {
    let closed = agrees(&model(&two_block_scene(), two_blocks().mesh), 6);
    assert!(0 < closed && closed < 9, "{closed}");
}

#[test]
fn several_materials_in_one_body_are_the_monolithic_solution() {
    let blocks = Blocks::new()
        .rectangle("left", [0.0, 1.0], [0.0, 1.0], [8, 8])
        .rectangle("right", [1.0, 2.0], [0.0, 1.0], [8, 8])
        .glued(|x, _| x == 1.0)
        .rectangle("upper", [0.5, 1.5], [1.0, 2.0], [8, 8]);
    let text = format!(
        "plane = 'strain'
        materials.steel = {{young = 210e9, poisson = 0.3}}
        materials.rock = {{young = 20e9, poisson = 0.22}}
        materials.rubber = {{young = 50e6, poisson = 0.4}}
        bodies.left.material = 'rock'
        bodies.right.material = 'rubber'
        bodies.upper.material = 'steel'
        {LOAD}
        [[displacement]]
        on = ['left bottom', 'right bottom']
        x = 0.0
        y = 0.0
        [[displacement]]
        on = 'upper left'
        x = 0.0
        [[contact]]
        name = 'joint'
        sides = ['upper bottom', ['left top', 'right top']]"
    );
    agrees(&model(&text, blocks.mesh), 7);
}

/// Three blocks on top of each other; the middle one is curved, so that the geometrical gaps vary from node to node.
fn sandwich() -> Model {
    let bent = |[s, t]: [f64; 2]| {
        [
            2.0 * s,
            1.0 + t + 4e-4 * (2.0 * s - 0.7).powi(2) * (0.5 - t),
        ]
    };
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [14, 6])
        .mapped("middle", [14, 6], bent)
        .rectangle("upper", [0.0, 2.0], [2.001, 3.0], [14, 6]);
    let text = format!(
        "{BODIES}
        bodies.middle.material = 'rock'
        {SUPPORTS}
        [[displacement]]
        on = 'middle left'
        x = 0.0
        [[displacement]]
        on = 'upper top'
        y = -1.2e-3
        [[contact]]
        name = 'below'
        sides = ['middle bottom', 'lower top']
        [[contact]]
        name = 'above'
        sides = ['middle top', 'upper bottom']"
    );
    model(&text, blocks.mesh)
}

#[test]
fn a_middle_block_that_touches_two_others_is_the_monolithic_solution() {
    for count in [3, 9] {
        let closed = agrees(&sandwich(), count);
        assert!(0 < closed && closed < 30, "{closed}");
    }
}

#[test]
fn a_given_gap_is_the_monolithic_solution() {
    let text = format!("{}gap = '2e-5*(x-1)^2'\n", two_block_scene());
    let closed = agrees(&model(&text, two_blocks().mesh), 5);
    assert!(0 < closed && closed < 9, "{closed}");
}

#[test]
fn an_interference_fit_is_the_monolithic_solution() {
    let text = format!(
        "{BODIES}{SUPPORTS}
        [[displacement]]
        on = 'upper top'
        y = 0.0
        {JOINT}
        gap = -1e-4"
    );
    let model = model(&text, two_blocks().mesh);
    assert!(model.warnings.iter().any(|w| w.contains("interference")));
    agrees(&model, 5);
}

#[test]
fn anisotropic_materials_are_the_monolithic_solution() {
    let text = two_block_scene().replace(
        "materials.rock = {young = 20e9, poisson = 0.22}",
        "materials.rock = {stiffness = [[40e9, 9e9, 3e9], [9e9, 15e9, -2e9], [3e9, -2e9, 6e9]]}",
    );
    agrees(&model(&text, two_blocks().mesh), 6);
}

#[test]
fn plane_stress_is_the_monolithic_solution() {
    let text = two_block_scene().replace("'strain'", "'stress'");
    agrees(&model(&text, two_blocks().mesh), 6);
}

#[test]
fn an_inclined_bilateral_support_is_the_monolithic_solution() {
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [16, 8])
        .quadrilateral(
            "upper",
            [[0.5, 1.0], [1.5, 1.0], [1.7, 2.0], [0.6, 2.0]],
            [8, 8],
        );
    let text = two_block_scene().replace(
        "[[displacement]]\non = 'upper left'\nx = 0.0",
        "[[bilateral]]\non = 'upper left'",
    );
    let text = text.replace("1.95-1.9*x", "1");
    assert!(text.contains("bilateral"));
    agrees(&model(&text, blocks.mesh), 6);
}

#[test]
fn prescribed_displacements_are_the_monolithic_solution() {
    let text = format!(
        "{BODIES}{SUPPORTS}
        [[displacement]]
        on = 'upper top'
        y = '-1e-3*(1.2-x)'
        {JOINT}"
    );
    let closed = agrees(&model(&text, two_blocks().mesh), 6);
    assert!(0 < closed && closed < 9, "{closed}");
}

/// A block above a rigid obstacle.
fn block_above(obstacle: &str) -> Model {
    let blocks = Blocks::new().rectangle("block", [-1.0, 1.0], [0.0, 1.0], [20, 10]);
    let text = format!(
        "plane = 'strain'
        materials.rock = {{young = 20e9, poisson = 0.22}}
        bodies.block.material = 'rock'
        [[displacement]]
        on = 'block left'
        x = 0.0
        [[pressure]]
        on = 'block top'
        value = 5e6
        [[contact]]
        name = 'ground'
        sides = ['block bottom']
        obstacle = {obstacle}"
    );
    model(&text, blocks.mesh)
}

#[test]
fn a_flat_obstacle_is_the_monolithic_solution() {
    let closed = agrees(
        &block_above("{ point = [0.0, -1e-5], normal = [3e-3, 1.0] }"),
        5,
    );
    assert!(0 < closed && closed < 21, "{closed}");
}

#[test]
fn a_round_obstacle_is_the_monolithic_solution() {
    let closed = agrees(&block_above("{ center = [0.1, -3.0], radius = 2.999 }"), 5);
    assert!(0 < closed && closed < 21, "{closed}");
}

/// The upper two blocks of the stack may slide; the solution contains no part of that motion.
#[test]
fn blocks_that_could_slide_are_the_monolithic_solution_without_sliding() {
    let model = built_in_model("stack", 0);
    let slides = ["middle block", "upper block"].map(|body| {
        let cells = model.mesh.groups[body].members.iter();
        let nodes: BTreeSet<u32> = cells
            .flat_map(|&cell| model.mesh.cells.nodes_of(cell as usize).to_vec())
            .collect();
        nodes.iter().map(|&node| (2 * node as usize, 1.0)).collect()
    });
    let reference = Monolithic::with(&model, slides.to_vec());
    for count in [4, 9] {
        compare(&model, &reference, &solve(&model, count));
    }
}

#[test]
fn stiffness_ratios_of_a_million_are_the_monolithic_solution() {
    for young in ["210e3", "210e15"] {
        let text = two_block_scene().replace("20e9", young);
        let model = model(&text, two_blocks().mesh);
        let difference = Monolithic::new(&model).energy_difference(&solve(&model, 7).dofs(&model));
        assert!(difference < 1e-6, "{difference:e}");
    }
}
