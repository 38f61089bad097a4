//! Condensation of blocks and merging up the hierarchy to the clusters.

use std::collections::BTreeMap;

use contact_dd_partition::id::{BlockId, OnPairs, OnTreeNodes, TreeNodeId};

use crate::comm::is_asked_to_stop;
use crate::condense::Condensation;
use crate::condense::blocks::CondensedBlocks;
use crate::condense::clusters::take_clusters;
use crate::condense::limits::{limits_of_clusters, limits_of_groups};
use crate::context::Context;
use crate::error::Failure;
use crate::interface::numbering::check_agreement;
use crate::interface::rigid_modes::RigidModes;
use crate::schur::cluster_schur::ClusterSchur;
use crate::schur::condensed::{Condensed, InterfaceDof};
use crate::schur::merge::{FreeInterfaceDof, MatrixPool, Merge};

/// Condenses the `blocks` of this rank and merges them, with the Schur complements that other ranks send, up to the
/// clusters. Collective.
///
/// # Errors
/// A part with a free motion although its boundary is held, or supports that differ between subdomains.
pub fn condense_clusters(
    condensation: &Condensation<'_>,
    modes: &OnPairs<RigidModes>,
) -> Result<CondensedBlocks, Failure> {
    let Context {
        comm,
        catalog,
        plan,
        listener,
        ..
    } = condensation.context;
    let mut merging = Merging {
        condensation,
        condensed: CondensedBlocks::default(),
        waiting: BTreeMap::new(),
        spare: MatrixPool::default(),
    };
    let (alone, across) = merging.nodes();
    let time = |&v: &TreeNodeId| match plan.node_owners[v] == comm.rank() {
        true => plan.time(v, catalog.dim),
        false => 0.0,
    };
    let all: f64 = alone.iter().chain(&across).map(time).sum();
    let mut spent = 0.0;
    let mut is_done = |v: TreeNodeId| {
        spent += time(&v);
        listener.done((spent / all).clamp(f64::MIN_POSITIVE, 1.0));
    };
    listener.done(0.0);
    // First the nodes that need no other rank, depth first, so that few matrices wait at a time.
    let mut merged = alone.into_iter().try_for_each(|v| {
        if is_asked_to_stop() {
            return Err(Failure::interrupted("interrupted while factorizing"));
        }
        merging.own_node(v)?;
        is_done(v);
        Ok(())
    });
    // Then those across ranks, even if this rank has failed: the missing child then makes its parent fail.
    for v in across {
        let result = merging.node_across_ranks(v);
        merged = merged.and(result);
        is_done(v);
    }
    comm.agree(merged)?;
    let Merging {
        mut condensed,
        waiting,
        ..
    } = merging;
    let (context, loads) = (&condensation.context, condensation.loads);
    let of_groups =
        limits_of_groups(context, loads).map_err(|failure| context.in_step(failure, 0))?;
    let limits = limits_of_clusters(context, &of_groups);
    take_clusters(plan, modes, limits, waiting, &mut condensed);
    Ok(condensed)
}

/// State of the merges of this rank.
struct Merging<'a> {
    condensation: &'a Condensation<'a>,
    condensed: CondensedBlocks,
    /// Condensed nodes waiting to be merged.
    waiting: OnTreeNodes<Condensed>,
    /// Memory of matrices already merged.
    spare: MatrixPool,
}

