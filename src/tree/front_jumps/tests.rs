use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use super::*;
use crate::schur::condensed::InterfaceDof;

fn noise(seed: usize) -> f64 {
    2.0 * ((seed as f64 * 78.233).sin() * 43758.5453).fract()
}

/// T of the jumps of a front, t = T τ, from what each of `m` displacements is that a jump alone replaces.
fn of_front(front: &FrontJumps, m: usize) -> Mat<f64> {
    let replaced: Vec<Replaced> = (0..m)
        .map(|k| Replaced {
            dof: InterfaceDof {
                node: k as u32,
                axis: 0,
            },
            staying: Vec::new(),
            jumps: vec![(k, 1.0)],
        })
        .collect();
    let mut t = Mat::<f64>::zeros(m, m);
    for (k, replaced) in front.replaced(&replaced).iter().enumerate() {
        for &(l, c) in &replaced.jumps {
            t[(k, l)] += c;
        }
    }
    t
}

/// The front's equations are solved for its open jumps; the answer fulfils those of the limits, among them rows that follow
/// from others and rows under given forces.
#[test]
fn the_answer_of_a_front_balances_and_has_closed_rows_at_their_bounds() {
    let m = 6;
    let mut rows = DependentConstraints::default();
    rows.push(vec![(0, 1.0), (1, -0.5), (2, 2.0)]);
    rows.push(vec![(1, 0.7), (3, 1.0)]);
    rows.push(vec![(2, 1.5), (3, -1.0), (4, 0.3)]);
    let limits = m + rows.len();
    for seed in 0..200 {
        let is_open = |i: usize| noise(1000 * seed + i) > -0.2;
        let open: Vec<bool> = (0..limits).map(is_open).collect();
        let front = FrontJumps::new(&rows, &open);
        let prescribed: Vec<f64> = (0..limits).map(|i| noise(31 * seed + i)).collect();
        let given = |i: usize| if i % 3 == 0 { noise(7 * seed + i) } else { 0.0 };
        let given: Vec<f64> = (0..limits)
            .map(|i| if open[i] { given(i) } else { 0.0 })
            .collect();
        let root = Mat::from_fn(m, m, |i, j| noise(57 * seed + 13 * i + j));
        let h = &root * root.transpose() + Mat::<f64>::identity(m, m);
        let c = Mat::from_fn(m, 1, |i, _| noise(91 * seed + i));

        let turned = of_front(&front, m);
        let (of_front, load) = (turned.transpose() * &h * &turned, turned.transpose() * &c);
        let open_there = front.open_in_front();
        let (free, held): (Vec<usize>, Vec<usize>) = (0..m).partition(|&i| open_there[i]);
        let mut jumps = vec![0.0; m];
        for (&i, value) in held.iter().zip(front.closed_values(&prescribed)) {
            jumps[i] = value;
        }
        let forces = front.open_forces(&given);
        let left = Mat::from_fn(free.len(), 1, |k, _| {
            let of_held = held.iter().map(|&j| of_front[(free[k], j)] * jumps[j]);
            load[(free[k], 0)] - forces[k] - of_held.sum::<f64>()
        });
        if !free.is_empty() {
            let of_free = Mat::from_fn(free.len(), free.len(), |k, l| of_front[(free[k], free[l])]);
            let solved = of_free.llt(Side::Lower).unwrap().solve(&left);
            free.iter()
                .enumerate()
                .for_each(|(k, &i)| jumps[i] = solved[(k, 0)]);
        }
        let balance = |i: usize| match open_there[i] {
            true => 0.0,
            false => load[(i, 0)] - (0..m).map(|j| of_front[(i, j)] * jumps[j]).sum::<f64>(),
        };
        let at = front.answer(jumps.clone(), (0..m).map(balance).collect(), &given);

        let forces: Vec<f64> = at
            .forces
            .iter()
            .zip(&given)
            .map(|(own, given)| own + given)
            .collect();
        for i in 0..m {
            let of_rows = rows.iter().zip(&forces[m..]);
            let of_rows = of_rows.map(|(row, force)| {
                let own = row.iter().find(|(t, _)| *t == i);
                own.map_or(0.0, |(_, c)| c * force)
            });
            let held = forces[i] + of_rows.sum::<f64>();
            let resisted: f64 = (0..m).map(|j| h[(i, j)] * at.jumps[j]).sum();
            let left = c[(i, 0)] - resisted - held;
            assert!(left.abs() < 1e-9, "{seed}: jump {i}: {left:e}");
        }
        let redundant: Vec<usize> = front.equalities.redundant.iter().map(|j| m + j).collect();
        for i in 0..limits {
            let (is_closed, is_held) = (!open[i], !redundant.contains(&i));
            if is_closed && is_held {
                assert!(
                    (at.jumps[i] - prescribed[i]).abs() < 1e-10,
                    "{seed}: limit {i}"
                );
            } else {
                assert_eq!(at.forces[i], 0.0, "{seed}: limit {i}");
            }
        }
        for j in 0..rows.len() {
            assert_eq!(at.jumps[m + j], rows.value(j, &at.jumps[..m]));
        }
    }
}
