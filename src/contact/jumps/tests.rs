//! Conditions in terms of normal jumps.

use super::*;

fn row(terms: &[(u32, f64)]) -> JumpRow {
    terms.to_vec()
}

/// b·v for v given by the unknowns that stay and the normal jumps `t`.
fn jump(row: &JumpRow, jumps: &Jumps, v: impl Fn(u32) -> f64, t: &[f64]) -> f64 {
    let replaced = |a: &Sum| {
        let term = |(&variable, &c): (&Variable, &f64)| match variable {
            Variable::Displacement(i) => {
                assert!(!jumps.replaced.contains_key(&i));
                c * v(i)
            }
            Variable::Jump(j) => c * t[j as usize],
        };
        a.terms.iter().map(term).sum::<f64>()
    };
    let value = |i: u32| jumps.replaced.get(&i).map_or_else(|| v(i), replaced);
    row.iter().map(|&(i, c)| c * value(i)).sum::<f64>()
}

#[test]
fn a_chain_of_conditions_leaves_every_jump_what_it_is_called() {
    // 0 against 1, 1 against 2, 2 against 0 in another direction, 3 alone.
    let rows = vec![
        row(&[(0, 1.0), (1, -1.0)]),
        row(&[(1, 1.0), (2, -0.8), (5, 0.6)]),
        row(&[(2, 1.0), (0, 0.7), (5, -0.3)]),
        row(&[(3, -1.0)]),
    ];
    let jumps = Jumps::new(&rows, &|_| false, |_| true, |_| 1.0).unwrap();
    let t = [0.5, 0.25, 0.125, 2.0];
    for (row, t_j) in rows.iter().zip(t) {
        let v = |i: u32| (f64::from(i) + 1.0).sqrt();
        assert!((jump(row, &jumps, v, &t) - t_j).abs() < 1e-14);
    }
}

#[test]
fn conditions_of_mortar_are_solved_for_what_each_has_alone() {
    // Unknown i is that of side a of condition i; those from 10 on, of side b, are in several.
    let rows: Vec<JumpRow> = (0..4)
        .map(|i| row(&[(i, 1.0), (10 + i, -0.7), (11 + i, -0.5), (12 + i, 0.2)]))
        .collect();
    for soft in [0, 10] {
        let stiffness = |v| if v / 10 * 10 == soft { 1.0 } else { 1e6 };
        let jumps = Jumps::new(&rows, &|_| false, |_| true, stiffness).unwrap();
        assert_eq!(jumps.pivots.len(), 4);
        for i in 1..4 {
            // Nothing but its own condition's.
            assert_eq!(jumps.replaced[&i].terms.len(), 4);
        }
    }
}

#[test]
fn conditions_of_quadratic_facets_keep_to_their_neighbours() {
    // Even conditions are at corners: what they have of side a the conditions beside them have, too. Side b is soft.
    let on_side_b = |i: u32| [(100 + i, -0.6), (101 + i, -0.4)];
    let at_node = |i: u32| match i % 2 {
        0 => [vec![(i, 1.0)], on_side_b(i).to_vec()].concat(),
        _ => [
            vec![(i - 1, -0.3), (i, 1.6), (i + 1, -0.3)],
            on_side_b(i).to_vec(),
        ]
        .concat(),
    };
    let rows: Vec<JumpRow> = (0..41).map(at_node).collect();
    let stiffness = |v: u32| if v < 100 { 1e6 } else { 1.0 };
    let jumps = Jumps::new(&rows, &|_| false, |_| true, stiffness).unwrap();
    for sum in jumps.replaced.values() {
        assert!(sum.terms.len() <= 9, "{sum:?}");
    }
}

#[test]
fn a_condition_given_twice_shares_its_jump() {
    let rows = [row(&[(0, 1.0), (1, -1.0)]), row(&[(0, 2.0), (1, -2.0)])];
    let jumps = Jumps::new(&rows, &|_| false, |_| true, |_| 1.0).unwrap();
    assert_eq!(jumps.pivots.len(), 1);
    let shared = JumpOf::Unknown {
        number: 0,
        factor: 2.0,
    };
    assert_eq!(jumps.of[1], shared);
}

#[test]
fn a_condition_that_follows_from_two_others_is_their_combination() {
    let rows = [
        row(&[(0, 1.0), (1, -1.0)]),
        row(&[(1, 1.0), (2, -1.0)]),
        row(&[(0, 1.0), (2, -1.0)]),
    ];
    let jumps = Jumps::new(&rows, &|_| false, |_| true, |_| 1.0).unwrap();
    assert_eq!(jumps.pivots.len(), 2);
    let JumpOf::Combination(terms) = &jumps.of[2] else {
        panic!("{:?}", jumps.of[2]);
    };
    let t = [0.3, 0.7];
    let value: f64 = terms.iter().map(|&(i, c)| c * t[i]).sum();
    let v = |i: u32| f64::from(i) + 2.0;
    let expected = jump(&rows[2], &jumps, v, &t);
    assert!((value - expected).abs() < 1e-15);
}

