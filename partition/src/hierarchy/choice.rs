//! Which interface solver takes less time: factors up to the roots of the hierarchy, or iterations between clusters.
//!
//! The constants are fitted to the times of two blocks of tetrahedra in contact, with 50 thousand to a million dofs:
//! they say which is faster there, and about where one becomes the other elsewhere.

use std::collections::BTreeMap;

use super::cost::ACTIVE_SETS;
use super::tree::Tree;
use crate::problem::Catalog;

/// Iterations that an active set takes in all, about.
const ITERATIONS: f64 = 60.0;
/// What an entry of S of a cluster takes in an iteration, in flops: it and its factor are read from memory.
const PER_ENTRY: f64 = 24.0;
/// What the part of a cluster in the preconditioner takes, over the cube of its size.
const PER_CUBE: f64 = 0.3;
/// Flops that the coarse problem takes, over the square of its size, in space.
const PER_COARSE_PAIR: f64 = 12.0;

/// Estimated flops that a cluster with so many unknowns on its boundary takes where iterations run between clusters.
pub fn iteration_flops(size: f64) -> f64 {
    PER_CUBE * size.powi(3) + ITERATIONS * PER_ENTRY * size * size
}

/// Estimated number of coarse unknowns between the clusters of a tree: of the nodes that the same clusters share, their
/// rigid motions.
pub fn coarse_dofs(tree: &Tree, dim: usize) -> usize {
    let mut clusters: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for &c in &tree.clusters {
        for &node in &tree.nodes[c].kept {
            clusters.entry(node).or_default().push(c);
        }
    }
    let mut classes: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
    for of_node in clusters.into_values().filter(|list| list.len() > 1) {
        *classes.entry(of_node).or_default() += 1;
    }
    let motions = dim * (dim + 1) / 2;
    let of_class = classes.into_values().map(|nodes| motions.min(dim * nodes));
    of_class.sum()
}

/// Estimated times, in flops: arithmetic, and what goes with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterfaceTimes {
    /// Factors up to the roots.
    pub direct: f64,
    /// Iterations between clusters.
    pub iterative: f64,
    /// The coarse problem, a part of these.
    pub coarse: f64,
}

impl InterfaceTimes {
    /// The times of a scene in space without friction, whose clusters are known and whose contact is node by node:
    /// others
    /// are solved directly, mortar because its conditions tie many unknowns of two clusters to each other.
    pub fn new(catalog: &Catalog) -> Option<Self> {
        let is_node_by_node = (catalog.points.iter()).all(|point| point.entries.len() <= 2);
        let can_be_either = catalog.dim == 3 && !catalog.has_friction() && is_node_by_node;
        if !can_be_either || catalog.hierarchy.clusters.len() < 2 {
            return None;
        }
        let tree = Tree::new(catalog);
        let is_frozen = tree.freezing_pays(catalog);
        let time = |v: usize, is_frozen| tree.time(v, catalog.dim, is_frozen);
        let direct = (0..tree.nodes.len()).map(|v| time(v, is_frozen)).sum();
        let of_cluster = |&c: &usize| {
            let size = tree.nodes[c].dofs[1] as f64;
            let below = tree.subtree(c).into_iter();
            let below: f64 = below.map(|v| time(v, true)).sum();
            below + iteration_flops(size)
        };
        let coarse = (coarse_dofs(&tree, catalog.dim) as f64).powi(2);
        let coarse = ACTIVE_SETS * PER_COARSE_PAIR * coarse;
        let clusters: f64 = tree.clusters.iter().map(of_cluster).sum();
        Some(Self {
            direct,
            iterative: clusters + coarse,
            coarse,
        })
    }

    /// Whether iterations take less.
    pub fn is_iterative(self) -> bool {
        self.iterative < self.direct
    }
}
