//! Blocks: the leaves of the tree, and the seams between them.

use std::collections::BTreeMap;

use crate::flops::condensation;
use crate::lists::Lists;
use crate::problem::Catalog;

/// A block of the problem: a linear subdomain, or a group in contact.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Block {
    /// Its subdomains, ascending.
    subdomains: Vec<usize>,
    /// Its group; `None` for a linear subdomain.
    group: Option<usize>,
}

impl Block {
    /// The blocks of a problem in the order of their first subdomains, and the block of every subdomain.
    fn of(catalog: &Catalog) -> (Vec<Self>, Vec<usize>) {
        let mut blocks: Vec<Self> = Vec::new();
        let mut of_group = vec![None; catalog.groups.len()];
        let mut of_subdomain = Vec::with_capacity(catalog.subdomains.len());
        for (index, subdomain) in catalog.subdomains.iter().enumerate() {
            let group = subdomain.group;
            let block = group.and_then(|g| of_group[g]).unwrap_or(blocks.len());
            if block == blocks.len() {
                let subdomains = Vec::new();
                blocks.push(Self { subdomains, group });
            }
            if let Some(g) = group {
                of_group[g] = Some(block);
            }
            blocks[block].subdomains.push(index);
            of_subdomain.push(block);
        }
        (blocks, of_subdomain)
    }

    /// Its number of nodes, those that several of its subdomains have counted in each.
    fn nodes(&self, catalog: &Catalog) -> usize {
        let subdomains = self.subdomains.iter();
        subdomains.map(|&s| catalog.subdomains[s].nodes).sum()
    }

    /// Its number of contact conditions.
    fn conditions(&self, catalog: &Catalog) -> usize {
        self.group.map_or(0, |group| catalog.groups[group])
    }
}

/// The linear subdomains and the groups in contact, in the order of their first subdomains.
///
/// All nodes of Γ that the same blocks share are one *seam*; those that lie within a block are in
/// none.
pub(super) struct Blocks {
    /// The block of every subdomain.
    pub of_subdomain: Vec<u32>,
    /// The seams of every block, ascending.
    pub seams: Lists<u32>,
    /// The blocks of every seam, ascending, two at least.
    pub sharing: Lists<u32>,
    /// Dofs of every seam.
    pub seam_dofs: Vec<usize>,
    /// Dofs of every block.
    pub dofs: Vec<f64>,
    /// Contact conditions of every block.
    pub conditions: Vec<usize>,
}

impl Blocks {
    /// Finds the blocks of a problem.
    pub fn new(catalog: &Catalog) -> Self {
        let (blocks, of_subdomain) = Block::of(catalog);
        let of_subdomain: Vec<u32> = of_subdomain.iter().map(|&block| block as u32).collect();
        let on = (of_subdomain.iter().zip(&catalog.interface))
            .flat_map(|(&block, nodes)| nodes.iter().map(move |&node| (node, block)));
        let mut sharing = Lists::new(catalog.interface_nodes, on);
        sharing.sort();
        sharing.dedup();
        let mut of_blocks: BTreeMap<&[u32], usize> = BTreeMap::new();
        for shared in sharing.iter().filter(|blocks| blocks.len() > 1) {
            *of_blocks.entry(shared).or_default() += catalog.dim;
        }
        let on = (0..)
            .zip(of_blocks.keys())
            .flat_map(|(seam, blocks)| blocks.iter().map(move |&block| (seam, block)));
        let sharing = Lists::new(of_blocks.len(), on.clone());
        Self {
            seams: Lists::new(blocks.len(), on.map(|(seam, block)| (block, seam))),
            seam_dofs: of_blocks.values().copied().collect(),
            of_subdomain,
            dofs: (blocks.iter())
                .map(|block| (catalog.dim * block.nodes(catalog)) as f64)
                .collect(),
            conditions: blocks.iter().map(|b| b.conditions(catalog)).collect(),
            sharing,
        }
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.dofs.len()
    }

    /// Dofs of a block that are left when its interior has been eliminated.
    pub fn kept(&self, block: u32) -> usize {
        let seams = self.seams.of(block as usize).iter();
        let dofs: usize = seams.map(|&seam| self.seam_dofs[seam as usize]).sum();
        dofs + self.conditions[block as usize]
    }

    /// Estimated flops to condense a block.
    pub fn cost(&self, block: u32) -> f64 {
        let kept = self.kept(block) as f64;
        condensation((self.dofs[block as usize] - kept).max(0.0), kept)
    }

    /// The other blocks that each one shares seams with, and how many dofs these have.
    pub fn neighbours(&self) -> Lists<(u32, u32)> {
        let mut shared = vec![0u32; self.len()];
        let of_block = |block| {
            let mut edges = Vec::new();
            for &seam in self.seams.of(block) {
                let others = self.sharing.of(seam as usize).iter();
                for &other in others.filter(|&&other| other as usize != block) {
                    if shared[other as usize] == 0 {
                        edges.push((other, 0));
                    }
                    shared[other as usize] += self.seam_dofs[seam as usize] as u32;
                }
            }
            edges.sort_unstable();
            for (other, weight) in &mut edges {
                *weight = std::mem::take(&mut shared[*other as usize]);
            }
            edges
        };
        (0..self.len()).map(of_block).collect()
    }
}
