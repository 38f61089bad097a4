//! Who owns what: blocks, and their assignment to ranks.

use contact_dd_partition::problem::Catalog;

/// A block of the problem: a linear subdomain, or a group in contact.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockPlan {
    /// Its subdomains, ascending.
    pub subdomains: Vec<usize>,
    /// Its group; `None` for a linear subdomain.
    pub group: Option<usize>,
    /// The rank that owns it.
    pub owner: usize,
}

/// The blocks in the order of their first subdomains; every sum over blocks runs in this order,
/// whoever owns what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Blocks.
    pub blocks: Vec<BlockPlan>,
    /// The block of every pair, ascending.
    pub pairs: Vec<usize>,
    /// How many blocks have each node of Γ.
    pub sharing: Vec<u32>,
    /// The block of every subdomain.
    pub block_of: Vec<usize>,
}

impl Plan {
    /// Assigns the blocks of `catalog` to `ranks` ranks by estimated factorization cost, the
    /// largest first.
    pub fn new(catalog: &Catalog, ranks: usize) -> Self {
        let mut blocks: Vec<BlockPlan> = Vec::new();
        let mut block_of_group = vec![None; catalog.groups.len()];
        let mut block_of = Vec::with_capacity(catalog.subdomains.len());
        for (index, subdomain) in catalog.subdomains.iter().enumerate() {
            let known = subdomain.group.and_then(|g| block_of_group[g]);
            let block = known.unwrap_or_else(|| {
                blocks.push(BlockPlan {
                    subdomains: Vec::new(),
                    group: subdomain.group,
                    owner: 0,
                });
                blocks.len() - 1
            });
            if let Some(g) = subdomain.group {
                block_of_group[g] = Some(block);
            }
            blocks[block].subdomains.push(index);
            block_of.push(block);
        }
        let mut sharing = vec![0u32; catalog.interface_nodes];
        for block in &blocks {
            for node in interface_nodes(catalog, block) {
                sharing[node as usize] += 1;
            }
        }
        let pairs = (0..blocks.len())
            .filter(|&b| blocks[b].group.is_some())
            .collect();
        let mut plan = Self {
            blocks,
            pairs,
            sharing,
            block_of,
        };
        plan.assign(catalog, ranks);
        plan
    }

    fn assign(&mut self, catalog: &Catalog, ranks: usize) {
        let costs: Vec<f64> = self.blocks.iter().map(|b| self.cost(catalog, b)).collect();
        let mut order: Vec<usize> = (0..costs.len()).collect();
        order.sort_by(|&a, &b| costs[b].total_cmp(&costs[a]).then(a.cmp(&b)));
        let mut load = vec![0.0; ranks];
        for block in order {
            let mut least = 0;
            for rank in 1..ranks {
                if load[rank] < load[least] {
                    least = rank;
                }
            }
            load[least] += costs[block];
            self.blocks[block].owner = least;
        }
    }

    /// Estimated flops of a block's factorization: its interior as a planar graph under nested
    /// dissection, its boundary dense.
    fn cost(&self, catalog: &Catalog, block: &BlockPlan) -> f64 {
        let dim = catalog.dim as f64;
        let nodes: usize = block
            .subdomains
            .iter()
            .map(|&s| catalog.subdomains[s].nodes)
            .sum();
        let boundary = interface_nodes(catalog, block)
            .iter()
            .filter(|&&node| self.sharing[node as usize] > 1)
            .count();
        let conditions = block.group.map_or(0, |g| catalog.groups[g]);
        let interior = dim * nodes as f64;
        let dense = dim * boundary as f64 + conditions as f64;
        30.0 * interior.powf(1.5) + interior * dense + dense.powi(3)
    }

    /// The owner of every block.
    pub fn owners(&self) -> Vec<usize> {
        self.blocks.iter().map(|b| b.owner).collect()
    }

    /// The owner of every pair.
    pub fn pair_owners(&self) -> Vec<usize> {
        self.pairs.iter().map(|&b| self.blocks[b].owner).collect()
    }

    /// The place of block b among the pairs.
    pub fn pair_of(&self, block: usize) -> Option<usize> {
        self.pairs.binary_search(&block).ok()
    }

    /// The nodes of Γ that block b shares with other blocks, ascending.
    pub fn shared_nodes(&self, catalog: &Catalog, block: usize) -> Vec<u32> {
        let mut nodes = interface_nodes(catalog, &self.blocks[block]);
        nodes.retain(|&node| self.sharing[node as usize] > 1);
        nodes
    }
}

/// The nodes of Γ of a block, each once, ascending.
fn interface_nodes(catalog: &Catalog, block: &BlockPlan) -> Vec<u32> {
    let mut nodes: Vec<u32> = block
        .subdomains
        .iter()
        .flat_map(|&s| catalog.interface[s].iter().copied())
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

#[cfg(test)]
mod tests {
    use contact_dd_partition::model::PlaneState;
    use contact_dd_partition::problem::{Body, SubdomainSummary};

    use super::*;

    /// Subdomains 1 and 3 in contact; 0, 2 and 4 linear, 4 the largest.
    fn catalog() -> Catalog {
        let sizes = [40, 30, 20, 30, 90];
        Catalog {
            title: String::new(),
            dim: 2,
            plane: PlaneState::Strain,
            materials: Vec::new(),
            bodies: vec![Body { name: "b".into() }],
            contacts: Vec::new(),
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
            hierarchy: Default::default(),
            warnings: Vec::new(),
        }
    }

    #[test]
    fn every_subdomain_lies_in_one_block_and_groups_stay_together() {
        let plan = Plan::new(&catalog(), 3);
        assert_eq!(plan.block_of, [0, 1, 2, 1, 3]);
        assert_eq!(plan.blocks[1].subdomains, [1, 3]);
        assert_eq!((plan.pairs.clone(), plan.pair_of(1)), (vec![1], Some(0)));
    }

    #[test]
    fn a_node_that_only_members_of_a_group_share_is_not_on_the_interface() {
        let catalog = catalog();
        let plan = Plan::new(&catalog, 1);
        assert_eq!(plan.shared_nodes(&catalog, 1), [1, 3]);
        assert_eq!(plan.sharing, [3, 2, 1, 2]);
    }

    #[test]
    fn blocks_and_their_order_do_not_depend_on_the_number_of_ranks() {
        let catalog = catalog();
        let one = Plan::new(&catalog, 1);
        for ranks in 2..8 {
            let plan = Plan::new(&catalog, ranks);
            for (a, b) in one.blocks.iter().zip(&plan.blocks) {
                assert_eq!(a.subdomains, b.subdomains);
                assert!(b.owner < ranks);
            }
        }
    }

    #[test]
    fn the_largest_block_gets_a_rank_of_its_own() {
        let plan = Plan::new(&catalog(), 2);
        let alone = plan.blocks[3].owner;
        assert_eq!(plan.blocks.iter().filter(|b| b.owner == alone).count(), 1);
    }
}
