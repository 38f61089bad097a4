//! Bounds on approaches: made where the blocks are, joined where their clusters are.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;

use super::condensed_blocks::CondensedBlocks;
use crate::comm::{Comm, Message};
use crate::contact::approach::ApproachOf;
use crate::contact::limits::Limits;
use crate::error::Failure;
use crate::fem::dofs::Dofs;
use crate::fem::owned::OwnedBlock;
use crate::plan::Plan;

/// The bounds on the approaches of every cluster in contact of this rank, by its place among those, as
/// gaps and supports of the blocks are now. Collective.
///
/// # Errors
/// Supports that make two sides penetrate.
pub(super) fn limits_of_clusters(
    comm: &Comm,
    plan: &Plan,
    catalog: &Catalog,
    blocks: &BTreeMap<usize, OwnedBlock>,
    condensed: &CondensedBlocks,
) -> Result<BTreeMap<usize, Limits>, Failure> {
    let made = plan.groups.iter().enumerate().filter_map(|(g, b)| {
        let (owned, dofs) = (blocks.get(b)?, condensed.dofs.get(b)?);
        Some(of_block(owned, dofs, catalog).map(|limits| (g, limits)))
    });
    let made: BTreeMap<usize, Limits> = comm.agree(made.collect())?;
    let groups = plan.groups_by_cluster();
    let mut arrived: BTreeMap<usize, Limits> = BTreeMap::new();
    comm.route(
        plan.ways_to_clusters(),
        |i| {
            let mut message = Message::default();
            if let Some(limits) = made.get(&groups[i]) {
                limits.pack(&mut message);
            }
            message
        },
        |i, message| {
            arrived.insert(groups[i], Limits::unpack(&mut message.read()));
        },
    );
    let contact = plan.contact.iter().map(|&c| &plan.clusters[c]);
    let own = (contact.enumerate()).filter(|(_, cluster)| cluster.owner == comm.rank());
    Ok(own
        .map(|(p, cluster)| {
            let groups = cluster.groups.iter();
            let limits: Vec<Limits> = groups.filter_map(|g| arrived.remove(g)).collect();
            (p, Limits::join(&limits))
        })
        .collect())
}

/// The bounds on a block's approaches.
fn of_block(owned: &OwnedBlock, dofs: &Dofs, catalog: &Catalog) -> Result<Limits, Failure> {
    let scale = prescribed_scale(owned);
    for (j, of) in dofs.approach_of.iter().enumerate() {
        let gap = owned.gaps[j];
        if let &ApproachOf::Prescribed(approach) = of
            && approach > gap + 1e-12 * scale
        {
            let point = &owned.points[j];
            let contact = &catalog.contacts[point.contact as usize].name;
            return Err(Failure::input(format!(
                "contact '{contact}': nodes {} and {} are prescribed to penetrate by {:.3e}; \
                 expected displacements that leave a gap",
                point.tag_a,
                point.tag_b,
                approach - gap
            )));
        }
    }
    Ok(Limits::new(
        dofs.approaches,
        &dofs.approach_of,
        &owned.gaps,
        scale,
    ))
}

/// The largest displacement that is prescribed in a block, initial gaps among them (m).
fn prescribed_scale(owned: &OwnedBlock) -> f64 {
    let prescribed = owned
        .block
        .members
        .iter()
        .flat_map(|m| m.supports.iter().map(|s| s.value.abs()));
    let gaps = owned.gaps.iter().map(|gap| gap.abs());
    prescribed.chain(gaps).fold(0.0, f64::max)
}
