//! Conditions that depend on others where fixed active sets are solved for: in the tree of fronts, and between clusters.

use contact_dd_partition::model::Model;

use super::{ITERATIVE, difference};
use crate::support::close::close;
use crate::support::scenes::{built_in, corner, model};
use crate::support::solver::{Case, LIMIT, built};
use crate::support::stress::draw_frictional;
use crate::support::stress::trial::{Interface, Trial, Verdict};

/// Three blocks that meet in a node, with these `words` of every contact.
fn junction(words: &str) -> Model {
    let (scene, mesh) = built_in("junction", 0);
    model(
        &scene.replace("[[contact]]", &format!("[[contact]]\n{words}")),
        mesh,
    )
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
            for (a, b) in dense.points().zip(found.points()) {
                close(a.force, b.force, 1e-9 * dense.largest_force());
            }
        }
    }
}

/// Supports leave two conditions with friction one and the same jump, each with a bound of its own.
#[test]
fn conditions_with_friction_that_share_a_jump_are_solved_between_clusters() {
    let drawn = draw_frictional(125_777, 12);
    let trial = Trial::with(&drawn, built(), LIMIT, None, Interface::Iterative(8));
    assert_eq!(trial.verdict, Verdict::Right, "{}", trial.reason);
    assert_eq!(trial.report.unwrap()["contact_operator"], "bddc");
}