#[test]
fn a_condition_from_the_other_side_is_a_negative_multiple() {
    let rows = [row(&[(0, 1.0)]), row(&[(0, -1.0)])];
    let jumps = Jumps::new(&rows, &|_| false, |_| true, |_| 1.0).unwrap();
    let opposite = JumpOf::Combination(vec![(0, -1.0)]);
    assert_eq!(jumps.of[1], opposite);
}

#[test]
fn conditions_whose_normals_cancel_are_prescribed() {
    let rows = [row(&[(0, 1.0), (1, -1.0)]), row(&[(0, 1e-14), (1, -1e-14)])];
    let jumps = Jumps::new(&rows, &|_| false, |_| true, |_| 1.0).unwrap();
    assert_eq!(jumps.of[1], JumpOf::Prescribed);
}

#[test]
fn a_condition_without_an_unknown_that_may_go_is_refused() {
    let rows = [row(&[(0, 1.0), (1, -1.0)]), row(&[(0, 1.0)])];
    let error = Jumps::new(&rows, &|_| false, |v| v != 0, |_| 1.0).unwrap_err();
    assert_eq!(error, NoUnknown(1));
}

#[test]
fn an_unknown_that_may_not_go_stays() {
    let rows = [row(&[(0, 1.0), (1, -1.0)])];
    let jumps = Jumps::new(&rows, &|_| false, |v| v != 0, |_| 1.0).unwrap();
    assert!(jumps.replaced.contains_key(&1));
}

#[test]
fn the_softer_side_follows_the_stiffer_one() {
    let rows = [row(&[(0, 1.0), (1, -1.0)])];
    for soft in [0, 1] {
        let stiffness = |v| if v == soft { 1.0 } else { 1e6 };
        let jumps = Jumps::new(&rows, &|_| false, |_| true, stiffness).unwrap();
        assert!(jumps.replaced.contains_key(&soft));
    }
}

#[test]
fn conditions_that_are_nearly_parallel_to_others_are_combinations_of_little() {
    let at = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        row(&[(0, cos), (1, sin)])
    };
    let jumps = Jumps::new(
        &[at(50.0), at(51.0), at(80.0)],
        &|_| false,
        |_| true,
        |_| 1.0,
    )
    .unwrap();
    assert_eq!(jumps.pivots.len(), 2);
    let JumpOf::Combination(terms) = &jumps.of[1] else {
        panic!("{:?}", jumps.of);
    };
    assert!(terms.iter().all(|(_, factor)| factor.abs() < 2.0));
}

/// A tie of 0 to 1, a contact that says the same of them and one beside it, and another tie around the corner.
#[test]
fn what_ties_prescribe_is_no_unknown_of_others() {
    let rows = vec![
        row(&[(0, 1.0), (1, -1.0)]),
        row(&[(0, 1.0), (2, -1.0)]),
        row(&[(0, 2.0), (1, -2.0)]),
        row(&[(1, 1.0), (3, -1.0)]),
        row(&[(3, 1.0), (0, -1.0)]),
    ];
    let is_tied = |j: usize| [0, 3, 4].contains(&j);
    let jumps = Jumps::new(&rows, &is_tied, |_| true, |_| 1.0).unwrap();
    assert_eq!((jumps.tied.len(), jumps.pivots.len()), (2, 1));
    // Two ties, and a third one that these are, less than nothing of it.
    let of_ties: Vec<JumpOf> = [0, 3, 4].map(|j| jumps.of[j].clone()).to_vec();
    let is_own = |of: &&JumpOf| matches!(of, JumpOf::Tied(_));
    assert_eq!(of_ties.iter().filter(is_own).count(), 2);
    assert_eq!(
        of_ties
            .iter()
            .filter(|of| **of == JumpOf::Prescribed)
            .count(),
        1
    );
    assert!(matches!(jumps.of[1], JumpOf::Unknown { number: 0, .. }));
    assert_eq!(jumps.of[2], JumpOf::Prescribed);
    // With the jumps of ties 0.5 and 0.25 that of the third is −0.75, and twice the first is that of the contact.
    let mut bounds = vec![0.5, 3.0, 7.0, 0.25, 0.0];
    for (condition, value) in [(0, 0.5), (3, 0.25), (4, -0.75)] {
        bounds[condition] = value;
    }
    jumps.subtract_known(&mut bounds);
    assert_eq!(bounds[2], 7.0 - 2.0 * 0.5);
    let dependent = [0, 3, 4]
        .into_iter()
        .find(|&j| jumps.of[j] == JumpOf::Prescribed)
        .unwrap();
    assert!(bounds[dependent].abs() < 1e-15);
    // Whatever stays, each is what it is called.
    let order = jumps
        .tied_conditions()
        .into_iter()
        .map(|j| [0.5, 0.0, 0.0, 0.25, -0.75][j]);
    let t: Vec<f64> = order.chain([2.0]).collect();
    let v = |i: u32| f64::from(i) + 0.7;
    for (j, expected) in [(0, 0.5), (1, 2.0), (2, 1.0), (3, 0.25), (4, -0.75)] {
        assert!((jump(&rows[j], &jumps, v, &t) - expected).abs() < 1e-14);
    }
}
