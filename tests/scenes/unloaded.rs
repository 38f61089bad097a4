//! Load steps without load, after others with some: what is left is round-off of those, and no failure.

use contact_dd_partition::element::ElementKind::{Hexahedron8, Tetrahedron4};
use contact_dd_partition::model::Model;

use crate::support::blocks::joined;
use crate::support::scenes::{
    BODIES, HELD, JOINT, LOAD, built_in, model, two_block_scene, two_blocks,
};
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::Case;

/// On, off, on again, off.
const STEPS: &str = "
[[step]]
[[step]]
name = 'off'
scale = 0
[[step]]
[[step]]
name = 'off again'
scale = 0
";

/// Solves the steps in one subdomain and in several; all of them converge. Of the last ones.
#[track_caller]
fn solved(text: &str, model: &Model) -> Vec<Solution> {
    let mut all = Vec::new();
    for count in [5, 8] {
        let case = Case::of(model, count);
        let ended = case.run(&[]);
        assert_eq!(ended.code(), 0, "{}{}\n{text}", ended.stdout, ended.stderr);
        all = Solution::steps(&case.result());
        assert_eq!(all.len(), 4);
        all.iter().for_each(Solution::check_certificate);
    }
    all
}

/// Two solids on each other, with friction, of which the upper one is held by nothing else.
fn solids(
    kind: contact_dd_partition::element::ElementKind,
) -> (String, contact_dd_partition::mesh::Mesh) {
    let low = solid("lower", kind, [3, 3, 2], between([0.0; 3], [1.0, 1.0, 0.5]));
    let high = solid(
        "upper",
        kind,
        [3, 3, 2],
        between([0.0, 0.0, 0.5], [1.0, 1.0, 1.0]),
    );
    let text = "materials.rock = {young = 20e9, poisson = 0.2}
        bodies.lower.material = 'rock'
        bodies.upper = {material = 'rock', body_force = [2e3, 1e3, -25e3]}
        [[displacement]]
        on = 'lower z0'
        x = 0
        y = 0
        z = 0
        [[contact]]
        name = 'joint'
        sides = ['upper z0', 'lower z1']
        friction = 0.4\n";
    (text.into(), joined(low, high))
}

#[test]
fn a_step_without_load_is_solved_after_others() {
    let mut scenes = Vec::new();
    for name in [
        "incline",
        "stack",
        "rollers",
        "stack3d",
        "granite-friction",
        "sphere",
        "patch",
    ] {
        let (text, mesh) = built_in(name, 0);
        scenes.push((text.to_owned(), mesh));
    }
    for kind in [Hexahedron8, Tetrahedron4] {
        scenes.push(solids(kind));
    }
    let rough = two_block_scene().replacen("[[contact]]\n", "[[contact]]\nfriction = 0.3\n", 1);
    scenes.push((rough, two_blocks().mesh));
    // The upper one is held by friction alone.
    let free = format!("{BODIES}{HELD}{LOAD}{JOINT}friction = 0.3\n").replace("1.95-1.9*x", "0.5");
    scenes.push((free, two_blocks().mesh));
    for (text, mesh) in scenes {
        let text = format!("{text}{STEPS}");
        let steps = solved(&text, &model(&text, mesh));
        // Nothing presses that nothing loads, and the second time is as the first one.
        let most = [0, 1, 3].map(|k| steps[k].largest_force());
        assert!(
            most[1].max(most[2]) <= 1e-9 * most[0] || text.contains("friction"),
            "{most:?}\n{text}"
        );
    }
}

#[test]
fn heat_that_is_gone_leaves_nothing() {
    let heated =
        "bodies.upper = {material = 'steel', thermal = {expansion = 1.2e-5, temperature = 80}}";
    let text = two_block_scene().replace("bodies.upper.material = 'steel'", heated);
    let text = text.replace(LOAD, "");
    for friction in ["", "friction = 0.3\n"] {
        let text = format!("{text}{friction}{STEPS}");
        let steps = solved(&text, &model(&text, two_blocks().mesh));
        let most = [0, 1, 3].map(|k| steps[k].largest_displacement());
        assert!(
            most[0] > 1e-4 && most[1].max(most[2]) <= 1e-9 * most[0] || !friction.is_empty(),
            "{most:?}"
        );
    }
}
