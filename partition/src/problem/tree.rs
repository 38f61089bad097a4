//! The hierarchy of the blocks: a tree along which their Schur complements are merged.
//!
//! A node of the tree stands for the blocks under it. It eliminates the nodes of Γ that all blocks
//! with them lie under it, but not under one of its children, and keeps those that blocks outside
//! have, too. The tree stands in the problem file, so that merges are the same on any number of
//! ranks.

use super::Catalog;
use crate::flops::{Front, condensation};

/// A block of the problem: a linear subdomain, or a group in contact.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Block {
    /// Its subdomains, ascending.
    pub subdomains: Vec<usize>,
    /// Its group; `None` for a linear subdomain.
    pub group: Option<usize>,
}

impl Block {
    /// The blocks of a problem in the order of their first subdomains, and the block of every subdomain.
    pub fn of(catalog: &Catalog) -> (Vec<Self>, Vec<usize>) {
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
    pub fn nodes(&self, catalog: &Catalog) -> usize {
        let subdomains = self.subdomains.iter();
        subdomains.map(|&s| catalog.subdomains[s].nodes).sum()
    }

    /// Its number of contact conditions.
    pub fn conditions(&self, catalog: &Catalog) -> usize {
        self.group.map_or(0, |group| catalog.groups[group])
    }

    /// Its nodes of Γ, each once, ascending.
    fn interface(&self, catalog: &Catalog) -> Vec<u32> {
        let subdomains = self.subdomains.iter();
        let mut nodes: Vec<u32> = subdomains
            .flat_map(|&s| catalog.interface[s].iter().copied())
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

/// The tree.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tree {
    /// Its nodes: the blocks in their order, then the inner ones, children before parents.
    pub nodes: Vec<TreeNode>,
    /// Number of blocks.
    pub blocks: usize,
    /// How many blocks have each node of Γ.
    pub sharing: Vec<u32>,
}

/// A node of the tree.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TreeNode {
    /// The node that it is merged into.
    pub parent: Option<usize>,
    /// The nodes that are merged into it, ascending.
    pub children: Vec<usize>,
    /// Nodes of a block, on Γ or not; none of an inner one.
    pub of_block: usize,
    /// Nodes of Γ that are eliminated here, ascending.
    pub eliminated: Vec<u32>,
    /// Nodes of Γ that blocks outside share, ascending.
    pub kept: Vec<u32>,
    /// Contact conditions of the groups under it.
    pub conditions: usize,
    /// Number of groups under it.
    pub groups: usize,
}

impl Tree {
    /// The hierarchy of `catalog` over its blocks; `block_of` has that of every subdomain.
    pub fn new(catalog: &Catalog, blocks: &[Block], block_of: &[usize]) -> Self {
        let subdomains = catalog.subdomains.len();
        let parents = &catalog.hierarchy.parent;
        // Members of a group hang under one parent: the group is one leaf.
        let number = |node: usize| match block_of.get(node) {
            Some(&block) => block,
            None => blocks.len() + node - subdomains,
        };
        let mut nodes = vec![TreeNode::default(); blocks.len() + parents.len() - subdomains];
        for (node, parent) in parents.iter().enumerate() {
            nodes[number(node)].parent = parent.map(|p| number(p as usize));
        }
        for node in 0..nodes.len() {
            if let Some(parent) = nodes[node].parent {
                nodes[parent].children.push(node);
            }
        }
        let mut tree = Self {
            nodes,
            blocks: blocks.len(),
            sharing: vec![0; catalog.interface_nodes],
        };
        tree.share_interface(catalog, blocks);
        tree
    }

