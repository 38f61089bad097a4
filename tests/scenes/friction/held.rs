//! Bodies held by friction, and bodies that slide off.

use contact_dd_partition::model::Model;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::process::Ended;
use crate::support::scenes::model;
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve, solve_steps};

/// A wide block on a plane inclined by `angle`, under its weight; `law` is the friction of its base.
fn incline(angle: f64, body_force: [f64; 2], law: &str, n: [usize; 2]) -> Model {
    above(0.0, angle, body_force, law, n)
}

/// The same block, lifted above the plane by `gap`.
fn above(gap: f64, angle: f64, body_force: [f64; 2], law: &str, n: [usize; 2]) -> Model {
    let (sin, cos) = angle.sin_cos();
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 0.5], [0.0, 0.5]];
    let turned = corners.map(|[x, y]| [cos * x - sin * y, sin * x + cos * y]);
    let text = format!(
        "plane = 'strain'
        materials.rock = {{young = 20e9, poisson = 0.22}}
        bodies.block = {{material = 'rock', body_force = [{:e}, {:e}]}}
        [[contact]]
        name = 'base'
        sides = ['block bottom']
        {law}
        obstacle = {{point = [{:e}, {:e}], normal = [{:e}, {cos:e}]}}",
        body_force[0],
        body_force[1],
        gap * sin,
        -gap * cos,
        -sin
    );
    model(&text, Blocks::new().quadrilateral("block", turned, n).mesh)
}

fn run(model: &Model, count: usize) -> Ended {
    Case::of(model, count).run(&[])
}

#[track_caller]
fn slides(ended: &Ended, name: &str) {
    assert_eq!(ended.code(), 4, "{}{}", ended.stdout, ended.stderr);
    let [error] = ended.errors()[..] else {
        panic!("{}", ended.stderr);
    };
    assert!(error.contains(&format!("'{name}' slides along")), "{error}");
}

const WEIGHT: f64 = 26e3;

/// Inclined gravity on a level plane, and an inclined plane under vertical gravity.
fn inclines(slope: f64, law: &str, n: [usize; 2]) -> [Model; 2] {
    [
        incline(0.0, [WEIGHT * slope, -WEIGHT], law, n),
        incline(-slope.atan(), [0.0, -WEIGHT], law, n),
    ]
}

#[test]
fn a_block_slides_down_a_plane_that_is_steeper_than_its_friction_angle() {
    for (friction, n) in [(0.1, [4, 2]), (0.6, [40, 10]), (2.5, [7, 30])] {
        let law = format!("friction = {friction}");
        for model in inclines(friction * (1.0 + 1e-12), &law, n) {
            for count in [1, 3] {
                slides(&run(&model, count), "block");
            }
        }
    }
}

#[test]
fn a_block_slides_that_pulls_more_than_given_friction_and_cohesion_hold() {
    // The base is 2 m long, and the block has an area of 1 m²: it weighs 26 kN.
    let pulls = |force: f64, law| run(&incline(0.0, [force, -WEIGHT], law, [8, 2]), 2);
    slides(&pulls(2e4 * (1.0 + 1e-12), "tresca = 1e4"), "block");
    let law = "friction = 0.5\ncohesion = 1e4";
    slides(&pulls(3.3e4 * (1.0 + 1e-12), law), "block");
    // Rigid bodies would stay, but corners that lift lose their cohesion.
    slides(&pulls(3.3e4 * 0.99, law), "block");
}

#[test]
fn a_block_stands_on_a_plane_that_is_less_steep_than_its_friction_angle() {
    for (friction, n) in [(0.1, [4, 2]), (0.6, [40, 10]), (2.5, [7, 30])] {
        let law = format!("friction = {friction}");
        for model in inclines(friction * (1.0 - 1e-12), &law, n) {
            for count in [1, 3] {
                solve(&model, count);
            }
        }
    }
    for model in inclines(0.3, "friction = 0.6", [8, 2]) {
        let solution = solve(&model, 2);
        assert_eq!((solution.closed(), solution.slipping()), (9, 0));
        let total = |k: usize| {
            solution
                .points()
                .map(|p| p.tangential_force[k])
                .sum::<f64>()
        };
        let pressed = solution.points().map(|p| p.force);
        close(total(0).hypot(total(1)) / pressed.sum::<f64>(), 0.3, 1e-12);
    }
}

