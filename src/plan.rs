//! What is to be condensed and merged, and by whom: blocks, their hierarchy, clusters.

mod assign;
pub mod cluster;
pub mod cost;

use contact_dd_partition::problem::Catalog;
use contact_dd_partition::problem::tree::{Block, Tree};

use self::assign::assign;
use self::cluster::{ClusterPlan, Merging, cluster_nodes};

/// The blocks in the order of their first subdomains and the clusters in that of the hierarchy; every
/// sum runs in this order, whoever owns what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Blocks.
    pub blocks: Vec<Block>,
    /// The block of every group in contact, ascending.
    pub groups: Vec<usize>,
    /// The block of every subdomain.
    pub block_of: Vec<usize>,
    /// The hierarchy of the blocks.
    pub tree: Tree,
    /// The owner of every node of the hierarchy.
    pub node_owners: Vec<usize>,
    /// What the interface problem is assembled from.
    pub clusters: Vec<ClusterPlan>,
    /// The clusters in contact.
    pub contact: Vec<usize>,
}

impl Plan {
    /// Assigns the blocks of `catalog` and the merges of their Schur complements to `ranks` ranks
    /// by estimated cost.
    pub fn new(catalog: &Catalog, ranks: usize, merging: Merging) -> Self {
        let (blocks, block_of) = Block::of(catalog);
        let groups = (0..blocks.len())
            .filter(|&b| blocks[b].group.is_some())
            .collect();
        let tree = Tree::new(catalog, &blocks, &block_of);
        let mut plan = Self {
            blocks,
            groups,
            block_of,
            tree,
            node_owners: Vec::new(),
            clusters: Vec::new(),
            contact: Vec::new(),
        };
        plan.hand_out(catalog, ranks, merging);
        plan
    }

    fn hand_out(&mut self, catalog: &Catalog, ranks: usize, merging: Merging) {
        let clusters = cluster_nodes(&self.tree, merging);
        let mut costs = vec![0.0; self.tree.nodes.len()];
        for &cluster in &clusters {
            for v in self.tree.subtree(cluster) {
                costs[v] = cost::weight(&self.tree, v, catalog.dim);
            }
        }
        self.node_owners = assign(&self.tree, &clusters, &costs, ranks);
        for node in clusters {
            let under = self.tree.subtree(node).into_iter();
            self.clusters.push(ClusterPlan {
                node,
                owner: self.node_owners[node],
                groups: under.filter_map(|b| self.group_of(b)).collect(),
            });
        }
        self.contact = (0..self.clusters.len())
            .filter(|&c| self.clusters[c].is_in_contact())
            .collect();
    }

    /// Number of nodes of Γ, each counted once.
    pub fn interface_nodes(&self) -> usize {
        self.tree
            .sharing
            .iter()
            .filter(|&&blocks| blocks > 1)
            .count()
    }

    /// The owner of every block.
    pub fn owners(&self) -> Vec<usize> {
        self.node_owners[..self.blocks.len()].to_vec()
    }

    /// The owner of every subdomain.
    pub fn subdomain_owners(&self) -> Vec<usize> {
        let blocks = self.block_of.iter();
        blocks.map(|&b| self.node_owners[b]).collect()
    }

    /// The owner of every group.
    pub fn group_owners(&self) -> Vec<usize> {
        self.groups.iter().map(|&b| self.node_owners[b]).collect()
    }

    /// The place of block b among the groups.
    pub fn group_of(&self, block: usize) -> Option<usize> {
        self.groups.binary_search(&block).ok()
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
        let mut of = vec![0; self.blocks.len()];
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
            groups.map(|&g| (self.node_owners[self.groups[g]], cluster.owner))
        })
    }
}

#[cfg(test)]
mod tests {
    use contact_dd_partition::model::PlaneState;
    use contact_dd_partition::problem::{Body, Hierarchy, SubdomainSummary};
    use contact_dd_partition::scene::units::Units;
    use contact_dd_partition::solver::SolverSettings;

    use super::*;

    /// Subdomains 1 and 3 in contact; 0, 2 and 4 linear, 4 the largest.
    fn catalog() -> Catalog {
        let sizes = [40, 30, 20, 30, 90];
        Catalog {
            title: String::new(),
            dim: 2,
            units: Units::Metre,
            plane: PlaneState::Strain,
            materials: Vec::new(),
            bodies: vec![Body { name: "b".into() }],
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
            groups: vec![5],
            hierarchy: Hierarchy {
                parent: [6, 5, 6, 5, 5, 7, 7]
                    .map(Some)
                    .into_iter()
                    .chain([None])
                    .collect(),
            },
            solver: SolverSettings::default(),
            warnings: Vec::new(),
        }
    }

    #[test]
    fn every_subdomain_lies_in_one_block_and_groups_stay_together() {
        let plan = Plan::new(&catalog(), 3, Merging::All);
        assert_eq!(plan.block_of, [0, 1, 2, 1, 3]);
        assert_eq!(plan.blocks[1].subdomains, [1, 3]);
        assert_eq!((&plan.groups[..], plan.group_of(1)), (&[1][..], Some(0)));
    }

    #[test]
    fn a_node_that_only_members_of_a_group_share_is_not_on_the_interface() {
        let catalog = catalog();
        let plan = Plan::new(&catalog, 1, Merging::All);
        assert_eq!(plan.tree.nodes[1].kept, [1, 3]);
        assert_eq!(plan.tree.sharing, [3, 2, 1, 2]);
    }

    #[test]
    fn blocks_and_their_order_do_not_depend_on_the_number_of_ranks() {
        let catalog = catalog();
        let one = Plan::new(&catalog, 1, Merging::All);
        for ranks in 2..8 {
            let plan = Plan::new(&catalog, ranks, Merging::All);
            assert_eq!(one.blocks, plan.blocks);
            assert!(plan.node_owners.iter().all(|&owner| owner < ranks));
        }
    }

    #[test]
    fn a_node_of_the_hierarchy_eliminates_what_only_its_blocks_share() {
        let plan = Plan::new(&catalog(), 1, Merging::All);
        let eliminated: Vec<&[u32]> = (4..7).map(|v| &plan.tree.nodes[v].eliminated[..]).collect();
        assert_eq!(eliminated, [&[][..], &[], &[0, 1, 3]]);
        assert_eq!(plan.tree.nodes[5].kept, [0, 1, 3]);
        assert_eq!(
            (plan.tree.nodes[4].groups, plan.tree.nodes[6].conditions),
            (1, 5)
        );
    }

    #[test]
    fn what_picard_merges_has_no_contact() {
        let clusters = |merging| -> Vec<usize> {
            let plan = Plan::new(&catalog(), 2, merging);
            plan.clusters.iter().map(|c| c.node).collect()
        };
        assert_eq!(clusters(Merging::All), [4, 5]);
        assert_eq!(clusters(Merging::Linear), [1, 3, 5]);
    }

    #[test]
    fn subtrees_are_split_until_ranks_have_about_the_same_to_do() {
        let plan = Plan::new(&catalog(), 2, Merging::All);
        let nodes = [40, 60, 20, 90];
        let of_rank = |rank: usize| -> usize {
            let own = (0..4).filter(|&b| plan.node_owners[b] == rank);
            own.map(|b| nodes[b]).sum()
        };
        assert_eq!((of_rank(0), of_rank(1)), (110, 100));
    }
}