    /// Finds what every node eliminates and keeps, from the leaves up.
    fn share_interface(&mut self, catalog: &Catalog, blocks: &[Block]) {
        let shared: Vec<Vec<u32>> = blocks.iter().map(|b| b.interface(catalog)).collect();
        for &node in shared.iter().flatten() {
            self.sharing[node as usize] += 1;
        }
        let sharing = &self.sharing;
        // For every node of the tree, the nodes of Γ it keeps and how many blocks under it have each.
        let mut under: Vec<Vec<(u32, u32)>> = Vec::with_capacity(self.nodes.len());
        for v in 0..self.nodes.len() {
            if let Some((block, shared)) = blocks.get(v).zip(shared.get(v)) {
                let kept: Vec<(u32, u32)> = (shared.iter())
                    .filter(|&&id| sharing[id as usize] > 1)
                    .map(|&id| (id, 1))
                    .collect();
                let node = &mut self.nodes[v];
                node.kept = kept.iter().map(|&(id, _)| id).collect();
                node.of_block = block.nodes(catalog);
                node.groups = usize::from(block.group.is_some());
                node.conditions = block.conditions(catalog);
                under.push(kept);
                continue;
            }
            let children = self.nodes[v].children.clone();
            let mut all: Vec<(u32, u32)> = Vec::new();
            for &child in &children {
                all.append(&mut under[child]);
                self.nodes[v].groups += self.nodes[child].groups;
                self.nodes[v].conditions += self.nodes[child].conditions;
            }
            all.sort_unstable();
            all.dedup_by(|next, first| {
                let same = next.0 == first.0;
                if same {
                    first.1 += next.1;
                }
                same
            });
            let (eliminated, kept): (Vec<_>, Vec<_>) = (all.into_iter())
                .partition(|&(id, blocks_under)| blocks_under == sharing[id as usize]);
            self.nodes[v].eliminated = eliminated.into_iter().map(|(id, _)| id).collect();
            self.nodes[v].kept = kept.iter().map(|&(id, _)| id).collect();
            under.push(kept);
        }
    }

    /// The unknowns, `dim` at a node, that node v eliminates and keeps.
    pub fn front(&self, v: usize, dim: usize) -> Front {
        let node = &self.nodes[v];
        let kept = dim * node.kept.len() + node.conditions;
        let eliminated = match v < self.blocks {
            true => (dim * node.of_block).saturating_sub(kept),
            false => dim * node.eliminated.len(),
        };
        Front { eliminated, kept }
    }

    /// Estimated flops of condensing a block, or of merging what lies under an inner node.
    pub fn flops(&self, v: usize, dim: usize) -> f64 {
        let front = self.front(v, dim);
        match v < self.blocks {
            true => condensation(front.eliminated as f64, front.kept as f64),
            false => front.flops(),
        }
    }

    /// For every node, the sum of `costs` over it and all that is under it.
    pub fn sums(&self, costs: &[f64]) -> Vec<f64> {
        let mut sums = costs.to_vec();
        for v in 0..self.nodes.len() {
            for &child in &self.nodes[v].children {
                sums[v] += sums[child];
            }
        }
        sums
    }

    /// The highest nodes for which `is_whole` holds, ascending; leaves do at the latest.
    pub fn highest(&self, is_whole: impl Fn(usize) -> bool) -> Vec<usize> {
        let whole = |v: usize| self.nodes[v].children.is_empty() || is_whole(v);
        let mut inside = vec![false; self.nodes.len()];
        let mut highest = Vec::new();
        for v in (0..self.nodes.len()).rev() {
            let within = self.nodes[v].parent.is_some_and(|parent| inside[parent]);
            inside[v] = within || whole(v);
            if inside[v] && !within {
                highest.push(v);
            }
        }
        highest.reverse();
        highest
    }

    /// The nodes under `v` and `v` itself, children before parents.
    pub fn subtree(&self, v: usize) -> Vec<usize> {
        let mut nodes = Vec::new();
        let mut stack = vec![(v, false)];
        while let Some((v, children_done)) = stack.pop() {
            if children_done {
                nodes.push(v);
                continue;
            }
            stack.push((v, true));
            let children = self.nodes[v].children.iter().rev();
            stack.extend(children.map(|&child| (child, false)));
        }
        nodes
    }
}
