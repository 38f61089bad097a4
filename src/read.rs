//! Reading: every rank takes its own blocks from the problem file.

use std::collections::BTreeMap;
use std::ops::Range;

use contact_dd_partition::problem::Subdomain;
use contact_dd_partition::problem::copies::NodeCopies;
use contact_dd_partition::problem::read::ProblemFile;

use crate::comm::Comm;
use crate::error::Failure;
use crate::fem::block::{Block, OwnedBlock};
use crate::plan::Plan;

/// Most subdomains that are read at once: what HDF5 hands over is there twice for a while.
const AT_ONCE: usize = 64;

/// Reads the blocks of `plan` that `rank` owns, by their number.
///
/// # Errors
/// A slice of the problem file isn't what it should be.
pub fn read_blocks(
    rank: usize,
    file: &ProblemFile,
    plan: &Plan,
) -> Result<BTreeMap<usize, OwnedBlock>, Failure> {
    let dim = file.catalog().dim;
    let mut subdomains = read_subdomains(rank, file, plan)?;
    let mut blocks = BTreeMap::new();
    for (number, of_plan) in plan.blocks.iter().enumerate() {
        if plan.node_owners[number] != rank {
            continue;
        }
        let members = of_plan.subdomains.iter();
        let members: Vec<Subdomain> = members
            .filter_map(|index| subdomains.remove(index))
            .collect();
        let points = of_plan
            .group
            .map(|group| file.points(group, &members.iter().collect::<Vec<_>>()))
            .transpose()?
            .unwrap_or_default();
        let block = Block::new(members, dim, |node| plan.tree.sharing[node as usize] > 1);
        blocks.insert(number, OwnedBlock::new(block, &points));
    }
    Ok(blocks)
}

/// The subdomains of `rank`, those that follow one another in the file read at once.
fn read_subdomains(
    rank: usize,
    file: &ProblemFile,
    plan: &Plan,
) -> Result<BTreeMap<usize, Subdomain>, Failure> {
    let owners = plan.subdomain_owners();
    let own = (0..owners.len()).filter(|&s| owners[s] == rank);
    let mut runs: Vec<Range<usize>> = Vec::new();
    for s in own {
        match runs.last_mut() {
            Some(run) if run.end == s && run.len() < AT_ONCE => run.end += 1,
            _ => runs.push(s..s + 1),
        }
    }
    let mut subdomains = BTreeMap::new();
    for run in runs {
        let read = file.subdomains(run.clone())?;
        subdomains.extend(run.zip(read));
    }
    Ok(subdomains)
}

/// Checks that subdomains agree on the nodes that they share and that no others have one tag.
/// Collective.
///
/// # Errors
/// The first node for which that isn't so.
pub fn check_copies(
    comm: &Comm,
    file: &ProblemFile,
    plan: &Plan,
    blocks: &BTreeMap<usize, OwnedBlock>,
) -> Result<(), Failure> {
    let mut copies = NodeCopies::new(file.catalog());
    comm.gather(
        &plan.subdomain_owners(),
        |s| {
            // Called on the owner of subdomain s, which has read its block.
            let block = &blocks[&plan.block_of[s]].block;
            let own = block.member(s).map(|m| block.members[m].own_nodes());
            own.unwrap_or_default()
        },
        |s, nodes| copies.add(s, nodes),
    );
    comm.agree(match comm.is_root() {
        true => (copies.check()).map_err(|error| Failure::from(file.refuse(error))),
        false => Ok(()),
    })
}