#[test]
fn given_friction_and_cohesion_hold_a_pull_up_to_their_bounds() {
    let pulls = |force: f64, law| solve(&incline(0.0, [force, -WEIGHT], law, [8, 2]), 2);
    let along = |held: Solution| held.points().map(|p| p.tangential_force[0]).sum();
    for part in [0.1, 0.9, 1.0 - 1e-12] {
        let held = pulls(2e4 * part, "tresca = 1e4");
        close(along(held), -2e4 * part, 1e-8);
    }
    // Corners that lift lose their cohesion.
    for part in [0.1, 0.8] {
        let held = pulls(3.3e4 * part, "friction = 0.5\ncohesion = 1e4");
        close(along(held), -3.3e4 * part, 1e-8);
    }
}

/// The block falls obliquely; its tangential motion before contact causes no friction.
#[test]
fn a_block_that_falls_on_a_plane_stands_on_it_as_one_that_was_there() {
    let n = [8, 2];
    for (angle, body_force, slack) in [
        (0.0, [0.3 * WEIGHT, -WEIGHT], 1e-11),
        (-0.3, [0.0, -WEIGHT], 1e-9),
    ] {
        let on = |gap| above(gap, angle, body_force, "friction = 0.6", n);
        let rests = solve(&on(0.0), 2);
        for gap in [1e-6, 1e-3, 0.1, 10.0] {
            let falls = solve(&on(gap), 2);

            alike(&falls, &rests, slack * (1.0 + gap));
            assert_eq!(falls.slipping(), 0);
        }
    }
}

/// Fails unless both have the same stresses and slip.
#[track_caller]
fn alike(first: &Solution, second: &Solution, slack: f64) {
    let slack = |size: f64| slack * size;
    let (force, size) = (second.largest_force(), second.largest_displacement());
    for (a, b) in first.points().zip(second.points()) {
        close(a.force, b.force, slack(force));
        assert_eq!((a.closed, a.slipping), (b.closed, b.slipping));
        for k in 0..2 {
            close(a.tangential_force[k], b.tangential_force[k], slack(force));
            close(a.slip[k], b.slip[k], slack(size));
        }
    }
}

/// A block pushed up a wedge with tan α = 0.1 at μ = 0.3 by F begins to slide at F/G = (tan α + μ)/(1 − μ tan α) =
/// 0.412371; NAFEMS benchmark CGS-4.
#[test]
fn a_wedge_begins_to_slide_as_the_nafems_benchmark_says() {
    let limit = 0.4 / 0.97;
    close(limit, 0.412_371, 1e-6);
    for (share, code) in [(1.0 - 1e-12, 0), (1.0 + 1e-12, 4), (0.9995, 0), (1.0005, 4)] {
        let forces = [WEIGHT * limit * share, -WEIGHT];
        let model = incline(0.1_f64.atan(), forces, "friction = 0.3\ngap = 0.0", [10, 3]);
        assert_eq!(run(&model, 3).code(), code, "{share}");
    }
}

const PUSHED: &str = "plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
bodies.block = {material = 'rock', body_force = [0.0, -26e3]}
[[contact]]
name = 'base'
sides = ['block bottom']
friction = 0.5
obstacle = {point = [0.0, 0.0], normal = [0.0, 1.0]}
[[contact]]
name = 'right'
sides = ['block right']
obstacle = {point = [2.1, 0.0], normal = [-1.0, 0.0]}
[[contact]]
name = 'left'
sides = ['block left']
obstacle = {point = [-0.2, 0.0], normal = [1.0, 0.0]}
";

/// A step with a pressure on a side of the block: at 26 kPa friction at its base is at its limit.
fn push(side: &str, pressure: f64) -> String {
    format!("[[step]]\n[[step.pressure]]\non = 'block {side}'\nvalue = {pressure:e}\n")
}

/// Checks the position of the centre of the block's base, in every step.
#[track_caller]
fn goes(steps: &[(&str, f64, f64)]) {
    let blocks = Blocks::new().rectangle("block", [0.0, 2.0], [0.0, 0.5], [8, 2]);
    let text = steps
        .iter()
        .map(|&(side, pressure, _)| push(side, pressure));
    let text = PUSHED.to_owned() + &text.collect::<String>();
    let middle = blocks
        .mesh
        .points
        .iter()
        .position(|x| *x == [1.0, 0.0, 0.0]);
    let tag = blocks.mesh.node_tags[middle.unwrap()];
    let solutions = solve_steps(&model(&text, blocks.mesh), 2);
    for (solution, (side, pressure, at)) in solutions.iter().zip(steps) {
        let found = solution.displacement[&tag][0];
        assert!((found - at).abs() < 1e-5, "{side} {pressure}: {found}");
        let base = &solution.contacts["base"];
        let slip = base.iter().find(|p| p.tags[0] == tag).unwrap().slip[0];
        close(slip, found, 1e-15);
    }
}

