use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use super::*;
use crate::schur::condensed::InterfaceDof;

/// Number of jumps of the front.
const M: usize = 6;

fn noise(seed: usize) -> f64 {
    2.0 * ((seed as f64 * 78.233).sin() * 43758.5453).fract()
}

/// T of the jumps of a front, t = T τ, from the displacements that a single jump replaces each.
fn of_front(front: &FrontJumps) -> Mat<f64> {
    let replaced = |k: usize| Replaced {
        dof: InterfaceDof {
            node: k as u32,
            axis: 0,
        },
        staying: Vec::new(),
        jumps: vec![(k, 1.0)],
        is_tied: false,
    };
    let replaced: Vec<Replaced> = (0..M).map(replaced).collect();
    let mut t = Mat::<f64>::zeros(M, M);
    for (k, replaced) in front.replaced(&replaced).iter().enumerate() {
        for &(l, c) in &replaced.jumps {
            t[(k, l)] += c;
        }
    }
    t
}

/// The jumps τ of a front with this stiffness and load, for prescribed values of closed limits and given forces on open
/// ones, and the balance at the closed jumps.
fn solved(
    front: &FrontJumps,
    (h, c): (&Mat<f64>, &Mat<f64>),
    (prescribed, given): (&[f64], &[f64]),
) -> (Vec<f64>, Vec<f64>) {
    let open = front.open_in_front();
    let (free, held): (Vec<usize>, Vec<usize>) = (0..M).partition(|&i| open[i]);
    let mut jumps = vec![0.0; M];
    for (&i, value) in held.iter().zip(front.closed_values(prescribed)) {
        jumps[i] = value;
    }
    let forces = front.open_forces(given);
    let left = Mat::from_fn(free.len(), 1, |k, _| {
        let of_held = held.iter().map(|&j| h[(free[k], j)] * jumps[j]);
        c[(free[k], 0)] - forces[k] - of_held.sum::<f64>()
    });
    if !free.is_empty() {
        let of_free = Mat::from_fn(free.len(), free.len(), |k, l| h[(free[k], free[l])]);
        let solved = of_free.llt(Side::Lower).unwrap().solve(&left);
        let all = free.iter().enumerate();
        all.for_each(|(k, &i)| jumps[i] = solved[(k, 0)]);
    }
    let balance = |i: usize| match open[i] {
        true => 0.0,
        false => c[(i, 0)] - (0..M).map(|j| h[(i, j)] * jumps[j]).sum::<f64>(),
    };
    let balance = (0..M).map(balance).collect();
    (jumps, balance)
}

/// The front's equations are solved for its open jumps; the result fulfils those of the limits, including dependent
/// rows and rows under given forces.
#[test]
fn the_answer_of_a_front_balances_and_has_closed_rows_at_their_bounds() {
    let mut rows = DependentConstraints::default();
    rows.push(vec![(0, 1.0), (1, -0.5), (2, 2.0)]);
    rows.push(vec![(1, 0.7), (3, 1.0)]);
    rows.push(vec![(2, 1.5), (3, -1.0), (4, 0.3)]);
    let limits = M + rows.len();
    let mut redundant = 0;
    for seed in 0..200 {
        let open: Vec<bool> = (0..limits).map(|i| noise(1000 * seed + i) > -0.2).collect();
        let front = FrontJumps::new(&rows, &open);
        let prescribed: Vec<f64> = (0..limits).map(|i| noise(31 * seed + i)).collect();
        let given = |i: usize| match open[i] && i.is_multiple_of(3) {
            true => noise(7 * seed + i),
            false => 0.0,
        };
        let given: Vec<f64> = (0..limits).map(given).collect();
        let root = Mat::from_fn(M, M, |i, j| noise(57 * seed + 13 * i + j));
        let h = &root * root.transpose() + Mat::<f64>::identity(M, M);
        let c = Mat::from_fn(M, 1, |i, _| noise(91 * seed + i));
        let t = of_front(&front);
        let turned = (&(t.transpose() * &h * &t), &(t.transpose() * &c));
        let (jumps, balance) = solved(&front, turned, (&prescribed, &given));
        let at = front.answer(jumps, balance, &given);

        let both = at.forces.iter().zip(&given);
        let forces: Vec<f64> = both.map(|(own, given)| own + given).collect();
        let mut held_by_all = forces[..M].to_vec();
        let opposite: Vec<f64> = forces[M..].iter().map(|force| -force).collect();
        rows.subtract_transposed(&opposite, &mut held_by_all);
        for (i, held) in held_by_all.iter().enumerate() {
            let resisted: f64 = (0..M).map(|j| h[(i, j)] * at.jumps[j]).sum();
            let left = c[(i, 0)] - resisted - held;
            assert!(left.abs() < 1e-9, "{seed}: jump {i}: {left:e}");
        }
        let follows: Vec<usize> = front.equalities.redundant.iter().map(|j| M + j).collect();
        redundant += follows.len();
        for i in (0..limits).filter(|i| !follows.contains(i)) {
            match open[i] {
                true => assert_eq!(at.forces[i], 0.0, "{seed}: limit {i}"),
                false => assert!((at.jumps[i] - prescribed[i]).abs() < 1e-10, "{seed}: {i}"),
            }
        }
        for j in 0..rows.len() {
            assert_eq!(at.jumps[M + j], rows.value(j, &at.jumps[..M]));
        }
    }
    assert!(redundant > 0);
}