impl Merging<'_> {
    /// The nodes of clusters for which all nodes below belong to this rank, depth first; and, the same on all ranks,
    /// those with nodes of several ranks below.
    fn nodes(&self) -> (Vec<TreeNodeId>, Vec<TreeNodeId>) {
        let plan = self.condensation.context.plan;
        let (mut alone, mut across) = (Vec::new(), Vec::new());
        let mut is_whole = plan.tree.nodes.like(true);
        for cluster in &plan.clusters {
            for v in plan.tree.subtree(cluster.node) {
                let owner = plan.node_owners[v];
                let children = &plan.tree.nodes[v].children;
                is_whole[v] = (children.iter())
                    .all(|&child| is_whole[child] && plan.node_owners[child] == owner);
                match is_whole[v] {
                    true if owner == self.condensation.context.comm.rank() => alone.push(v),
                    true => {}
                    false => across.push(v),
                }
            }
        }
        (alone, across)
    }

    /// Condenses a block, or merges the children of an inner node, all of them on this rank.
    fn own_node(&mut self, v: TreeNodeId) -> Result<(), Failure> {
        let Context { plan, blocks, .. } = self.condensation.context;
        if let Some((b, block)) = (plan.tree.block(v)).and_then(|b| Some((b, blocks.get(&b)?))) {
            let of_block = self.condensation.condense(b, block, &mut self.condensed)?;
            self.keep(v, of_block);
            return Ok(());
        }
        let children = &plan.tree.nodes[v].children;
        let waiting = children
            .iter()
            .filter_map(|child| self.waiting.remove(child));
        let children = waiting.collect();
        self.merge(v, children)
    }

    /// Merges the children of an inner node that belong to several ranks. Collective.
    fn node_across_ranks(&mut self, v: TreeNodeId) -> Result<(), Failure> {
        let plan = self.condensation.context.plan;
        let (me, owner) = (self.condensation.context.comm.rank(), plan.node_owners[v]);
        let children = &plan.tree.nodes[v].children;
        let mut arrived = Vec::new();
        for child in children {
            match (plan.node_owners[*child], owner == me) {
                (of_child, true) if of_child == me => arrived.extend(self.waiting.remove(child)),
                (of_child, true) => {
                    let comm = self.condensation.context.comm;
                    arrived.extend(comm.receive::<Option<Condensed>>(of_child));
                }
                (of_child, false) if of_child == me => {
                    let comm = self.condensation.context.comm;
                    comm.send(owner, &self.waiting.remove(child));
                }
                _ => {}
            }
        }
        // A child is missing if it failed; its owner reports the failure.
        if owner == me && arrived.len() == children.len() {
            self.merge(v, arrived)?;
        }
        Ok(())
    }

    /// Keeps S of node v until it is merged, or packed, for the iterations between clusters, which begin here.
    fn keep(&mut self, v: TreeNodeId, condensed: Condensed) {
        let plan = self.condensation.context.plan;
        if plan.merging.has_active_set() && plan.is_merge_root(v) {
            let (packed, s) = ClusterSchur::packed(condensed);
            self.condensed.merge_roots.insert(v, packed);
            self.spare.keep(s);
        } else {
            self.waiting.insert(v, condensed);
        }
    }

    fn merge(&mut self, v: TreeNodeId, children: Vec<Condensed>) -> Result<(), Failure> {
        let Context { comm, plan, .. } = self.condensation.context;
        let began = comm.times();
        let node = &plan.tree.nodes[v];
        let interface_dofs: Vec<&[InterfaceDof]> =
            children.iter().map(|c| &c.interface_dofs[..]).collect();
        let kept = node
            .children
            .iter()
            .map(|&child| &plan.tree.nodes[child].kept[..]);
        check_agreement(&interface_dofs, &kept.collect::<Vec<_>>())?;
        let (merge, condensed) = Merge::new(
            children,
            plan.eliminated(v),
            &self.condensation.replaced(v)?,
            &mut self.spare,
            self.condensation.context.par,
        )
        .map_err(|FreeInterfaceDof(dof)| self.free_motion(v, dof))?;
        self.condensed.merges.insert(v, merge);
        self.keep(v, condensed);
        self.condensed.seconds[1] += comm.times() - began;
        Ok(())
    }

    fn free_motion(&self, v: TreeNodeId, dof: InterfaceDof) -> Failure {
        let plan = self.condensation.context.plan;
        let under = plan.tree.subtree(v).into_iter();
        let subdomains: Vec<BlockId> = under.filter_map(|v| plan.tree.block(v)).collect();
        let first = (subdomains.iter().min().copied()).unwrap_or(BlockId::new(0));
        let body = self.condensation.context.catalog.body_of(first);
        Failure::ill_posed(format!(
            "body '{}': its {} subdomains around subdomain {first} can move although their boundary \
             is held (found at node {} of /interface/interface); expected supports or contact that \
             hold them",
            self.condensation.context.catalog.bodies[body].name,
            subdomains.len(),
            dof.node
        ))
    }
}
