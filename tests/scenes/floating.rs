//! Bodies held only by contact, from the beginning or after falling.

use std::collections::BTreeSet;

use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::{BODIES, HELD, JOINT, built_in_model, model};
use crate::support::solution::Solution;
use crate::support::solver::solve;
use crate::support::statics::{balanced, reaction};

/// A support of the upper block that prevents sliding.
const GUIDED: &str = "
[[displacement]]
on = 'upper left'
x = 0.0
";

const WEIGHT: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
bodies.lower.material = 'rock'
bodies.upper = {material = 'rock', body_force = [0.0, -25e3]}
";

fn apart(gap: f64) -> Blocks {
    Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [16, 8])
        .rectangle("upper", [0.5, 1.5], [1.0 + gap, 2.0 + gap], [8, 8])
}

/// Fails unless stresses and contact forces of both are equal.
#[track_caller]
fn stressed_alike(first: &Solution, second: &Solution, slack: f64) {
    let stresses = first.cells.iter().flat_map(|(_, stress)| stress);
    let size = stresses.fold(0.0, |m: f64, s| m.max(s.abs()));
    for ((_, a), (_, b)) in first.cells.iter().zip(&second.cells) {
        for (a, b) in a.iter().zip(b) {
            close(*a, *b, slack * size);
        }
    }
    for (a, b) in first.points().zip(second.points()) {
        close(a.force, b.force, slack * first.largest_force());
        assert_eq!(a.closed, b.closed);
    }
}

#[test]
fn a_body_that_falls_is_stressed_as_one_that_rests() {
    let text = format!("{WEIGHT}{HELD}{GUIDED}{JOINT}");
    for count in [2, 6] {
        let rests = solve(&model(&text, apart(0.0).mesh), count);
        for gap in [1e-6, 1e-3, 0.1, 10.0] {
            let falls = solve(&model(&text, apart(gap).mesh), count);
            // Coordinates, and therefore the stiffness, have round-off relative to the gap.
            stressed_alike(&rests, &falls, 1e-11 * (1.0 + gap));
            assert!(falls.sweeps() <= 1, "{} sweeps", falls.sweeps());
            assert_eq!(falls.report["warnings"].as_array().unwrap().len(), 0);
            let down = |s: &Solution| s.displacement.values().map(|u| u[1]).collect::<Vec<_>>();
            let deepest = |s: &Solution| down(s).into_iter().fold(0.0, f64::min);
            close(deepest(&falls), deepest(&rests) - gap, 1e-15 * (1.0 + gap));
        }
    }
}

#[test]
fn a_body_that_falls_on_one_that_falls_comes_to_rest_on_it() {
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [8, 4])
        .rectangle("middle", [0.0, 2.0], [1.2, 2.2], [8, 4])
        .rectangle("upper", [0.5, 1.5], [2.5, 3.5], [4, 4]);
    // The middle block is unloaded.
    let text = format!(
        "{WEIGHT}
        bodies.middle.material = 'rock'
        {HELD}{GUIDED}
        [[displacement]]
        on = 'middle left'
        x = 0.0
        [[contact]]
        name = 'below'
        sides = ['middle bottom', 'lower top']
        [[contact]]
        name = 'above'
        sides = ['middle top', 'upper bottom']"
    );
    for count in [3, 8] {
        let solution = solve(&model(&text, blocks.mesh.clone()), count);
        for name in ["below", "above"] {
            let forces = solution.contacts[name].iter().map(|point| point.force);
            close(forces.sum(), 25e3, 1e-6);
        }
        let lowest = |y: f64| {
            let nodes = blocks.mesh.node_tags.iter().zip(&blocks.mesh.points);
            let at = nodes.filter(|(_, x)| x[1] == y);
            at.map(|(tag, _)| solution.displacement[tag][1])
                .fold(0.0, f64::min)
        };
        close(lowest(2.2), -0.2, 1e-5);
        close(lowest(3.5), -0.5, 1e-5);
    }
}

