//! Consecutive subdomains of one owner: what travels to the root in one message.

use std::collections::BTreeMap;
use std::ops::Range;

use contact_dd_partition::element::geometry::padded;

use crate::comm::Comm;
use crate::fem::block::{Block, OwnedBlock};
use crate::fem::elasticity::{principal_stresses, von_mises};
use crate::output::result::{PartitionSize, SubdomainResults};
use crate::plan::Plan;
use crate::recover::solution::Solution;
use crate::recover::stresses::Stress;

/// A slab of the result file, or a part of one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Parcel {
    /// Its subdomains.
    pub subdomains: Range<usize>,
    /// The rank that owns them all.
    pub owner: usize,
    /// Whether its slab is complete with it.
    pub ends_slab: bool,
}

impl Parcel {
    /// Cuts the root's `slabs` where the owner changes. Collective.
    pub(super) fn cut(comm: &Comm, slabs: &[Range<usize>], plan: &Plan) -> Vec<Self> {
        let mut ends: Vec<usize> = slabs.iter().map(|slab| slab.end).collect();
        comm.broadcast(&mut ends);
        let owners = plan.subdomain_owners();
        cut(ends.into_iter(), |s| owners[s])
    }

    /// Appends what was found on its subdomains; called on their owner.
    pub(super) fn append_to(
        &self,
        results: &mut SubdomainResults,
        blocks: &BTreeMap<usize, OwnedBlock>,
        solution: &Solution,
        plan: &Plan,
    ) {
        for index in self.subdomains.clone() {
            let b = plan.block_of[index];
            let block = blocks.get(&b).map(|owned| &owned.block);
            let member = block.and_then(|block| Some((block, block.member(index)?)));
            match member.zip(solution.displacement.get(&b)) {
                Some(((block, m), displacement)) => {
                    append_member(results, block, m, displacement);
                    if let Some(stress) = solution.stress.as_ref().and_then(|stress| stress.get(&b))
                    {
                        append_stress(results, block, m, stress);
                    }
                }
                // It takes its place without any content, so that the file names it.
                None => results.sizes.push(PartitionSize::default()),
            }
        }
    }
}

fn cut(slab_ends: impl Iterator<Item = usize>, owner: impl Fn(usize) -> usize) -> Vec<Parcel> {
    let mut parcels = Vec::new();
    let mut start = 0;
    for slab_end in slab_ends {
        while start < slab_end {
            let rank = owner(start);
            let end = (start..slab_end)
                .find(|&s| owner(s) != rank)
                .unwrap_or(slab_end);
            parcels.push(Parcel {
                subdomains: start..end,
                owner: rank,
                ends_slab: end == slab_end,
            });
            start = end;
        }
    }
    parcels
}

/// Appends member `m` of a block and its displacement.
fn append_member(results: &mut SubdomainResults, block: &Block, m: usize, displacement: &[f64]) {
    let member = &block.members[m];
    let displacement_at = |&node: &u32| {
        let start = node as usize * block.dim;
        padded(&displacement[start..start + block.dim])
    };
    results.sizes.push(PartitionSize {
        points: member.points.len(),
        cells: member.cells.len(),
        connectivity: member.cells.connectivity().len(),
    });
    results.points.extend_from_slice(&member.points);
    results.node_tags.extend_from_slice(&member.node_tags);
    results
        .displacement
        .extend(block.node_of[m].iter().map(displacement_at));
    let connectivity = member.cells.connectivity().iter();
    results
        .connectivity
        .extend(connectivity.map(|&n| i64::from(n)));
    let offsets = member.cells.offsets().iter();
    results.offsets.extend(offsets.map(|&o| o as i64));
    let types = member.cells.iter().map(|(kind, _)| kind.vtk());
    results.types.extend(types);
    let materials = member.cell_material.iter();
    results.materials.extend(materials.map(|&m| m as i32));
}

/// Appends the stresses of member `m` of a block.
fn append_stress(results: &mut SubdomainResults, block: &Block, m: usize, stress: &Stress) {
    let first_cell: usize = block.members[..m].iter().map(|o| o.cells.len()).sum();
    let of_member = first_cell..first_cell + block.members[m].cells.len();
    let cells = &stress.cells[of_member.clone()];
    let errors = &stress.recovered.errors[of_member];
    let nodal = stress.recovered.of_member(block, m);
    results.nodal_stress.extend(nodal);
    results.cell_stress.extend_from_slice(cells);
    let norms = errors.iter().map(|e| e.error.sqrt());
    results.energy_error.extend(norms);
    results
        .principal
        .extend(cells.iter().map(principal_stresses));
    results.von_mises.extend(cells.iter().map(von_mises));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parcels_end_where_a_slab_ends_or_the_owner_changes() {
        let owners = [0, 0, 1, 1, 1, 0];
        let parcels = cut([4, 6].into_iter(), |s| owners[s]);
        let parcel = |subdomains, owner, ends_slab| Parcel {
            subdomains,
            owner,
            ends_slab,
        };
        assert_eq!(
            parcels,
            [
                parcel(0..2, 0, false),
                parcel(2..4, 1, true),
                parcel(4..5, 1, false),
                parcel(5..6, 0, true),
            ]
        );
    }
}
