//! Estimated cost of a run: memory and arithmetic of every rank, before the work starts.
//!
//! The constants of memory are fitted to measurements: in the plane to 45 peaks on 1 and 2 ranks, from 20 thousand to 2
//! million dofs, in 8 to 1000 subdomains, with up to 5000 contact constraints; in space to 7 of boxes and pins on 2
//! ranks, from 20 to 212 thousand dofs, with 441 to 5043 constraints. With a dense matrix of constraints, estimate over
//! measurement is 0.94 to 1.07.

use contact_dd_partition::flops::{Front, condensation};
use contact_dd_partition::id::TreeNodeId;
use contact_dd_partition::problem::Catalog;

use super::Plan;
use super::cluster::Merging;

/// Memory of an idle program (bytes).
const AT_REST: f64 = 2.8e7;
/// Memory of a block of n dofs by nested dissection, over n log₂ n (bytes): its factor and its mesh.
const PER_DOF: f64 = 50.0;
/// Time of other cells over that of three-node triangles: a constant, and a factor of the number of nodes per cell.
const PER_NODE_OF_CELL: [f64; 2] = [0.82, 0.4];
/// Memory that its boundary adds to a block's factor, over the boundary's size times √n, in the plane and in space, where
/// factors mostly have no rows on the boundary (bytes).
const PER_BOUNDARY: [f64; 2] = [165.0, 105.0];
/// An entry of a matrix (bytes).
const PER_ENTRY: f64 = 8.0;
/// Memory of a cluster of the iterative solver over the square of its number of unknowns (bytes): half of S, and half of
/// its factor in single precision.
const PER_ENTRY_OF_CLUSTER: f64 = 6.0;
/// Most memory of matrices kept for reuse (bytes).
const SPARE: f64 = 2.7e8;
/// Fragmentation: the part of the memory of matrices waiting to be merged that isn't reused, and its largest amount
/// (bytes). Freed matrices up to some size are kept by the allocator.
const IN_PIECES: f64 = 0.5;
const MOST_PIECES: f64 = 1e8;
/// Number of matrices over all constraints held at once during the solution: S of the cluster, H at the root, and H
/// condensed onto the closed constraints.
const OF_CONDITIONS: f64 = 4.5;

/// The estimated cost of a rank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CostEstimate {
    /// Memory at its peak (bytes).
    pub bytes: f64,
    /// Arithmetic of its factorizations (flops).
    pub flops: f64,
}

impl CostEstimate {
    /// The cost of some ranks together.
    pub fn sum(ranks: &[Self]) -> Self {
        Self {
            bytes: ranks.iter().map(|rank| rank.bytes).sum(),
            flops: ranks.iter().map(|rank| rank.flops).sum(),
        }
    }

    /// The largest memory of any rank, and the largest arithmetic of any.
    pub fn largest(ranks: &[Self]) -> Self {
        let largest = |of: fn(&Self) -> f64| ranks.iter().map(of).fold(0.0, f64::max);
        Self {
            bytes: largest(|rank| rank.bytes),
            flops: largest(|rank| rank.flops),
        }
    }
}

impl Plan {
    /// True if the front of node v is eliminated again for every active set.
    fn has_active_set_at(&self, v: TreeNodeId) -> bool {
        self.merging.has_active_set() && self.tree.nodes[v].conditions > 0
    }

