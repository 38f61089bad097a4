//! How well the scene is conditioned: an estimate of its condition number.

use std::collections::BTreeMap;

use super::frozen::{BlockLoad, Frozen};
use super::recover::BlockSolution;
use crate::comm::Message;

/// Estimates κ = λ_max / λ_min of D^(−1/2) K D^(−1/2), K the stiffness of the whole scene with its
/// contacts frozen as they are, D its diagonal: round-off makes a relative error of about
/// κ · 10⁻¹⁶ in displacements.
///
/// λ_min comes from two steps of the inverse power iteration, which makes the estimate a lower
/// bound but for λ_max, whose bound is the number of unknowns of a cell. Collective; the root gets
/// the estimate, `None` where it can't be made.
pub fn condition_number(
    frozen: &Frozen<'_>,
    solutions: &BTreeMap<usize, BlockSolution>,
) -> Option<f64> {
    let mut able = Message {
        integers: vec![i64::from(frozen.root.is_some_and(|root| root.can_solve()))],
        reals: Vec::new(),
    };
    frozen.comm.broadcast(&mut able);
    if able.read().integer() == 0 {
        return None;
    }
    let start = |&b: &usize| {
        let signs = |d: (usize, &f64)| d.1 * sign(b, d.0);
        (
            b,
            diagonal(frozen, b).iter().enumerate().map(signs).collect(),
        )
    };
    let loads: BTreeMap<usize, Vec<f64>> = frozen.condensed.dofs.keys().map(start).collect();
    let first = solve(frozen, solutions, &loads);
    let weighted = |(&b, x): (&usize, &Vec<f64>)| {
        let product = diagonal(frozen, b).iter().zip(x).map(|(d, x)| d * x);
        (b, product.collect())
    };
    let loads: BTreeMap<usize, Vec<f64>> = first.iter().map(weighted).collect();
    let second = solve(frozen, solutions, &loads);

    // xᵀ D x and xᵀ D K⁻¹ D x, summed block by block so that ranks make no difference.
    let mut largest = 0;
    let mut sums = [0.0; 2];
    frozen.comm.gather(
        &frozen.plan.owners(),
        |b| {
            let dot = |x: Option<&Vec<f64>>| {
                let pairs = x
                    .into_iter()
                    .flatten()
                    .zip(loads.get(&b).into_iter().flatten());
                pairs.map(|(x, l)| x * l).sum()
            };
            Message {
                integers: vec![largest_cell(frozen, b) as i64],
                reals: vec![dot(first.get(&b)), dot(second.get(&b))],
            }
        },
        |_, message| {
            let mut reader = message.read();
            largest = largest.max(reader.count());
            sums = sums.map(|sum| sum + reader.real());
        },
    );
    let [before, after] = sums;
    (frozen.root.is_some() && before > 0.0).then(|| largest as f64 * after / before)
}

/// K⁻¹ `loads`, every contact frozen. Collective.
fn solve(
    frozen: &Frozen<'_>,
    solutions: &BTreeMap<usize, BlockSolution>,
    loads: &BTreeMap<usize, Vec<f64>>,
) -> BTreeMap<usize, Vec<f64>> {
    let load_of = |(&b, load): (&usize, &Vec<f64>)| {
        let closed = solutions
            .get(&b)
            .map_or_else(Vec::new, |s| s.closed.clone());
        let load = BlockLoad {
            load: load.clone(),
            missing: vec![0.0; closed.len()],
            closed,
        };
        (b, load)
    };
    let changes = frozen.solve(loads.iter().map(load_of).collect());
    changes.into_iter().map(|(b, c)| (b, c.x)).collect()
}

fn diagonal<'a>(frozen: &Frozen<'a>, b: usize) -> &'a [f64] {
    frozen
        .condensed
        .diagonals
        .get(&b)
        .map_or(&[], Vec::as_slice)
}

/// The most unknowns that a cell of block b has.
fn largest_cell(frozen: &Frozen<'_>, b: usize) -> usize {
    frozen.blocks.get(&b).map_or(0, |owned| {
        let nodes = owned.block.cells().map(|cell| cell.kind.nodes()).max();
        nodes.unwrap_or(0) * owned.block.dim
    })
}

/// 1 or −1, as good as by chance and always the same, so that no mode is missed by symmetry.
fn sign(block: usize, unknown: usize) -> f64 {
    let mixed = (block as u64 + 1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(unknown as u64)
        .wrapping_mul(0xbf58_476d_1ce4_e5b9);
    if (mixed >> 40).count_ones().is_multiple_of(2) {
        1.0
    } else {
        -1.0
    }
}
