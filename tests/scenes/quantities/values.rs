//! Values of quantities, compared with the fields of the result, and invalid quantities.

use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;
use serde_json::Value;

use super::{FRICTION, KNOBS, Knob, in_plane, plane, quantities, varied};
use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve, solve_steps};

#[test]
fn quantities_are_those_of_the_fields() {
    let knobs: Vec<&Knob> = KNOBS.iter().chain([&FRICTION]).collect();
    let varied = varied(&plane(), super::COULOMB, &in_plane("quad4"), &knobs, None);
    let solution = Case::of(&varied, 5).solve(&[]);
    let all = quantities(&solution.report);
    let check = |name: &str, expected: f64| {
        let found = all[name]["value"].as_f64().unwrap();
        close(found, expected, 1e-10 * expected.abs());
    };
    let node = all["sag"]["node"].as_i64().unwrap();
    let mut tags = varied.mesh.node_tags.iter();
    let at = tags.position(|&tag| tag == node).unwrap();
    assert_eq!(varied.mesh.points[at], [1.0, 2.0, 0.0]);
    let [x, y, _] = solution.displacement[&node];
    check("sag", (x - 2.0 * y) / 5f64.sqrt());
    // All cells of the lower body have the same area.
    let below = solution.cells.iter().filter(|(center, _)| center[1] < 1.0);
    let below: Vec<f64> = below.map(|(_, stress)| stress[1]).collect();
    check(
        "mean stress",
        below.iter().sum::<f64>() / below.len() as f64,
    );
    let points = |name: &str| solution.contacts[name].iter();
    check("pressed", points("joint").map(|point| point.force).sum());
    let area = |name: &str| points(name).map(|point| point.force / point.pressure);
    let closed = area("wall").filter(|area| area.is_finite()).count();
    assert!(closed > 0 && closed < points("wall").count());
    check("mean", points("wall").map(|point| point.force).sum::<f64>());
    check(
        "peak",
        points("joint")
            .map(|point| point.pressure)
            .fold(0.0, f64::max),
    );
    // Average pressures in windows of 0.3 m to both sides.
    let joint = varied.contacts.iter().find(|of| of.name == "joint");
    let joint = &joint.unwrap().points;
    let window = |at: f64, x: f64| (1.0 - (at - x).abs() / 0.3).max(0.0);
    let smoothed = |at: f64| {
        let force = points("joint").map(|point| window(at, point.position[0]) * point.force);
        let area = joint
            .iter()
            .map(|point| window(at, point.position[0]) * point.area);
        force.sum::<f64>() / area.sum::<f64>()
    };
    let all_smoothed = joint.iter().map(|point| smoothed(point.position[0]));
    check("smooth", all_smoothed.fold(0.0, f64::max));
    let corner = points("wall")
        .find(|point| point.position == [0.4, 1.0, 0.0])
        .unwrap();
    check("mouth", corner.gap);
    let report = &solution.report;
    check(
        "sheared",
        report["contacts"][0]["force"][0].as_f64().unwrap(),
    );
    let (force, moment) = (
        &report["contacts"][0]["force"],
        &report["contacts"][0]["moment"],
    );
    let [x, y, moment] = [&force[0], &force[1], &moment[2]].map(|of| of.as_f64().unwrap());
    check("tilt", moment - (0.3 * y - 0.9 * x));
    check(
        "support",
        report["reactions"][0]["force"][1].as_f64().unwrap(),
    );
    let norm = report["error_estimate"]["energy_norm"].as_f64().unwrap();
    // The energy norm of the estimate includes the estimated error.
    let error = report["error_estimate"]["error"].as_f64().unwrap();
    let stored = all["stored"]["value"].as_f64().unwrap();
    assert!((stored - 0.5 * norm * norm).abs() <= 0.5 * error * error + 1e-9 * stored);
}

