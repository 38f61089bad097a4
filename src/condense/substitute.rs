//! Loads up the hierarchy and solutions down again, with the factors at hand.

use std::collections::BTreeMap;

use crate::bytes::Reals;
use crate::condense::blocks::CondensedBlocks;
use crate::context::Context;
use crate::schur::local::CondensedLoad;

/// The factors of all ranks.
#[derive(Clone, Copy)]
pub struct Factors<'a> {
    /// What the run works on.
    pub context: Context<'a>,
    /// What this rank has.
    pub condensed: &'a CondensedBlocks,
}

impl Factors<'_> {
    /// Condenses `loads` on the blocks up to the clusters; returns the load of every node of this rank.
    /// Collective.
    pub fn condense(&self, mut loads: BTreeMap<usize, Vec<f64>>) -> BTreeMap<usize, CondensedLoad> {
        let (plan, condensed) = (self.context.plan, self.condensed);
        let mut of_nodes: BTreeMap<usize, CondensedLoad> = BTreeMap::new();
        for v in self.nodes() {
            if let Some(block) = condensed.blocks.get(&v) {
                let load = loads.remove(&v).unwrap_or_default();
                of_nodes.insert(v, block.factor.condense(load));
                continue;
            }
            let mut arrived = BTreeMap::new();
            self.exchange(
                v,
                |child| {
                    of_nodes
                        .get(&child)
                        .map_or_else(Vec::new, |l| l.boundary().to_vec())
                },
                |child, load| {
                    arrived.insert(child, load);
                },
                Direction::Up,
            );
            if let Some(merge) = condensed.merges.get(&v) {
                let children = plan.tree.nodes[v].children.iter();
                let of_children: Vec<&[f64]> = children
                    .map(|child| match (of_nodes.get(child), arrived.get(child)) {
                        (Some(own), _) => own.boundary(),
                        (None, load) => load.map_or(&[][..], Vec::as_slice),
                    })
                    .collect();
                let load = merge.condense(&of_children);
                of_nodes.insert(v, load);
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
        let (plan, condensed) = (self.context.plan, self.condensed);
        let mut of_blocks = BTreeMap::new();
        for v in self.nodes().into_iter().rev() {
            let own = boundaries.remove(&v);
            if let (Some(block), Some(x), Some(load)) =
                (condensed.blocks.get(&v), &own, loads.get(&v))
            {
                of_blocks.insert(v, block.factor.recover(load, x));
                continue;
            }
            let mut of_children: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
            if let (Some(merge), Some(x), Some(load)) =
                (condensed.merges.get(&v), &own, loads.get(&v))
            {
                let children = plan.tree.nodes[v].children.iter().copied();
                of_children.extend(children.zip(merge.recover(load, x).0));
            }
            let mut arrived = Vec::new();
            self.exchange(
                v,
                |child| of_children.get(&child).cloned().unwrap_or_default(),
                |child, x| arrived.push((child, x)),
                Direction::Down,
            );
            let me = self.context.comm.rank();
            of_children.retain(|&child, _| plan.node_owners[child] == me);
            boundaries.extend(of_children);
            boundaries.extend(arrived);
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

    /// Sends what `make` makes for every child of v along the edge between them if it joins two ranks,
    /// and `take`s it at the other end. Collective.
    fn exchange(
        &self,
        v: usize,
        make: impl Fn(usize) -> Vec<f64>,
        mut take: impl FnMut(usize, Vec<f64>),
        direction: Direction,
    ) {
        let owners = &self.context.plan.node_owners;
        let across = self.context.plan.tree.nodes[v].children.iter().copied();
        let across: Vec<usize> = across.filter(|&child| owners[child] != owners[v]).collect();
        let ways = across.iter().map(|&child| match direction {
            Direction::Up => (owners[child], owners[v]),
            Direction::Down => (owners[v], owners[child]),
        });
        self.context.comm.route(
            ways,
            |i| Reals(make(across[i])),
            |i, Reals(list)| take(across[i], list),
        );
    }
}

/// Along the hierarchy.
#[derive(Clone, Copy)]
enum Direction {
    Up,
    Down,
}
