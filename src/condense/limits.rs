//! Bounds of normal jumps: computed on the owners of contact groups, joined on the owners of their clusters.

use std::collections::BTreeMap;

use contact_dd_partition::id::{GroupId, OnGroups, OnPairs};

use crate::contact::jumps::JumpOf;
use crate::contact::jumps::Jumps;
use crate::contact::limits::{Conditions, Limits};
use crate::context::hierarchy::jumps;
use crate::context::{Context, Loads};
use crate::error::Failure;
use crate::fem::contact_group::{ContactGroup, GroupLoads};

/// Round-off of bounds, relative to prescribed displacements, and of measured gaps, relative to coordinates.
const EQUAL: f64 = 1e-13;
const OF_COORDINATES: f64 = 1e-14;

/// The known jumps of the ties of every contact group of this rank, by its number, each with its constraint (m).
pub type TiedJumps = OnGroups<Vec<(usize, f64)>>;

/// The known jumps of ties from the limits of groups.
pub fn tied_jumps(of_groups: &OnGroups<Limits>) -> TiedJumps {
    let tied = of_groups
        .iter()
        .map(|(&g, limits)| (g, limits.tied.clone()));
    tied.collect()
}

/// The bounds of the normal jumps of every cluster in contact of this rank in a load step, by its number among the
/// pairs, joined from the limits `made` of its groups. Collective.
pub fn limits_of_clusters(context: &Context<'_>, made: &OnGroups<Limits>) -> OnPairs<Limits> {
    let Context { comm, plan, .. } = context;
    let groups = plan.groups_by_cluster();
    let mut arrived: OnGroups<Limits> = BTreeMap::new();
    comm.route(
        plan.routes_to_clusters(),
        |i| made.get(&groups[i]).cloned().unwrap_or_default(),
        |i, limits| {
            arrived.insert(groups[i], limits);
        },
    );
    let contact = plan.pairs.each().map(|(p, &c)| (p, &plan.clusters[c]));
    let own = contact.filter(|(_, cluster)| cluster.owner == comm.rank());
    own.map(|(p, cluster)| {
        let groups = cluster.groups.iter();
        let limits: Vec<Limits> = groups.filter_map(|g| arrived.remove(g)).collect();
        (p, Limits::join(&limits))
    })
    .collect()
}

/// The bounds of the normal jumps of every contact group of this rank in a load step, by its number. Collective.
///
/// # Errors
/// Prescribed displacements by which two sides penetrate.
pub fn limits_of_groups(context: &Context<'_>, loads: &Loads) -> Result<OnGroups<Limits>, Failure> {
    let made = context.groups.iter().map(|(&g, group)| {
        let limits = of_group(context, g, group, &loads.groups[&g])?;
        Ok((g, limits))
    });
    context.comm.agree(made.collect())
}

/// The bounds of the normal jumps of group g.
fn of_group(
    context: &Context<'_>,
    g: GroupId,
    group: &ContactGroup,
    loads: &GroupLoads,
) -> Result<Limits, Failure> {
    let scale = loads.largest_prescribed();
    let jumps = jumps(context, g, group)?;
    let bounds = group.bounds(loads, &jumps);
    check_ties(context, group, &jumps, (&bounds, scale))?;
    for ((point, &bound), of) in group.points.iter().zip(&bounds).zip(&jumps.of) {
        if *of == JumpOf::Prescribed && !point.law.is_tied() && bound < -1e-12 * scale {
            let contact = &context.catalog.contacts[point.contact as usize].name;
            return Err(Failure::input(format!(
                "contact '{contact}': nodes {} and {} are prescribed to penetrate by {:.3e}; \
                 expected displacements that leave a gap",
                point.tag_a, point.tag_b, -bound
            )));
        }
    }
    let conditions = Conditions {
        of: &jumps.of,
        gaps: &bounds,
        areas: &group.areas(),
        friction: &group.friction(),
        scale,
        round_off: &group.round_off(EQUAL * scale, OF_COORDINATES),
    };
    Ok(Limits::new(jumps.pivots.len(), conditions))
}

/// Checks that supports and other ties don't contradict the jump of a tie if they prescribe all of it: `bounds` are the
/// differences, compared with the scale of displacements.
///
/// # Errors
/// The first contradictory constraint.
fn check_ties(
    context: &Context<'_>,
    group: &ContactGroup,
    jumps: &Jumps,
    (bounds, scale): (&[f64], f64),
) -> Result<(), Failure> {
    for (j, condition) in group.conditions().enumerate() {
        let is_prescribed = condition.is_tied && jumps.of[j] == JumpOf::Prescribed;
        if !is_prescribed || bounds[j].abs() <= 1e-12 * scale || group.is_left_out(&condition) {
            continue;
        }
        let point = &group.points[condition.point];
        let contact = &context.catalog.contacts[point.contact as usize];
        // The reference point of a coupling is no node of the mesh.
        let place = match point.tag() {
            tag if tag < 0 => String::new(),
            tag => format!("at node {tag} "),
        };
        return Err(Failure::input(format!(
            "{} '{}': {place}displacements that supports and others prescribe contradict it, by {:.3e}; expected \
             displacements that leave it as it is",
            contact.kind.word(),
            contact.name,
            bounds[j].abs()
        )));
    }
    Ok(())
}
