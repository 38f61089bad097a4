//! Reading of the problem file: every rank reads its own blocks.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use contact_dd_partition::error::InputError;
use contact_dd_partition::id::{BlockId, GroupId, OnBlocks, OnGroups};
use contact_dd_partition::mesh::bounding_box::BoundingBox;
use contact_dd_partition::problem::consistency::Places;
use contact_dd_partition::problem::copies::{Disagreement, NodeCopies, OwnNodes};
use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::problem::{Catalog, Subdomain, trial};

use crate::comm::{Comm, is_asked_to_stop};
use crate::error::Failure;
use crate::fem::block::Block;
use crate::fem::contact_group::ContactGroup;
use crate::fem::contact_node::ContactNode;
use crate::plan::Plan;

/// Most subdomains read at once: for a while their data exist twice, in HDF5's buffers and here.
const AT_ONCE: usize = 64;

/// Checks that the HDF5 library can read the problem file, on the root alone. Collective.
///
/// # Errors
/// The file is missing or damaged, or a signal asked the run to stop.
pub fn check_problem(comm: &Comm, path: &Path) -> Result<(), Failure> {
    let check = || trial::check(path, is_asked_to_stop).err();
    let mut damage = comm.is_root().then(check).flatten().map(Failure::from);
    comm.broadcast(&mut damage);
    match damage {
        Some(damage) => Err(damage),
        None if comm.is_any_asked_to_stop() => Err(Failure::interrupted(
            "interrupted while reading, before a result was written",
        )),
        None => Ok(()),
    }
}

/// Reads the blocks of `plan` that `rank` owns, by their number.
///
/// # Errors
/// Inconsistent or malformed data of a subdomain in the problem file.
pub fn read_blocks(
    rank: usize,
    file: &ProblemFile,
    plan: &Plan,
) -> Result<OnBlocks<Block>, Failure> {
    let dim = file.catalog().dim;
    let subdomains = read_subdomains(rank, file, plan)?.into_iter();
    Ok(subdomains
        .map(|(s, subdomain)| (s, Block::new(subdomain, &plan.tree, dim)))
        .collect())
}

/// The contact groups of this rank, by their number, in the stage described by `catalog`; the owners of `blocks` send
/// the data of their nodes. Collective.
///
/// # Errors
/// A contact point that contradicts the mesh.
pub fn collect_groups(
    comm: &Comm,
    file: &ProblemFile,
    catalog: &Catalog,
    plan: &Plan,
    blocks: &OnBlocks<Block>,
) -> Result<OnGroups<ContactGroup>, Failure> {
    let mut bounds = BoundingBox::EMPTY;
    blocks
        .values()
        .for_each(|block| bounds.include(&BoundingBox::around(block.points())));
    let boxes = comm.collect(&(bounds.low, bounds.high)).into_iter();
    boxes.for_each(|(low, high)| bounds.include(&BoundingBox { low, high }));
    let mut extent = bounds.extent();
    comm.broadcast(&mut extent);
    let described = plan.nodes_to_groups(comm, |b, nodes| {
        let nodes: Vec<(u32, u32)> = nodes
            .iter()
            .map(|(at, number)| (at.node, *number))
            .collect();
        let block = blocks.get(&b);
        block.map_or_else(Vec::new, |block| {
            ContactNode::of(block, &catalog.materials, &nodes)
        })
    });
    let group = |(g, nodes): (GroupId, Vec<ContactNode>)| -> Result<_, InputError> {
        let of_plan = &plan.groups[g];
        let numbers = of_plan.numbers.iter();
        let places = Places {
            nodes: numbers
                .map(|(&at, &n)| (at, nodes[n as usize].place()))
                .collect(),
            extent,
            dim: catalog.dim,
            plane: catalog.plane,
        };
        let mut points = Vec::new();
        for &j in &plan.tree.nodes[of_plan.node].points {
            let point = &catalog.points[j as usize];
            places.check(point, j as usize)?;
            points.push(point.rename(|at| of_plan.numbers.get(&at).copied()));
        }
        let dim = catalog.dim;
        Ok((g, ContactGroup::new(points, nodes, dim)))
    };
    let groups: Result<_, InputError> = described.into_iter().map(group).collect();
    comm.agree(groups.map_err(|error| Failure::from(file.refuse(error))))
}

/// The subdomains of `rank`; consecutive ones in the file are read together.
fn read_subdomains(
    rank: usize,
    file: &ProblemFile,
    plan: &Plan,
) -> Result<OnBlocks<Subdomain>, Failure> {
    let owners = plan.owners();
    let own = owners.each().filter(|&(_, &owner)| owner == rank);
    let mut runs: Vec<Range<usize>> = Vec::new();
    for s in own.map(|(b, _)| b.index()) {
        match runs.last_mut() {
            Some(run) if run.end == s && run.len() < AT_ONCE => run.end += 1,
            _ => runs.push(s..s + 1),
        }
    }
    let mut subdomains = BTreeMap::new();
    for run in runs {
        let read = file.subdomains(run.clone())?;
        subdomains.extend(run.map(BlockId::new).zip(read));
    }
    Ok(subdomains)
}

/// Checks that subdomains agree on the nodes that they share and that no two other nodes have the same tag; every rank
/// checks a part of the nodes. Collective.
///
/// # Errors
/// The first node at which that fails.
pub fn check_copies(
    comm: &Comm,
    file: &ProblemFile,
    blocks: &OnBlocks<Block>,
) -> Result<(), Failure> {
    let ranks = comm.size();
    let mut parts = vec![Vec::new(); ranks];
    for (&s, block) in blocks {
        let of_block = block.subdomain.own_nodes().parts(ranks).into_iter();
        for (part, to) in of_block.zip(&mut parts) {
            to.push((s, part));
        }
    }
    let mut own: Vec<(BlockId, OwnNodes)> = comm.exchange(parts).into_iter().flatten().collect();
    own.sort_by_key(|&(s, _)| s);
    let mut copies = NodeCopies::default();
    for (s, nodes) in own {
        copies.add(s.index(), nodes);
    }
    let first = comm.collect(&copies.check()).into_iter().flatten().min();
    let refused = |fault: Disagreement| Failure::from(file.refuse(InputError::new(fault.message)));
    comm.agree(first.map_or(Ok(()), |fault| Err(refused(fault))))
}