#[test]
fn a_block_falls_into_gaps_that_differ_and_turns_on_the_way() {
    let blocks = Blocks::new().rectangle("upper", [0.0, 2.0], [0.0, 1.0], [12, 6]);
    // The ground rises to the right; in the middle it is too low for contact.
    let text = "
        plane = 'strain'
        materials.rock = {young = 20e9, poisson = 0.22}
        bodies.upper = {material = 'rock', body_force = [0.0, -25e3]}
        [[contact]]
        name = 'ground'
        sides = ['upper bottom']
        obstacle = {point = [0, 0], normal = [0, 1]}
        gap = '0.05 - 0.01*x + 0.02*x*(2 - x)'";
    let model = model(text, blocks.mesh);
    for count in [1, 5] {
        let solution = solve(&model, count);
        let points = &solution.contacts["ground"];
        let total = points.iter().map(|point| point.force).sum::<f64>();
        close(total, 50e3, 1e-6);
        for point in points {
            let at_end = point.position[0] == 0.0 || point.position[0] == 2.0;
            assert_eq!(point.closed, at_end, "{point:?}");
            if at_end {
                close(point.force, 25e3, 1e-6);
            }
        }
    }
}

#[test]
fn a_plate_that_comes_from_afar_presses_as_one_that_is_there() {
    let scene = |down: f64| {
        format!(
            "{BODIES}{HELD}
            [[displacement]]
            on = 'upper top'
            x = 0.0
            y = {down}
            {JOINT}"
        )
    };
    for count in [2, 6] {
        let there = solve(&model(&scene(-1e-5), apart(0.0).mesh), count);
        let afar = solve(&model(&scene(-0.12501), apart(0.125).mesh), count);
        // Rounding 0.12501 m by 1e-17 m changes the stress in steel cells of 0.125 m by 2e-5 Pa, 3e-11 of it.
        stressed_alike(&there, &afar, 1e-10);
        assert!(there.largest_force() > 1e4);
    }
}

/// The nodes of a body.
fn nodes_of(mesh: &Mesh, body: &str) -> BTreeSet<u32> {
    let cells = mesh.groups[body].members.iter();
    (cells.flat_map(|&cell| mesh.cells.nodes_of(cell as usize)))
        .copied()
        .collect()
}

#[test]
fn a_body_that_may_slide_stays_in_the_mean_and_a_warning_says_so() {
    for gap in [0.0, 0.1] {
        let model = model(&format!("{WEIGHT}{HELD}{JOINT}"), apart(gap).mesh);
        for count in [2, 6] {
            let solution = solve(&model, count);
            let nodes = nodes_of(&model.mesh, "upper");
            let aside = nodes.iter().map(|&node| {
                let tag = model.mesh.node_tags[node as usize];
                solution.displacement[&tag][0]
            });
            close(aside.sum(), 0.0, 1e-20 * nodes.len() as f64);
            let warnings = solution.report["warnings"].as_array().unwrap();
            assert_eq!(warnings.len(), 1, "{warnings:?}");
            let warning = warnings[0].as_str().unwrap();
            assert!(
                warning.contains("'upper' (translation along ("),
                "{warning}"
            );
            close(reaction(&solution.contacts["joint"])[1], 25e3, 1e-7);
        }
    }
}

/// The unbalanced part of forces along the common free motion has to be distributed.
#[test]
fn round_off_along_a_free_motion_is_left_at_no_single_node() {
    for n in [36, 48, 52, 56] {
        let blocks = Blocks::new()
            .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [n, n])
            .rectangle("upper", [0.0, 1.0], [1.0, 2.0], [n, n]);
        let text = format!(
            "plane = 'strain'
            materials.rock = {{young = 20e9, poisson = 0.22}}
            bodies.lower.material = 'rock'
            bodies.upper.material = 'rock'
            [[bilateral]]
            on = ['lower left', 'upper left']
            [[pressure]]
            on = ['lower bottom', 'upper top']
            value = '1e6*(1.2-x^2)'
            {JOINT}"
        );
        let model = model(&text, blocks.mesh);
        for count in [2, 6] {
            let solution = solve(&model, count);
            let equilibrium = solution.report["certificate"]["equilibrium"].as_f64();
            assert!(
                equilibrium.is_some_and(|e| e < 4e-15),
                "{n}: {equilibrium:?}"
            );
        }
    }
}

