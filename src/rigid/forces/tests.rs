//! Bodies with and without enough friction to hold them, with known answers.

mod bricks;

use contact_dd_partition::contact_point::LocalFrame;

use crate::contact::friction::ForceBound;
use crate::error::Failure;
use crate::rigid::analysis::RigidMotions;
use crate::rigid::scene::{BodyState, RigidRow, Scene};
use crate::rigid::squares::{self, body};

const FRICTIONLESS: Option<ForceBound> = None;

fn coulomb(coefficient: f64) -> Option<ForceBound> {
    Some(squares::coulomb(coefficient))
}

/// A bound at every point (N).
fn given(cohesion: f64) -> Option<ForceBound> {
    Some(ForceBound {
        cohesion,
        ..ForceBound::default()
    })
}

/// A unit square about the origin or, with a third dimension, a cube.
fn block(load: &[f64]) -> BodyState {
    let z = if load.len() == 6 { 0.5 } else { 0.0 };
    body([-0.5, -0.5, -z], [0.5, 0.5, z], load)
}

/// Points of the block, each with a normal against an obstacle.
fn scene(body: BodyState, points: &[([f64; 3], [f64; 3])], bound: Option<ForceBound>) -> Scene {
    let dim = if body.load.len() == 6 { 3 } else { 2 };
    let normal = |&(at, n): &([f64; 3], [f64; 3])| body.row(0, at, n);
    let mut rows: Vec<RigidRow> = points.iter().map(normal).collect();
    for (j, &(at, n)) in points.iter().enumerate() {
        for &tangent in &LocalFrame::new(n).tangents[..dim - 1] {
            rows.extend(bound.map(|bound| body.row(0, at, tangent).rough(j, bound)));
        }
    }
    squares::scene(dim, vec![body], rows)
}

const DOWN: [f64; 3] = [0.0, -1.0, 0.0];

fn on_floor(load: [f64; 3], bound: Option<ForceBound>) -> Result<RigidMotions, Failure> {
    let corners = [-0.5, 0.1, 0.5].map(|x| ([x, -0.5, 0.0], DOWN));
    scene(block(&load), &corners, bound).analyse()
}

#[track_caller]
fn slides(found: Result<RigidMotions, Failure>, along: &str) {
    let failure = found.unwrap_err();
    let expected = format!("'brick 0' slides along {along}");
    assert!(failure.message.contains(&expected), "{failure}");
    assert_eq!(failure.exit_code(), 4.into());
}

/// The load acts at the middle of the base, so that the block doesn't topple.
#[test]
fn a_block_on_an_incline_slides_from_the_friction_angle_on() {
    for coefficient in [0.03_f64, 0.1, 0.3, 0.6, 1.0, 2.5] {
        for turned in [0.0_f64, 0.3, -1.2, 2.9] {
            let at = |slope: f64| {
                let weight = 1.0 / slope.hypot(1.0);
                let (sin, cos) = turned.sin_cos();
                let turn = |x: f64, y: f64| [cos * x - sin * y, sin * x + cos * y, 0.0];
                let [x, y, _] = turn(slope * weight, -weight);
                let body = block(&[x, y, 0.0]);
                let size = body.frame.size;
                let mut body = body;
                // The force acts at the middle of the base, half a side below the center.
                body.load[2] = 0.5 * slope * weight / size;
                body.load_scale = x.abs() + y.abs();
                let corners = [-0.5, 0.1, 0.5].map(|x| (turn(x, -0.5), turn(0.0, -1.0)));
                let along = turn(1.0, 0.0);
                (scene(body, &corners, coulomb(coefficient)).analyse(), along)
            };
            for below in [0.0, 0.5, 1.0 - 1e-6, 1.0 - 1e-12] {
                let (found, _) = at(coefficient * below);
                assert_eq!(found, Ok(RigidMotions::default()), "{coefficient} {turned}");
            }
            for above in [1.0 + 1e-12, 1.0 + 1e-6, 3.0] {
                let (found, [x, y, _]) = at(coefficient * above);
                let failure = found.unwrap_err();
                assert!(
                    failure.message.contains("'brick 0' slides along"),
                    "{failure}"
                );
                if above > 1.0 + 1e-9 {
                    slides(Err(failure), &format!("({x:.4}, {y:.4})"));
                }
            }
        }
    }
}

#[test]
fn without_friction_the_floor_holds_no_push() {
    let pushed = on_floor([0.1, -1.0, 0.0], FRICTIONLESS);
    assert!(pushed.unwrap_err().message.contains("nothing resists it"));
    assert_eq!(
        on_floor([0.0, -1.0, 0.0], FRICTIONLESS).unwrap().free.len(),
        1
    );
    // Motions that friction can resist aren't free.
    assert_eq!(
        on_floor([0.0, -1.0, 0.0], coulomb(0.1)),
        Ok(RigidMotions::default())
    );
}