/// A support and a foundation of several groups: of each group its own part, on nodes of several subdomains, too.
#[test]
fn the_reaction_of_a_group_is_without_those_of_others_of_its_condition() {
    let scene = |on: [&str; 2], asked: &str| {
        format!(
            "plane = 'strain'
            materials.rock = {{young = 2e10, poisson = 0.25}}
            bodies.beam.material = 'rock'
            {}
            [[spring]]
            on = ['beam bottom', 'beam top']
            stiffness = [1e7, 3e9]
            [[force]]
            on = 'beam top'
            total = [1e4, -3e5]
            {asked}",
            on.map(|on| format!("[[displacement]]\non = {on}\nx = 0\ny = '1e-5*x'\n"))
                .join("\n"),
        )
    };
    let asked = ["left", "right", "bottom", "top"].map(|side| {
        format!(
            "[[quantity]]\nname = '{side}'\nkind = 'reaction'\non = 'beam {side}'\ndirection = [1.0, 2.0]\n"
        )
    });
    let asked = asked.join("");
    let blocks = Blocks::new().rectangle("beam", [0.0, 3.0], [0.0, 1.0], [9, 5]);
    let solved = |scene: &str, subdomains: usize| {
        quantities(&solve(&model(scene, blocks.mesh.clone()), subdomains).report)
    };
    let apart = solved(&scene(["'beam left'", "'beam right'"], &asked), 1);
    let number = |of: &Value| of["value"].as_f64().unwrap();
    for subdomains in [1, 5] {
        let both = scene(["['beam left', 'beam right']"; 2], &asked);
        let both = both.replacen(
            "[[displacement]]\non = ['beam left', 'beam right']\nx = 0\ny = '1e-5*x'\n",
            "",
            1,
        );
        let all = solved(&both, subdomains);
        for side in ["left", "right"] {
            close(number(&all[side]), number(&apart[side]), 1e-6);
            let of = |all: &Value| all["derivatives"][0]["derivative"].as_f64().unwrap();
            close(of(&all[side]), of(&apart[side]), 1e-6);
        }
        // All forces are in balance.
        let sum: f64 = all.values().map(number).sum();
        close(sum, -(1e4 - 6e5) / 5f64.sqrt(), 1e-5);
        assert!((number(&all["top"]) - number(&all["bottom"])).abs() > 1.0);
    }
}

/// The derivative in a load step is with respect to its own loads, without friction.
#[test]
fn quantities_are_those_of_every_load_step_and_friction_in_a_later_one_has_no_derivatives() {
    let steps = "[[step]]\nscale = 0.5\n[[step]]\nscale.pressure = 2.0\n";
    let knobs: Vec<&Knob> = KNOBS.iter().chain([&FRICTION]).collect();
    let solved = |law: &str| {
        let text = format!("{}{steps}", plane());
        solve_steps(&varied(&text, law, &in_plane("quad4"), &knobs, None), 4)
    };
    let without = solved("");
    let pressed = |solution: &Solution| quantities(&solution.report)["support"].clone();
    for (solution, scale) in without.iter().zip([0.5, 2.0]) {
        let found = super::derivative(&pressed(solution), "pressure[1] on 'high top'");
        // ∫ 1 + 0.3 x over the side.
        close(
            found,
            scale * 1e6 * (1.2 + 0.15 * (1.6 * 1.6 - 0.4 * 0.4)),
            1e-4,
        );
    }
    let with = solved(super::COULOMB);
    assert!(with[0].report["without_derivatives"].is_null());
    let why = with[1].report["without_derivatives"].as_str().unwrap();
    assert!(why.contains("friction depends on"), "{why}");
    assert!(
        pressed(&with[1])["derivatives"]
            .as_array()
            .unwrap()
            .is_empty()
    );
}

