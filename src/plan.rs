//! The plan of condensation and merging: blocks, their hierarchy, clusters, and their owners.

mod assign;
pub mod choice;
pub mod cluster;
pub mod cost;

pub mod group;
pub mod links;
pub mod memory;

use std::cmp::Reverse;
use std::collections::BTreeSet;

use contact_dd_partition::hierarchy::choice::{coarse_dofs, iteration_flops};
use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::id::{BlockId, ClusterId, GroupId, MergeRootId, PairId, TreeNodeId};
use contact_dd_partition::numbered::Numbered;
use contact_dd_partition::problem::Catalog;

use self::assign::assign;
use self::cluster::{ClusterPlan, Merging, cluster_nodes};
use self::group::GroupPlan;

/// Number of constraints of a cluster at a root, tangential ones included, from which on its nodes of Γ are eliminated
/// in the cluster: its matrix then has a row for each constraint and none for the nodes, and all constraints are solved
/// for once instead of twice. For a pin in a plate with 4218 constraints this takes 0.73 times the arithmetic and 0.84
/// times the memory.
const MANY_CONDITIONS: usize = 1_000;

/// The blocks, which are the subdomains, and the clusters, in the order of the hierarchy. Every sum runs in this order,
/// whichever ranks own the terms, so that results don't depend on the number of ranks.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The hierarchy of the blocks.
    pub tree: Tree,
    /// The contact groups, by ascending nodes of the hierarchy.
    pub groups: Numbered<GroupId, GroupPlan>,
    /// The owner of every node of the hierarchy.
    pub node_owners: Numbered<TreeNodeId, usize>,
    /// The clusters, of which the interface problem is assembled.
    pub clusters: Numbered<ClusterId, ClusterPlan>,
    /// The pairs: the clusters in contact.
    pub pairs: Numbered<PairId, ClusterId>,
    /// The treatment of contact in merging.
    pub merging: Merging,
    /// The nodes of the hierarchy above which nothing is merged where active sets are fixed, ascending: its roots, or
    /// the clusters between which the iterative interface solver works.
    pub merge_roots: Numbered<MergeRootId, TreeNodeId>,
}

impl Plan {
    /// Assigns the blocks of `catalog`, whose hierarchy is `tree`, and the merges of their Schur complements to `ranks`
    /// ranks by estimated cost.
    pub fn new(catalog: &Catalog, tree: &Tree, ranks: usize, merging: Merging) -> Self {
        let tree = match merging {
            Merging::All | Merging::ActiveSet | Merging::Clusters => tree.clone(),
            Merging::Linear | Merging::Groups => Tree::by_group(catalog),
        };
        let in_contact = (tree.nodes.ids()).filter(|&v| !tree.nodes[v].points.is_empty());
        let mut plan = Self {
            groups: in_contact
                .map(|v| GroupPlan::new(catalog, &tree, v))
                .collect(),
            merge_roots: match merging {
                Merging::Clusters => tree.clusters.clone().into(),
                _ => tree.roots().collect(),
            },
            tree,
            node_owners: Numbered::default(),
            clusters: Numbered::default(),
            pairs: Numbered::default(),
            merging,
        };
        plan.node_owners = plan.assign_nodes(catalog, ranks);
        plan.form_clusters(merging);
        plan
    }

    /// Estimated cost of node v of the hierarchy (flops).
    pub fn time(&self, v: TreeNodeId, dim: usize) -> f64 {
        self.tree.time(v, dim, self.merging.has_active_set())
    }

    /// The owner of every node of the hierarchy.
    fn assign_nodes(&self, catalog: &Catalog, ranks: usize) -> Numbered<TreeNodeId, usize> {
        let top = match self.merging {
            Merging::ActiveSet | Merging::Clusters => self.merge_roots.values().to_vec(),
            _ => cluster_nodes(&self.tree, self.merging, self.merge_roots.values()),
        };
        let mut costs = self.tree.nodes.like(0.0);
        for &v in &top {
            for v in self.tree.subtree(v) {
                costs[v] = self.time(v, catalog.dim);
            }
        }
        if self.merging == Merging::Clusters {
            for &v in &self.merge_roots {
                costs[v] += iteration_flops(self.tree.nodes[v].dofs[1] as f64);
            }
        }
        assign(&self.tree, &top, &costs, ranks)
    }

