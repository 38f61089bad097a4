//! What the analysis of rigid motions needs of contact conditions, from the ranks that have them.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;

use super::analysis::RigidRow;
use super::motion::BodyFrame;
use crate::comm::Comm;
use crate::fem::block::OwnedBlock;
use crate::plan::Plan;

/// The conditions against the rigid motions of the bodies, group by group, and how many each group has;
/// on the root. Collective.
pub(super) fn rigid_rows(
    comm: &Comm,
    blocks: &BTreeMap<usize, OwnedBlock>,
    catalog: &Catalog,
    plan: &Plan,
    frames: &[BodyFrame],
) -> (Vec<RigidRow>, Vec<usize>) {
    let mut rows = Vec::new();
    let mut conditions = Vec::new();
    comm.gather(
        &plan.group_owners(),
        |g| match blocks.get(&plan.groups[g]) {
            Some(owned) => of_block(owned, catalog.dim, frames),
            None => Vec::new(),
        },
        |_, of_block| {
            conditions.push(of_block.len());
            rows.extend(of_block);
        },
    );
    (rows, conditions)
}

fn of_block(owned: &OwnedBlock, dim: usize, frames: &[BodyFrame]) -> Vec<RigidRow> {
    let block = &owned.block;
    let against = |(node, row): (u32, [f64; 3])| {
        let body = block.bodies[node as usize] as usize;
        let x = &block.points[node as usize];
        (body, frames[body].action(dim, x, &row))
    };
    let points = owned.points.iter();
    points
        .map(|point| RigidRow {
            bodies: point.row().map(against).collect(),
            gap: point.gap,
        })
        .collect()
}
