//! Bounds on normal jumps: made where the contact groups are, joined where their clusters are.

use std::collections::BTreeMap;

use crate::contact::jumps::JumpOf;
use crate::contact::limits::Limits;
use crate::context::hierarchy::jumps;
use crate::context::{Context, Loads};
use crate::error::Failure;
use crate::fem::contact_group::{ContactGroup, GroupLoads};

/// The bounds on the normal jumps of every cluster in contact of this rank in a load step, by its place among
/// those. Collective.
///
/// # Errors
/// Supports that make two sides penetrate.
pub fn limits_of_clusters(
    context: &Context<'_>,
    loads: &Loads,
) -> Result<BTreeMap<usize, Limits>, Failure> {
    let Context { comm, plan, .. } = context;
    let made = limits_of_groups(context, loads)?;
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

/// The bounds on the normal jumps of every contact group of this rank in a load step, by its number. Collective.
///
/// # Errors
/// Supports that make two sides penetrate.
pub fn limits_of_groups(
    context: &Context<'_>,
    loads: &Loads,
) -> Result<BTreeMap<usize, Limits>, Failure> {
    let made = context.groups.iter().map(|(&g, group)| {
        let limits = of_group(context, g, group, &loads.groups[&g])?;
        Ok((g, limits))
    });
    context.comm.agree(made.collect())
}

/// The bounds on the normal jumps of group g.
fn of_group(
    context: &Context<'_>,
    g: usize,
    group: &ContactGroup,
    loads: &GroupLoads,
) -> Result<Limits, Failure> {
    let scale = loads.largest_prescribed();
    let jumps = jumps(context, g, group)?;
    let bounds = group.bounds(loads);
    for ((point, &bound), of) in group.points.iter().zip(&bounds).zip(&jumps.of) {
        if *of == JumpOf::Prescribed && bound < -1e-12 * scale {
            let contact = &context.catalog.contacts[point.contact as usize].name;
            return Err(Failure::input(format!(
                "contact '{contact}': nodes {} and {} are prescribed to penetrate by {:.3e}; \
                 expected displacements that leave a gap",
                point.tag_a, point.tag_b, -bound
            )));
        }
    }
    Ok(Limits::new(
        jumps.pivots.len(),
        &jumps.of,
        &bounds,
        &group.friction(),
        scale,
    ))
}
