//! Reactions: what supports carry.

use std::collections::BTreeMap;

use crate::output::resultants::{Reaction, Resultant};
use crate::recover::BlockSolution;
use crate::recover::frozen::Frozen;

/// What every condition that prescribes displacements exerts on the bodies; on the root it is that
/// of the whole solution. Collective.
pub fn reactions(frozen: &Frozen<'_>, solutions: &BTreeMap<usize, BlockSolution>) -> Vec<Reaction> {
    let names = frozen.context.catalog.supports.iter();
    let mut reactions: Vec<Reaction> = names
        .map(|support| Reaction {
            support: support.clone(),
            resultant: Resultant::default(),
        })
        .collect();
    frozen.context.comm.gather(
        &frozen.context.plan.owners(),
        |b| match solutions.get(&b) {
            Some(solution) => of_block(frozen, b, solution),
            None => Vec::new(),
        },
        |_, of_block| {
            for (condition, at, force) in of_block {
                reactions[condition as usize].resultant.add(at, force);
            }
        },
    );
    reactions
}

/// For every support its condition, its position and the reaction.
fn of_block(
    frozen: &Frozen<'_>,
    b: usize,
    solution: &BlockSolution,
) -> Vec<(u32, [f64; 3], [f64; 3])> {
    let mut reactions = Vec::new();
    let Some(owned) = frozen.context.blocks.get(&b) else {
        return reactions;
    };
    let held = frozen
        .step
        .loads
        .get(&b)
        .map_or(&[][..], |loads| &loads.supports);
    if held.is_empty() {
        return reactions;
    }
    let dim = owned.block.dim;
    let residual = frozen
        .balance(b, solution)
        .map_or_else(Vec::new, |b| b.residual);
    for support in held {
        let residual = residual
            .get(dim * support.node as usize..)
            .unwrap_or_default();
        let along: f64 = (residual.iter().zip(&support.direction[..dim]))
            .map(|(r, d)| r * d)
            .sum();
        let at = owned.block.points[support.node as usize];
        let force = support.direction.map(|d| -along * d);
        reactions.push((support.condition, at, force));
    }
    reactions
}
