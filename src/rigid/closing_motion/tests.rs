//! Squares that come to rest at known positions.

use super::*;
use crate::rigid::squares::{coulomb, square};

const DOWN: [f64; 3] = [0.0, -1.0, 0.0];
const UP: [f64; 3] = [0.0, 1.0, 0.0];

/// A floor below the lower corners of a square, with these gaps.
fn floor(body: &BodyState, gaps: [f64; 2]) -> Vec<RigidRow> {
    let row = |(x, gap): (f64, f64)| body.row(0, [x, -1.0, 0.0], DOWN).open(gap);
    [(-1.0, gaps[0]), (1.0, gaps[1])].map(row).to_vec()
}

#[track_caller]
fn close(found: &[f64], expected: &[f64]) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-14, "{found:?}, expected {expected:?}");
    }
}

#[test]
fn a_square_falls_onto_an_uneven_floor_and_leans_on_it() {
    let body = square([0.0, -2.0, 0.1]);
    let rows = floor(&body, [0.1, 0.3]);
    let z = closing_motions(2, std::slice::from_ref(&body), &rows, &[]).remove(0);
    let motions = [z.clone()];
    close(&[0, 1].map(|j| jump(&rows[j], &motions)), &[0.1, 0.3]);
    // It sinks by the mean gap, and turns by the difference of the gaps over the width.
    close(&z[1..], &[-0.2, -0.1 * body.frame.size]);
}

#[test]
fn what_rests_stays() {
    let body = square([0.0, -2.0, 0.1]);
    let rows = floor(&body, [0.0, 0.0]);
    close(&closing_motions(2, &[body], &rows, &[])[0], &[0.0; 3]);
}

#[test]
fn supports_push_no_body_into_another() {
    let body = square([0.0; 3]).held([0.0; 3], UP, -0.4);
    let rows = floor(&body, [0.1, 0.3]);
    close(
        &closing_motions(2, &[body], &rows, &[])[0],
        &[0.0, -0.1, 0.0],
    );
}

#[test]
fn a_body_follows_its_supports() {
    let body = square([0.0, 5.0, 0.0])
        .held([-1.0, 0.0, 0.0], UP, 0.2)
        .held([1.0, 0.0, 0.0], UP, 0.4);
    let turned = 0.1 * body.frame.size;
    let found = closing_motions(2, &[body], &[], &[]);
    close(&found[0], &[0.0, 0.3, turned]);
}

#[test]
fn a_body_without_load_is_pushed_by_the_one_that_falls_on_it() {
    let bodies = [square([0.0, -1.0, 0.0]), square([0.0; 3])];
    let rows = [-1.0, 1.0].map(|x| {
        let mut between = bodies[0].row(0, [x, 0.0, 0.0], DOWN).open(0.5);
        between
            .bodies
            .extend(bodies[1].row(1, [x, 0.0, 0.0], UP).bodies);
        [between, bodies[1].row(1, [x, 0.0, 0.0], DOWN).open(0.25)]
    });
    let rows = rows.concat();
    let motions = closing_motions(2, &bodies, &rows, &[]);
    close(&motions[0], &[0.0, -0.75, 0.0]);
    close(&motions[1], &[0.0, -0.25, 0.0]);
}

/// A floor below the lower corners with a wall on the right, and friction on the floor.
fn rough_floor(body: &BodyState, gap: f64, wall: f64, friction: f64) -> Vec<RigidRow> {
    let mut rows = floor(body, [gap; 2]);
    let right = [1.0, 0.0, 0.0];
    rows.push(body.row(0, right, right).open(wall));
    for (normal, x) in [-1.0, 1.0].into_iter().enumerate() {
        let along = body.row(0, [x, -1.0, 0.0], right);
        rows.push(along.rough(normal, coulomb(friction)));
    }
    rows
}

/// A push on the base, where it has no overturning moment.
fn pushed(push: f64) -> BodyState {
    let frame = square([0.0; 3]).frame;
    let action = frame.action(2, &[0.0, -1.0, 0.0], &[push, -2.0, 0.0]);
    square([action[0], action[1], action[2]])
}

#[test]
fn what_friction_holds_stays_and_what_it_does_not_slides_to_the_wall() {
    for (push, along) in [(0.9, 0.0), (1.1, 0.7)] {
        let body = pushed(push);
        let rows = rough_floor(&body, 0.0, 0.7, 0.5);
        let found = closing_motions(2, &[body], &rows, &[]);
        close(&found[0], &[along, 0.0, 0.0]);
    }
}

#[test]
fn what_falls_askew_onto_a_floor_that_holds_it_rests_without_slip() {
    for (push, along) in [(0.9, 0.0), (1.1, 0.7)] {
        let body = pushed(push);
        let rows = rough_floor(&body, 0.1, 0.7, 0.5);
        let found = closing_motions(2, &[body], &rows, &[]);
        close(&found[0], &[along, -0.1, 0.0]);
    }
}

/// A body is pushed to the wall, released, and pulled back as far as a second wall allows.
#[test]
fn a_body_goes_on_from_where_the_step_before_left_it() {
    let body = pushed(1.1);
    let rows = rough_floor(&body, 0.1, 0.7, 0.5);
    let there = closing_motions(2, std::slice::from_ref(&body), &rows, &[]);
    for push in [-0.9, 0.0, 0.3, 2.0] {
        let found = closing_motions(2, &[pushed(push)], &rows, &there);
        close(&found[0], &[0.7, -0.1, 0.0]);
    }
    let mut both = rows.clone();
    let left = [-1.0, 0.0, 0.0];
    both.push(body.row(0, left, left).open(0.2));
    let found = closing_motions(2, &[pushed(-1.1)], &both, &there);
    close(&found[0], &[-0.2, -0.1, 0.0]);
}

#[test]
fn supports_go_on_from_where_the_step_before_left_them() {
    let body = square([0.0; 3]).held([0.0; 3], UP, 0.4);
    let rows = rough_floor(&body, 0.0, 0.7, 0.5);
    let before = [vec![0.3, 0.1, 0.0]];
    close(
        &closing_motions(2, &[body], &rows, &before)[0],
        &[0.3, 0.4, 0.0],
    );
}
