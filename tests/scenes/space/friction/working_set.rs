//! Many contact points with friction, most of which stay open and are left out of the solution.

use contact_dd_partition::element::ElementKind::Hexahedron8;

use super::BODY;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::solid;
use crate::support::solution::{Solution, datasets};
use crate::support::solver::Case;

/// A block with a curved bottom, pressed onto a plane and then sheared by `push` (Pa): only springs at the top hold it
/// without friction, and they don't rotate it.
fn curved(push: f64) -> Case {
    let below = |x: f64| 2e-3 * (x - 0.2).powi(2);
    let curved = |[x, y, z]: [f64; 3]| {
        let [x, z] = [x - 0.5, 0.8 * z];
        [x, y, z.max(below(x))]
    };
    let mesh = solid("block", Hexahedron8, [36, 32, 2], curved);
    let text = format!(
        "{BODY}
        [[spring]]
        on = 'block z1'
        normal = 1e6
        tangential = 1e9
        [[traction]]
        on = 'block z1'
        value = [0.0, 0.0, -1e6]
        [[contact]]
        name = 'floor'
        sides = ['block z0']
        obstacle = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
        friction = 0.6
        [[step]]
        name = 'press'
        [[step]]
        name = 'push'
        [[step.traction]]
        on = 'block z1'
        value = [{push:?}, 0.0, -1e6]"
    );
    Case::of(&model(&text, mesh), 8)
}

/// The steps of a run, and the number of points included in the solution.
fn run(case: &Case, ranks: usize, args: &[&str]) -> (Vec<Solution>, usize) {
    let ended = case.run_on(ranks, args);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let report = Solution::read_report(&case.result());
    let why = report["interface_choice"].as_str().unwrap().to_owned();
    let all = 37 * 33;
    let solved_for = why.split("only ").nth(1).map_or(all, |rest| {
        let [few, of] = [0, 2].map(|i| rest.split(' ').nth(i).unwrap().parse().unwrap());
        assert_eq!(of, all, "{why}");
        few
    });
    (Solution::increments(&case.result(), true), solved_for)
}

#[test]
fn points_that_stay_open_are_left_out_and_change_nothing() {
    let case = curved(6e5);
    let (steps, few) = run(&case, 1, &[]);
    let bits = datasets(&case.result());
    run(&case, 3, &[]);
    assert!(datasets(&case.result()) == bits, "on 3 ranks");
    // A limit on sweeps applies with all points included.
    let (of_all, all) = run(&case, 2, &["--max-sweeps", "50"]);
    assert_eq!(all, 37 * 33);
    // Friction rotates the block, so that additional points close, compared with no friction: they were included in the
    // second step.
    let (_, at_first) = run(&curved(0.0), 1, &[]);
    assert!(at_first < few && few < all, "{at_first} < {few} < {all}");
    for (one, other) in steps.iter().zip(&of_all) {
        one.check_certificate();
        assert_eq!(one.closed(), other.closed());
        assert_eq!(one.slipping(), other.slipping());
        let (length, force) = (other.largest_displacement(), other.largest_force());
        for (tag, u) in &other.displacement {
            (0..3).for_each(|k| close(one.displacement[tag][k], u[k], 1e-10 * length));
        }
        for (point, of_other) in one.points().zip(other.points()) {
            close(point.gap, of_other.gap, 1e-10 * length);
            close(point.force, of_other.force, 1e-9 * force);
            for k in 0..3 {
                close(point.slip[k], of_other.slip[k], 1e-10 * length);
                let [a, b] = [point, of_other].map(|p| p.tangential_force[k]);
                close(a, b, 1e-9 * force);
            }
        }
    }
    assert!(steps[1].closed() > steps[0].closed() / 2 && steps[1].slipping() > 0);
}
