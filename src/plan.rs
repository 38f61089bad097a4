//! What is to be condensed and merged, and by whom: blocks, their hierarchy, clusters.

mod assign;
pub mod cluster;
pub mod cost;

pub mod links;

use std::cmp::Reverse;
use std::collections::BTreeSet;

use contact_dd_partition::problem::tree::Tree;
use contact_dd_partition::problem::{Catalog, choice};

use self::assign::assign;
use self::cluster::{ClusterPlan, Merging, cluster_nodes};
use self::links::GroupPlan;

/// The blocks, which are the subdomains, and the clusters in the order of the hierarchy; every sum runs in this
/// order, whoever owns what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// The hierarchy of the blocks.
    pub tree: Tree,
    /// The contact groups, by ascending nodes of the hierarchy.
    pub groups: Vec<GroupPlan>,
    /// The owner of every node of the hierarchy.
    pub node_owners: Vec<usize>,
    /// What the interface problem is assembled from.
    pub clusters: Vec<ClusterPlan>,
    /// The clusters in contact.
    pub contact: Vec<usize>,
    /// What becomes of contact on the way.
    pub merging: Merging,
    /// The nodes of the hierarchy above which nothing is merged where active sets are frozen, ascending: its roots, or
    /// the clusters between which the iterative interface solver works.
    pub tops: Vec<usize>,
}

impl Plan {
    /// Assigns the blocks of `catalog` and the merges of their Schur complements to `ranks` ranks
    /// by estimated cost.
    pub fn new(catalog: &Catalog, ranks: usize, merging: Merging) -> Self {
        let tree = match merging {
            Merging::All | Merging::Frozen | Merging::Clusters => Tree::new(catalog),
            Merging::Linear | Merging::Groups => Tree::by_group(catalog),
        };
        let in_contact = (0..tree.nodes.len()).filter(|&v| !tree.nodes[v].points.is_empty());
        let mut plan = Self {
            groups: in_contact
                .map(|v| GroupPlan::new(catalog, &tree, v))
                .collect(),
            tops: match merging {
                Merging::Clusters => tree.clusters.clone(),
                _ => tree.roots().collect(),
            },
            tree,
            node_owners: Vec::new(),
            clusters: Vec::new(),
            contact: Vec::new(),
            merging,
        };
        plan.node_owners = plan.hand_out(catalog, ranks);
        plan.form_clusters(merging);
        plan
    }

    /// The merging that takes least for this scene, where newton may choose.
    pub fn cheapest(catalog: &Catalog) -> Merging {
        match Tree::new(catalog).freezing_pays(catalog) {
            true => Merging::Frozen,
            false => Merging::All,
        }
    }

    /// Estimated time of what is done at node v of the hierarchy (flops).
    pub fn time(&self, v: usize, dim: usize) -> f64 {
        self.tree.time(v, dim, self.merging.is_frozen())
    }

    /// The owner of every node of the hierarchy.
    fn hand_out(&self, catalog: &Catalog, ranks: usize) -> Vec<usize> {
        let top = match self.merging {
            Merging::Frozen | Merging::Clusters => self.tops.clone(),
            _ => cluster_nodes(&self.tree, self.merging, &self.tops),
        };
        let mut costs = vec![0.0; self.tree.nodes.len()];
        for &v in &top {
            for v in self.tree.subtree(v) {
                costs[v] = self.time(v, catalog.dim);
            }
        }
        if self.merging == Merging::Clusters {
            for &v in &self.tops {
                costs[v] += choice::between((catalog.dim * self.tree.nodes[v].kept.len()) as f64);
            }
        }
        assign(&self.tree, &top, &costs, ranks)
    }

    /// Forms the clusters, whatever the owners were chosen for.
    pub fn form_clusters(&mut self, merging: Merging) {
        self.merging = merging;
        self.clusters.clear();
        for node in cluster_nodes(&self.tree, merging, &self.tops) {
            let under = self.tree.subtree(node).into_iter();
            self.clusters.push(ClusterPlan {
                node,
                owner: self.node_owners[node],
                groups: under.filter_map(|v| self.group_of(v)).collect(),
            });
        }
        self.contact = (0..self.clusters.len())
            .filter(|&c| self.clusters[c].is_in_contact())
            .collect();
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.tree.subdomains
    }

    /// The owner of every block.
    pub fn owners(&self) -> &[usize] {
        &self.node_owners[..self.blocks()]
    }

    /// The owners of nodes of the hierarchy.
    pub fn owners_of(&self, nodes: &[usize]) -> Vec<usize> {
        nodes.iter().map(|&v| self.node_owners[v]).collect()
    }

    /// Whether frozen active sets are merged no further than to node v of the hierarchy.
    pub fn is_top(&self, v: usize) -> bool {
        self.tops.binary_search(&v).is_ok()
    }

