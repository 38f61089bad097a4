//! What a tree costs.

use crate::flops::Front;
use crate::problem::Catalog;
use crate::problem::tree::Tree;

/// What the nodes of a problem's hierarchy cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// The front of every inner node.
    pub fronts: Vec<Front>,
    /// Estimated work under the heaviest child of the heaviest root, over the mean of all its
    /// children; 1 where there is none.
    pub uneven_halves: f64,
}

impl Work {
    /// What the hierarchy of `catalog` costs.
    pub fn new(catalog: &Catalog) -> Self {
        let tree = Tree::new(catalog);
        let nodes = 0..tree.nodes.len();
        let costs: Vec<f64> = nodes.map(|v| tree.flops(v, catalog.dim)).collect();
        let inner = tree.subdomains..tree.nodes.len();
        Self {
            fronts: inner.map(|v| tree.front(v, catalog.dim)).collect(),
            uneven_halves: uneven_halves(&tree, &tree.sums(&costs)),
        }
    }

    /// Flops of all fronts.
    pub fn of_fronts(&self) -> f64 {
        // The empty sum of floats is −0.
        self.fronts.iter().map(Front::flops).fold(0.0, |a, b| a + b)
    }
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