#[test]
fn a_block_on_a_rough_floor_stays_where_a_push_took_it() {
    goes(&[
        ("left", 20e3, 0.0),
        ("left", 30e3, 0.1),
        ("left", 10e3, 0.1),
        ("right", 20e3, 0.1),
        ("right", 30e3, -0.2),
        ("left", 25e3, -0.2),
        ("left", 60e3, 0.1),
    ]);
}

/// A plate between two fixed plates, pressed by the upper one, is held by twice the friction of either.
#[test]
fn a_plate_between_two_others_is_held_by_friction_alone() {
    let blocks = || {
        Blocks::new()
            .rectangle("lower", [-0.5, 2.5], [0.0, 0.5], [12, 2])
            .rectangle("middle", [0.0, 2.0], [0.5, 1.0], [8, 2])
            .rectangle("upper", [0.0, 2.0], [1.0, 1.5], [8, 2])
    };
    let text = |pull: f64| {
        format!(
            "plane = 'strain'
            materials.rock = {{young = 20e9, poisson = 0.22}}
            bodies.lower.material = 'rock'
            bodies.middle.material = 'rock'
            bodies.upper.material = 'rock'
            [[displacement]]
            on = 'lower bottom'
            x = 0.0
            y = 0.0
            [[displacement]]
            on = 'upper top'
            x = 0.0
            [[pressure]]
            on = 'upper top'
            value = 1e6
            [[pressure]]
            on = 'middle right'
            value = {:e}
            [[contact]]
            name = 'below'
            sides = ['middle bottom', 'lower top']
            friction = 0.3
            [[contact]]
            name = 'above'
            sides = ['middle top', 'upper bottom']
            friction = 0.3",
            -pull / 0.5
        )
    };
    let of = |pull: f64| model(&text(pull), blocks().mesh);
    for pull in [0.0, 0.6e6, 1.1e6] {
        let solution = solve(&of(pull), 4);
        let along = solution.points().map(|p| p.tangential_force[0]);
        close(along.sum(), -pull, 1e-6);
    }
    slides(&run(&of(1.2e6 * (1.0 + 1e-9)), 4), "middle");
}

/// A block between two walls, squeezed by `interference` on either side, above a smooth floor.
fn squeezed(interference: f64, friction: f64, gap: f64) -> Model {
    let blocks = Blocks::new().rectangle("block", [0.0, 1.0], [0.0, 0.5], [6, 3]);
    let text = format!(
        "plane = 'strain'
        materials.rock = {{young = 20e9, poisson = 0.22}}
        bodies.block = {{material = 'rock', body_force = [0.0, {:e}]}}
        [[contact]]
        name = 'left'
        sides = ['block left']
        gap = {:e}
        friction = {friction}
        obstacle = {{point = [0.0, 0.0], normal = [1.0, 0.0]}}
        [[contact]]
        name = 'right'
        sides = ['block right']
        gap = {:e}
        friction = {friction}
        obstacle = {{point = [1.0, 0.0], normal = [-1.0, 0.0]}}
        [[contact]]
        name = 'floor'
        sides = ['block bottom']
        obstacle = {{point = [0.0, {:e}], normal = [0.0, 1.0]}}",
        -WEIGHT, -interference, -interference, -gap
    );
    model(&text, blocks.mesh)
}

/// The walls alone could hold it if their pressure were larger: the rigid-body analysis leaves that to the solver.
#[test]
fn a_block_between_two_walls_hangs_if_they_squeeze_it_enough_and_slides_to_the_floor_if_not() {
    let weight = 0.5 * WEIGHT;
    for (interference, friction, hangs) in
        [(1e-5, 0.3, true), (1e-5, 0.01, false), (0.0, 0.3, false)]
    {
        let solution = solve(&squeezed(interference, friction, 1e-3), 2);
        let on_floor: f64 = solution.contacts["floor"].iter().map(|p| p.force).sum();
        let held: f64 = solution.points().map(|p| p.tangential_force[1]).sum();
        close(on_floor + held, weight, 1e-7);
        assert_eq!(on_floor == 0.0, hangs, "{interference} {friction}");
    }
}

/// Of the positions between walls without contact a block gets the nearest one, without friction from an earlier
/// pressure.
#[test]
fn what_moves_away_from_a_wall_leaves_no_friction_there() {
    for count in [1, 3] {
        let solution = solve(&squeezed(-1e-6, 1.0, 1e-3), count);
        for point in solution.points().filter(|point| !point.closed) {
            assert_eq!(point.tangential_force, [0.0; 3], "{point:?}");
        }
        assert_eq!(solution.closed(), solution.contacts["floor"].len());
    }
}