#[test]
fn what_is_no_quantity_is_refused_with_what_there_is() {
    let knobs: Vec<&Knob> = KNOBS.iter().collect();
    let refused = |from: &str, to: &str| {
        let mut text = format!("mesh = 'here.msh'\n{}", plane().replace("@law@", ""));
        for Knob(word, value, ..) in &knobs {
            text = text.replace(word, &format!("{value:?}"));
        }
        let text = text.replacen(from, to, 1);
        match Scene::parse(&text) {
            Ok(scene) => Model::new(&scene, in_plane("quad4"))
                .unwrap_err()
                .to_string(),
            Err(error) => error.to_string(),
        }
    };
    for (from, to, expected) in [
        (
            "contact = 'joint'",
            "contact = 'jiont'",
            "did you mean 'joint'",
        ),
        (
            "contact = 'joint'",
            "contact = 'x'",
            "Known here: joint, wall",
        ),
        ("body = 'low'", "body = 'lower'", "did you mean 'low'"),
        (
            "on = 'low bottom'\ndirection",
            "on = 'high top'\ndirection",
            "no support is on 'high top'",
        ),
        ("kind = 'energy'", "kind = 'enrgy'", "did you mean 'energy'"),
        (
            "kind = 'energy'",
            "kind = 'energy'\nbody = 'low'",
            "that of all bodies",
        ),
        (
            "name = 'mean'",
            "name = 'peak'",
            "has the name 'peak' already",
        ),
        ("at = [1.0, 2.0]", "at = [1.0, 2.0, 3.0]", "two components"),
        (
            "at = [1.0, 2.0]",
            "at = [1.0, 1.0]",
            "expected 'node', the tag of one",
        ),
        (
            "at = [1.0, 2.0]",
            "node = 123456",
            "no body has a node 123456",
        ),
        (
            "at = [1.0, 2.0]",
            "at = [100.0, 2.0]",
            "m away from the bodies, the nearest node",
        ),
        (
            "at = [0.4, 1.0]",
            "at = [0.4, -50.0]",
            "51 m away from the contact, the nearest point at (0.4, 1)",
        ),
        ("component = 'yy'", "component = 'yz'", "no such shear"),
        ("direction = [1, -2]", "direction = 'down'", "a direction"),
        ("direction = 'x'", "direction = [0, 0]", "zero vector"),
        ("over = 0.3", "over = 0", "expected a number above 0"),
        ("over = 0.3", "about = [0, 0]", "perhaps 'over'"),
        (
            "about = [0.3, 0.9]",
            "about = [0.3, 0.9, 0]",
            "two components",
        ),
        (
            "about = [0.3, 0.9]",
            "about = [0.3, 0.9]\ndirection = 'x'",
            "expected no direction",
        ),
        ("about = [0.3, 0.9]", "", "'about', a point"),
    ] {
        let message = refused(from, to);
        assert!(message.contains(expected), "{to}: {message}");
        assert!(message.contains("quantity"), "{message}");
    }
}

/// A wall that touches without force, as the adjacent block has Poisson's ratio 0.
#[test]
fn points_about_to_change_are_named() {
    let scene = "
plane = 'strain'
materials.cork = {young = 1e8, poisson = 0}
bodies.block.material = 'cork'
[[bilateral]]
on = 'block right'
[[pressure]]
on = 'block top'
value = 1e5
[[contact]]
name = 'table'
sides = ['block bottom']
obstacle = {point = [0, 0], normal = [0, 1]}
[[contact]]
name = 'wall'
sides = ['block left']
obstacle = {point = [0, 0], normal = [1, 0]}
gap = 0.0
[[quantity]]
name = 'sag'
kind = 'displacement'
at = [0.0, 1.0]
direction = 'y'
";
    let mesh = Blocks::new().rectangle("block", [0.0, 1.0], [0.0, 1.0], [3, 3]);
    let solution = Case::of(&model(scene, mesh.mesh), 2).solve(&[]);
    let named = solution.report["about_to_change"].as_array().unwrap();
    assert_eq!(named.len(), 4, "{named:?}");
    let of_wall = |name: &Value| name.as_str().unwrap().contains("contact 'wall'");
    assert!(named.iter().all(of_wall), "{named:?}");
    let sag = &quantities(&solution.report)["sag"];
    close(
        super::derivative(sag, "pressure[1] on 'block top'"),
        -1e-3,
        1e-12,
    );
}
