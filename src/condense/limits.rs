//! Bounds on normal jumps: made where the blocks are, joined where their clusters are.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;

use crate::condense::blocks::CondensedBlocks;
use crate::condense::dof_failure;
use crate::contact::limits::Limits;
use crate::contact::normal_jump::NormalJumpOf;
use crate::context::Context;
use crate::context::Loads;
use crate::error::Failure;
use crate::fem::block::OwnedBlock;
use crate::fem::load::BlockLoads;
use crate::fem::prescribed::Prescribed;

/// What supports prescribe in the blocks of this rank in a load step. Collective.
///
/// # Errors
/// A contact point that lies on Γ.
pub fn prescribe(
    context: &Context<'_>,
    condensed: &CondensedBlocks,
    loads: &Loads,
) -> Result<BTreeMap<usize, Prescribed>, Failure> {
    let Context { comm, catalog, .. } = context;
    let made = condensed.blocks.keys().filter_map(|&b| {
        let owned = context.blocks.get(&b)?;
        let made = Prescribed::new(owned, loads.get(&b)?, &catalog.materials)
            .map_err(|error| dof_failure(error, owned, catalog));
        Some(made.map(|prescribed| (b, prescribed)))
    });
    comm.agree(made.collect())
}

/// The bounds on the normal jumps of every cluster in contact of this rank in a load step, by its place among
/// those. Collective.
///
/// # Errors
/// Supports that make two sides penetrate.
pub fn limits_of_clusters(
    context: &Context<'_>,
    loads: &Loads,
    prescribed: &BTreeMap<usize, Prescribed>,
    condensed: &CondensedBlocks,
) -> Result<BTreeMap<usize, Limits>, Failure> {
    let Context {
        comm,
        catalog,
        plan,
        blocks,
        ..
    } = context;
    let made = plan.groups.iter().enumerate().filter_map(|(g, b)| {
        let jumps = condensed.blocks.get(b)?.dofs.jumps;
        let (owned, loads) = (blocks.get(b)?, loads.get(b)?);
        let limits = of_block(owned, loads, prescribed.get(b)?, jumps, catalog);
        Some(limits.map(|limits| (g, limits)))
    });
    let made: BTreeMap<usize, Limits> = comm.agree(made.collect())?;
    let groups = plan.groups_by_cluster();
    let mut arrived: BTreeMap<usize, Limits> = BTreeMap::new();
    comm.route(
        plan.ways_to_clusters(),
        |i| made.get(&groups[i]).cloned().unwrap_or_default(),
        |i, limits| {
            arrived.insert(groups[i], limits);
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

/// The bounds on a block's `jumps`.
fn of_block(
    owned: &OwnedBlock,
    loads: &BlockLoads,
    prescribed: &Prescribed,
    jumps: usize,
    catalog: &Catalog,
) -> Result<Limits, Failure> {
    let scale = loads.largest_prescribed();
    let points = owned.points.iter().zip(&loads.gaps);
    for ((point, gap), of) in points.zip(&prescribed.jump_of) {
        if let &NormalJumpOf::Prescribed(jump) = of
            && jump > gap + 1e-12 * scale
        {
            let contact = &catalog.contacts[point.contact as usize].name;
            return Err(Failure::input(format!(
                "contact '{contact}': nodes {} and {} are prescribed to penetrate by {:.3e}; \
                 expected displacements that leave a gap",
                point.tag_a,
                point.tag_b,
                jump - gap
            )));
        }
    }
    let of = &prescribed.jump_of;
    Ok(Limits::new(jumps, of, &loads.gaps, scale))
}
