//! A block as its owner has it: subdomains and contact points from the problem file.

use std::hash::{DefaultHasher, Hash, Hasher};

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::problem::SubdomainNode;

use super::block::Block;
use crate::schur::repeats::BlockShape;

/// A block as it was read.
#[derive(Clone, Debug)]
pub struct OwnedBlock {
    /// Its subdomains.
    pub block: Block,
    /// Its contact points, over the nodes of the block.
    pub points: Vec<ContactPoint<u32>>,
    /// The gap at every point that bounds its normal jump now (m).
    pub gaps: Vec<f64>,
}

impl OwnedBlock {
    /// A block and the contact `points` of its group.
    pub fn new(block: Block, points: &[ContactPoint<SubdomainNode>]) -> Self {
        let of_block = |at: SubdomainNode| block.node(at.subdomain as usize, at.node);
        let points: Vec<_> = points.iter().map(|point| point.rename(of_block)).collect();
        Self {
            gaps: points.iter().map(|point| point.gap).collect(),
            block,
            points,
        }
    }

    /// The gaps that displacements `u`, node by node, leave at its points: g − n·⟦u⟧ (m).
    pub fn gaps_left(&self, u: &[f64]) -> Vec<f64> {
        let gaps = self.points.iter().zip(&self.gaps);
        gaps.map(|(point, gap)| gap - point.normal_jump(self.block.dim, u))
            .collect()
    }

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
            conditions: self.points.len(),
            mesh: mesh.finish(),
        }
    }
}
