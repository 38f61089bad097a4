//! How large the nodes of the hierarchy are, in unknowns.

use contact_dd_partition::flops::Front;
use contact_dd_partition::problem::Catalog;

use super::Plan;

/// The size of a node of the hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Size {
    /// A block that is condensed.
    Block {
        /// Number of nodes.
        nodes: usize,
        /// Number of cells.
        cells: usize,
        /// Unknowns that are eliminated.
        interior: usize,
        /// Unknowns that are kept.
        kept: usize,
    },
    /// An inner node, where Schur complements are merged.
    Merge(Front),
}

impl Plan {
    /// The size of node v.
    pub(super) fn size(&self, catalog: &Catalog, v: usize) -> Size {
        let node = &self.tree.nodes[v];
        let kept = catalog.dim * node.kept.len() + node.conditions;
        let Some(block) = self.blocks.get(v) else {
            return Size::Merge(Front {
                eliminated: catalog.dim * node.eliminated.len(),
                kept,
            });
        };
        let subdomains = block.subdomains.iter().map(|&s| &catalog.subdomains[s]);
        let nodes = subdomains.clone().map(|s| s.nodes).sum();
        Size::Block {
            nodes,
            cells: subdomains.map(|s| s.cells).sum(),
            interior: (catalog.dim * nodes).saturating_sub(kept),
            kept,
        }
    }
}