    /// Forms the clusters.
    fn form_clusters(&mut self, merging: Merging) {
        self.merging = merging;
        self.clusters = Numbered::default();
        for node in cluster_nodes(&self.tree, merging, self.merge_roots.values()) {
            let under = self.tree.subtree(node).into_iter();
            self.clusters.push(ClusterPlan {
                node,
                owner: self.node_owners[node],
                groups: under.filter_map(|v| self.group_of(v)).collect(),
                conditions: self.tree.nodes[node].conditions,
            });
        }
        self.pairs = (self.clusters.ids())
            .filter(|&c| self.clusters[c].is_in_contact())
            .collect();
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.tree.subdomains
    }

    /// The owner of every block.
    pub fn owners(&self) -> Numbered<BlockId, usize> {
        self.node_owners.values()[..self.blocks()].to_vec().into()
    }

    /// The owners of nodes of the hierarchy.
    pub fn owners_of<I>(&self, nodes: &Numbered<I, TreeNodeId>) -> Numbered<I, usize> {
        nodes.iter().map(|&v| self.node_owners[v]).collect()
    }

    /// True if node v of the hierarchy is where merging ends for fixed active sets.
    pub fn is_merge_root(&self, v: TreeNodeId) -> bool {
        self.merge_roots.values().binary_search(&v).is_ok()
    }

    /// The node of the hierarchy that node v is merged into, if any.
    pub fn merged_into(&self, v: TreeNodeId) -> Option<TreeNodeId> {
        self.tree.nodes[v].parent.filter(|_| !self.is_merge_root(v))
    }

    /// True if merging for fixed active sets goes up to the roots of the hierarchy, so that no interface between
    /// clusters is left.
    pub fn has_one_cluster(&self) -> bool {
        (self.merge_roots.iter()).all(|&v| self.tree.nodes[v].parent.is_none())
    }

    /// The nodes of the hierarchy that are `sought`, the deepest first: nodes shared by ranks are near the roots, so
    /// that no rank waits for another in the nodes below.
    pub fn deepest_first(&self, is_sought: impl Fn(TreeNodeId) -> bool) -> Vec<TreeNodeId> {
        let nodes = &self.tree.nodes;
        let mut depth = nodes.like(0);
        for v in nodes.ids().rev() {
            depth[v] = nodes[v].parent.map_or(0, |parent| depth[parent] + 1);
        }
        let mut sought: Vec<TreeNodeId> = nodes.ids().filter(|&v| is_sought(v)).collect();
        sought.sort_by_key(|&v| Reverse(depth[v]));
        sought
    }

    /// Marks all ancestors of marked nodes of the hierarchy.
    pub fn mark_above(&self, marked: &mut Numbered<TreeNodeId, bool>) {
        for v in marked.ids() {
            if let (true, Some(parent)) = (marked[v], self.tree.nodes[v].parent) {
                marked[parent] = true;
            }
        }
    }

    /// True if node v of the hierarchy is above a node where merging ends for fixed active sets.
    pub fn is_above_merge_roots(&self, v: TreeNodeId) -> bool {
        let mut above = Some(v);
        while let Some(v) = above {
            if self.is_merge_root(v) {
                return false;
            }
            above = self.tree.nodes[v].parent;
        }
        true
    }

    /// Estimated number of coarse unknowns of the iterative interface solver, if it is used.
    pub fn coarse_dofs(&self, dim: usize) -> Option<usize> {
        (self.merging == Merging::Clusters).then(|| coarse_dofs(&self.tree, dim))
    }

    /// The owner of every group.
    pub fn group_owners(&self) -> Numbered<GroupId, usize> {
        let nodes = self.groups.iter().map(|group| group.node);
        nodes.map(|v| self.node_owners[v]).collect()
    }

    /// The group of node v of the hierarchy.
    pub fn group_of(&self, v: TreeNodeId) -> Option<GroupId> {
        let groups = self.groups.values();
        let at = groups.binary_search_by_key(&v, |group| group.node);
        at.ok().map(GroupId::new)
    }

