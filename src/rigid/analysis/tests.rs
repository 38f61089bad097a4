//! Scenes of a few blocks with known answers.

use super::*;
use crate::rigid::closing_motion::closing_motions;
use crate::rigid::squares::{body, coulomb, scene};

const DOWN: [f64; 3] = [0.0, -1.0, 0.0];

/// The unit square.
fn square(load: [f64; 3]) -> BodyState {
    body([0.0; 3], [1.0, 1.0, 0.0], &load)
}

fn floor(body: &BodyState, xs: &[f64]) -> Vec<RigidRow> {
    let row = |&x: &f64| body.row(0, [x, 0.0, 0.0], DOWN);
    xs.iter().map(row).collect()
}

fn analyse(body: BodyState, rows: Vec<RigidRow>) -> Result<RigidMotions, Failure> {
    scene(2, vec![body], rows).analyse()
}

#[test]
fn a_block_on_the_floor_slides_freely_and_is_pinned_once() {
    let block = square([0.0, -3.0, 0.0]);
    let rows = floor(&block, &[0.0, 0.5, 1.0]);
    let motions = analyse(block, rows).unwrap();
    assert_eq!(motions.fixing_dofs.len(), 1);
    assert_eq!(motions.fixing_dofs[0].component, 0);
    assert!(motions.warnings[0].contains("'brick 0'"));
}

#[test]
fn a_pushed_block_slides_and_is_named() {
    let block = square([0.1, -3.0, 0.0]);
    let rows = floor(&block, &[0.0, 1.0]);
    let failure = analyse(block, rows).unwrap_err();
    assert!(failure.message.contains("'brick 0'"), "{failure}");
    assert!(
        failure
            .message
            .contains("translation along (1.0000, 0.0000)")
    );
}

#[test]
fn a_lifted_block_and_a_toppling_one_have_no_equilibrium() {
    let lifted = square([0.0, 1.0, 0.0]);
    let rows = floor(&lifted, &[0.0, 1.0]);
    assert!(analyse(lifted, rows.clone()).is_err());
    let toppling = square([0.0, -1.0, -3.0]);
    assert!(analyse(toppling, rows.clone()).is_err());
    let steady = square([0.0, -1.0, -0.5]);
    assert!(analyse(steady, rows).is_ok());
}

/// Blocks on top of each other, the lowest on the ground; the joints are tilted by about `slope` with alternating sign.
/// Each block is pushed sideways by a fraction of its joint's resistance.
fn tower(count: usize, slope: f64, unit: f64, push: f64) -> Scene {
    let state = |i: usize| {
        let (low, high) = (i as f64 * unit, (i as f64 + 1.0) * unit);
        let aside = slope * push * if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let load = [aside, -1.0, 0.0];
        BodyState {
            load_scale: 1.0,
            ..body([0.0, low, 0.0], [2.0 * unit, high, 0.0], &load)
        }
    };
    let bodies: Vec<BodyState> = (0..count).map(state).collect();
    let nodes = 6;
    let row = |k: usize| {
        let (i, node) = (k / nodes, k % nodes);
        let at = [
            2.0 * unit * node as f64 / (nodes - 1) as f64,
            i as f64 * unit,
            0.0,
        ];
        let tilt = slope * if node % 2 == 0 { 1.0 } else { -1.0 };
        let normal = [tilt, -1.0, 0.0].map(|c| c / tilt.hypot(1.0));
        let back = normal.map(|c| -c);
        let mut row = bodies[i].row(i, at, normal);
        if i > 0 {
            let below = bodies[i - 1].row(i - 1, at, back);
            row.bodies.extend(below.bodies);
        }
        row
    };
    let rows: Vec<RigidRow> = (0..count * nodes).map(row).collect();
    scene(2, bodies, rows)
}

#[test]
fn rough_joints_hold_a_tower_however_high_and_in_any_unit() {
    let stands = |count, slope, unit| {
        let motions = tower(count, slope, unit, 0.3).analyse();
        assert_eq!(motions, Ok(RigidMotions::default()), "{count} {slope}");
        // This push is more than round-off, and more than the joints resist.
        if slope >= 1e-6 {
            let pushed = tower(count, slope, unit, 30.0).analyse();
            assert!(pushed.is_err(), "{count} {slope}");
        }
    };
    for count in [1, 2, 5, 12] {
        for slope in [1e-2, 1e-4, 1e-5, 1e-6, 1e-7] {
            for unit in [1e-3, 1.0, 1e3] {
                stands(count, slope, unit);
            }
        }
    }
    // A tower of 50 blocks takes seconds.
    for (slope, unit) in [(1e-2, 1e3), (1e-5, 1.0), (1e-7, 1e-3)] {
        stands(50, slope, unit);
    }
}