/// An expression may give a bound of 0 in places.
#[test]
fn a_law_that_bounds_friction_by_nothing_holds_nothing() {
    for none in [given(0.0), coulomb(0.0)] {
        slides(on_floor([0.1, -1.0, 0.0], none), "(1.0000, 0.0000)");
        assert!(on_floor([0.0, -1.0, 0.0], none).is_ok());
    }
}

#[test]
fn friction_lifts_nothing_and_keeps_nothing_from_toppling() {
    let lifted = on_floor([0.0, 1.0, 0.0], coulomb(0.5)).unwrap_err();
    assert!(lifted.message.contains("is under-constrained"), "{lifted}");
    // A push at half the height topples the block when its moment, push · ½, exceeds the weight's, 1 · ½.
    for (push, topples) in [(0.99, false), (1.01, true)] {
        let found = on_floor([push, -1.0, 0.0], coulomb(2.0));
        assert_eq!(found.is_err(), topples, "{push}");
        let message = found.err().map_or(String::new(), |f| f.message);
        assert!(!message.contains("slides"), "{message}");
    }
}

/// A force drives a wedge out from between two planes, each at this angle to its axis: friction with the tangent of
/// that angle holds at any pressure.
#[test]
fn a_wedge_between_two_frictional_walls_locks_itself_at_the_angle_of_friction() {
    let half: f64 = 0.2;
    let (sin, cos) = half.sin_cos();
    let walls = [
        ([-0.4, 0.1, 0.0], [-cos, -sin, 0.0]),
        ([-0.4, -0.1, 0.0], [-cos, -sin, 0.0]),
        ([0.4, 0.1, 0.0], [cos, -sin, 0.0]),
        ([0.4, -0.1, 0.0], [cos, -sin, 0.0]),
    ];
    let pulled =
        |coefficient| scene(block(&[0.0, 1.0, 0.0]), &walls, coulomb(coefficient)).analyse();
    assert_eq!(pulled(half.tan() * 1.000001), Ok(RigidMotions::default()));
    assert!(pulled(half.tan() * 0.999999).is_err());
    let pressed = scene(block(&[0.0, -1.0, 0.0]), &walls, coulomb(0.0)).analyse();
    assert_eq!(pressed, Ok(RigidMotions::default()));
}

#[test]
fn given_friction_holds_a_pull_up_to_its_bound() {
    let law = given(1e5);
    let floor = |pull: f64| on_floor([pull, -1e6, 0.0], law);
    assert_eq!(floor(3e5 * (1.0 - 1e-12)), Ok(RigidMotions::default()));
    slides(floor(3e5 * (1.0 + 1e-12)), "(1.0000, 0.0000)");
    slides(floor(-4e5), "(-1.0000, 0.0000)");
    // Tresca friction needs no pressure.
    let wall = [
        ([0.5, -0.5, 0.0], [1.0, 0.0, 0.0]),
        ([0.5, 0.5, 0.0], [1.0, 0.0, 0.0]),
    ];
    let hanging = |weight: f64| scene(block(&[1e6, -weight, 0.0]), &wall, law).analyse();
    assert_eq!(hanging(1.9e5), Ok(RigidMotions::default()));
    slides(hanging(2.1e5), "(0.0000, -1.0000)");
}

#[test]
fn cohesion_holds_beside_friction() {
    let law = coulomb(0.5).map(|bound| ForceBound {
        cohesion: 2.0,
        ..bound
    });
    let pushed = |push: f64| on_floor([push, -10.0, push / 2.0_f64.sqrt()], law);
    assert_eq!(pushed(11.0 * (1.0 - 1e-12)), Ok(RigidMotions::default()));
    slides(pushed(11.0 * (1.0 + 1e-12)), "(1.0000, 0.0000)");
}

/// A plate between two clamped ones, pressed against the lower by its load; the upper plate's forces act on it twice.
#[test]
fn what_is_clamped_between_two_plates_is_held_by_friction_alone() {
    let up = [0.0, 1.0, 0.0];
    let both = [
        ([-0.5, -0.5, 0.0], DOWN),
        ([0.5, -0.5, 0.0], DOWN),
        ([-0.5, 0.5, 0.0], up),
        ([0.5, 0.5, 0.0], up),
    ];
    for (plates, held) in [(&both[..], true), (&both[..2], false)] {
        let found = scene(block(&[0.4, -1.0, 0.0]), plates, coulomb(0.3)).analyse();
        assert_eq!(found.is_ok(), held, "{found:?}");
    }
    let found = scene(block(&[0.29, -1.0, 0.0]), &both[..2], coulomb(0.3)).analyse();
    assert_eq!(found, Ok(RigidMotions::default()));
}

