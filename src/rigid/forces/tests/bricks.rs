//! Bricks held on each other by friction.

use super::*;

/// A wall of rows of bricks, each under its weight and a sideways push.
fn wall(rows: usize, columns: usize, coefficient: f64, push: impl Fn(usize) -> f64) -> Scene {
    let place = |b: usize| {
        let (i, k) = (b / columns, b % columns);
        let offset = if i.is_multiple_of(2) { 0.0 } else { 0.25 };
        (k as f64 + offset, i as f64 * 0.3)
    };
    let state = |b: usize| {
        let (x, y) = place(b);
        body([x, y, 0.0], [x + 1.0, y + 0.3, 0.0], &[push(b), -1.0, 0.0])
    };
    let bodies: Vec<BodyState> = (0..rows * columns).map(state).collect();
    let (mut normals, mut tangents) = (Vec::new(), Vec::new());
    for upper in 0..bodies.len() {
        let (x, y) = place(upper);
        let below: Vec<Option<usize>> = match upper / columns {
            0 => vec![None],
            _ => (0..upper)
                .filter(|&b| (y - place(b).1 - 0.3).abs() < 0.01 && (place(b).0 - x).abs() < 0.9)
                .map(Some)
                .collect(),
        };
        for lower in below {
            let from = lower.map_or(x, |b| place(b).0.max(x));
            let to = lower.map_or(x + 1.0, |b| (place(b).0 + 1.0).min(x + 1.0));
            for k in 0..5 {
                let at = [from + (to - from) * k as f64 / 4.0, y, 0.0];
                let row = |along: [f64; 3]| {
                    let mut row = bodies[upper].row(upper, at, along);
                    let back = along.map(|c| -c);
                    (row.bodies).extend(
                        lower
                            .into_iter()
                            .flat_map(|b| bodies[b].row(b, at, back).bodies),
                    );
                    row
                };
                let bound = squares::coulomb(coefficient);
                tangents.push(row([1.0, 0.0, 0.0]).rough(normals.len(), bound));
                normals.push(row(DOWN));
            }
        }
    }
    normals.extend(tangents);
    squares::scene(2, bodies, normals)
}

#[test]
fn friction_holds_the_uppermost_brick_of_a_high_stack_to_its_last_digits() {
    let stack = |part: f64| {
        let push = |b: usize| if b == 11 { 0.5 * part } else { 0.0 };
        wall(12, 1, 0.5, push).analyse()
    };
    assert_eq!(stack(1.0 - 1e-11), Ok(RigidMotions::default()));
    let failure = stack(1.0 + 1e-11).unwrap_err();
    assert!(failure.message.contains("'brick 11' slides"), "{failure}");
}

#[test]
fn a_wall_under_a_push_on_every_brick_stands_up_to_its_coefficient() {
    assert_eq!(
        wall(4, 4, 0.5, |_| 0.499).analyse(),
        Ok(RigidMotions::default())
    );
    let failure = wall(4, 4, 0.5, |_| 0.501).analyse().unwrap_err();
    assert!(failure.message.contains("slides"), "{failure}");
}

#[test]
fn however_little_friction_there_is_it_holds_what_it_can_and_no_more() {
    for friction in [1e-8, 1e-5, 1e-2, 1.0] {
        let stack = |part: f64| {
            wall(
                12,
                1,
                friction,
                |b| if b == 11 { part * friction } else { 0.0 },
            )
        };
        assert_eq!(
            stack(0.99).analyse(),
            Ok(RigidMotions::default()),
            "{friction}"
        );
        assert!(stack(1.01).analyse().is_err(), "{friction}");
    }
}