    /// True if node v is a cluster at a root that leaves its nodes of Γ to the interface problem, because its contact
    /// points lie between several parts of the scene. A cluster with many constraints eliminates these nodes, so that
    /// its contact problem is solved once and not once more at the root.
    pub fn leaves_its_nodes(&self, v: TreeNodeId) -> bool {
        let node = &self.tree.nodes[v];
        let is_root = node.parent.is_none() && node.children.len() > 1;
        let is_small = node.conditions <= MANY_CONDITIONS || self.merging != Merging::All;
        is_root && is_small && !self.merging.has_active_set()
    }

    /// The nodes of Γ that the merge at node v eliminates.
    pub fn eliminated(&self, v: TreeNodeId) -> &[u32] {
        match self.leaves_its_nodes(v) {
            true => &[],
            false => &self.tree.nodes[v].eliminated,
        }
    }

    /// The nodes of Γ that the merge at node v keeps.
    pub fn kept(&self, v: TreeNodeId) -> &[u32] {
        match self.leaves_its_nodes(v) {
            true => &self.tree.nodes[v].eliminated,
            false => &self.tree.nodes[v].kept,
        }
    }

    /// The contact points of the constraints of a pair: their indices in `catalog`, each once, ascending.
    pub fn points_of_conditions(
        &self,
        catalog: &Catalog,
        p: PairId,
        conditions: &[usize],
    ) -> BTreeSet<u32> {
        let groups = &self.clusters[self.pairs[p]].groups;
        let of_group = |&g: &GroupId| {
            let points = &self.tree.nodes[self.groups[g].node].points;
            let tangents = |&j: &u32| {
                let tangents = catalog.points[j as usize].tangents(catalog.dim).len();
                std::iter::repeat_n(j, tangents)
            };
            let tangential = points.iter().flat_map(tangents);
            points.iter().copied().chain(tangential).collect::<Vec<_>>()
        };
        let all: Vec<u32> = groups.iter().flat_map(of_group).collect();
        conditions.iter().map(|&j| all[j]).collect()
    }

    /// The owner of every cluster.
    pub fn cluster_owners(&self) -> Numbered<ClusterId, usize> {
        self.clusters.iter().map(|c| c.owner).collect()
    }

    /// The owner of every pair.
    pub fn pair_owners(&self) -> Numbered<PairId, usize> {
        self.pairs.iter().map(|&c| self.clusters[c].owner).collect()
    }

    /// The number of cluster c among the pairs, if it is in contact.
    pub fn pair_of(&self, c: ClusterId) -> Option<PairId> {
        let at = self.pairs.values().binary_search(&c);
        at.ok().map(PairId::new)
    }

    /// The cluster of every block.
    pub fn clusters_of_blocks(&self) -> Numbered<BlockId, ClusterId> {
        let mut of: Numbered<BlockId, ClusterId> = vec![ClusterId::new(0); self.blocks()].into();
        for (c, cluster) in self.clusters.each() {
            for v in self.tree.subtree(cluster.node) {
                if let Some(b) = self.tree.block(v) {
                    of[b] = c;
                }
            }
        }
        of
    }

    /// Number of groups with contact points that aren't ties.
    pub fn contact_groups(&self) -> usize {
        let nodes = self.groups.iter().map(|group| group.node);
        nodes.filter(|&v| self.tree.own_conditions(v) > 0).count()
    }

    /// All groups of clusters in contact, cluster by cluster.
    pub fn groups_by_cluster(&self) -> Vec<GroupId> {
        let clusters = self.pairs.iter().map(|&c| &self.clusters[c]);
        clusters.flat_map(|c| c.groups.clone()).collect()
    }

    /// The owners of every such group and of its cluster, cluster by cluster.
    pub fn routes_to_clusters(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let clusters = self.pairs.iter().map(|&c| &self.clusters[c]);
        clusters.flat_map(|cluster| {
            let groups = cluster.groups.iter();
            groups.map(|&g| (self.node_owners[self.groups[g].node], cluster.owner))
        })
    }
}

#[cfg(test)]
mod tests;
