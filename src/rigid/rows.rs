//! What the analysis of rigid motions needs of contact conditions, from the ranks that have them.

use std::collections::BTreeMap;

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::problem::Catalog;

use super::analysis::RigidRow;
use super::motion::BodyFrame;
use crate::comm::{Comm, Message};
use crate::fem::owned::OwnedBlock;
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
    let modes = BodyFrame::count(catalog.dim);
    let mut rows = Vec::new();
    let mut conditions = Vec::new();
    comm.gather(
        &plan.group_owners(),
        |g| {
            let mut message = Message::default();
            if let Some(owned) = blocks.get(&plan.groups[g]) {
                for point in &owned.points {
                    pack_row(owned, point, catalog, frames, &mut message);
                    message.reals.push(point.gap);
                }
            }
            message
        },
        |_, message| {
            let count = message.integers.len();
            let before = rows.len();
            let mut reader = message.read();
            let mut read = 0;
            while read < count {
                let entries = reader.count();
                read += 1 + entries;
                let bodies = (0..entries)
                    .map(|_| (reader.count(), reader.reals(modes)))
                    .collect();
                let gap = reader.real();
                rows.push(RigidRow { bodies, gap });
            }
            conditions.push(rows.len() - before);
        },
    );
    (rows, conditions)
}

fn pack_row(
    owned: &OwnedBlock,
    point: &ContactPoint<u32>,
    catalog: &Catalog,
    frames: &[BodyFrame],
    message: &mut Message,
) {
    let block = &owned.block;
    message.integers.push(point.entries.len() as i64);
    for (node, row) in point.row() {
        let (x, body) = (&block.points[node as usize], block.bodies[node as usize]);
        message.integers.push(i64::from(body));
        message
            .reals
            .extend(frames[body as usize].action(catalog.dim, x, &row));
    }
}
