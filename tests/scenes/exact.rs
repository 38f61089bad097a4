//! Scenes with exact solutions.

use contact_dd_partition::element::ElementKind::Quad4;
use contact_dd_partition::example;

use crate::support::close::close;
use crate::support::scenes::{
    BODIES, JOINT, SUPPORTS, built_in, built_in_model, model, two_blocks,
};
use crate::support::solution::Solution;
use crate::support::solver::solve;
use crate::support::sorts::{Sort, sort};
use crate::support::statics::{balanced, reaction};

/// Pressure, Young's modulus and Poisson's ratio of a uniform compression.
type Compression = [f64; 3];

/// u = −p (1+ν)(1−2ν)/E · (x − x_0).
fn compressed([p, young, poisson]: Compression, x_0: f64, x: [f64; 3]) -> [f64; 2] {
    let strain = -p * (1.0 + poisson) * (1.0 - 2.0 * poisson) / young;
    [strain * (x[0] - x_0), strain * (x[1] - x_0)]
}

/// Fails unless stress and contact pressure are those of the compression everywhere, with every contact closed, to
/// within `slack`.
#[track_caller]
fn is_compressed(solution: &Solution, [p, _, poisson]: Compression, slack: f64) {
    let expected = [-p, -p, -2.0 * poisson * p, 0.0, 0.0, 0.0];
    solution.check_cells(expected, 10.0 * slack * p);
    solution.check_pressure(p, 10.0 * slack * p);
    for point in solution.points() {
        close(point.gap, 0.0, slack * solution.largest_displacement());
    }
}

/// The wedge may slide on the base and the right block follow without energy: the solution contains only the uniform
/// compression, no part of that motion.
#[test]
fn three_contacts_that_meet_leave_uniform_compression_alone() {
    let model = built_in_model("junction", 0);
    let compression = [1e6, 100e6, 0.3];
    let motions = [
        ("base", [0.0, 0.0]),
        ("left block", [0.0, 0.0]),
        ("right block", [0.0, -3.0]),
        ("wedge", [5.0, -3.0]),
    ];
    for count in [4, 9] {
        let solution = solve(&model, count);
        is_compressed(&solution, compression, 1e-10);
        let slack = 1e-10 * solution.largest_displacement();
        let mut nodes: Vec<(usize, [f64; 2])> = Vec::new();
        for (body, motion) in motions {
            let cells = model.mesh.groups[body].members.iter();
            let all = cells.flat_map(|&cell| model.mesh.cells.nodes_of(cell as usize));
            nodes.extend(all.map(|&node| (node as usize, motion)));
        }
        nodes.sort_by_key(|&(node, _)| node);
        nodes.dedup_by_key(|&mut (node, _)| node);
        let u = |node: usize| solution.displacement[&model.mesh.node_tags[node]];
        let along = |f: &dyn Fn(usize) -> [f64; 2]| -> f64 {
            let terms = nodes
                .iter()
                .map(|&(node, z)| f(node)[0] * z[0] + f(node)[1] * z[1]);
            terms.sum()
        };
        let exact = |node: usize| compressed(compression, -5.0, model.mesh.points[node]);
        let length: f64 = nodes.iter().map(|(_, z)| z[0] * z[0] + z[1] * z[1]).sum();
        let part = along(&exact) / length;
        for &(node, z) in &nodes {
            for ((u, e), z) in u(node).into_iter().zip(exact(node)).zip(z) {
                close(u, e - part * z, slack);
            }
        }
        let warnings = &solution.report["warnings"];
        assert_eq!(warnings.as_array().unwrap().len(), 1, "{warnings:#}");
    }
}

