//! Unloaded load steps after loaded ones: the solution is round-off of these, without failure.

use contact_dd_partition::element::ElementKind::{Hexahedron8, Tetrahedron4};
use contact_dd_partition::model::Model;

use crate::support::blocks::joined;
use crate::support::scenes::{
    BODIES, HELD, JOINT, LOAD, built_in, model, two_block_scene, two_blocks,
};
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::Case;

/// Loaded, unloaded, loaded again, unloaded.
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

/// Solves the steps in one subdomain and in several, where all have to converge; returns the steps of the last run.
#[track_caller]
fn solved(text: &str, model: &Model) -> Vec<Solution> {
    let mut all = Vec::new();
    for count in [5, 8, 13] {
        let case = Case::of(model, count);
        let ended = case.run(&[]);
        assert_eq!(ended.code(), 0, "{}{}\n{text}", ended.stdout, ended.stderr);
        all = Solution::steps(&case.result());
        assert_eq!(all.len(), 4);
        all.iter().for_each(Solution::check_certificate);
    }
    all
}

/// Two solids on top of each other, with friction, where the upper one is held only by contact.
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
    // The upper one is held only by friction.
    let free = format!("{BODIES}{HELD}{LOAD}{JOINT}friction = 0.3\n").replace("1.95-1.9*x", "0.5");
    scenes.push((free, two_blocks().mesh));
    for (text, mesh) in scenes {
        let text = format!("{text}{STEPS}");
        let model = model(&text, mesh);
        let steps = solved(&text, &model);
        let most = [0, 1, 3].map(|k| steps[k].largest_force());
        if text.contains("friction") {
            // Locked-in forces stay in equilibrium, within the law of friction.
            for k in [1, 3] {
                check_locked_in(&steps[k], most[0], &text);
            }
            continue;
        }
        // Without loads there are no forces and no displacements, and the second time equals the first.
        assert!(most[1].max(most[2]) <= 1e-9 * most[0], "{most:?}\n{text}");
        let far = [0, 1, 3].map(|k| steps[k].largest_displacement());
        assert!(far[1].max(far[2]) <= 1e-9 * far[0], "{far:?}\n{text}");
    }
}

/// Checks that the forces of an unloaded step fulfil the law of friction and are in equilibrium: the forces of contacts
/// and supports sum up to zero without other loads; `most` is the largest force of a loaded step (N).
#[track_caller]
fn check_locked_in(step: &Solution, most: f64, text: &str) {
    step.check_certificate();
    let law = text.split("friction = ").nth(1).unwrap();
    let coefficient: f64 = (law.split_whitespace().next().unwrap().parse()).unwrap();
    for point in step.points() {
        let along = point
            .tangential_force
            .iter()
            .map(|f| f * f)
            .sum::<f64>()
            .sqrt();
        assert!(
            point.force >= 0.0 && point.gap >= -1e-12,
            "{point:?}\n{text}"
        );
        assert!(
            along <= coefficient * point.force + 1e-9 * most,
            "{point:?}\n{text}"
        );
        assert!(point.force * point.gap <= 1e-12 * most, "{point:?}\n{text}");
    }
    // A body with a single contact is in equilibrium under that contact alone.
    for contact in step.report["contacts"].as_array().unwrap() {
        let force = contact["force"].as_array().unwrap();
        let size = |part: &serde_json::Value| part.as_f64().unwrap().abs();
        let is_alone = !text.contains("granite") && !text.contains("on = 'upper left'");
        assert!(
            !is_alone || force.iter().all(|part| size(part) <= 1e-9 * most),
            "{contact}\n{text}"
        );
    }
}

/// A position that contact doesn't determine is the nearest one, independent of earlier steps: without friction a step
/// has the solution that it has alone.
#[test]
fn what_a_step_leaves_without_load_is_where_it_is_without_earlier_steps() {
    let (text, mesh) = built_in("rollers", 0);
    let own = "[[step]]
        scale = { pressure = 0 }
        body_force = { 'left roller' = [0.0, -1e5] }\n";
    let alone = model(&format!("{text}{own}"), mesh.clone());
    let after = model(&format!("{text}\n[[step]]\n{own}"), mesh);
    for count in [5, 8, 9, 13] {
        let steps = |model: &Model| {
            let case = Case::of(model, count);
            let ended = case.run(&[]);
            assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
            Solution::steps(&case.result())
        };
        let (alone, after) = (&steps(&alone)[0], &steps(&after));
        let most = after[0].largest_displacement();
        assert!(most > 1e-4, "{most}");
        after[1].check_certificate();
        for (node, u) in &alone.displacement {
            for (u, v) in u.iter().zip(&after[1].displacement[node]) {
                assert!((u - v).abs() <= 1e-12 * most, "{count}, {node}: {u} {v}");
            }
        }
    }
}

/// The position of unloaded bodies without supports is arbitrary; their round-off must not affect the solution of the
/// others.
#[test]
fn one_body_is_loaded_among_others_that_nothing_holds() {
    let (text, mesh) = built_in("rollers", 0);
    let (head, rest) = text.split_once("[[pressure]]").unwrap();
    let (_, contacts) = rest.split_once("# Nodes don't match").unwrap();
    for roller in ["left", "middle", "right"] {
        let own = format!("\"{roller} roller\" = {{ material = \"steel\"");
        let loaded = head.replace(&own, &format!("{own}, body_force = [0.0, -1e5]"));
        let text = format!("{loaded}# Nodes don't match{contacts}");
        let model = model(&text, mesh.clone());
        for count in [14, 18, 32] {
            Case::of(&model, count).solve(&[]).check_certificate();
        }
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
