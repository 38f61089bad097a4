//! The hierarchy: a tree along which the Schur complements of the subdomains are merged.
//!
//! A node of the tree represents the subdomains under it. It eliminates the nodes of Γ whose subdomains all lie under
//! it, but not all under one child, and keeps those that are shared with subdomains outside. Γ holds the nodes shared
//! by several subdomains and all nodes of contact points: a contact point belongs to the lowest tree node under which
//! all subdomains with its nodes lie. There its normal jump replaces a displacement.
//!
//! The tree follows from the problem file, so that merges are the same on any number of ranks.

use std::collections::{BTreeMap, BTreeSet};

use super::interface::{Interface, UnsharedNode};
use crate::disjoint_sets::DisjointSets;
use crate::id::{BlockId, TreeNodeId};
use crate::numbered::Numbered;
use crate::problem::{Catalog, Hierarchy};

/// The tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tree {
    /// The nodes: first the subdomains, then the inner nodes, children before parents.
    pub nodes: Numbered<TreeNodeId, TreeNode>,
    /// Number of subdomains.
    pub subdomains: usize,
    /// Number of nodes of Γ: first those shared by several subdomains, then those of a single subdomain with contact
    /// points.
    pub interface_nodes: usize,
    /// The nodes of the second kind, subdomain by subdomain.
    pub unshared: Vec<UnsharedNode>,
    /// The nodes that are clusters of the iterative interface solver, ascending; none where the file has none.
    pub clusters: Vec<TreeNodeId>,
}

/// A node of the tree.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TreeNode {
    /// The node that it is merged into.
    pub parent: Option<TreeNodeId>,
    /// The nodes that are merged into it, ascending.
    pub children: Vec<TreeNodeId>,
    /// Number of mesh nodes of a subdomain, on Γ or not; 0 for an inner node.
    pub of_subdomain: usize,
    /// Nodes of Γ that are eliminated here, ascending.
    pub eliminated: Vec<u32>,
    /// Nodes of Γ shared with subdomains outside, ascending.
    pub kept: Vec<u32>,
    /// Unknowns at the nodes that are eliminated, and at those that are kept.
    pub dofs: [usize; 2],
    /// The contact points that belong to it, by their index in the catalog, ascending.
    pub points: Vec<u32>,
    /// Number of contact constraints that belong to it or to a node under it, without ties.
    pub conditions: usize,
    /// Number of tied constraints that belong to it.
    pub tied: usize,
}

impl Tree {
    /// The hierarchy of `catalog`.
    pub fn new(catalog: &Catalog) -> Self {
        Self::along(catalog, &catalog.hierarchy)
    }

    /// The tree that merges each contact group, and the subdomains without contact, separately, along the hierarchy of
    /// `catalog`, and joins them last.
    pub fn by_group(catalog: &Catalog) -> Self {
        Self::along(catalog, &catalog.hierarchy.by_group(catalog))
    }

    fn along(catalog: &Catalog, hierarchy: &Hierarchy) -> Self {
        let interface = Interface::new(catalog);
        let mut tree = Self {
            nodes: vec![TreeNode::default(); catalog.subdomains.len()].into(),
            subdomains: catalog.subdomains.len(),
            interface_nodes: interface.subdomains.len(),
            unshared: Vec::new(),
            clusters: Vec::new(),
        };
        tree.grow(catalog, hierarchy, &interface);
        tree.join_roots(&interface);
        tree.place(catalog, &interface);
        tree.unshared = interface.unshared;
        tree
    }

    /// Adds the inner nodes. A subdomain that has contact points or nodes of Γ of its own gets a parent of its own.
    fn grow(&mut self, catalog: &Catalog, hierarchy: &Hierarchy, interface: &Interface) {
        let subdomains = self.subdomains;
        for (node, summary) in self.nodes.iter_mut().zip(&catalog.subdomains) {
            node.of_subdomain = summary.nodes;
        }
        let mut above: Vec<TreeNodeId> = self.nodes.ids().collect();
        for own in &interface.unshared {
            let subdomain = own.at.subdomain as usize;
            if above[subdomain].index() == subdomain {
                let inner = self.nodes.push(TreeNode::default());
                self.nodes[TreeNodeId::new(subdomain)].parent = Some(inner);
                above[subdomain] = inner;
            }
        }
        let shift = self.nodes.len() - subdomains;
        let parents = &hierarchy.parent;
        for _ in subdomains..parents.len() {
            self.nodes.push(TreeNode::default());
        }
        let inner = |v: u32| TreeNodeId::new(v as usize + shift);
        let place = |v: u32| above.get(v as usize).copied().unwrap_or_else(|| inner(v));
        for (node, parent) in (0..).zip(parents) {
            self.nodes[place(node)].parent = parent.map(inner);
        }
        self.clusters = hierarchy.clusters.iter().map(|&v| place(v)).collect();
        self.clusters.sort_unstable();
    }

