//! What the analysis of rigid motions needs of contact conditions, from the ranks that have them.

use std::collections::BTreeMap;

use super::analysis::RigidRow;
use super::motion::BodyFrame;
use crate::comm::Comm;
use crate::fem::contact_group::ContactGroup;
use crate::plan::Plan;

/// The conditions against the rigid motions of the bodies, group by group, and how many each group has;
/// on the root. Collective.
pub(super) fn rigid_rows(
    comm: &Comm,
    groups: &BTreeMap<usize, ContactGroup>,
    plan: &Plan,
    frames: &[BodyFrame],
) -> (Vec<RigidRow>, Vec<usize>) {
    let mut rows = Vec::new();
    let mut conditions = Vec::new();
    comm.gather(
        &plan.group_owners(),
        |g| of_group(&groups[&g], frames),
        |_, of_group| {
            conditions.push(of_group.len());
            rows.extend(of_group);
        },
    );
    (rows, conditions)
}

fn of_group(group: &ContactGroup, frames: &[BodyFrame]) -> Vec<RigidRow> {
    let against = |(node, row): (u32, [f64; 3])| {
        let node = &group.nodes[node as usize];
        (
            node.body,
            frames[node.body].action(group.dim, &node.at, &row),
        )
    };
    let points = group.points.iter();
    points
        .map(|point| RigidRow {
            bodies: point.row().map(against).collect(),
            gap: point.gap,
        })
        .collect()
}
