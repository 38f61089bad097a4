//! Dissects the graph of the subdomains into the tree along which their Schur complements are merged.

mod blocks;
mod cut;
mod dissect;
mod work;

use self::blocks::Blocks;
use self::dissect::Dissection;
use crate::problem::{Catalog, Hierarchy};

pub use self::work::Work;

impl Hierarchy {
    /// Dissects so that the fronts of inner nodes are cheap, and halves even; the graph of blocks that share nodes of Γ; every connected part of it gets a root.
    /// Inner nodes have two children. Equal catalogs give equal trees; the one that the catalog
    /// holds doesn't count.
    pub fn new(catalog: &Catalog) -> Self {
        let blocks = Blocks::new(catalog);
        let above = Dissection::new(&blocks).parents();
        let count = blocks.of_subdomain.len() as u32;
        let inner = above[blocks.len()..].iter();
        let leaves = blocks.of_subdomain.iter().map(|&b| &above[b as usize]);
        // Inner nodes follow on the blocks in the one numbering, on the subdomains in the other.
        let shifted = |&parent: &Option<u32>| parent.map(|p| p - blocks.len() as u32 + count);
        Self {
            parent: leaves.chain(inner).map(shifted).collect(),
        }
    }

    /// The subdomains, the first `subdomains` nodes, in depth-first order: what is under a node
    /// stands together, a group's members beside each other, children by their lowest subdomain.
    pub fn depth_first(&self, groups: &[Option<usize>]) -> Vec<u32> {
        let subdomains = groups.len();
        let nodes = self.parent.len();
        // The lowest subdomain under each node: parents come after their children.
        let mut lowest: Vec<u32> = (0..nodes as u32).collect();
        lowest[subdomains..].fill(u32::MAX);
        let mut lowest_of_group = vec![u32::MAX; subdomains];
        for (subdomain, group) in (0..).zip(groups) {
            if let Some(group) = *group {
                let first = &mut lowest_of_group[group];
                *first = subdomain.min(*first);
                lowest[subdomain as usize] = *first;
            }
        }
        for node in 0..nodes {
            if let Some(parent) = self.parent[node] {
                lowest[parent as usize] = lowest[parent as usize].min(lowest[node]);
            }
        }
        // The way from the root to each subdomain tells its place.
        let key = |subdomain: u32| {
            let mut way = vec![subdomain];
            let mut node = Some(subdomain);
            while let Some(at) = node {
                way.push(lowest[at as usize]);
                node = self.parent[at as usize];
            }
            way.reverse();
            way
        };
        let mut order: Vec<u32> = (0..subdomains as u32).collect();
        order.sort_by_cached_key(|&subdomain| key(subdomain));
        order
    }

    /// The same tree after subdomain `order[i]` got the number i.
    #[must_use]
    pub fn renumbered(&self, order: &[u32]) -> Self {
        let leaves = order.iter().map(|&old| self.parent[old as usize]);
        let inner = self.parent[order.len()..].iter().copied();
        Self {
            parent: leaves.chain(inner).collect(),
        }
    }
}