/// A square standing on its corner on top of a block.
fn on_its_tip() -> Model {
    let corners = [[0.0, 0.0], [1.0, 1.0], [0.0, 2.0], [-1.0, 1.0]];
    let blocks = Blocks::new()
        .rectangle("lower", [-1.0, 1.0], [-1.0, 0.0], [8, 4])
        .quadrilateral("upper", corners, [8, 8]);
    let joint = "
        [[contact]]
        name = 'joint'
        sides = [['upper bottom', 'upper left'], 'lower top']";
    model(&format!("{WEIGHT}{HELD}{joint}"), blocks.mesh)
}

#[track_caller]
fn rests_on_its_tip(count: usize) {
    let solution = solve(&on_its_tip(), count);
    assert_eq!(solution.closed(), 1);
    balanced(reaction(solution.points()), [0.0, 50e3, 0.0], 1e-6);
}

#[test]
fn a_body_on_its_tip_rests_on_it() {
    rests_on_its_tip(2);
}

#[test]
fn a_body_in_several_subdomains_on_its_tip_rests_on_it() {
    rests_on_its_tip(6);
}

#[test]
fn a_wedge_between_two_blocks_spreads_its_weight() {
    let blocks = Blocks::new()
        .quadrilateral(
            "left",
            [[-2.0, 0.0], [0.0, 0.0], [-0.5, 1.0], [-2.0, 1.0]],
            [8, 6],
        )
        .quadrilateral(
            "right",
            [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.5, 1.0]],
            [8, 6],
        )
        .quadrilateral(
            "upper",
            [[0.0, 0.0], [0.5, 1.0], [0.0, 2.0], [-0.5, 1.0]],
            [6, 6],
        );
    let text = "
        plane = 'strain'
        materials.rock = {young = 20e9, poisson = 0.22}
        bodies.left.material = 'rock'
        bodies.right.material = 'rock'
        bodies.upper = {material = 'rock', body_force = [0.0, -25e3]}
        [[displacement]]
        on = ['left left', 'right right']
        x = 0.0
        y = 0.0
        [[contact]]
        name = 'right joint'
        sides = ['upper bottom', 'right left']
        [[contact]]
        name = 'left joint'
        sides = ['upper left', 'left right']";
    let model = model(text, blocks.mesh);
    let reference = Monolithic::new(&model);
    for count in [3, 7] {
        let solution = solve(&model, count);
        compare(&model, &reference, &solution);
        // Its sides have the slope 2: each carries half the weight and twice that horizontally.
        let [right, left] = ["right joint", "left joint"].map(|n| reaction(&solution.contacts[n]));
        balanced([right[0], right[1], 0.0], [-25e3, 12.5e3, 0.0], 1e-6);
        balanced([left[0], left[1], 0.0], [25e3, 12.5e3, 0.0], 1e-6);
    }
}

/// The semi-coercive case: with all subdomains in contact there is no Γ and no S_0; with subdomains on Γ that only
/// touch each other S_0 is singular; then with many subdomains.
#[test]
fn a_stack_has_one_answer_in_any_number_of_subdomains() {
    let model = built_in_model("stack", 0);
    let first = solve(&model, 3);
    assert_eq!(first.report["interface_dofs"], 0);
    let slack = 1e-11 * first.largest_displacement();
    for count in [4, 5, 6, 8, 14] {
        let other = solve(&model, count);
        for (tag, u) in &first.displacement {
            for (a, b) in u.iter().zip(other.displacement[tag]) {
                close(*a, b, slack);
            }
        }
        for (a, b) in first.points().zip(other.points()) {
            close(a.force, b.force, 1e-10 * first.largest_force());
            assert_eq!(a.closed, b.closed);
        }
    }
}
