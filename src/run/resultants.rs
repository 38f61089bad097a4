//! Resultants: what contacts and supports carry.

use std::collections::BTreeMap;

use super::frozen::Frozen;
use super::recover::BlockSolution;
use super::refine::balance;
use crate::comm::Message;
use crate::fem::node_frames::supports;
use crate::output::resultants::{ContactResultant, Reaction, Resultant, Resultants};

/// Sums up contact forces and reactions; on the root they are those of the whole solution.
/// Collective.
pub fn resultants(frozen: &Frozen<'_>, solutions: &BTreeMap<usize, BlockSolution>) -> Resultants {
    let catalog = frozen.catalog;
    let contacts = catalog.contacts.iter().map(|contact| ContactResultant {
        name: contact.name.clone(),
        conditions: contact.conditions,
        ..ContactResultant::default()
    });
    let reactions = catalog.supports.iter().map(|support| Reaction {
        support: support.clone(),
        resultant: Resultant::default(),
    });
    let mut all = Resultants {
        contacts: contacts.collect(),
        reactions: reactions.collect(),
    };
    frozen.comm.gather(
        &frozen.plan.owners(),
        |b| match solutions.get(&b) {
            Some(solution) => of_block(frozen, b, solution),
            None => Message::default(),
        },
        |_, message| add(&mut all, &message),
    );
    all
}

/// For every condition its contact, whether it is closed, and position, force on side a and
/// pressure; for every support its condition and position and reaction.
fn of_block(frozen: &Frozen<'_>, b: usize, solution: &BlockSolution) -> Message {
    let mut message = Message::default();
    let Some(owned) = frozen.blocks.get(&b) else {
        return message;
    };
    message.integers.push(owned.rows.len() as i64);
    for (j, row) in owned.rows.iter().enumerate() {
        let force = solution.forces[j];
        let closed = i64::from(solution.closed[j]);
        message.integers.extend([i64::from(row.contact), closed]);
        message.reals.extend(row.position);
        message.reals.extend(row.normal.map(|n| -force * n));
        message.reals.push(force / row.share);
    }
    let held = supports(&owned.block);
    let balance = match held.is_empty() {
        true => None,
        false => balance(frozen, b, solution),
    };
    if let Some(balance) = balance {
        let dim = owned.block.dim;
        for support in held {
            let residual = &balance.residual[dim * support.node as usize..][..dim];
            let along: f64 = (residual.iter().zip(&support.direction))
                .map(|(r, d)| r * d)
                .sum();
            message.integers.push(i64::from(support.condition));
            (message.reals).extend(owned.block.points[support.node as usize]);
            (message.reals).extend(support.direction.map(|d| -along * d));
        }
    }
    message
}

fn add(all: &mut Resultants, message: &Message) {
    let Some((&rows, integers)) = message.integers.split_first() else {
        return;
    };
    let (conditions, supports) = integers.split_at(2 * rows as usize);
    let (of_conditions, of_supports) = message.reals.split_at(7 * rows as usize);
    for (i, r) in conditions.chunks(2).zip(of_conditions.chunks(7)) {
        let contact = &mut all.contacts[i[0] as usize];
        contact.closed += i[1] as usize;
        contact
            .resultant
            .add([r[0], r[1], r[2]], [r[3], r[4], r[5]]);
        contact.largest_pressure = contact.largest_pressure.max(r[6]);
    }
    for (&condition, r) in supports.iter().zip(of_supports.chunks(6)) {
        let reaction = &mut all.reactions[condition as usize];
        (reaction.resultant).add([r[0], r[1], r[2]], [r[3], r[4], r[5]]);
    }
}
