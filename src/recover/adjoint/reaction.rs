//! The reaction of supports and springs as a functional of the solution.

use std::collections::BTreeMap;

use contact_dd_partition::element::geometry::dot as along;
use contact_dd_partition::id::{BlockId, OnBlocks};
use contact_dd_partition::model::Support;
use contact_dd_partition::quantity::Quantity;

use super::functional::Functional;
use super::solved::Solved;
use crate::fem::block::Block;
use crate::fem::springs::spring_forces;
use crate::vector::dot;

impl Functional {
    /// Adds the forces of supports along a direction, and of springs, −K_s u: on all of their nodes, or on those with a
    /// weight, if there are any. Collective.
    pub(super) fn weigh_reactions(&mut self, solved: Solved<'_>, quantity: &Quantity) {
        let context = &solved.fixed.context;
        let nodes = |(&b, block): (&BlockId, &Block)| {
            let weights = block.subdomain.shares.weights.iter();
            let own = weights.filter(|weight| weight.quantity as usize == self.number);
            (b, own.map(|weight| weight.node as usize).collect())
        };
        let nodes: OnBlocks<Vec<usize>> = context.blocks.iter().map(nodes).collect();
        let any = nodes.values().any(|of_block| !of_block.is_empty());
        let is_part = context.comm.largest([&f64::from(u8::from(any))]) > 0.0;
        let mut parts = BTreeMap::new();
        for (&b, block) in context.blocks {
            let mut counts = vec![!is_part; block.nodes()];
            nodes[&b].iter().for_each(|&node| counts[node] = true);
            self.weigh_springs(quantity, (b, block), &counts);
            self.weigh_supports(solved, quantity, b, &counts);
            if is_part {
                parts.insert(b, self.of_part(solved, (b, block)));
            }
        }
        let of_part = context.sum_of_blocks(|b| parts.get(&b).copied().unwrap_or_default());
        let reactions = (solved.solution.reactions.iter().enumerate())
            .filter(|(condition, _)| quantity.of.contains(&(*condition as u32)));
        let whole = reactions.map(|(_, of)| along(of.resultant.force, quantity.direction));
        self.value = match is_part {
            true => of_part,
            false => whole.sum(),
        };
    }

    /// Weighs the supports of block b at the nodes that count.
    fn weigh_supports(
        &mut self,
        solved: Solved<'_>,
        quantity: &Quantity,
        b: BlockId,
        counts: &[bool],
    ) {
        let loads = solved.fixed.step.loads.blocks.get(&b);
        let supports = loads.map_or(&[][..], |loads| &loads.supports);
        let counted = |support: &Support| {
            quantity.of.contains(&support.condition) && counts[support.node as usize]
        };
        if supports.iter().any(counted) {
            let weight = |support: &Support| match counted(support) {
                true => along(support.direction, quantity.direction),
                false => 0.0,
            };
            self.of_supports
                .insert(b, supports.iter().map(weight).collect());
        }
    }

    /// Weighs the displacements of block b by the stiffness of the springs at the nodes that count.
    fn weigh_springs(
        &mut self,
        quantity: &Quantity,
        (b, block): (BlockId, &Block),
        counts: &[bool],
    ) {
        let mut everywhere = vec![0.0; block.dim * block.nodes()];
        for (of_node, counts) in everywhere.chunks_exact_mut(block.dim).zip(counts) {
            if *counts {
                of_node.copy_from_slice(&quantity.direction[..block.dim]);
            }
        }
        let springs = spring_forces(block, &everywhere);
        for (_, node, force) in springs.filter(|(of, ..)| quantity.of.contains(of)) {
            let of_nodes = (self.of_nodes.entry(b)).or_insert_with(|| vec![0.0; everywhere.len()]);
            for (component, force) in force.into_iter().enumerate().take(block.dim) {
                of_nodes[node as usize * block.dim + component] += force;
            }
        }
    }

    /// The weighted forces of supports, the unbalanced ones at their nodes, and of springs in block b.
    fn of_part(&self, solved: Solved<'_>, (b, block): (BlockId, &Block)) -> f64 {
        let fixed = solved.fixed;
        let Some(of_block) = solved.solution.discrete.blocks.get(&b) else {
            return 0.0;
        };
        let of_springs = self.of_nodes.get(&b);
        let mut part = of_springs.map_or(0.0, |of_nodes| dot(of_nodes, &of_block.u));
        let loads = fixed
            .step
            .loads
            .blocks
            .get(&b)
            .zip(self.of_supports.get(&b));
        if let (Some((loads, weights)), Some(balance)) = (loads, fixed.balance(b, of_block)) {
            for (support, weight) in loads.supports.iter().zip(weights) {
                let residual = &balance.residual[support.node as usize * block.dim..];
                part -= weight * dot(&residual[..block.dim], &support.direction[..block.dim]);
            }
        }
        part
    }
}
