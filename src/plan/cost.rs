//! What a run will cost: memory and arithmetic of every rank, before either is spent.
//!
//! The constants of memory are measured: on 45 peaks of 1 and 2 ranks, from 20 thousand to 2 million dofs, in 8
//! to 1000 subdomains, with up to 5000 contact conditions, the estimate is within a quarter of each; in space on 4 peaks
//! of blocks of tetrahedra with 49 thousand to a million dofs; where active sets are frozen on 3 of walls with 20 and 107
//! thousand conditions.

use contact_dd_partition::flops::condensation;
use contact_dd_partition::problem::Catalog;

use super::Plan;
use super::cluster::Merging;

/// Memory of a program that does nothing yet (bytes).
const AT_REST: f64 = 2.8e7;
/// A block of n dofs, by nested dissection n log n, in bytes: its factor and its mesh.
const PER_DOF: f64 = 50.0;
/// Time of other cells over that of triangles of three nodes: a constant, and for each node by cell.
const PER_NODE_OF_CELL: [f64; 2] = [0.82, 0.4];
/// The part of a block's factor that its boundary adds, by its size times √n (bytes).
const PER_BOUNDARY: f64 = 165.0;
/// An entry of the largest matrix that blocks are merged in (bytes): it and its children.
const PER_ENTRY: f64 = 16.0;
/// An entry of the factor of a front, or of what is left there (bytes), which counts in space and above frozen contact.
const PER_ENTRY_OF_FACTOR: f64 = 8.0;
/// An entry of S of a cluster between which an iterative solver works (bytes): S, and its part of the preconditioner.
const PER_ENTRY_OF_CLUSTER: f64 = 8.0;
/// An entry of the contact problem of all pairs, at the root (bytes).
const PER_PAIR_OF_CONDITIONS: f64 = 33.0;

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

    /// The memory of the rank that needs most of it, and the arithmetic of the one that needs most of that.
    pub fn largest(ranks: &[Self]) -> Self {
        let largest = |of: fn(&Self) -> f64| ranks.iter().map(of).fold(0.0, f64::max);
        Self {
            bytes: largest(|rank| rank.bytes),
            flops: largest(|rank| rank.flops),
        }
    }
}

impl Plan {
    /// Whether the front of node v is made again for every active set.
    fn is_frozen_at(&self, v: usize) -> bool {
        self.merging.is_frozen() && self.tree.nodes[v].conditions > 0
    }

    /// What every one of `ranks` ranks needs.
    pub fn cost_estimates(&self, catalog: &Catalog, ranks: usize) -> Vec<CostEstimate> {
        let mut estimates = vec![CostEstimate::default(); ranks];
        let mut largest = vec![0.0f64; ranks];
        let all = self.node_owners.iter().enumerate();
        for (v, &owner) in
            all.filter(|&(v, _)| self.merging != Merging::Clusters || !self.is_above_merge_roots(v))
        {
            let front = self.tree.front_of(v, catalog.dim, self.merging.is_frozen());
            let estimate = &mut estimates[owner];
            estimate.flops += match v < self.blocks() {
                true => condensation(front.eliminated as f64, front.kept as f64, catalog.dim),
                false => front.flops(),
            };
            if let Some(subdomain) = catalog.subdomains.get(v) {
                let (n, kept) = (front.eliminated.max(1) as f64, front.kept as f64);
                let [least, more] = PER_NODE_OF_CELL;
                let of_kind = least + more * subdomain.nodes as f64 / subdomain.cells.max(1) as f64;
                estimate.bytes += PER_DOF * of_kind * n * n.log2() + PER_BOUNDARY * kept * n.sqrt();
            } else {
                let size = (front.eliminated + front.kept) as f64;
                largest[owner] = largest[owner].max(size);
                if catalog.dim == 3 || self.is_frozen_at(v) {
                    estimate.bytes += PER_ENTRY_OF_FACTOR * front.eliminated as f64 * size;
                }
            }
            // What is merged there is kept for other active sets.
            if (self.merged_into(v)).is_some_and(|parent| self.is_frozen_at(parent)) {
                estimate.bytes += PER_ENTRY_OF_FACTOR * (front.kept as f64).powi(2);
            }
        }
        if self.merging == Merging::Clusters {
            for &v in &self.merge_roots {
                let kept = self.tree.nodes[v].dofs[1] as f64;
                estimates[self.node_owners[v]].bytes += PER_ENTRY_OF_CLUSTER * kept * kept;
            }
        }
        for (estimate, largest) in estimates.iter_mut().zip(largest) {
            estimate.bytes += AT_REST + PER_ENTRY * largest * largest;
        }
        if let (Some(root), true) = (estimates.first_mut(), !self.merging.is_frozen()) {
            root.bytes += PER_PAIR_OF_CONDITIONS * (catalog.conditions() as f64).powi(2);
        }
        estimates
    }
}
