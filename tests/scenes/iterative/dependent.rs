//! Linearly dependent contact constraints with fixed active sets: in the tree of fronts, and between clusters.

use std::collections::BTreeMap;

use contact_dd_partition::element::geometry::{advance, dot};
use contact_dd_partition::model::Model;

use super::{ITERATIVE, difference};
use crate::support::scenes::{built_in, corner, model};
use crate::support::solution::Solution;
use crate::support::solver::{Case, LIMIT, built};
use crate::support::stress::draw_frictional;
use crate::support::stress::trial::{Interface, Trial, Verdict};

/// Three blocks that meet in a node, with the keys `words` in every contact.
fn junction(words: &str) -> Model {
    let (scene, mesh) = built_in("junction", 0);
    model(
        &scene.replace("[[contact]]", &format!("[[contact]]\n{words}")),
        mesh,
    )
}

/// Forces of all contacts on every node without a support, by its tag: the total of linearly dependent constraints is
/// unique, the single forces aren't; nor are they where supports prescribe a part of the jump.
fn forces_on_nodes(model: &Model, solution: &Solution) -> BTreeMap<i64, [f64; 3]> {
    let mut sums: BTreeMap<i64, [f64; 3]> = BTreeMap::new();
    for point in solution.points() {
        for (tag, sign) in point.tags.into_iter().zip([1.0, -1.0]) {
            let sum = sums.entry(tag).or_default();
            for (i, sum) in sum.iter_mut().enumerate() {
                let own = point.tangential_force[i] - point.force * point.normal[i];
                *sum += sign * own;
            }
        }
    }
    for support in &model.supports {
        let tag = model.mesh.node_tags[support.node as usize];
        if let Some(sum) = sums.get_mut(&tag) {
            *sum = advance(*sum, -dot(*sum, support.direction), support.direction);
        }
    }
    sums
}

#[test]
fn conditions_that_depend_on_others_have_the_dense_answer_in_the_tree_and_between_clusters() {
    for (name, model) in [
        ("corner", corner([-1e4, -25e3], "")),
        ("turned", corner([-25e3, -1e4], "")),
        ("rough corner", corner([-1e4, -25e3], "friction = 0.3")),
        ("junction", junction("friction = 0.4")),
        ("sticky junction", junction("tresca = 1e5")),
    ] {
        let dense = Case::in_clusters(&model, 12, 1).solve(&["--interface", "direct"]);
        assert_eq!(dense.report["contact_operator"], "dense", "{name}");
        for (clusters, operator) in [(1, "tree"), (6, "bddc")] {
            let found = Case::in_clusters(&model, 12, clusters).solve(&ITERATIVE);
            assert_eq!(found.report["contact_operator"], operator, "{name}");
            let difference = difference(&dense, &found);
            assert!(difference < 1e-9, "{name}, {operator}: {difference:e}");
            assert_eq!(dense.closed(), found.closed(), "{name}, {operator}");
            let [forces, expected] = [&found, &dense].map(|of| forces_on_nodes(&model, of));
            for (tag, force) in forces {
                let differs = (0..3).map(|i| (force[i] - expected[&tag][i]).abs());
                let differs = differs.fold(0.0, f64::max);
                let largest = dense.largest_force();
                assert!(
                    differs < 1e-9 * largest,
                    "{name}, {operator}: node {tag}, {differs:e}"
                );
            }
        }
    }
}

/// Supports leave two constraints with friction the same jump, each with a separate bound.
#[test]
fn conditions_with_friction_that_share_a_jump_are_solved_between_clusters() {
    let drawn = draw_frictional(125_777, 12);
    let trial = Trial::with(&drawn, built(), LIMIT, None, Interface::Iterative(8));
    assert_eq!(trial.verdict, Verdict::Right, "{}", trial.reason);
    assert_eq!(trial.report.unwrap()["contact_operator"], "bddc");
}
