//! Parcels: consecutive subdomains of one owner, sent to the root in one message.

use std::iter::repeat_n;
use std::ops::Range;

use contact_dd_partition::element::geometry::padded;
use contact_dd_partition::id::BlockId;

use crate::comm::Comm;
use crate::context::Context;
use crate::fem::block::Block;
use crate::fem::elasticity::{principal_stresses, von_mises};
use crate::output::result::{PartitionSize, SubdomainResults};
use crate::plan::Plan;
use crate::recover::solution::Solution;
use crate::recover::stresses::Stress;

/// A slab of the result file, or a part of one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Parcel {
    /// Subdomains.
    pub subdomains: Range<usize>,
    /// The rank that owns all of them.
    pub owner: usize,
    /// True if it is the last parcel of its slab.
    pub ends_slab: bool,
}

impl Parcel {
    /// Splits the root's `slabs` where the owner changes. Collective.
    pub(super) fn cut(comm: &Comm, slabs: &[Range<usize>], plan: &Plan) -> Vec<Self> {
        let mut ends: Vec<usize> = slabs.iter().map(|slab| slab.end).collect();
        comm.broadcast(&mut ends);
        let owners = plan.owners();
        cut(ends.into_iter(), |s| owners[BlockId::new(s)])
    }

    /// Appends the results of its subdomains; called on their owner.
    pub(super) fn append_to(
        &self,
        results: &mut SubdomainResults,
        context: &Context<'_>,
        solution: &Solution,
    ) {
        let &Context {
            catalog, blocks, ..
        } = context;
        for b in self.subdomains.clone().map(BlockId::new) {
            match blocks.get(&b).zip(solution.displacement.get(&b)) {
                Some((block, displacement)) => {
                    append_block(results, block, displacement);
                    if catalog.has_stages() {
                        let is_there = !catalog.bodies[block.subdomain.body].is_absent;
                        let cells = block.subdomain.cells.len();
                        results.present.extend(repeat_n(u8::from(is_there), cells));
                    }
                    if let Some(stress) = solution.stress.as_ref().and_then(|all| all.get(&b)) {
                        append_stress(results, stress, block.body_nodes());
                        if !catalog.quantities.is_empty() {
                            let errors = solution.quantities.errors_of_cells.get(&b);
                            let none = || vec![f64::NAN; stress.cells.len()];
                            let errors = errors.cloned().unwrap_or_else(none);
                            results.quantity_error.extend(errors);
                        }
                    }
                }
                // An absent subdomain has an empty partition, so that the file lists it.
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

/// Appends a block and its displacement.
fn append_block(results: &mut SubdomainResults, block: &Block, displacement: &[f64]) {
    let subdomain = &block.subdomain;
    results.sizes.push(PartitionSize {
        points: block.body_nodes(),
        cells: subdomain.cells.len(),
        connectivity: subdomain.cells.connectivity().len(),
    });
    let nodes = block.body_nodes();
    results.points.extend_from_slice(block.body_points());
    (results.node_tags).extend_from_slice(&subdomain.node_tags[..nodes]);
    let at_nodes = displacement.chunks_exact(block.dim).take(nodes);
    results.displacement.extend(at_nodes.map(padded));
    let connectivity = subdomain.cells.connectivity().iter();
    results
        .connectivity
        .extend(connectivity.map(|&n| i64::from(n)));
    let offsets = subdomain.cells.offsets().iter();
    results.offsets.extend(offsets.map(|&o| o as i64));
    let types = subdomain.cells.iter().map(|(kind, _)| kind.vtk());
    results.types.extend(types);
    let materials = subdomain.cell_material.iter();
    results.materials.extend(materials.map(|&m| m as i32));
}

/// Appends the stresses of a block whose cells have this number of `nodes`.
fn append_stress(results: &mut SubdomainResults, stress: &Stress, nodes: usize) {
    let cells = &stress.cells;
    let nodes = &stress.nodes[..nodes];
    results.nodal_stress.extend_from_slice(nodes);
    let nodes = nodes.iter();
    results.nodal_von_mises.extend(nodes.map(von_mises));
    results.cell_stress.extend_from_slice(cells);
    let norms = stress.errors.iter().map(|e| e.error.sqrt());
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
