//! Load steps: each has the solution of its own loads, independent of earlier steps.

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, joined};
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::{
    BODIES, JOINT, LOAD, SUPPORTS, at_step, model, two_block_scene, two_blocks,
};
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve};

/// Increasing and decreasing, other loads, the opposite sign, and the loads of the first step again.
const STEPS: &str = "
[[step]]
name = 'a little'
scale = 0.1
[[step]]
scale = 2
[[step]]
scale = { pressure = 0.5, displacement = 3.0 }
[[step.pressure]]
on = 'upper top'
value = '1e6*(0.1+1.9*x)'
[[step.traction]]
on = 'upper right'
value = ['-4e5*y', 1e5]
[[step]]
[step.body_force]
upper = [-3e4, -8e4]
[[step]]
name = 'a little again'
scale = 0.1
";

/// Solves all steps of `model` in `count` subdomains.
#[track_caller]
fn solved(model: &Model, count: usize, args: &[&str]) -> Vec<Solution> {
    let case = Case::of(model, count);
    let ended = case.run(args);
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    let steps = Solution::steps(&case.result());
    assert_eq!(steps.len(), model.steps.len());
    steps.iter().for_each(Solution::check_certificate);
    steps
}

/// Fails unless every step has the reference's solution for its loads alone; returns the numbers of closed constraints.
#[track_caller]
fn agrees(model: &Model, count: usize, args: &[&str]) -> Vec<usize> {
    let steps = solved(model, count, args);
    for (k, solution) in steps.iter().enumerate() {
        let model = at_step(model, k);
        compare(&model, &Monolithic::new(&model), solution);
    }
    steps.iter().map(Solution::closed).collect()
}

#[test]
fn every_step_is_the_monolithic_solution_of_its_own_loads() {
    let two = model(&format!("{}{STEPS}", two_block_scene()), two_blocks().mesh);
    for method in ["newton", "anderson"] {
        let closed = agrees(&two, 6, &["--method", method, "--tolerance", "1e-12"]);
        // Scaling the loads changes no contact status; the other steps do.
        assert_eq!((closed[0], closed[0]), (closed[1], closed[4]));
        assert!(
            closed[2] != closed[0] && closed[3] != closed[0],
            "{closed:?}"
        );
    }
}

#[test]
fn prescribed_displacements_are_loads() {
    let text = format!(
        "{BODIES}{SUPPORTS}
        [[displacement]]
        on = 'upper top'
        y = '-1e-4*(x-0.5)'
        {JOINT}
        gap = '1e-5*x^2'
        [[step]]
        [[step]]
        scale = 0.05
        [[step]]
        [[step.displacement]]
        on = 'lower bottom'
        x = '1e-5*x'
        y = 2e-5
        [[step.displacement]]
        on = 'upper left'
        x = '1e-5*(y-1)'
        [[step.displacement]]
        on = 'upper top'
        y = -3e-5"
    );
    let closed = agrees(&model(&text, two_blocks().mesh), 6, &[]);
    assert_eq!(closed, [9, 0, 9]);
}

/// The prescribed side of a contact is part of its normal jump, and the supports are inclined.
#[test]
fn constants_of_normal_jumps_follow_the_steps() {
    let text = format!(
        "{BODIES}
        [[displacement]]
        on = ['lower bottom', 'lower top']
        x = 0.0
        y = 1e-5
        [[displacement]]
        on = 'upper left'
        x = 0.0
        {LOAD}{JOINT}
        [[step]]
        [[step]]
        scale = {{ displacement = -2, pressure = 1.5 }}
        [[step]]
        scale = {{ displacement = 40 }}
        body_force = {{ upper = [0.0, -1e5] }}"
    );
    agrees(&model(&text, two_blocks().mesh), 4, &[]);
}

/// The corner of a block lies in that of two walls and on a third one across: three constraints on a node, of which the
/// tightest ones become unknowns. Which ones these are changes with the closing motion.
#[test]
fn conditions_that_depend_on_others_follow_the_steps() {
    let blocks = Blocks::new().rectangle("block", [0.01, 1.01], [0.02, 1.02], [8, 8]);
    let wall = |name: &str, on: &str, point: &str, normal: &str| {
        format!(
            "[[contact]]
            name = '{name}'
            sides = ['block {on}']
            obstacle = {{ point = {point}, normal = {normal} }}\n"
        )
    };
    let text = format!(
        "plane = 'strain'
        materials.rock = {{young = 2e9, poisson = 0.22}}
        bodies.block = {{material = 'rock', body_force = [-1e4, -25e3]}}
        {}{}{}
        [[step]]
        [[step]]
        body_force = {{ block = [-25e3, -1e4] }}
        [[step]]
        scale = 3",
        wall("floor", "bottom", "[0.0, 0.0]", "[0.0, 1.0]"),
        wall("wall", "left", "[0.0, 0.0]", "[1.0, 0.0]"),
        wall("slope", "bottom", "[0.005, 0.0]", "[1.0, 1.0]"),
    );
    alike(&model(&text, blocks.mesh), 4);
}

/// Fails unless every step has the contact forces and gaps of its loads alone.
#[track_caller]
fn alike(model: &Model, count: usize) {
    for (k, solution) in solved(model, count, &[]).iter().enumerate() {
        let alone = solve(&at_step(model, k), count);
        let (force, size) = (alone.largest_force(), alone.largest_displacement());
        assert!(alone.closed() > 0);
        for (a, b) in solution.points().zip(alone.points()) {
            assert!(
                (a.force - b.force).abs() <= 1e-10 * force,
                "{k}: {a:?}, {b:?}"
            );
            assert!((a.gap - b.gap).abs() <= 1e-11 * size, "{k}: {a:?}, {b:?}");
        }
    }
}

