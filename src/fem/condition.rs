//! Contact conditions n·(u_a − u_b) ≤ g, rows of B u ≤ g over the nodes of a block.

use contact_dd_partition::problem::ContactRow;

use super::block::Block;

/// A condition of a block: Σ coefficient·u(node of the block) ≤ gap.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockCondition {
    /// Nodes of the block and coefficients.
    pub entries: Vec<(u32, [f64; 3])>,
    /// g (m).
    pub gap: f64,
}

impl BlockCondition {
    /// A row of the problem file in terms of the nodes of its block.
    pub fn new(block: &Block, row: &ContactRow) -> Self {
        let entries = row
            .entries
            .iter()
            .filter_map(|entry| {
                let m = block.member(entry.subdomain as usize)?;
                Some((block.node_of[m][entry.node as usize], entry.coefficient))
            })
            .collect();
        Self {
            entries,
            gap: row.gap,
        }
    }

    /// The gap that displacements `u`, node by node, leave: g − B u (m).
    pub fn gap_left(&self, dim: usize, u: &[f64]) -> f64 {
        let approach: f64 = self
            .entries
            .iter()
            .flat_map(|(node, c)| (0..dim).map(move |k| c[k] * u[*node as usize * dim + k]))
            .sum();
        self.gap - approach
    }
}