/// A bar leans against a wall without friction: friction at the floor holds up to the textbook angle, here a push half
/// as large as the weight.
#[test]
fn friction_at_one_contact_works_beside_another_without() {
    let leaning = |coefficient| {
        let points = [
            ([-0.5, -0.5, 0.0], DOWN),
            ([0.5, 0.5, 0.0], [1.0, 0.0, 0.0]),
        ];
        let mut scene = scene(block(&[0.0, -1.0, 0.0]), &points, coulomb(coefficient));
        // The second point has no friction.
        scene.rows.truncate(3);
        scene.conditions = vec![3];
        scene.analyse()
    };
    assert_eq!(leaning(0.5 * (1.0 + 1e-12)), Ok(RigidMotions::default()));
    assert!(leaning(0.5 * (1.0 - 1e-11)).is_err());
}

/// The incline's direction is arbitrary and agrees with no tangent.
#[test]
fn a_cube_on_an_incline_slides_from_the_friction_angle_on_in_every_direction() {
    let down = [0.0, 0.0, -1.0];
    let corners = [[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]];
    let corners = corners.map(|[x, y]| ([x, y, -0.5], down));
    for direction in [0.0_f64, 0.1, 0.7, 2.0, 3.9] {
        let pushed = |push: f64| {
            let (y, x) = direction.sin_cos();
            let mut body = block(&[push * x, push * y, -1.0, 0.0, 0.0, 0.0]);
            // The load acts on the base.
            let moment = body
                .frame
                .action(3, &[0.0, 0.0, -0.5], &[push * x, push * y, 0.0]);
            body.load[3..].copy_from_slice(&moment[3..]);
            scene(body, &corners, coulomb(0.4)).analyse()
        };
        let held = pushed(0.4 * (1.0 - 1e-9));
        assert_eq!(held, Ok(RigidMotions::default()), "{direction}");
        let found = pushed(0.4 * (1.0 + 1e-9)).unwrap_err();
        assert!(found.message.contains("slides"), "{found}");
    }
}

/// Nine points and a direction that agrees with no tangent and no corner of a polygon.
#[test]
fn a_cube_on_many_points_is_held_up_to_its_friction_along_no_special_direction() {
    let down = [0.0, 0.0, -1.0];
    let along = |k: usize| 0.5 * (k as f64 - 1.0);
    let points: Vec<_> = (0..9)
        .map(|k| ([along(k % 3), along(k / 3), -0.5], down))
        .collect();
    for coefficient in [0.3, 1.7] {
        let pushed = |push: f64| {
            let [x, y] = [0.6 * push, 0.8 * push];
            let mut body = block(&[x, y, -1.0, 0.0, 0.0, 0.0]);
            let moment = body.frame.action(3, &[0.0, 0.0, -0.5], &[x, y, 0.0]);
            body.load[3..].copy_from_slice(&moment[3..]);
            scene(body, &points, coulomb(coefficient)).analyse()
        };
        for below in [0.5, 1.0 - 1e-6, 1.0 - 1e-9, 1.0 - 1e-12] {
            let found = pushed(coefficient * below);
            assert_eq!(found, Ok(RigidMotions::default()), "{below}");
        }
        for above in [1.0 + 1e-6, 1.0 + 1e-3, 1.1, 2.0] {
            let failure = pushed(coefficient * above).unwrap_err();
            assert!(failure.message.contains("slides"), "{failure}");
        }
    }
}

#[test]
fn whatever_friction_there_is_what_presses_is_held() {
    for coefficient in [1e3, 1e6, 1e12, 1e15] {
        for push in [0.0, 0.3, -0.9] {
            let found = on_floor([push, -1.0, 0.0], coulomb(coefficient));
            assert_eq!(found, Ok(RigidMotions::default()), "{coefficient} {push}");
        }
        let lifted = on_floor([0.3, 1.0, 0.0], coulomb(coefficient));
        assert!(lifted.is_err(), "{coefficient}");
        let down = [0.0, 0.0, -1.0];
        let corners = [[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]];
        let corners = corners.map(|[x, y]| ([x, y, -0.5], down));
        for push in [[0.0, 0.0], [0.1, -0.2]] {
            let body = block(&[push[0], push[1], -1.0, 0.0, 0.1, 0.0]);
            let found = scene(body, &corners, coulomb(coefficient)).analyse();
            assert_eq!(found, Ok(RigidMotions::default()), "{coefficient} {push:?}");
        }
    }
}