    /// The node of the hierarchy that node v is merged into.
    pub fn merged_into(&self, v: usize) -> Option<usize> {
        self.tree.nodes[v].parent.filter(|_| !self.is_top(v))
    }

    /// Whether frozen active sets are merged up to the roots of the hierarchy, so that nothing is left between clusters.
    pub fn has_one_cluster(&self) -> bool {
        (self.tops.iter()).all(|&v| self.tree.nodes[v].parent.is_none())
    }

    /// The nodes of the hierarchy that are `sought`, the deepest first: what ranks share is near the roots, and none
    /// waits for another before.
    pub fn deepest_first(&self, is_sought: impl Fn(usize) -> bool) -> Vec<usize> {
        let nodes = &self.tree.nodes;
        let mut depth = vec![0; nodes.len()];
        for v in (0..nodes.len()).rev() {
            depth[v] = nodes[v].parent.map_or(0, |parent| depth[parent] + 1);
        }
        let mut sought: Vec<usize> = (0..nodes.len()).filter(|&v| is_sought(v)).collect();
        sought.sort_by_key(|&v| Reverse(depth[v]));
        sought
    }

    /// Marks whatever is above marked nodes of the hierarchy.
    pub fn mark_above(&self, marked: &mut [bool]) {
        for v in 0..marked.len() {
            if let (true, Some(parent)) = (marked[v], self.tree.nodes[v].parent) {
                marked[parent] = true;
            }
        }
    }

    /// Whether node v of the hierarchy is above the last ones that frozen active sets are merged to.
    pub fn is_above_tops(&self, v: usize) -> bool {
        let mut above = Some(v);
        while let Some(v) = above {
            if self.is_top(v) {
                return false;
            }
            above = self.tree.nodes[v].parent;
        }
        true
    }

    /// Estimated number of coarse unknowns between clusters, where an iterative interface solver works.
    pub fn coarse_dofs(&self, dim: usize) -> Option<usize> {
        (self.merging == Merging::Clusters).then(|| choice::coarse_dofs(&self.tree, dim))
    }

    /// The owner of every group.
    pub fn group_owners(&self) -> Vec<usize> {
        let nodes = self.groups.iter().map(|group| group.node);
        nodes.map(|v| self.node_owners[v]).collect()
    }

    /// The group of node v of the hierarchy.
    pub fn group_of(&self, v: usize) -> Option<usize> {
        self.groups
            .binary_search_by_key(&v, |group| group.node)
            .ok()
    }

    /// Whether node v is a cluster at a root, whose nodes of Γ are left to the interface problem: its contact
    /// points lie between several parts of the scene.
    pub fn leaves_its_nodes(&self, v: usize) -> bool {
        let node = &self.tree.nodes[v];
        let is_root = node.parent.is_none() && node.children.len() > 1;
        is_root && !self.merging.is_frozen()
    }

    /// The nodes of Γ that the merge at node v eliminates.
    pub fn eliminated(&self, v: usize) -> &[u32] {
        match self.leaves_its_nodes(v) {
            true => &[],
            false => &self.tree.nodes[v].eliminated,
        }
    }

    /// The nodes of Γ that the merge at node v keeps.
    pub fn kept(&self, v: usize) -> &[u32] {
        match self.leaves_its_nodes(v) {
            true => &self.tree.nodes[v].eliminated,
            false => &self.tree.nodes[v].kept,
        }
    }