/// Sneddon's crack: the pressure p of a fluid in it opens it by 4 (1−ν²) p b/E; if the compression of the plate exceeds
/// p, the crack is closed under the difference.
#[test]
fn pressure_in_a_crack_opens_it_or_takes_from_its_contact_pressure() {
    let (text, mesh) = built_in("crack", 0);
    let (bodies, _) = text.split_once("[[traction]]").unwrap();
    let (_, contact) = text.split_once("# At its tips").unwrap();
    let pressed = |sort: Sort, outside: f64| {
        let scene = format!(
            "{bodies}
            [[pressure]]
            on = ['crack upper', 'crack lower']
            value = 1e7
            [[pressure]]
            on = ['left', 'right', 'top', 'bottom']
            value = {outside:e}
            # At its tips{contact}"
        );
        solve(&model(&scene, sort.of(&mesh)), 6)
    };
    let exact = 4.0 * (1.0 - 0.25 * 0.25) * 1e7 / 25e9;
    for (name, slack) in [("triangle3", 6e-2), ("triangle6", 2e-2)] {
        let open = pressed(sort(name), 0.0);
        let widest = open.points().map(|point| point.gap).fold(0.0, f64::max);
        assert!(
            (widest / exact - 1.0).abs() < slack,
            "{name}: {widest:e}, {exact:e}"
        );
        assert_eq!(open.closed(), 0);
    }
    for point in pressed(sort("triangle3"), 3e7).points() {
        assert!(
            point.closed && (point.pressure / 2e7 - 1.0).abs() < 1e-9,
            "{point:?}"
        );
    }
}

#[test]
fn rollers_press_as_hertz_says_of_the_forces_they_carry() {
    let mesh = example::find("rollers").unwrap().mesh_of(Quad4, 0);
    let model = model(example::find("rollers").unwrap().scene, mesh.unwrap());
    let stiffness = 1.0 / (0.91 / 210e9 + 0.91 / 70e9);
    let solution = solve(&model, 8);
    assert_eq!(solution.report["warnings"].as_array().unwrap().len(), 0);
    let mut total = [0.0; 2];
    for (roller, x) in [("left", -0.12), ("middle", 0.0), ("right", 0.12)] {
        let [below, above] =
            ["below", "above"].map(|side| &solution.contacts[&format!("{roller} roller {side}")]);
        let (on_plate, on_roller) = (reaction(below), reaction(above));
        balanced(on_plate, on_roller, 1e-9 * on_plate[1].abs());
        let force = -on_plate[1];
        total = [total[0] + force, total[1] - on_plate[2]];
        close(on_plate[2], -force * x, 1e-4 * force);
        let largest = (force * stiffness / (std::f64::consts::PI * 0.05)).sqrt();
        for points in [below, above] {
            let found = points.iter().fold(0.0, |m: f64, p| m.max(p.pressure));
            close(found, largest, 0.02 * largest);
        }
    }
    // ∫ p dx and ∫ p x dx of the pressure on the upper plate.
    close(total[0], 40e6, 1e-9 * 40e6);
    close(
        total[1],
        1e8 / 0.4 * 2.0 * 0.2_f64.powi(3) / 3.0,
        1e-6 * 1e6,
    );
}

#[test]
fn blocks_held_by_contact_alone_carry_their_weight() {
    let model = built_in_model("stack", 0);
    for count in [4, 6, 11] {
        let solution = solve(&model, count);
        let warnings = solution.report["warnings"].to_string();
        assert!(warnings.contains("middle block") || warnings.contains("upper block"));
        for (name, load) in [
            ("upper joint", 25e3 * 2.0 + 2e6),
            ("lower joint", 25e3 * 5.0 + 2e6),
        ] {
            let forces = solution.contacts[name].iter().map(|p| p.force);
            close(forces.sum(), load, 1e-11 * load);
        }
    }
}

#[test]
fn reactions_of_a_joint_are_its_load() {
    let text = format!(
        "{}{SUPPORTS}
        [[traction]]
        on = 'upper top'
        value = ['0', '-1e6*x^2']
        {JOINT}",
        BODIES
    );
    let solution = solve(&model(&text, two_blocks().mesh), 5);
    let load = 1e6 / 3.0 * (1.5_f64.powi(3) - 0.5_f64.powi(3));
    close(solution.points().map(|p| p.force).sum(), load, 1e-12 * load);
}
