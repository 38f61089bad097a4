//! A block as its owner has it: subdomains and contact points from the problem file.

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::problem::SubdomainNode;

use super::block::Block;

/// A block as it was read.
#[derive(Clone, Debug)]
pub struct OwnedBlock {
    /// Its subdomains.
    pub block: Block,
    /// Its contact points, over the nodes of the block.
    pub points: Vec<ContactPoint<u32>>,
}

impl OwnedBlock {
    /// A block and the contact `points` of its group.
    pub fn new(block: Block, points: &[ContactPoint<SubdomainNode>]) -> Self {
        let of_block = |at: SubdomainNode| block.node(at.subdomain as usize, at.node);
        let points = points.iter().map(|point| point.rename(of_block)).collect();
        Self { block, points }
    }
}
