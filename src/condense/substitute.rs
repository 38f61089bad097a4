//! Loads up the hierarchy and solutions down again, with the factors at hand.

use std::collections::BTreeMap;

use crate::condense::blocks::CondensedBlocks;
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
}

impl Factors<'_> {
    /// Condenses `loads` on the blocks up to the clusters; returns the load of every node of this rank.
    /// Collective.
    pub fn condense(&self, mut loads: BTreeMap<usize, Vec<f64>>) -> BTreeMap<usize, CondensedLoad> {
        let (context, condensed) = (&self.context, self.condensed);
        let mut of_nodes: BTreeMap<usize, CondensedLoad> = BTreeMap::new();
        let mut arrived = BTreeMap::new();
        for v in self.nodes() {
            let children = &context.plan.tree.nodes[v].children;
            for &child in children {
                let load = of_nodes.get(&child).map(|load| load.boundary().to_vec());
                carry(context, child, Some(v), load, &mut arrived, Direction::Up);
            }
            if let Some(block) = condensed.blocks.get(&v) {
                let load = loads.remove(&v).unwrap_or_default();
                of_nodes.insert(v, block.factor.condense(load));
            } else if let Some(merge) = condensed.merges.get(&v) {
                let of_children: Vec<&[f64]> =
                    children.iter().map(|child| &arrived[child][..]).collect();
                of_nodes.insert(v, merge.condense(&of_children, &[]));
            }
        }
        of_nodes
    }

    /// The unknowns of every block of this rank for those on the `boundaries` of its clusters, by node,
    /// where `loads` are the condensed ones. Collective.
    pub fn recover(
        &self,
        loads: &BTreeMap<usize, CondensedLoad>,
        mut boundaries: BTreeMap<usize, Vec<f64>>,
    ) -> BTreeMap<usize, Vec<f64>> {
        let (context, condensed) = (&self.context, self.condensed);
        let mut of_blocks = BTreeMap::new();
        for v in self.nodes().into_iter().rev() {
            let mut of_children: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
            let children = &context.plan.tree.nodes[v].children;
            if let (Some(x), Some(load)) = (boundaries.remove(&v), loads.get(&v)) {
                if let Some(block) = condensed.blocks.get(&v) {
                    of_blocks.insert(v, block.factor.recover(load, &x));
                } else if let Some(merge) = condensed.merges.get(&v) {
                    let x = merge.recover(load, &x).0;
                    of_children.extend(children.iter().copied().zip(x));
                }
            }
            for &child in children {
                let x = of_children.remove(&child);
                carry(context, child, Some(v), x, &mut boundaries, Direction::Down);
            }
        }
        of_blocks
    }

    /// The nodes of all clusters, children before parents, on all ranks the same.
    fn nodes(&self) -> Vec<usize> {
        let clusters = self.context.plan.clusters.iter();
        clusters
            .flat_map(|c| self.context.plan.tree.subtree(c.node))
            .collect()
    }
}
