//! The cost of a tree.

use super::choice::{Operator, OperatorTimes, iteration_flops};
use super::tree::Tree;
use crate::flops::Front;
use crate::id::TreeNodeId;
use crate::numbered::Numbered;
use crate::problem::Catalog;

/// The cost of the nodes of a problem's hierarchy.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// The front of every inner node.
    pub fronts: Vec<Front>,
    /// Load imbalance at the top: estimated work under the heaviest child of the heaviest root over the average of its
    /// children; 1 without children.
    pub imbalance: f64,
    /// Best possible speed-up: estimated time of all nodes over that of the critical path from a leaf to a root.
    pub speed_up: f64,
}

/// Least relative gain for which the number of ranks is doubled.
const GAIN: f64 = 0.2;

impl Work {
    /// The cost of the hierarchy of `catalog`; the speed-up covers all active sets if these are fixed one by one, and
    /// the iterations between clusters if these take less time.
    pub fn new(catalog: &Catalog) -> Self {
        let (tree, dim) = (Tree::new(catalog), catalog.dim);
        let operators = OperatorTimes::new(catalog, &tree);
        let has_active_set = operators.direct().next() == Some(Operator::Tree);
        let front = |v: TreeNodeId| match has_active_set {
            true => tree.active_set_front(v, dim),
            false => tree.front(v, dim),
        };
        let (times, coarse) = match operators.fastest() {
            Operator::Clusters => (times_to_clusters(&tree, dim), operators.coarse),
            _ => {
                let nodes = tree.nodes.ids();
                (
                    nodes.map(|v| tree.time(v, dim, has_active_set)).collect(),
                    0.0,
                )
            }
        };
        let nodes = tree.nodes.ids();
        let costs: Numbered<TreeNodeId, f64> = nodes.map(|v| tree.flops(v, dim)).collect();
        let inner = tree.nodes.ids().skip(tree.subdomains);
        Self {
            fronts: inner.map(front).collect(),
            imbalance: imbalance(&tree, &tree.sums(&costs)),
            speed_up: speed_up(&tree, &times, coarse),
        }
    }

    /// The largest useful number of ranks: the next power of 2 would save less than a fifth of the time.
    ///
    /// With r ranks that wait for each other only as the tree requires, the work outside of the critical path takes 1/r
    /// of its time (Brent 1974).
    pub fn useful_ranks(&self) -> usize {
        let time = |ranks: usize| 1.0 + (self.speed_up - 1.0) / ranks as f64;
        let powers = (0..usize::BITS - 1).map(|power| 1 << power);
        let last = powers
            .clone()
            .find(|&r| time(2 * r) > (1.0 - GAIN) * time(r));
        last.unwrap_or(1)
    }

    /// Flops of all fronts.
    pub fn of_fronts(&self) -> f64 {
        // The empty sum of floats is −0.
        self.fronts.iter().map(Front::flops).fold(0.0, |a, b| a + b)
    }
}

/// Times of all nodes if nothing is merged above clusters, iterations between clusters included.
fn times_to_clusters(tree: &Tree, dim: usize) -> Numbered<TreeNodeId, f64> {
    let mut times = tree.nodes.like(0.0);
    for &cluster in &tree.clusters {
        for v in tree.subtree(cluster) {
            times[v] = tree.time(v, dim, true);
        }
        times[cluster] += iteration_flops(tree.nodes[cluster].dofs[1] as f64);
    }
    times
}

/// The speed-up from the `times` of all nodes and the time `coarse` of a sparse coarse problem: with nested dissection
/// in space, two thirds of it lie on the critical path.
fn speed_up(tree: &Tree, times: &Numbered<TreeNodeId, f64>, coarse: f64) -> f64 {
    let mut all = coarse;
    let mut paths = tree.nodes.like(0.0f64);
    for (v, &own) in times.each() {
        let children = tree.nodes[v].children.iter().map(|&child| paths[child]);
        paths[v] = own + children.fold(0.0, f64::max);
        all += own;
    }
    let longest = paths.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    all / (longest + 2.0 / 3.0 * coarse)
}

/// The load imbalance from `below`, the work of every node including its subtree.
fn imbalance(tree: &Tree, below: &Numbered<TreeNodeId, f64>) -> f64 {
    let heaviest = tree.roots().max_by(|&a, &b| below[a].total_cmp(&below[b]));
    let children = heaviest.map_or(&[][..], |root| &tree.nodes[root].children);
    let work = children.iter().map(|&child| below[child]);
    let (largest, sum) = (work.clone().fold(0.0, f64::max), work.sum::<f64>());
    match children.len() {
        0 => 1.0,
        count => largest * count as f64 / sum,
    }
}
