//! What the report says of forces and moments, against statics.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod support;

use hdf5::File;
use serde_json::Value;

use support::blocks::{Blocks, moved};
use support::close;
use support::scenes::{BODIES, built_in_model, model, two_block_scene, two_blocks};
use support::solution::Solution;
use support::solver::{Case, solve};

/// Force and moment (x, y; about z) of an entry of the report.
fn resultant(entry: &Value) -> [f64; 3] {
    let number = |list: &str, k: usize| entry[list][k].as_f64().unwrap();
    [number("force", 0), number("force", 1), number("moment", 2)]
}

fn named<'a>(solution: &'a Solution, list: &str, key: &str, name: &str) -> &'a Value {
    let entries = solution.report[list].as_array().unwrap();
    let found = entries.iter().find(|entry| entry[key] == name);
    found.unwrap_or_else(|| panic!("{name} isn't in {entries:?}"))
}

/// The pressure 1e6 (1.95 − 1.9 x) on 0.5 ≤ x ≤ 1.5 presses with 0.05e6 in all; its moment about
/// the origin is −∫ x p dx.
#[test]
fn supports_and_contacts_carry_the_load() {
    let model = model(&two_block_scene(), two_blocks().mesh);
    let (force, first, second) = (0.05e6, 1e6 * 1.95, 1e6 * 1.9);
    let moment = -(first * (1.5 * 1.5 - 0.25) / 2.0 - second * (1.5f64.powi(3) - 0.125) / 3.0);
    for count in [2, 7] {
        let solution = solve(&model, count);
        let joint = resultant(named(&solution, "contacts", "name", "joint"));
        let bottom = resultant(named(
            &solution,
            "reactions",
            "support",
            "displacement[1] on 'lower bottom'",
        ));
        let left = resultant(named(
            &solution,
            "reactions",
            "support",
            "displacement[2] on 'upper left'",
        ));
        let slack = 1e-9 * 1e6;
        // The joint is frictionless and level; side a is the upper block's.
        close(joint[0], 0.0, slack);
        close(joint[1], force, slack);
        close(bottom[0], 0.0, slack);
        close(bottom[1], force, slack);
        close(left[1], 0.0, slack);
        close(left[0], 0.0, slack);
        close(moment + left[2] + joint[2], 0.0, slack);
        close(bottom[2], joint[2], slack);
        let of_rows: f64 = solution.points().map(|p| p.force * p.position[0]).sum();
        close(joint[2], of_rows, slack);
        let closed = solution.points().filter(|p| p.closed).count();
        let entry = named(&solution, "contacts", "name", "joint");
        assert_eq!(entry["closed"], closed);
        let largest = solution.points().map(|p| p.pressure).fold(0.0, f64::max);
        assert_eq!(entry["largest_pressure"].as_f64(), Some(largest));
    }
}

/// Two blocks that overlap in part, turned by an angle: a node at an end of the overlap hands over
/// to its neighbour. What acts on the upper one is in balance, moments included.
#[test]
fn a_body_between_load_supports_and_contact_is_balanced() {
    for (n, x, angle) in [
        ([8, 4], [0.5, 1.5], 0.0),
        ([5, 7], [0.35, 2.6], 0.0),
        ([5, 7], [0.35, 2.03], 0.4),
        ([13, 3], [-0.4, 1.9], 2.0),
    ] {
        let (sin, cos) = f64::sin_cos(angle);
        let blocks = Blocks::new()
            .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [n[0], 4])
            .rectangle("upper", x, [1.0, 1.6], [n[1], 4]);
        let mesh = moved(blocks.mesh, |[x, y]| [cos * x - sin * y, sin * x + cos * y]);
        for sides in ["'upper bottom', 'lower top'", "'lower top', 'upper bottom'"] {
            let text = format!(
                "{BODIES}
                [[displacement]]
                on = 'lower bottom'
                x = 0.0
                y = 0.0
                [[bilateral]]
                on = 'upper left'
                [[pressure]]
                on = 'upper top'
                value = '1e6*(1+0.3*sin(x+2*y))'
                [[contact]]
                name = 'joint'
                sides = [{sides}]
                gap = '1e-6*x'"
            );
            let model = model(&text, mesh.clone());
            let solution = solve(&model, 4);
            assert!(solution.closed() > 0);
            let upper = model.mesh.groups["lower"].members.len();
            let upper: Vec<u32> = (upper..model.mesh.cells.len())
                .flat_map(|cell| model.mesh.cells.nodes_of(cell).to_vec())
                .collect();
            let (mut sum, mut scale) = ([0.0; 3], 0.0);
            for (node, [fx, fy, _]) in &model.forces {
                let at = model.mesh.points[*node as usize];
                if upper.contains(node) {
                    let moment = at[0] * fy - at[1] * fx;
                    sum = [sum[0] + fx, sum[1] + fy, sum[2] + moment];
                    scale += fx.abs() + fy.abs();
                }
            }
            let joint = resultant(named(&solution, "contacts", "name", "joint"));
            let left = resultant(named(
                &solution,
                "reactions",
                "support",
                "bilateral[1] on 'upper left'",
            ));
            let sign = if sides.starts_with("'upper") {
                1.0
            } else {
                -1.0
            };
            for k in 0..3 {
                close(sum[k] + left[k] + sign * joint[k], 0.0, 1e-12 * scale);
            }
        }
    }
}

/// The loads on granite: 0.6e7 on the lower right and upper left side, 0.3e7 on top.
#[test]
fn reactions_balance_loads_in_any_number_of_subdomains() {
    let model = built_in_model("granite", 0);
    let mut loads = [0.0; 3];
    for &(node, force) in &model.forces {
        let at = model.mesh.points[node as usize];
        loads[0] += force[0];
        loads[1] += force[1];
        loads[2] += at[0] * force[1] - at[1] * force[0];
    }
    for count in [1, 8, 70] {
        let solution = solve(&model, count);
        let reactions = solution.report["reactions"].as_array().unwrap();
        assert_eq!(reactions.len(), 1);
        for (reaction, load) in resultant(&reactions[0]).iter().zip(loads) {
            close(reaction + load, 0.0, 1e-9 * 3e8);
        }
    }
}

/// A problem file from elsewhere needn't say which condition a support comes from.
#[test]
fn supports_without_names_have_one_reaction() {
    let case = Case::of(&built_in_model("granite", 0), 8);
    let file = File::open_rw(case.problem()).unwrap();
    file.unlink("support/condition").unwrap();
    file.unlink("support/name").unwrap();
    file.close().unwrap();
    let solution = case.solve(&[]);
    let reactions = solution.report["reactions"].as_array().unwrap();
    assert_eq!(reactions.len(), 1);
    assert_eq!(reactions[0]["support"], "supports");
    let [_, up, _] = resultant(&reactions[0]);
    close(up, 3e6 * 10.0, 1e-9 * 3e8);
}
