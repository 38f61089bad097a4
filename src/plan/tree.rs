//! The hierarchy of the blocks: a tree along which their Schur complements are merged.
//!
//! A node of the tree stands for the blocks under it. It eliminates the nodes of Γ that all blocks
//! with them lie under it, but not under one of its children, and keeps those that blocks outside
//! have, too. The tree stands in the problem file, so that merges are the same on any number of
//! ranks.

use contact_dd_partition::problem::Catalog;

use super::BlockPlan;

/// The tree.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tree {
    /// Its nodes: the blocks in their order, then the inner ones, children before parents.
    pub nodes: Vec<TreeNode>,
}

/// A node of the tree.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TreeNode {
    /// The node that it is merged into.
    pub parent: Option<usize>,
    /// The nodes that are merged into it, ascending.
    pub children: Vec<usize>,
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
    /// The hierarchy of `catalog` over its blocks; `sharing` tells how many of them have each node
    /// of Γ.
    pub fn new(
        catalog: &Catalog,
        blocks: &[BlockPlan],
        block_of: &[usize],
        sharing: &[u32],
    ) -> Self {
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
        let mut tree = Self { nodes };
        tree.share_interface(catalog, blocks, sharing);
        tree
    }

    /// Finds what every node eliminates and keeps, from the leaves up.
    fn share_interface(&mut self, catalog: &Catalog, blocks: &[BlockPlan], sharing: &[u32]) {
        // For every node of the tree, the nodes of Γ it keeps and how many blocks under it have each.
        let mut under: Vec<Vec<(u32, u32)>> = Vec::with_capacity(self.nodes.len());
        for v in 0..self.nodes.len() {
            if let Some(block) = blocks.get(v) {
                let shared = super::interface_nodes(catalog, block).into_iter();
                let kept: Vec<(u32, u32)> = (shared.filter(|&id| sharing[id as usize] > 1))
                    .map(|id| (id, 1))
                    .collect();
                let node = &mut self.nodes[v];
                node.kept = kept.iter().map(|&(id, _)| id).collect();
                node.groups = usize::from(block.group.is_some());
                node.conditions = block.group.map_or(0, |g| catalog.groups[g]);
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
