use super::*;
use crate::contact::tangent::ForceBound;

fn unknown(number: usize, factor: f64) -> JumpOf {
    JumpOf::Unknown { number, factor }
}

fn conditions<'a>(
    of: &'a [JumpOf],
    gaps: &'a [f64],
    areas: &'a [f64],
    friction: &'a [TangentialCondition],
) -> Conditions<'a> {
    Conditions {
        of,
        gaps,
        areas,
        friction,
        scale: 0.1,
        round_off: &[1e-14; 16][..of.len()],
    }
}

fn limits(gap: f64) -> Limits {
    let combination = JumpOf::Combination(vec![(0, 1.0), (1, -2.0)]);
    let of = [
        unknown(0, 1.0),
        combination,
        unknown(1, 1.0),
        unknown(1, 2.0),
    ];
    Limits::new(2, conditions(&of, &[gap, 2.5, 8.0, 6.0], &[1.0; 4], &[]))
}

#[test]
fn the_tightest_condition_bounds_a_normal_jump() {
    let limits = limits(1.0);
    assert_eq!(limits.bounds, [1.0, 3.0, 2.5]);
    assert_eq!(limits.forces(&[7.0, 8.0, 9.0]), [7.0, 9.0, 0.0, 4.0]);
    assert_eq!(
        limits.closed([true, false, true]),
        [true, true, false, false]
    );
}

#[test]
fn pairs_that_are_joined_keep_their_conditions() {
    let joined = Limits::join(&[limits(1.0), limits(2.0)]);
    assert_eq!(joined.bounds, [1.0, 3.0, 2.0, 3.0, 2.5, 2.5]);
    assert_eq!(joined.defining, [0, 2, 4, 6]);
    assert_eq!(joined.rows.row(1), [(2, 1.0), (3, -2.0)]);
    let forces = joined.forces(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(forces, [1.0, 5.0, 0.0, 1.0, 3.0, 6.0, 0.0, 2.0]);
}

/// Two points whose nodes an equation joins, and a third with another gap: the first two have one pressure, and the
/// friction of both.
#[test]
fn conditions_with_one_bound_share_the_force_by_their_areas() {
    let of = [
        unknown(0, 1.0),
        unknown(0, 1.0),
        unknown(0, 1.0),
        unknown(1, 1.0),
        unknown(1, 1.0),
        unknown(1, 1.0),
    ];
    let friction: Vec<TangentialCondition> = (0..3)
        .map(|normal| TangentialCondition {
            number: 3 + normal,
            normal,
            bound: ForceBound {
                coefficient: 0.3,
                cohesion: [1.0, 3.0, 1.0][normal],
                only_closed: true,
            },
        })
        .collect();
    let gaps = [0.5, 0.5, 0.6, 0.0, 0.0, 0.0];
    let areas = [1.0, 3.0, 1.0, 1.0, 3.0, 1.0];
    let limits = Limits::new(2, conditions(&of, &gaps, &areas, &friction));
    assert_eq!(limits.bounds, [0.5, 0.0, 0.0]);
    let [first, third] = [0, 1].map(|k| limits.tangents[k].bound);
    assert_eq!((first.coefficient, first.cohesion), (0.3, 4.0));
    assert_eq!(third.cohesion, 1.0);
    let forces = limits.forces(&[8.0, -4.0, 0.5]);
    assert_eq!(forces, [2.0, 6.0, 0.0, -1.0, -3.0, 0.5]);
    assert_eq!(limits.of_limits(&forces), [8.0, -4.0, 0.5]);
    assert_eq!(
        limits.closed([true, true, false]),
        [true, true, false, true, true, false]
    );
    let mut jumps = [4.0, 0.0, 7.0, 0.0, 8.0, 9.0];
    limits.share_jumps(&mut jumps);
    assert_eq!(jumps, [1.0, 1.0, 7.0, 6.0, 6.0, 9.0]);
}

/// Nodes with different coefficients, one without friction, beside one with a smaller gap or none.
#[test]
fn conditions_that_share_a_jump_slip_under_the_strength_of_all() {
    let of = [
        unknown(0, 1.0),
        unknown(0, 1.0),
        unknown(0, 1.0),
        unknown(1, 1.0),
        unknown(1, 1.0),
    ];
    let friction = |[first, second]: [f64; 2]| {
        let tangential = |(number, normal, coefficient): (usize, usize, f64)| TangentialCondition {
            number,
            normal,
            bound: ForceBound {
                coefficient,
                cohesion: 0.0,
                only_closed: true,
            },
        };
        [(3, 1, first), (4, 2, second)].map(tangential)
    };
    let areas = [2.0, 1.0, 5.0, 1.0, 5.0];
    let of_gaps = |gaps: &[f64; 5], friction: &[TangentialCondition]| {
        Limits::new(2, conditions(&of, gaps, &areas, friction))
    };
    let limits = of_gaps(&[0.5, 0.5, 0.5, 0.0, 0.0], &friction([0.8, 0.32]));
    assert_eq!(limits.tangents.len(), 1);
    assert_eq!(limits.tangents[0].normal, Some(0));
    // 1/8 of the pressing force under 0.8, 5/8 under 0.32.
    assert!((limits.tangents[0].bound.coefficient - 0.3).abs() < 1e-15);
    let forces = limits.forces(&[8.0, 2.4]);
    for (force, expected) in forces.iter().zip([2.0, 1.0, 5.0, 0.8, 1.6]) {
        assert!((force - expected).abs() < 1e-14, "{forces:?}");
    }
    // The first alone is closed.
    let limits = of_gaps(&[0.4, 0.5, 0.5, 0.0, 0.0], &friction([0.8, 0.32]));
    assert_eq!(limits.bounds[0], 0.4);
    assert_eq!(limits.forces(&[8.0, 0.0])[..3], [8.0, 0.0, 0.0]);
    assert_eq!(limits.closed_points(|i| i == 0), 1);
    // The others are, together.
    let limits = of_gaps(&[0.6, 0.5, 0.5, 0.0, 0.0], &friction([0.8, 0.8]));
    assert_eq!(limits.bounds[0], 0.5);
    let forces = limits.forces(&[6.0, 0.0]);
    assert_eq!(forces[0], 0.0);
    assert!(
        (forces[1] - 1.0).abs() + (forces[2] - 5.0).abs() < 1e-14,
        "{forces:?}"
    );
    assert_eq!(limits.closed_points(|i| i == 0), 2);
}

#[test]
fn bounds_that_differ_by_more_than_their_round_off_are_apart() {
    let of = [unknown(0, 1.0), unknown(0, 1.0)];
    let gaps = [5.0e-16, 3.0e-16];
    let with = |round_off: &[f64]| {
        let all = conditions(&of, &gaps, &[1.0, 3.0], &[]);
        Limits::new(1, Conditions { round_off, ..all })
    };
    // Given gaps, of which the tighter one carries all force.
    let given = with(&[1e-28, 1e-28]);
    assert_eq!(given.bounds, [3.0e-16]);
    assert_eq!(given.forces(&[4.0]), [0.0, 4.0]);
    // One of them is measured.
    let measured = with(&[1e-28, 1e-14]);
    assert_eq!(measured.forces(&[4.0]), [1.0, 3.0]);
}
