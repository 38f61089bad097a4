//! Contact conditions for the analysis of rigid motions, from the ranks that have them.

use super::scene::{Friction, RigidRow};
use crate::contact::friction::TangentialCondition;
use crate::context::Context;
use crate::fem::body_frame::BodyFrame;
use crate::fem::contact_group::{Condition, ContactGroup};

/// The conditions against the rigid motions of the bodies, group by group, and how many each group has;
/// on the root. Collective.
pub(super) fn rigid_rows(
    context: &Context<'_>,
    frames: &[BodyFrame],
) -> (Vec<RigidRow>, Vec<usize>) {
    let mut rows = Vec::new();
    let mut conditions = Vec::new();
    context.comm.gather(
        &context.plan.group_owners(),
        |g| of_group(&context.groups[&g], frames),
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

fn of_group(group: &ContactGroup, frames: &[BodyFrame]) -> Vec<RigidRow> {
    let against = |(node, row): (u32, [f64; 3])| {
        let node = &group.nodes[node as usize];
        (
            node.body,
            frames[node.body].action(group.dim, &node.at, &row),
        )
    };
    let row = |condition: Condition| RigidRow {
        bodies: group.row_of(&condition).map(against).collect(),
        gap: match condition.is_tangential {
            true => 0.0,
            false => group.points[condition.point].gap,
        },
        friction: None,
        is_tied: condition.is_tied,
    };
    let mut rows: Vec<RigidRow> = group.conditions().map(row).collect();
    for TangentialCondition {
        number,
        normal,
        bound,
    } in group.friction()
    {
        rows[number].friction = Some(Friction { normal, bound });
    }
    rows
}