/// Cubes on top of each other, the lowest on the ground, with friction in their joints if there is a coefficient; the
/// uppermost one is pushed sideways.
fn cubes(count: usize, friction: Option<f64>, push: f64) -> Scene {
    let state = |i: usize| {
        let (z, push) = (i as f64, if i + 1 == count { push } else { 0.0 });
        let load = [push, 0.0, -1.0, 0.0, 0.0, 0.0];
        body([0.0, 0.0, z], [1.0, 1.0, z + 1.0], &load)
    };
    let bodies: Vec<BodyState> = (0..count).map(state).collect();
    let mut rows = Vec::new();
    for i in 0..count {
        let row = |x: [f64; 2], along: [f64; 3]| {
            let at = [x[0], x[1], i as f64];
            let mut row = bodies[i].row(i, at, along);
            if i > 0 {
                let below = bodies[i - 1].row(i - 1, at, along.map(|c| -c));
                row.bodies.extend(below.bodies);
            }
            row
        };
        for x in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
            let normal = rows.len();
            rows.push(row(x, [0.0, 0.0, -1.0]));
            for along in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
                rows.extend(friction.map(|mu| row(x, along).rough(normal, coulomb(mu))));
            }
        }
    }
    scene(3, bodies, rows)
}

/// Height of a tower that sparse matrices analyse.
const HIGH: usize = 100;

#[test]
fn every_cube_of_a_smooth_tower_slides_and_turns_by_itself() {
    let tower = cubes(HIGH, None, 0.0);
    let motions = tower.analyse().unwrap();
    assert_eq!(motions.free.len(), 3 * HIGH);
    assert!(motions.free.iter().all(|motion| motion.bodies.len() == 1));
    assert_eq!(motions.fixing_dofs.len(), 3 * HIGH);
    let closing = closing_motions(3, &tower.bodies, &tower.rows, &[]);
    assert!(closing.iter().flatten().all(|z| *z == 0.0));
    let pushed = cubes(HIGH, None, 0.01).analyse().unwrap_err().message;
    let last = HIGH - 1;
    let expected = format!(
        "body 'brick {last}' is under-constrained: its rigid-body motion, translation along (1.0000"
    );
    assert!(pushed.starts_with(&expected), "{pushed}");
}

#[test]
fn friction_holds_the_uppermost_cube_of_a_tower_up_to_its_coefficient() {
    let stands = |count, push| {
        let tower = cubes(count, Some(0.5), push);
        assert_eq!(tower.analyse(), Ok(RigidMotions::default()), "{count}");
        let closing = closing_motions(3, &tower.bodies, &tower.rows, &[]);
        assert!(closing.iter().flatten().all(|z| *z == 0.0), "{count}");
    };
    stands(12, 0.4);
    stands(HIGH, 0.0);
    let slides = cubes(12, Some(0.5), 0.7).analyse().unwrap_err().message;
    assert!(slides.starts_with("body 'brick 11' slides"), "{slides}");
}

/// Slopes of 1e-5 and 2e-5 hold the block; an excess of 3e-10 of the load is below the tolerance, but is reported.
#[test]
fn a_load_that_contact_hardly_fails_to_hold_is_told() {
    for (beyond, told) in [(0.0, false), (3e-10, true)] {
        let block = square([2e-5 + beyond, -1.0, 0.0]);
        let row = |slope: f64| block.row(0, block.frame.center, [slope, -1.0, 0.0]);
        let rows = vec![row(1e-5), row(2e-5)];
        let warnings = analyse(block, rows).unwrap().warnings;
        let found = warnings
            .iter()
            .any(|w| w.contains("of the total; treated as round-off"));
        assert_eq!(found, told, "{warnings:?}");
    }
}

#[test]
fn a_supported_body_is_left_alone() {
    let ([x, y], origin) = ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [0.0; 3]);
    let body = square([5.0, 1.0, 2.0])
        .held(origin, x, 0.0)
        .held(origin, y, 0.0)
        .held(x, y, 0.0);
    let motions = analyse(body, vec![]).unwrap();
    assert_eq!(motions, RigidMotions::default());
}
