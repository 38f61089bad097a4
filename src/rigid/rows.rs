//! Contact constraints for the rigid-body analysis, gathered from the ranks that own their groups.

use std::collections::BTreeMap;

use super::scene::{Friction, RigidRow};
use crate::contact::friction::TangentialCondition;
use crate::context::{Context, Loads};
use crate::fem::body_frame::BodyFrame;
use crate::fem::contact_group::{Condition, ContactGroup, GroupLoads};
use crate::vector::{axpy, largest};

/// Action of a tie on a body, relative to its terms, that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// The constraints in the rigid motions of the bodies, group by group, and their number in each group; on the root.
/// Collective.
pub(super) fn rigid_rows(
    context: &Context<'_>,
    frames: &[BodyFrame],
    loads: &Loads,
) -> (Vec<RigidRow>, Vec<usize>) {
    let mut rows = Vec::new();
    let mut conditions = Vec::new();
    context.comm.gather(
        &context.plan.group_owners(),
        |g| of_group(&context.groups[&g], frames, &loads.groups[&g]),
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

fn of_group(group: &ContactGroup, frames: &[BodyFrame], loads: &GroupLoads) -> Vec<RigidRow> {
    let against = |(node, row): (u32, [f64; 3])| {
        let node = &group.nodes[node as usize];
        let action = || frames[node.body].action(group.dim, &node.at, &row);
        (!node.is_auxiliary).then(|| (node.body, action()))
    };
    let row = |condition: Condition| RigidRow {
        bodies: {
            let all = group.row_of(&condition).filter_map(against).collect();
            if condition.is_tied { summed(all) } else { all }
        },
        gap: match condition.is_tangential {
            true => 0.0,
            false => {
                let moved = group.moved(condition.point, condition.direction, loads);
                group.points[condition.point].gap - moved
            }
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

/// Actions summed over each body: those of a body on both sides of a tie cancel up to round-off.
fn summed(all: Vec<(usize, Vec<f64>)>) -> Vec<(usize, Vec<f64>)> {
    let mut of_bodies: BTreeMap<usize, [Vec<f64>; 2]> = BTreeMap::new();
    for (body, action) in all {
        let none = || [vec![0.0; action.len()], vec![0.0; action.len()]];
        let [sum, sizes] = of_bodies.entry(body).or_insert_with(none);
        axpy(1.0, &action, sum);
        (sizes.iter_mut().zip(&action)).for_each(|(size, a)| *size += a.abs());
    }
    for [sum, sizes] in of_bodies.values_mut() {
        let nothing = ROUND_OFF * largest(sizes);
        (sum.iter_mut().filter(|a| a.abs() <= nothing)).for_each(|a| *a = 0.0);
    }
    let bodies = of_bodies.into_iter();
    bodies.map(|(body, [sum, _])| (body, sum)).collect()
}
