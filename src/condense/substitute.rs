//! Condensation of loads up the hierarchy, and back-substitution down again, with existing factors.

use std::collections::BTreeMap;

use contact_dd_partition::id::{BlockId, OnBlocks, OnGroups, OnTreeNodes, TreeNodeId};
use contact_dd_partition::numbered::Numbered;

use crate::condense::blocks::{CondensedBlock, CondensedBlocks};
use crate::condense::limits::TiedJumps;
use crate::context::Context;
use crate::context::hierarchy::{Direction, carry};
use crate::schur::local::CondensedLoad;

/// The factors of all ranks.
#[derive(Clone, Copy)]
pub struct Factors<'a> {
    /// The context of the run.
    pub context: Context<'a>,
    /// The factors of this rank.
    pub condensed: &'a CondensedBlocks,
    /// The nodes of the hierarchy with loads or requested solutions, and all nodes between them and the clusters,
    /// inclusive; all nodes if `None`.
    pub only: Option<&'a Numbered<TreeNodeId, bool>>,
}

impl Factors<'_> {
    /// Condenses `loads` on the blocks up to the clusters, where ties have these jumps; returns the load of every node
    /// of this rank. Collective.
    pub fn condense(
        &self,
        mut loads: OnBlocks<Vec<f64>>,
        tied: &TiedJumps,
    ) -> OnTreeNodes<CondensedLoad> {
        let (context, condensed) = (&self.context, self.condensed);
        let mut of_nodes: OnTreeNodes<CondensedLoad> = BTreeMap::new();
        let mut arrived = BTreeMap::new();
        for v in self.nodes() {
            let children = &context.plan.tree.nodes[v].children;
            for &child in children.iter().filter(|child| self.has(**child)) {
                let load = of_nodes.get(&child).map(|load| load.boundary().to_vec());
                carry(context, child, Some(v), load, &mut arrived, Direction::Up);
            }
            if let Some((b, block)) = self.block(v) {
                let load = loads.remove(&b).unwrap_or_default();
                of_nodes.insert(v, block.factor.condense(load));
            } else if let Some(merge) = condensed.merges.get(&v) {
                // Children without a load have none to send.
                let arrived = children.iter().map(|child| arrived.get(child));
                let of_children: Vec<&[f64]> = arrived
                    .map(|load: Option<&Vec<f64>>| load.map_or(&[][..], Vec::as_slice))
                    .collect();
                let group = context.plan.group_of(v);
                let known = group.and_then(|g| tied.get(&g)).into_iter().flatten();
                let known: Vec<f64> = known.map(|&(_, jump)| jump).collect();
                of_nodes.insert(v, merge.condense(&of_children, &[], &known));
            }
        }
        of_nodes
    }

    /// The unknowns of every block of this rank from those on the `boundaries` of its clusters, by node, where `loads`
    /// are the condensed loads; and the forces of ties below clusters, by contact group. Collective.
    pub fn recover(
        &self,
        loads: &OnTreeNodes<CondensedLoad>,
        mut boundaries: OnTreeNodes<Vec<f64>>,
    ) -> (OnBlocks<Vec<f64>>, OnGroups<Vec<f64>>) {
        let (context, condensed) = (&self.context, self.condensed);
        let (mut of_blocks, mut of_ties) = (BTreeMap::new(), BTreeMap::new());
        for v in self.nodes().into_iter().rev() {
            let mut of_children: OnTreeNodes<Vec<f64>> = BTreeMap::new();
            let children = &context.plan.tree.nodes[v].children;
            if let (Some(x), Some(load)) = (boundaries.remove(&v), loads.get(&v)) {
                if let Some((b, block)) = self.block(v) {
                    of_blocks.insert(b, block.factor.recover(load, &x));
                } else if let Some(merge) = condensed.merges.get(&v) {
                    let recovered = merge.recover(load, &x);
                    of_children.extend(children.iter().copied().zip(recovered.children));
                    if let Some(g) = context.plan.group_of(v) {
                        of_ties.insert(g, recovered.forces);
                    }
                }
            }
            for &child in children.iter().filter(|child| self.has(**child)) {
                let x = of_children.remove(&child);
                carry(context, child, Some(v), x, &mut boundaries, Direction::Down);
            }
        }
        (of_blocks, of_ties)
    }

    /// The nodes of all clusters, children before parents, the same on all ranks.
    fn nodes(&self) -> Vec<TreeNodeId> {
        let clusters = self.context.plan.clusters.iter();
        clusters
            .flat_map(|c| self.context.plan.tree.subtree(c.node))
            .filter(|&v| self.has(v))
            .collect()
    }

    /// The block of node v, if this rank has it.
    fn block(&self, v: TreeNodeId) -> Option<(BlockId, &CondensedBlock)> {
        let b = self.context.plan.tree.block(v)?;
        Some((b, self.condensed.blocks.get(&b)?))
    }

    /// True if a node takes part in condensation and back-substitution.
    fn has(&self, v: TreeNodeId) -> bool {
        self.only.is_none_or(|only| only[v])
    }
}
