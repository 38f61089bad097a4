//! A block as its owner has it: subdomains and contact rows from the problem file.

use std::hash::{DefaultHasher, Hash, Hasher};

use contact_dd_partition::problem::ContactRow;

use super::block::Block;
use super::condition::BlockCondition;
use crate::schur::repeats::BlockShape;

/// A block as it was read.
#[derive(Clone, Debug)]
pub struct OwnedBlock {
    /// Its subdomains.
    pub block: Block,
    /// Its contact rows.
    pub rows: Vec<ContactRow>,
    /// The same over the nodes of the block.
    pub conditions: Vec<BlockCondition>,
}

impl OwnedBlock {
    /// What it has in common with blocks that are equal to it.
    pub fn shape(&self) -> BlockShape {
        let mut mesh = DefaultHasher::new();
        let points = &self.block.points;
        for (point, first) in points.iter().flat_map(|p| p.iter().zip(&points[0])) {
            mesh.write_u64((point - first).to_bits());
        }
        for member in &self.block.members {
            member.cells.connectivity().hash(&mut mesh);
        }
        BlockShape {
            interface: self.block.interface.len(),
            conditions: self.conditions.len(),
            mesh: mesh.finish(),
        }
    }
}
