//! Comparing what the ranks read of nodes that several subdomains have.

use std::collections::BTreeMap;

use contact_dd_partition::problem::copies::NodeCopies;
use contact_dd_partition::problem::read::ProblemFile;

use crate::comm::Comm;
use crate::error::Failure;
use crate::fem::owned::OwnedBlock;
use crate::plan::Plan;

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