/// A block that falls by ten times its height.
#[test]
fn bodies_that_fall_fall_anew_in_every_step() {
    let blocks = Blocks::new().rectangle("block", [0.0, 1.0], [10.0, 11.0], [8, 8]);
    let text = "
        plane = 'strain'
        materials.rock = {young = 20e9, poisson = 0.22}
        bodies.block = {material = 'rock', body_force = [0.0, -25e3]}
        [[displacement]]
        on = 'block left'
        x = 0.0
        [[contact]]
        name = 'floor'
        sides = ['block bottom']
        obstacle = { point = [0.0, 0.0], normal = [0.0, 1.0] }
        [[step]]
        [[step]]
        [[step.traction]]
        on = 'block top'
        value = [0.0, '-1e5*x']
        [[step]]
        scale = { body_force = 2 }";
    let falling = model(text, blocks.mesh);
    alike(&falling, 4);
    let steps = solved(&falling, 4, &[]);
    assert!(steps.iter().all(|s| s.largest_displacement() > 9.9));
}

#[test]
fn a_step_with_the_loads_of_the_one_before_needs_no_sweep() {
    let text = format!(
        "{}[[step]]\n[[step]]\n[[step]]\nscale = 1.001",
        two_block_scene()
    );
    let steps = solved(&model(&text, two_blocks().mesh), 6, &[]);
    let work = |k: usize| -> u64 { steps[k].report["active_set_iterations"].as_u64().unwrap() };
    assert_eq!([1, 2].map(|k| steps[k].sweeps()), [0, 1]);
    assert!(work(2) < work(0), "{} and {}", work(0), work(2));
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-11 * steps[0].largest_force();
    let mut both = steps[0].points().zip(steps[1].points());
    assert!(both.all(|(a, b)| close(a.force, b.force)));
}

/// One box on another, whose top is pushed down on one side and turned.
const PUSHED_BOXES: &str = "
materials.rock = {young = 20e9, poisson = 0.25}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
[[displacement]]
on = 'lower z0'
x = 0
y = 0
z = 0
[[displacement]]
on = 'upper z1'
x = '1.2e-5*(1+y)'
y = '6e-6*(1-x)'
z = '-1e-4*(1-1.6*x)'
[[contact]]
name = 'joint'
sides = ['upper z0', 'lower z1']
";

/// Ten equal increments of load with friction, along which no status changes after the first one.
#[test]
fn steps_continue_from_the_statuses_and_slips_before() {
    let steps: String = (1..=10)
        .map(|k| format!("[[step]]\nscale = {}\n", f64::from(k) / 10.0))
        .collect();
    let plane = format!("{}friction = 0.2\n{steps}", two_block_scene());
    let space = format!("{PUSHED_BOXES}friction = 0.3\n{steps}");
    let below = solid("lower", Hexahedron8, [4, 4, 2], between([0.0; 3], [1.0; 3]));
    let at = between([0.0, 0.0, 1.0], [1.0, 1.0, 2.0]);
    let boxes = joined(below, solid("upper", Hexahedron8, [4, 4, 2], at));
    for (model, most) in [
        (model(&plane, two_blocks().mesh), 4.0),
        (model(&space, boxes), 3.0),
    ] {
        let steps = solved(&model, 4, &["--interface", "direct"]);
        let solves = |step: &Solution| step.report["linear_solves"].as_f64().unwrap();
        let all: f64 = steps.iter().map(solves).sum();
        assert!(
            all <= most * solves(&steps[0]),
            "{all} of {}",
            solves(&steps[0])
        );
        for (k, step) in steps.iter().enumerate() {
            let slipping = &step.report["friction"]["slipping"];
            assert!(slipping.as_u64() > Some(0), "step {k}");
        }
        agrees_in_proportion(&steps);
    }
}

/// Fails unless displacements grow in proportion to the steps' numbers.
fn agrees_in_proportion(steps: &[Solution]) {
    let largest = steps[0].largest_displacement();
    for (k, step) in steps.iter().enumerate() {
        let times = k as f64 + 1.0;
        for (tag, u) in &step.displacement {
            let first = steps[0].displacement[tag];
            assert!((0..3).all(|i| (u[i] - times * first[i]).abs() < 1e-11 * times * largest));
        }
    }
}

#[test]
fn the_report_names_steps_and_ends_with_the_last_one() {
    let text = format!("{}{STEPS}", two_block_scene());
    let case = Case::of(&model(&text, two_blocks().mesh), 6);
    assert_eq!(case.run(&[]).code(), 0);
    let report = Solution::read_report(&case.result());
    let steps = report["steps"].as_array().unwrap();
    let names: Vec<&str> = steps.iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["a little", "2", "3", "4", "a little again"]);
    let times: Vec<f64> = steps.iter().map(|s| s["time"].as_f64().unwrap()).collect();
    assert_eq!(times, [1.0, 2.0, 3.0, 4.0, 5.0]);
    let last = &steps[4];
    for key in ["active_contacts", "contacts", "reactions", "error_estimate"] {
        assert_eq!(report[key], last[key], "{key}");
    }
    let sweeps: u64 = steps.iter().map(|s| s["sweeps"].as_u64().unwrap()).sum();
    assert_eq!(report["sweeps"], sweeps);
    let worst = steps
        .iter()
        .map(|s| s["certificate"]["equilibrium"].as_f64().unwrap());
    let worst = worst.fold(0.0, f64::max);
    assert_eq!(report["certificate"]["equilibrium"].as_f64(), Some(worst));
}
