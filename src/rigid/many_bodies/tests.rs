//! Sparse matrices compared with dense ones.

use nalgebra::{DMatrix, DVector};

use super::*;
use crate::rigid::nonnegative;

/// Bodies in a row with two motions each; `rows` constraints connect each to the next one or to the ground.
fn chain(bodies: usize, rows: usize, seed: usize) -> (Vec<SparseRow>, DMatrix<f64>) {
    let noise = |s: usize| ((s as f64 * 78.233).sin() * 43758.5453).fract();
    // Unknowns are numbered out of order.
    let number = |i: usize| i * 7 % (2 * bodies);
    let row = |j: usize| -> SparseRow {
        let body = j % bodies;
        let unknowns = 2 * body..(2 * body + 4).min(2 * bodies);
        unknowns
            .map(|i| (number(i), noise(100 * seed + 5 * j + i)))
            .collect()
    };
    let sparse: Vec<SparseRow> = (0..rows).map(row).collect();
    let mut dense = DMatrix::zeros(rows, 2 * bodies);
    for (j, row) in sparse.iter().enumerate() {
        row.iter().for_each(|&(i, b)| dense[(j, i)] += b);
    }
    (sparse, dense)
}

/// Constraints on this number of motions of bodies along a line.
fn bodies(motions: usize, rows: Vec<SparseRow>) -> ManyBodies {
    let points: Vec<_> = (0..motions).map(|i| [i as f64, 0.0, 0.0]).collect();
    ManyBodies::new(&points, rows).unwrap()
}

#[test]
fn forces_balance_what_those_of_least_squares_do() {
    let mut balanced = 0;
    for seed in 0..60 {
        let rows = 12 + seed % 9;
        let (sparse, b) = chain(4, rows, seed);
        let n = b.ncols();
        // Half of the loads lie in the cone of the forces.
        let lambda = DVector::from_fn(rows, |j, _| ((j + seed) % 3) as f64);
        let any = DVector::from_fn(n, |i, _| ((i * i + seed) as f64).sin());
        let load = if seed % 2 == 0 {
            b.tr_mul(&lambda)
        } else {
            any
        };
        let nearest = nonnegative::residual(&b.transpose(), &load);
        let left = nearest.norm();
        let residual = bodies(n, sparse.clone()).residual(load.as_slice()).unwrap();
        let differs = DVector::from_vec(residual.left) - nearest;
        assert!(differs.norm() < 1e-8 * load.norm(), "{seed}: {differs}");
        let found = bodies(n, sparse).rest(load.as_slice(), &vec![0.0; rows]);
        let found = found.map_or(f64::INFINITY, |rest| rest.unbalanced());
        let nothing = 1e-11 * load.norm();
        assert_eq!(
            found <= nothing,
            left <= nothing,
            "{seed}: {found:e}, expected {left:e}"
        );
        balanced += usize::from(left <= nothing);
    }
    assert!((20..50).contains(&balanced), "{balanced}");
}

#[test]
fn bodies_rest_where_no_motion_within_the_gaps_does_more_work() {
    for seed in 0..20 {
        let (sparse, b) = chain(5, 40, seed);
        let gaps: Vec<f64> = (0..40).map(|j| 0.1 * (j % 4) as f64).collect();
        let lambda = DVector::from_fn(40, |j, _| ((j + seed) % 3) as f64);
        let load = b.tr_mul(&lambda);
        let rest = bodies(10, sparse).rest(load.as_slice(), &gaps).unwrap();
        assert!(rest.unbalanced() <= 1e-7 * load.norm(), "{rest:?}");
        let y = DVector::from_vec(rest.motion);
        let jumps = &b * &y;
        for (jump, gap) in jumps.iter().zip(&gaps) {
            assert!(*jump <= gap + 1e-12, "{jump}, expected at most {gap}");
        }
        // A load that the closed constraints can't balance would do more work.
        let closed: Vec<usize> = (0..40).filter(|&j| jumps[j] > gaps[j] - 1e-9).collect();
        let drive = nonnegative::residual(&b.select_rows(&closed).transpose(), &load);
        assert!(drive.norm() <= 1e-7 * load.norm(), "{drive}");
    }
}

#[test]
fn motions_are_held_unless_some_combination_is_free() {
    for seed in 0..20 {
        let (sparse, _) = chain(6, 30, seed);
        let hold_all = |rows| bodies(12, rows).unheld().unwrap().is_empty();
        assert!(hold_all(sparse.clone()));
        // The last column becomes a combination of others in the rows that contain both.
        let with_one_less = sparse.iter().map(|row| {
            let all = row.iter().filter(|(i, _)| *i != 3);
            all.copied().collect()
        });
        assert!(!hold_all(with_one_less.collect()));
        let few = sparse[..11].to_vec();
        assert!(!hold_all(few));
    }
}
