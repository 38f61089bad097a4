//! Estimate of the scene's condition number.

use std::collections::BTreeMap;

use contact_dd_partition::id::{BlockId, GroupId, OnBlocks};

use crate::contact::status::FixedStatus;
use crate::recover::fixed_active_set::FixedActiveSet;
use crate::recover::fixed_conditions::conditions;
use crate::recover::refine::prescribed;
use crate::recover::{DiscreteSolution, GroupSolution};

/// Accuracy of the inverse iteration with an iterative solver.
const ACCURACY: f64 = 3e-2;

/// Estimates κ = λ_max / λ_min of A = D^(−1/2) K D^(−1/2), K the stiffness of the whole scene with its contacts fixed
/// as they are, D its diagonal: round-off makes a relative error of about κ · 10⁻¹⁶ in displacements.
///
/// One step of inverse iteration: the Rayleigh quotient of x = A⁻¹ s is at least λ_min, and little more unless s has
/// next to nothing of its mode. s is random, with a part constant over each block, which the smooth and therefore
/// softest modes contain most of. λ_max is at most the number of unknowns of a cell. Collective; the root gets the
/// estimate, or `None` where it can't be made.
pub fn condition_number(fixed: &FixedActiveSet<'_>, solution: &DiscreteSolution) -> Option<f64> {
    let able = fixed.root.is_some_and(|root| root.can_solve());
    if !fixed.context.comm.decide(able) {
        return None;
    }
    let dim = fixed.context.catalog.dim;
    let start = |&b: &BlockId| {
        let diagonal = diagonal(fixed, b).iter().enumerate();
        let value = |i: usize| sign(b, i) + sign(b, usize::MAX - i % dim);
        let load = diagonal.map(|(i, d)| d.max(0.0).sqrt() * value(i));
        (b, load.collect())
    };
    let loads: OnBlocks<Vec<f64>> = fixed.condensed.blocks.keys().map(start).collect();
    let statuses = solution.groups.iter();
    let statuses = statuses.map(|(&g, of_group)| (g, statuses_of(fixed, g, of_group)));
    let answer = fixed.solve(
        loads.clone(),
        statuses.collect(),
        &BTreeMap::new(),
        ACCURACY,
    );
    let answer = answer.blocks;

    // xᵀ D x and xᵀ K x, summed block by block so that the result doesn't depend on the ranks.
    let mut largest = 0;
    let (mut sum, mut energy) = (0.0, 0.0);
    fixed.context.comm.gather(
        &fixed.context.plan.owners(),
        |b| {
            let answer = answer.get(&b).into_iter().flatten();
            let terms = answer.clone().zip(diagonal(fixed, b));
            let work = answer.zip(loads.get(&b).into_iter().flatten());
            (
                largest_cell(fixed, b),
                terms.map(|(x, d)| d * x * x).sum::<f64>(),
                work.map(|(x, f)| x * f).sum::<f64>(),
            )
        },
        |_, (cell, part, of_energy)| {
            largest = largest.max(cell);
            sum += part;
            energy += of_energy;
        },
    );
    (fixed.root.is_some() && energy > 0.0).then(|| largest as f64 * sum / energy)
}

/// The statuses of a contact group's constraints. In space, forces of slipping points turn with the slip, which resists
/// a motion where no point sticks; fronts of an active set leave that out, as it isn't in their matrices.
fn statuses_of(
    fixed: &FixedActiveSet<'_>,
    g: GroupId,
    of_group: &GroupSolution,
) -> Vec<FixedStatus> {
    let context = &fixed.context;
    if context.catalog.dim == 2 || fixed.fronts.is_some() {
        let closed = of_group.closed.iter();
        return closed.map(|closed| FixedStatus::new(!closed)).collect();
    }
    let mut aligned = of_group.clone();
    let statuses = conditions(&context.groups[&g], &mut aligned, &prescribed(context, g));
    let at_rest = |status: FixedStatus| match status {
        FixedStatus::Closed { .. } => FixedStatus::Closed { distance: 0.0 },
        other => other,
    };
    statuses.into_iter().map(at_rest).collect()
}

fn diagonal<'a>(fixed: &FixedActiveSet<'a>, b: BlockId) -> &'a [f64] {
    let block = fixed.condensed.blocks.get(&b);
    block.map_or(&[], |block| &block.diagonal)
}

/// The largest number of unknowns of a cell in block b.
fn largest_cell(fixed: &FixedActiveSet<'_>, b: BlockId) -> usize {
    fixed.context.blocks.get(&b).map_or(0, |block| {
        let nodes = block.cells().map(|cell| cell.kind.nodes()).max();
        nodes.unwrap_or(0) * block.dim
    })
}

/// Reproducible pseudo-random 1 or −1, so that no mode is missed by symmetry.
fn sign(block: BlockId, unknown: usize) -> f64 {
    let mixed = (block.index() as u64 + 1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(unknown as u64)
        .wrapping_mul(0xbf58_476d_1ce4_e5b9);
    if (mixed >> 40).count_ones().is_multiple_of(2) {
        1.0
    } else {
        -1.0
    }
}
