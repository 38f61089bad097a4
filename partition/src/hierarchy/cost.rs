//! Cost of the tree's nodes: their fronts, and estimates of flops and time.

use super::tree::Tree;
use crate::flops::{Front, condensation};
use crate::id::TreeNodeId;

/// Approximate number of active sets until convergence.
pub const ACTIVE_SETS: f64 = 8.0;

impl Tree {
    /// The unknowns that node v eliminates and keeps, with `dim` unknowns at each node of a subdomain.
    pub fn front(&self, v: TreeNodeId, dim: usize) -> Front {
        let node = &self.nodes[v];
        let [eliminated, kept] = node.dofs;
        let kept = kept + node.conditions;
        let eliminated = match self.block(v).is_some() {
            true => (dim * node.of_subdomain).saturating_sub(kept),
            false => eliminated.saturating_sub(self.own_conditions(v) + node.tied),
        };
        Front { eliminated, kept }
    }

    /// The front of node v with a fixed active set, where no normal jump under the node is kept.
    pub fn active_set_front(&self, v: TreeNodeId, dim: usize) -> Front {
        let (front, node) = (self.front(v, dim), &self.nodes[v]);
        Front {
            eliminated: front.eliminated,
            kept: front.kept - node.conditions + node.points.len(),
        }
    }

    /// The front of node v, which keeps all normal jumps under it unless the active set is fixed.
    pub fn front_of(&self, v: TreeNodeId, dim: usize, has_active_set: bool) -> Front {
        let (front, node) = (self.front(v, dim), &self.nodes[v]);
        match has_active_set {
            true => Front {
                eliminated: front.eliminated,
                kept: front.kept - node.conditions + self.own_conditions(v),
            },
            false => front,
        }
    }

    /// Estimated time of node v, in flops: its arithmetic and overhead, over all active sets if these are fixed one by
    /// one.
    pub fn time(&self, v: TreeNodeId, dim: usize, has_active_set: bool) -> f64 {
        let front = self.front_of(v, dim, has_active_set);
        match self.block(v).is_some() {
            true => front.time_to_condense(dim),
            false if has_active_set && self.nodes[v].conditions > 0 => ACTIVE_SETS * front.time(),
            false => front.time(),
        }
    }

    /// Estimated flops for condensing a subdomain, or for merging the children of an inner node.
    pub fn flops(&self, v: TreeNodeId, dim: usize) -> f64 {
        let front = self.front(v, dim);
        match self.block(v).is_some() {
            true => condensation(front.eliminated as f64, front.kept as f64, dim),
            false => front.flops(),
        }
    }
}
