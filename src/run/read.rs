//! Reading: every rank takes its own blocks from the problem file.

use std::collections::BTreeMap;

use contact_dd_partition::problem::ContactRow;
use contact_dd_partition::problem::read::ProblemFile;

use crate::comm::Comm;
use crate::error::Failure;
use crate::fem::block::Block;
use crate::fem::condition::BlockCondition;
use crate::plan::Plan;

/// A block as it was read.
#[derive(Clone, Debug)]
pub struct OwnedBlock {
    /// Its subdomains.
    pub block: Block,
    /// Its contact rows.
    pub rows: Vec<ContactRow>,
    /// The same over the nodes of the block.
    pub conditions: Vec<BlockCondition>,
}

/// Reads the blocks of `plan` that this rank owns, by their number.
///
/// # Errors
/// A slice of the problem file isn't what it should be.
pub fn read_blocks(
    comm: &Comm,
    file: &ProblemFile,
    plan: &Plan,
) -> Result<BTreeMap<usize, OwnedBlock>, Failure> {
    let dim = file.catalog().dim;
    let mut blocks = BTreeMap::new();
    for (number, of_plan) in plan.blocks.iter().enumerate() {
        if of_plan.owner != comm.rank() {
            continue;
        }
        let members = of_plan
            .subdomains
            .iter()
            .map(|&index| file.subdomain(index))
            .collect::<Result<Vec<_>, _>>()?;
        let rows = of_plan
            .group
            .map(|group| file.rows(group))
            .transpose()?
            .unwrap_or_default();
        let block = Block::new(members, dim, |node| plan.sharing[node as usize] > 1);
        let conditions = rows
            .iter()
            .map(|row| BlockCondition::new(&block, row))
            .collect();
        blocks.insert(
            number,
            OwnedBlock {
                block,
                rows,
                conditions,
            },
        );
    }
    Ok(blocks)
}
