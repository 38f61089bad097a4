//! What a tree costs.

use crate::flops::Front;
use crate::problem::Catalog;
use crate::problem::tree::{ACTIVE_SETS, Tree};

/// What the nodes of a problem's hierarchy cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// The front of every inner node.
    pub fronts: Vec<Front>,
    /// Estimated work under the heaviest child of the heaviest root, over the mean of all its
    /// children; 1 where there is none.
    pub uneven_halves: f64,
    /// Best possible speed-up: estimated time of all nodes over that of the costliest way from a leaf to a root.
    pub speed_up: f64,
}

/// What doubling the number of ranks must gain.
const GAIN: f64 = 0.2;

impl Work {
    /// What the hierarchy of `catalog` costs; the speed-up is that over all active sets where these are frozen.
    pub fn new(catalog: &Catalog) -> Self {
        let (tree, dim) = (Tree::new(catalog), catalog.dim);
        let is_frozen = tree.freezing_pays(catalog);
        let front = |v: usize| match is_frozen {
            true => tree.frozen_front(v, dim),
            false => tree.front(v, dim),
        };
        let time = |v: usize| match v < tree.subdomains {
            true => front(v).time_to_condense(dim),
            false if is_frozen && tree.nodes[v].conditions > 0 => ACTIVE_SETS * front(v).time(),
            false => front(v).time(),
        };
        let nodes = 0..tree.nodes.len();
        let costs: Vec<f64> = nodes.map(|v| tree.flops(v, dim)).collect();
        let inner = tree.subdomains..tree.nodes.len();
        Self {
            fronts: inner.map(front).collect(),
            uneven_halves: uneven_halves(&tree, &tree.sums(&costs)),
            speed_up: speed_up(&tree, time),
        }
    }

    /// The largest useful number of ranks: the next power of 2 would save less than a fifth of the time.
    ///
    /// With r ranks that don't wait for each other more than the tree makes them, the work outside of the
    /// costliest way takes 1/r of its time (Brent 1974).
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

/// `time` is that of each node.
fn speed_up(tree: &Tree, time: impl Fn(usize) -> f64) -> f64 {
    let mut all = 0.0;
    let mut ways = vec![0.0f64; tree.nodes.len()];
    for v in 0..tree.nodes.len() {
        let own = time(v);
        let children = tree.nodes[v].children.iter().map(|&child| ways[child]);
        ways[v] = own + children.fold(0.0, f64::max);
        all += own;
    }
    all / ways.into_iter().fold(f64::MIN_POSITIVE, f64::max)
}

/// `below` has the work of every node with all that is under it.
fn uneven_halves(tree: &Tree, below: &[f64]) -> f64 {
    let roots = (0..tree.nodes.len()).filter(|&v| tree.nodes[v].parent.is_none());
    let heaviest = roots.max_by(|&a, &b| below[a].total_cmp(&below[b]));
    let children = heaviest.map_or(&[][..], |root| &tree.nodes[root].children);
    let work = children.iter().map(|&child| below[child]);
    let (largest, sum) = (work.clone().fold(0.0, f64::max), work.sum::<f64>());
    match children.len() {
        0 => 1.0,
        count => largest * count as f64 / sum,
    }
}
