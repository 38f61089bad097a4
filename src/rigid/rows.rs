//! What the analysis of rigid motions needs of contact conditions, from the ranks that have them.

use std::collections::BTreeMap;

use super::analysis::RigidRow;
use super::forces::Friction;
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
        |_, mut of_group: Vec<RigidRow>| {
            for friction in of_group.iter_mut().filter_map(|row| row.friction.as_mut()) {
                friction.normal += rows.len();
            }
            conditions.push(of_group.len());
            rows.extend(of_group);
        },
    );
    (rows, conditions)
}

/// The conditions of a group: those along the normals, then those along the tangents where there is friction.
fn of_group(group: &ContactGroup, frames: &[BodyFrame]) -> Vec<RigidRow> {
    let against = |(node, row): (u32, [f64; 3])| {
        let node = &group.nodes[node as usize];
        (
            node.body,
            frames[node.body].action(group.dim, &node.at, &row),
        )
    };
    let points = group.points.iter();
    let normals = points.clone().map(|point| RigidRow {
        bodies: point.row().map(against).collect(),
        gap: point.gap,
        friction: None,
    });
    let tangential = points.enumerate().flat_map(|(j, point)| {
        let friction = Friction::new(point.law, point.area, j);
        let tangents = &point.frame.tangents[..group.dim - 1];
        let with_friction = friction
            .into_iter()
            .flat_map(|friction| tangents.iter().map(move |&tangent| (friction, tangent)));
        with_friction.map(|(friction, tangent)| RigidRow {
            bodies: point.row_along(tangent).map(against).collect(),
            gap: 0.0,
            friction: Some(friction),
        })
    });
    normals.chain(tangential).collect()
}
