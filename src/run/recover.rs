//! Back-substitution: from U on Γ to displacements and contact forces everywhere.

use std::collections::BTreeMap;

use super::condense::CondensedBlocks;
use crate::comm::{Comm, Message};
use crate::plan::Plan;

/// The solution on a block.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockSolution {
    /// Displacement, node by node (m).
    pub u: Vec<f64>,
    /// Force of every condition (N/m).
    pub forces: Vec<f64>,
    /// Which conditions are closed.
    pub closed: Vec<bool>,
}

/// Sends every block its part of U and recovers its interior. Collective; `root` holds U and the
/// numbers of every block's traces.
pub fn recover(
    comm: &Comm,
    blocks: &CondensedBlocks,
    plan: &Plan,
    root: Option<(&[f64], &[Vec<u32>])>,
) -> BTreeMap<usize, BlockSolution> {
    let mut traces: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    comm.scatter(
        &plan.owners(),
        |b| Message {
            integers: Vec::new(),
            reals: root.map_or_else(Vec::new, |(u, numbers)| {
                numbers[b].iter().map(|&i| u[i as usize]).collect()
            }),
        },
        |b, message| {
            traces.insert(b, message.reals);
        },
    );
    traces
        .into_iter()
        .filter_map(|(b, u)| Some((b, recover_block(blocks, plan, b, &u)?)))
        .collect()
}

fn recover_block(
    blocks: &CondensedBlocks,
    plan: &Plan,
    b: usize,
    u: &[f64],
) -> Option<BlockSolution> {
    let dofs = blocks.dofs.get(&b)?;
    if let Some(linear) = blocks.linear.get(&b) {
        let x = linear.schur.recover(&linear.load, u);
        return Some(BlockSolution {
            u: dofs.displacement(&x),
            forces: Vec::new(),
            closed: Vec::new(),
        });
    }
    let pair = blocks.pairs.get(&plan.pair_of(b)?)?;
    let mut x_b = pair.approaches().to_vec();
    x_b.extend_from_slice(u);
    let x = pair.schur().recover(pair.load(), &x_b);
    let (forces, closed) = pair.conditions();
    Some(BlockSolution {
        u: dofs.displacement(&x),
        forces,
        closed,
    })
}
