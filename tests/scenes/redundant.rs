//! Constraints that repeat other constraints or supports.

use std::collections::BTreeMap;

use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use crate::support::close::close;
use crate::support::scenes::{BODIES, JOINT, LOAD, SUPPORTS, model, two_block_scene, two_blocks};
use crate::support::solution::Solution;
use crate::support::solver::solve;

/// Forces by the tags of a constraint's nodes in either order.
fn forces(solution: &Solution) -> BTreeMap<[i64; 2], f64> {
    let mut sums = BTreeMap::new();
    for point in solution.points() {
        let mut tags = point.tags;
        tags.sort_unstable();
        *sums.entry(tags).or_default() += point.force;
    }
    sums
}

/// A scene with the contact of another one in addition to its own, which no scene may have, but a problem file may.
fn with_contact_of(scene: &str, other: &str) -> Model {
    let mut both = model(scene, two_blocks().mesh);
    let mut again = model(other, two_blocks().mesh).contacts.remove(0);
    again.points.iter_mut().for_each(|point| point.contact = 1);
    both.contacts.push(again);
    both
}

#[test]
fn a_contact_given_twice_carries_the_same_force_once() {
    let first = solve(&model(&two_block_scene(), two_blocks().mesh), 5);
    let again = JOINT.replace("'joint'", "'again'");
    let reversed = again.replace(
        "['upper bottom', 'lower top']",
        "['lower top', 'upper bottom']",
    );
    assert_ne!(again, reversed);
    for second in [again, reversed] {
        let other = two_block_scene().replace(JOINT, &second);
        let solution = solve(&with_contact_of(&two_block_scene(), &other), 5);
        for (tag, u) in &first.displacement {
            for (a, b) in u.iter().zip(solution.displacement[tag]) {
                close(*a, b, 1e-11 * first.largest_displacement());
            }
        }
        let sums = forces(&solution);
        for (tags, force) in forces(&first) {
            close(sums[&tags], force, 1e-10 * first.largest_force());
        }
        for (a, b) in first.points().zip(&solution.contacts["joint"]) {
            close(a.gap, b.gap, 1e-11 * first.largest_displacement());
        }
    }
}

#[test]
fn the_tighter_of_two_gaps_counts() {
    let again = JOINT.replace("'joint'", "'again'");
    let scene = |joint: &str, gap: f64| format!("{BODIES}{SUPPORTS}{LOAD}{joint}gap = {gap}\n");
    let tight = format!("{BODIES}{SUPPORTS}{LOAD}{JOINT}gap = -1e-5\n");
    let expected = solve(&model(&tight, two_blocks().mesh), 5);
    for gaps in [[-1e-5, 2e-5], [2e-5, -1e-5]] {
        let [first, second] = [scene(JOINT, gaps[0]), scene(&again, gaps[1])];
        let found = solve(&with_contact_of(&first, &second), 5);
        let sums = forces(&found);
        for (tags, force) in forces(&expected) {
            close(sums[&tags], force, 1e-10 * expected.largest_force());
        }
    }
}

#[test]
fn a_joint_whose_sides_are_prescribed_has_no_condition_unless_they_penetrate() {
    let held = |y: f64| {
        format!(
            "{BODIES}
            [[displacement]]
            on = ['lower bottom', 'lower top']
            x = 0.0
            y = 0.0
            [[displacement]]
            on = 'upper bottom'
            x = 0.0
            y = {y}
            {JOINT}"
        )
    };
    let model = model(&held(1e-5), two_blocks().mesh);
    assert!(
        model
            .warnings
            .iter()
            .any(|w| w.contains("all its nodes are prescribed"))
    );
    let solution = solve(&model, 2);
    assert_eq!(solution.points().count(), 0);
    let scene = format!("mesh = 'here.msh'\n{}", held(-1e-5));
    let scene = Scene::parse(&scene).unwrap();
    let refused = Model::new(&scene, two_blocks().mesh).unwrap_err();
    assert!(refused.to_string().contains("no penetration"), "{refused}");
}