    /// The contact points of conditions of a cluster in contact, by its place among those: their places in `catalog`,
    /// each once, ascending.
    pub fn points_of_conditions(
        &self,
        catalog: &Catalog,
        p: usize,
        conditions: &[usize],
    ) -> BTreeSet<u32> {
        let groups = &self.clusters[self.contact[p]].groups;
        let of_group = |&g: &usize| {
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
    pub fn cluster_owners(&self) -> Vec<usize> {
        self.clusters.iter().map(|c| c.owner).collect()
    }

    /// The owner of every cluster in contact.
    pub fn contact_owners(&self) -> Vec<usize> {
        self.contact
            .iter()
            .map(|&c| self.clusters[c].owner)
            .collect()
    }

    /// The place of cluster c among those in contact.
    pub fn contact_place(&self, c: usize) -> Option<usize> {
        self.contact.binary_search(&c).ok()
    }

    /// The cluster of every block.
    pub fn clusters_of_blocks(&self) -> Vec<usize> {
        let mut of = vec![0; self.blocks()];
        for (c, cluster) in self.clusters.iter().enumerate() {
            for v in self.tree.subtree(cluster.node) {
                if let Some(of) = of.get_mut(v) {
                    *of = c;
                }
            }
        }
        of
    }

    /// All groups, cluster by cluster.
    pub fn groups_by_cluster(&self) -> Vec<usize> {
        let clusters = self.clusters.iter();
        clusters.flat_map(|c| c.groups.clone()).collect()
    }

    /// From the owner of every group to that of its cluster, cluster by cluster.
    pub fn ways_to_clusters(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.clusters.iter().flat_map(|cluster| {
            let groups = cluster.groups.iter();
            groups.map(|&g| (self.node_owners[self.groups[g].node], cluster.owner))
        })
    }
}

#[cfg(test)]
mod tests {
    use contact_dd_partition::contact_point::ContactPoint;
    use contact_dd_partition::model::PlaneState;
    use contact_dd_partition::problem::{
        Body, Hierarchy, PointNode, SubdomainNode, SubdomainSummary,
    };
    use contact_dd_partition::scene::units::Units;
    use contact_dd_partition::solver::SolverSettings;

    use super::*;

    /// Two contact points between subdomains 1 and 3; 0, 2 and 4 linear, 4 the largest.
    fn catalog() -> Catalog {
        let sizes = [40, 30, 20, 30, 90];
        let node = |subdomain, node| SubdomainNode { subdomain, node };
        let point = |a, b| {
            let entries = vec![(node(1, a), 1.0), (node(3, b), -1.0)];
            ContactPoint::new(entries, [1.0, 0.0, 0.0], [0.0; 3], 0)
        };
        let free = |interface| PointNode {
            interface,
            is_free: true,
        };
        Catalog {
            title: String::new(),
            dim: 2,
            units: Units::Metre,
            plane: Some(PlaneState::Strain),
            materials: Vec::new(),
            bodies: vec![Body::new("b".into())],
            supports: Vec::new(),
            contacts: Vec::new(),
            steps: Vec::new(),
            subdomains: sizes
                .iter()
                .enumerate()
                .map(|(s, &nodes)| SubdomainSummary {
                    body: 0,
                    group: [1, 3].contains(&s).then_some(0),
                    nodes,
                    cells: nodes,
                })
                .collect(),
            interface: vec![vec![0, 1], vec![1, 2], vec![0, 3], vec![2, 3], vec![0]],
            interface_nodes: 4,
            groups: vec![2],
            points: vec![point(5, 6), point(7, 8)],
            point_nodes: vec![vec![free(None); 2], vec![free(Some(2)), free(None)]],
            hierarchy: Hierarchy {
                parent: [6, 5, 6, 5, 5, 7, 7]
                    .map(Some)
                    .into_iter()
                    .chain([None])
                    .collect(),
                clusters: Vec::new(),
            },
            solver: SolverSettings::default(),
            warnings: Vec::new(),
        }
    }

    /// The number in the tree of what is node v in the file: two subdomains have nodes that points alone name.
    fn inner(v: usize) -> usize {
        v + 2
    }

    #[test]
    fn contact_points_belong_where_all_that_have_their_nodes_come_together() {
        let plan = Plan::new(&catalog(), 3, Merging::All);
        let [group] = &plan.groups[..] else {
            panic!("{:?}", plan.groups);
        };
        assert_eq!((group.node, group.nodes.len()), (inner(5), 4));
        let node = &plan.tree.nodes[inner(5)];
        assert_eq!((&node.points[..], node.conditions), (&[0, 1][..], 2));
        // Nodes that the points alone name go there, too.
        assert_eq!(plan.tree.interface_nodes, 7);
        assert_eq!(node.eliminated, [2, 4, 5, 6]);
        assert_eq!(node.kept, [0, 1, 3]);
    }

    #[test]
    fn the_tree_does_not_depend_on_the_number_of_ranks() {
        let catalog = catalog();
        let one = Plan::new(&catalog, 1, Merging::All);
        for ranks in 2..8 {
            let plan = Plan::new(&catalog, ranks, Merging::All);
            assert_eq!(one.tree, plan.tree);
            assert!(plan.node_owners.iter().all(|&owner| owner < ranks));
        }
    }

    #[test]
    fn what_picard_merges_has_no_contact() {
        let clusters = |merging| -> Vec<usize> {
            let plan = Plan::new(&catalog(), 2, merging);
            plan.clusters.iter().map(|c| c.node).collect()
        };
        assert_eq!(clusters(Merging::All), [inner(5), inner(6)]);
        let mut apart = catalog();
        apart.points.clear();
        apart.point_nodes.clear();
        let plan = Plan::new(&apart, 2, Merging::Linear);
        assert_eq!(plan.clusters.len(), 2);
    }

    #[test]
    fn subtrees_are_split_until_ranks_have_about_the_same_to_do() {
        let plan = Plan::new(&catalog(), 2, Merging::All);
        let nodes = [40, 30, 20, 30, 90];
        let of_rank = |rank: usize| -> usize {
            let own = (0..5).filter(|&b| plan.node_owners[b] == rank);
            own.map(|b| nodes[b]).sum()
        };
        assert_eq!((of_rank(0), of_rank(1)), (90, 120));
    }
}