    /// The cost of each of `ranks` ranks.
    pub fn cost_estimates(&self, catalog: &Catalog, ranks: usize) -> Vec<CostEstimate> {
        let mut estimates = vec![CostEstimate::default(); ranks];
        for (v, &owner) in self.node_owners.each() {
            if self.merging == Merging::Clusters && self.is_above_merge_roots(v) {
                continue;
            }
            let front = self.front(v, catalog.dim);
            let block = self.tree.block(v);
            let estimate = &mut estimates[owner];
            estimate.flops += match block.is_some() {
                true => condensation(front.eliminated as f64, front.kept as f64, catalog.dim),
                false => front.flops(),
            };
            let (eliminated, kept) = (front.eliminated as f64, front.kept as f64);
            if let Some(block) = block {
                let subdomain = &catalog.subdomains[block.index()];
                let n = eliminated.max(1.0);
                let [least, more] = PER_NODE_OF_CELL;
                let of_kind = least + more * subdomain.nodes as f64 / subdomain.cells.max(1) as f64;
                let per_boundary = PER_BOUNDARY[usize::from(catalog.dim == 3)];
                estimate.bytes += PER_DOF * of_kind * n * n.log2() + per_boundary * kept * n.sqrt();
            } else {
                // Open jumps are eliminated, too; closed ones are kept.
                let own = match self.has_active_set_at(v) {
                    true => self.tree.own_conditions(v) as f64,
                    false => 0.0,
                };
                estimate.bytes += PER_ENTRY * (eliminated + own) * (eliminated + kept);
            }
            // Merged fronts are kept for other active sets.
            if (self.merged_into(v)).is_some_and(|parent| self.has_active_set_at(parent)) {
                estimate.bytes += PER_ENTRY * kept * kept;
            }
        }
        if self.merging == Merging::Clusters {
            for &v in &self.merge_roots {
                let kept = self.front(v, catalog.dim).kept as f64;
                estimates[self.node_owners[v]].bytes += PER_ENTRY_OF_CLUSTER * kept * kept;
            }
        }
        let mut held = self.waiting(catalog.dim, ranks);
        if let (Some(root), false) = (held.first_mut(), self.merging.has_active_set()) {
            *root = root.max(self.of_interface_problem(catalog.dim));
        }
        for (estimate, held) in estimates.iter_mut().zip(held) {
            estimate.bytes += AT_REST + held + (IN_PIECES * held).min(MOST_PIECES);
        }
        estimates
    }

    /// The largest memory, on each of `ranks` ranks, of matrices waiting to be merged and of the one that they are
    /// merged into (bytes).
    fn waiting(&self, dim: usize, ranks: usize) -> Vec<f64> {
        let (mut now, mut most) = (vec![0.0; ranks], vec![0.0f64; ranks]);
        let s = |v: TreeNodeId| PER_ENTRY * (self.front(v, dim).kept as f64).powi(2);
        for cluster in &self.clusters {
            for v in self.tree.subtree(cluster.node) {
                let (owner, children) = (self.node_owners[v], &self.tree.nodes[v].children);
                let is_elsewhere = |child: &&TreeNodeId| self.node_owners[**child] != owner;
                let arrived = children.iter().filter(is_elsewhere).map(|&child| s(child));
                let merged: f64 = children.iter().map(|&child| s(child)).sum();
                let all = now[owner] + arrived.sum::<f64>() + s(v) + merged.min(SPARE);
                most[owner] = most[owner].max(all);
                now[owner] += s(v);
                for &child in children {
                    now[self.node_owners[child]] -= s(child);
                }
            }
            // With fixed active sets, the cluster's matrix is counted among those kept for other sets.
            if self.merging.has_active_set() {
                now[cluster.owner] -= s(cluster.node);
            }
        }
        most
    }

    /// The front of node v in this plan.
    fn front(&self, v: TreeNodeId, dim: usize) -> Front {
        let front = self.tree.front_of(v, dim, self.merging.has_active_set());
        match self.leaves_its_nodes(v) {
            true => Front {
                eliminated: 0,
                kept: front.eliminated + front.kept,
            },
            false => front,
        }
    }

    /// Memory of the problem on Γ and of all constraints, at the root.
    fn of_interface_problem(&self, dim: usize) -> f64 {
        let roots = self.tree.roots();
        let [mut shared, mut conditions] = [0.0; 2];
        for v in roots {
            conditions += self.tree.nodes[v].conditions as f64;
            if self.leaves_its_nodes(v) {
                shared += self.tree.front(v, dim).eliminated as f64;
            }
        }
        PER_ENTRY * (OF_CONDITIONS * conditions * conditions + 2.0 * shared * (shared + conditions))
    }
}
