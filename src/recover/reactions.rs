//! Reactions: forces of supports.

use contact_dd_partition::id::{BlockId, OnBlocks};

use crate::fem::resultants::{Reaction, Resultant};
use crate::fem::springs::spring_forces;
use crate::recover::BlockSolution;
use crate::recover::fixed_active_set::FixedActiveSet;

/// Reactions on the bodies of every condition that prescribes displacements; on the root they are those of the whole
/// solution. Collective.
pub fn reactions(fixed: &FixedActiveSet<'_>, solutions: &OnBlocks<BlockSolution>) -> Vec<Reaction> {
    let names = fixed.context.catalog.supports.iter();
    let mut reactions: Vec<Reaction> = names
        .map(|support| Reaction {
            support: support.clone(),
            resultant: Resultant::default(),
        })
        .collect();
    fixed.context.comm.gather(
        &fixed.context.plan.owners(),
        |b| match solutions.get(&b) {
            Some(solution) => of_block(fixed, b, solution),
            None => Vec::new(),
        },
        |_, of_block| {
            for (condition, at, force) in of_block {
                if let Some(reaction) = reactions.get_mut(condition as usize) {
                    reaction.resultant.add(at, force);
                }
            }
        },
    );
    reactions
}

/// The condition, the position and the reaction of every support.
fn of_block(
    fixed: &FixedActiveSet<'_>,
    b: BlockId,
    solution: &BlockSolution,
) -> Vec<(u32, [f64; 3], [f64; 3])> {
    let mut reactions = Vec::new();
    let Some(block) = fixed.context.blocks.get(&b) else {
        return reactions;
    };
    let held = fixed
        .step
        .loads
        .blocks
        .get(&b)
        .map_or(&[][..], |loads| &loads.supports);
    for (condition, node, force) in spring_forces(block, &solution.u) {
        reactions.push((condition, block.points()[node as usize], force));
    }
    if held.is_empty() {
        return reactions;
    }
    let dim = block.dim;
    let balance = fixed.balance(b, solution);
    let residual = balance.as_ref().map_or(&[][..], |b| &b.residual);
    for support in held {
        let residual = residual
            .get(dim * support.node as usize..)
            .unwrap_or_default();
        let along: f64 = (residual.iter().zip(&support.direction[..dim]))
            .map(|(r, d)| r * d)
            .sum();
        let at = block.points()[support.node as usize];
        let force = support.direction.map(|d| -along * d);
        reactions.push((support.condition, at, force));
    }
    reactions
}
