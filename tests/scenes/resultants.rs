//! Forces and moments in the report, compared with equilibrium.

use hdf5::File;
use serde_json::Value;

use crate::support::blocks::{Blocks, moved};
use crate::support::close::close;
use crate::support::scenes::{BODIES, HELD, built_in_model, model, two_block_scene, two_blocks};
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve};

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

/// The pressure 1e6 (1.95 − 1.9 x) on 0.5 ≤ x ≤ 1.5 has the resultant 0.05e6; its moment about the origin is −∫ x p dx.
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
        // The joint is frictionless and horizontal; side a belongs to the upper block.
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

/// Two partly overlapping blocks, rotated by an angle: a node at an end of the overlap passes its part on to its
/// neighbour. The forces on the upper block are in equilibrium, including moments.
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
                "{BODIES}{HELD}
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

/// A problem file of another program may lack the boundary conditions of supports.
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

/// The load above a bed joint of the wall is 18e3 × 1.25 × 0.125 N/m per course and 50e3 × 1.25 N/m. Head joints press
/// along x, with the force of the pillars at both ends.
#[test]
fn the_joints_of_the_wall_carry_what_is_above_them() {
    let solution = solve(&built_in_model("wall", 0), 33);
    let force = |name: &str| resultant(named(&solution, "contacts", "name", name));
    let (course, load, slack) = (18e3 * 1.25 * 0.125, 50e3 * 1.25, 1e-4);
    let [x, y, _] = force("ground");
    close(x, 0.0, slack);
    close(y, load + 6.0 * course, slack);
    for below in 1..=5 {
        let [x, y, moment] = force(&format!("bed joint {below}"));
        close(x, 0.0, slack);
        close(y, load + f64::from(6 - below) * course, slack);
        // The wall is symmetric.
        close(moment, 0.625 * y, slack);
    }
    let pillars = resultant(named(
        &solution,
        "reactions",
        "support",
        "bilateral[1] on 'left end', 'right end'",
    ));
    close(pillars[0], 0.0, slack);
}

/// Flanks press along the line of action, a tangent of the base circle: P r_b = M. The largest pressure of each pair
/// follows from Hertz with its force and radii, r₁ sin α ± s and r₂ sin α ∓ s at half a base pitch s from the pitch
/// point, and moments are proportional to numbers of teeth.
#[test]
fn gears_transmit_the_torque_and_press_as_hertz_says() {
    let solution = solve(&built_in_model("gears", 0), 8);
    let (module, alpha, torque) = (5e-3, 20_f64.to_radians(), 30e3);
    let radii = [17.0, 24.0].map(|teeth| 0.5 * module * teeth);
    let along = 0.5 * std::f64::consts::PI * module * alpha.cos();
    let stiffness = 210e9 / (2.0 * (1.0 - 0.3 * 0.3));
    let mut moments = 0.0;
    for (name, s) in [("approach", -along), ("recess", along)] {
        let pair = named(&solution, "contacts", "name", name);
        let [x, y, moment] = resultant(pair);
        let force = x.hypot(y);
        close(moment / (force * radii[0] * alpha.cos()), -1.0, 2e-4);
        close(x / y, alpha.tan(), 1e-2);
        let curvatures = [radii[0], radii[1]].map(|r| r * alpha.sin());
        let curvature = 1.0 / (curvatures[0] + s) + 1.0 / (curvatures[1] - s);
        let largest = (force * stiffness * curvature / std::f64::consts::PI).sqrt();
        let pressure = pair["largest_pressure"].as_f64().unwrap();
        close(pressure / largest, 1.0, 5e-3);
        moments += moment;
    }
    close(moments / torque, -1.0, 1e-7);
    let rim = named(
        &solution,
        "reactions",
        "support",
        "displacement[1] on 'rim'",
    );
    let [_, y, moment] = resultant(rim);
    let about_wheel = moment - (radii[0] + radii[1]) * y;
    close(about_wheel / torque, 24.0 / 17.0, 1e-3 * 24.0 / 17.0);
}
