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
