//! Messages along the hierarchy, and the jumps of the contact groups at its nodes.

use contact_dd_partition::id::{GroupId, OnTreeNodes, TreeNodeId};

use crate::bytes::Reals;
use crate::contact::jumps::{Jumps, NoUnknown};
use crate::contact::limits::{Conditions, Limits};
use crate::context::Context;
use crate::error::Failure;
use crate::fem::contact_group::ContactGroup;

/// Sends a vector of node v between its owner and that of its `parent`; without a parent, the owner keeps it.
/// Collective.
pub fn carry(
    context: &Context<'_>,
    v: TreeNodeId,
    parent: Option<TreeNodeId>,
    mut vector: Option<Vec<f64>>,
    into: &mut OnTreeNodes<Vec<f64>>,
    direction: Direction,
) {
    let Context { comm, plan, .. } = *context;
    let Some(parent) = parent else {
        into.extend(vector.map(|vector| (v, vector)));
        return;
    };
    let (here, above) = (plan.node_owners[v], plan.node_owners[parent]);
    let route = match direction {
        Direction::Up => (here, above),
        Direction::Down => (above, here),
    };
    comm.route(
        [route],
        |_| Reals(vector.take().unwrap_or_default()),
        |_, Reals(arrived)| {
            into.insert(v, arrived);
        },
    );
}

/// The direction of a message along the hierarchy.
#[derive(Clone, Copy, Debug)]
pub enum Direction {
    /// A message from a node to the one that it is merged into.
    Up,
    /// A message to a node from the one that it was merged into.
    Down,
}

/// The limits of contact group g of this rank without loads, as the dependent rows don't depend on gaps.
///
/// # Errors
/// A contact point none of whose unknowns can be replaced by its jump.
pub fn resting_limits(
    context: &Context<'_>,
    g: GroupId,
    group: &ContactGroup,
) -> Result<Limits, Failure> {
    let jumps = jumps(context, g, group)?;
    let conditions = Conditions {
        of: &jumps.of,
        gaps: &vec![0.0; jumps.of.len()],
        areas: &group.areas(),
        friction: &group.friction(),
        scale: 0.0,
        round_off: &vec![0.0; jumps.of.len()],
    };
    Ok(Limits::new(jumps.pivots.len(), conditions))
}

/// The jumps of contact group g of this rank.
///
/// # Errors
/// A contact point none of whose unknowns can be replaced by its jump.
pub fn jumps(context: &Context<'_>, g: GroupId, group: &ContactGroup) -> Result<Jumps, Failure> {
    let node = &context.plan.tree.nodes[context.plan.groups[g].node];
    group.jumps(&node.eliminated).map_err(|NoUnknown(j)| {
        let number = group.conditions().nth(j).map_or(0, |condition| condition.point);
        let point = &group.points[number];
        let contact = &context.catalog.contacts[point.contact as usize].name;
        Failure::input(format!(
            "contact '{contact}': linearly dependent contact constraints at nodes {} and {}; expected points whose rows are \
             independent, or multiples of each other",
            point.tag_a, point.tag_b
        ))
    })
}