    /// Adds a root above all roots that are linked by a node of Γ or a contact point.
    fn join_roots(&mut self, interface: &Interface) {
        let mut root: Numbered<TreeNodeId, TreeNodeId> = self.nodes.ids().collect();
        for v in self.nodes.ids().rev() {
            root[v] = self.nodes[v].parent.map_or(v, |parent| root[parent]);
        }
        let root_of = |s: u32| root[TreeNodeId::new(s as usize)].index() as u32;
        let mut sets = DisjointSets::new(self.nodes.len());
        for subdomains in interface.subdomains.iter() {
            for pair in subdomains.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(root_of);
                sets.unite(a, b);
            }
        }
        for numbers in &interface.of_points {
            for pair in numbers.windows(2) {
                let first = |number: u32| interface.subdomains.of(number as usize)[0];
                let [a, b] = [pair[0], pair[1]].map(|n| root_of(first(n)));
                sets.unite(a, b);
            }
        }
        let mut joined: BTreeMap<u32, Vec<TreeNodeId>> = BTreeMap::new();
        for v in self.nodes.ids().filter(|&v| root[v] == v) {
            joined
                .entry(sets.find(v.index() as u32))
                .or_default()
                .push(v);
        }
        for roots in joined.into_values().filter(|roots| roots.len() > 1) {
            let above = self.nodes.push(TreeNode::default());
            for v in roots {
                self.nodes[v].parent = Some(above);
            }
        }
        for v in self.nodes.ids() {
            if let Some(parent) = self.nodes[v].parent {
                self.nodes[parent].children.push(v);
            }
        }
    }

    /// Determines the nodes of Γ that every tree node eliminates and keeps, and its contact points.
    fn place(&mut self, catalog: &Catalog, interface: &Interface) {
        // The lowest inner node above all subdomains of a node of Γ.
        let mut ends: Vec<TreeNodeId> = (interface.subdomains.iter())
            .map(|list| {
                let leaf = |s: u32| TreeNodeId::new(s as usize);
                let first = leaf(list[0]);
                let first = self.nodes[first].parent.unwrap_or(first);
                let others = list[1..].iter().map(|&s| leaf(s));
                others.fold(first, |v, s| self.lowest_above(v, s))
            })
            .collect();
        let systems = interface.systems(catalog);
        let mut homes = vec![TreeNodeId::new(0); interface.of_points.len()];
        for system in &systems {
            let points = || system.points.iter().map(|&j| j as usize);
            let of_nodes = points().flat_map(|j| &interface.of_points[j]);
            let of_nodes = of_nodes.map(|&number| ends[number as usize]);
            let of_others = system.above.iter().map(|&j| homes[j as usize]);
            let all = of_nodes.chain(of_others);
            let home = all
                .reduce(|v, w| self.lowest_above(v, w))
                .unwrap_or(TreeNodeId::new(0));
            points().for_each(|j| homes[j] = home);
            self.nodes[home].points.extend(&system.points);
        }
        for (numbers, &home) in interface.of_points.iter().zip(&homes) {
            for &number in numbers {
                let end = &mut ends[number as usize];
                *end = self.lowest_above(*end, home);
            }
        }
        for (number, &end) in (0..).zip(&ends) {
            self.nodes[end].eliminated.push(number);
        }
        for (node, numbers) in self.nodes.iter_mut().zip(interface.numbers.iter()) {
            node.kept = numbers.to_vec();
            node.kept.sort_unstable();
        }
        self.sum_up(catalog, &ends);
        self.count_dofs(catalog, interface);
    }

    /// Determines the nodes that inner nodes keep, from the `ends` at which nodes of Γ are eliminated, and the number
    /// of constraints under every node.
    fn sum_up(&mut self, catalog: &Catalog, ends: &[TreeNodeId]) {
        for v in self.nodes.ids() {
            let mut kept: Vec<u32> = Vec::new();
            let points = self.nodes[v].points.iter();
            let points = points.map(|&j| &catalog.points[j as usize]);
            let all: usize = points
                .clone()
                .map(|p| p.directions(catalog.dim).count())
                .sum();
            let mut conditions = points.map(|p| p.unknown_jumps(catalog.dim)).sum();
            let tied = all - conditions;
            for child in self.nodes[v].children.clone() {
                kept.extend(&self.nodes[child].kept);
                conditions += self.nodes[child].conditions;
            }
            let node = &mut self.nodes[v];
            node.points.sort_unstable();
            (node.conditions, node.tied) = (conditions, tied);
            if v.index() >= self.subdomains {
                kept.sort_unstable();
                kept.dedup();
                kept.retain(|&number| ends[number as usize] != v);
                node.kept = kept;
            }
        }
    }

    /// Counts the unknowns at the nodes of Γ that every node eliminates and keeps.
    fn count_dofs(&mut self, catalog: &Catalog, interface: &Interface) {
        let slides = interface.unshared.iter().filter(|own| own.slides.is_some());
        let slides: BTreeSet<u32> = slides.map(|own| own.number).collect();
        let dofs_at = |numbers: &[u32]| -> usize {
            let dofs = numbers.iter().map(|number| match slides.contains(number) {
                true => 1,
                false => catalog.dim,
            });
            dofs.sum()
        };
        for node in &mut self.nodes {
            node.dofs = [dofs_at(&node.eliminated), dofs_at(&node.kept)];
        }
    }

    /// The block of node v; `None` for an inner node.
    pub fn block(&self, v: TreeNodeId) -> Option<BlockId> {
        (v.index() < self.subdomains).then(|| BlockId::new(v.index()))
    }

    /// The lowest common ancestor of two nodes, which may be one of them.
    pub fn lowest_above(&self, mut v: TreeNodeId, mut w: TreeNodeId) -> TreeNodeId {
        while v != w {
            let lower = if v < w { &mut v } else { &mut w };
            match self.nodes[*lower].parent {
                Some(parent) => *lower = parent,
                None => return v.max(w),
            }
        }
        v
    }

    /// The nodes without a parent.
    pub fn roots(&self) -> impl Iterator<Item = TreeNodeId> + '_ {
        (self.nodes.ids()).filter(|&v| self.nodes[v].parent.is_none())
    }

    /// Number of contact constraints that belong to node v, without ties.
    pub fn own_conditions(&self, v: TreeNodeId) -> usize {
        let children = self.nodes[v].children.iter();
        let below: usize = children.map(|&child| self.nodes[child].conditions).sum();
        self.nodes[v].conditions - below
    }

    /// Sums of `costs` over every node and all nodes under it.
    pub fn sums(&self, costs: &Numbered<TreeNodeId, f64>) -> Numbered<TreeNodeId, f64> {
        let mut sums = costs.clone();
        for v in self.nodes.ids() {
            for &child in &self.nodes[v].children {
                sums[v] += sums[child];
            }
        }
        sums
    }

    /// The highest nodes for which `is_whole` is true, ascending; it has to be true for leaves.
    pub fn highest(&self, is_whole: impl Fn(TreeNodeId) -> bool) -> Vec<TreeNodeId> {
        let whole = |v: TreeNodeId| self.nodes[v].children.is_empty() || is_whole(v);
        let mut inside = self.nodes.like(false);
        let mut highest = Vec::new();
        for v in self.nodes.ids().rev() {
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
    pub fn subtree(&self, v: TreeNodeId) -> Vec<TreeNodeId> {
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

impl Hierarchy {
    /// A root above copies of this tree, one for every contact group and one for the subdomains without contact.
    fn by_group(&self, catalog: &Catalog) -> Self {
        let linear = catalog.groups.len();
        let mut classes: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); self.parent.len()];
        for (classes, subdomain) in classes.iter_mut().zip(&catalog.subdomains) {
            classes.insert(subdomain.group.unwrap_or(linear));
        }
        for v in 0..self.parent.len() {
            if let Some(parent) = self.parent[v] {
                let below = classes[v].clone();
                classes[parent as usize].extend(below);
            }
        }
        let mut number = BTreeMap::new();
        for (v, classes) in classes.iter().enumerate() {
            for &class in classes {
                let next = number.len() as u32;
                number.insert((v, class), next);
            }
        }
        let root = number.len() as u32;
        let above = |&(v, class): &(usize, usize)| match self.parent[v] {
            Some(parent) => Some(number[&(parent as usize, class)]),
            None => Some(root),
        };
        Self {
            parent: number.keys().map(above).chain([None]).collect(),
            clusters: Vec::new(),
        }
    }
}
