//! Comparing what the ranks read of nodes that several subdomains have.

use std::collections::BTreeMap;

use contact_dd_partition::problem::copies::{NodeCopies, OwnNodes, SharedNode};
use contact_dd_partition::problem::read::ProblemFile;

use crate::comm::{Comm, Message};
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
            pack(own.unwrap_or_default())
        },
        |s, message| copies.add(s, unpack(message)),
    );
    comm.agree(match comm.is_root() {
        true => (copies.check()).map_err(|error| Failure::from(file.refuse(error))),
        false => Ok(()),
    })
}

fn pack(nodes: OwnNodes) -> Message {
    let mut message = Message::default();
    message.integers.push(nodes.inner.len() as i64);
    message.integers.extend(nodes.inner);
    message.integers.push(nodes.shared.len() as i64);
    for node in nodes.shared {
        let supports = node.supports.len() as i64;
        let values = node.supports.first().map_or(0, |(_, values)| values.len());
        let head = [i64::from(node.interface), node.tag, supports, values as i64];
        message.integers.extend(head);
        message.reals.extend(node.point);
        for (direction, values) in node.supports {
            message.reals.extend(direction);
            message.reals.extend(values);
        }
    }
    message
}

fn unpack(message: Message) -> OwnNodes {
    let mut reader = message.read();
    let count = reader.count();
    let inner = reader.integers(count);
    let shared = (0..reader.count()).map(|_| {
        let (interface, tag) = (reader.count(), reader.integer());
        let (supports, values) = (reader.count(), reader.count());
        let point = std::array::from_fn(|_| reader.real());
        let mut support = || (std::array::from_fn(|_| reader.real()), reader.reals(values));
        SharedNode {
            interface: interface as u32,
            tag,
            point,
            supports: (0..supports).map(|_| support()).collect(),
        }
    });
    OwnNodes {
        inner,
        shared: shared.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_arrive_as_they_were_sent() {
        let node = |interface, supports: &[f64]| SharedNode {
            interface,
            tag: 100 + i64::from(interface),
            point: [0.1, 0.2, f64::from(interface)],
            supports: (supports.iter())
                .map(|&v| ([0.6, 0.8, 0.0], vec![v, 2.0 * v]))
                .collect(),
        };
        let nodes = OwnNodes {
            inner: vec![7, 3, 1 << 40],
            shared: vec![node(4, &[]), node(5, &[1.0, -2.0]), node(9, &[0.5])],
        };
        assert_eq!(unpack(pack(nodes.clone())), nodes);
    }
}
