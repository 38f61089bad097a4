//! The results on their way to the root and into the file.

mod parcel;

use std::collections::BTreeMap;

use contact_dd_partition::error::OutputError;

use self::parcel::{Parcel, pack, unpack};
use super::recover::BlockSolution;
use super::solution::Solution;
use crate::comm::{Comm, Message, ROOT};
use crate::error::Failure;
use crate::fem::owned::OwnedBlock;
use crate::output::result::{ContactResult, SubdomainResults};
use crate::output::resultants::ContactResultant;
use crate::output::vtkhdf::ResultFile;
use crate::plan::Plan;

/// Streams all subdomains and contact rows to the root, which writes a slab of subdomains as soon
/// as it is complete. Collective; `file` is the root's.
///
/// On the root the conditions are added up to `contacts` on their way.
///
/// The slabs don't depend on who owns what: the same calls write the same numbers on any ranks.
///
/// # Errors
/// The file can't be written.
pub fn write_solution(
    comm: &Comm,
    blocks: &BTreeMap<usize, OwnedBlock>,
    solution: &Solution,
    plan: &Plan,
    mut file: Option<&mut ResultFile>,
    contacts: &mut [ContactResultant],
) -> Result<(), Failure> {
    let slabs = file.as_ref().map_or(Vec::new(), |file| file.slabs());
    let mut failed = Ok(());
    let mut write = |write: &mut dyn FnMut(&mut ResultFile) -> Result<(), OutputError>| {
        if let (Some(file), Ok(())) = (file.as_deref_mut(), &failed) {
            failed = write(file);
        }
    };
    let parcels = Parcel::cut(comm, &slabs, plan);
    let owners: Vec<usize> = parcels.iter().map(|parcel| parcel.owner).collect();
    let (mut sent, mut slab) = (SubdomainResults::default(), SubdomainResults::default());
    comm.gather(
        &owners,
        |p| {
            // What is the root's own needs no message.
            if comm.is_root() {
                return Message::default();
            }
            sent.restart(parcels[p].subdomains.start);
            parcels[p].append_to(&mut sent, blocks, solution, plan);
            pack(&sent)
        },
        |p, message| {
            let parcel = &parcels[p];
            match parcel.owner {
                ROOT => parcel.append_to(&mut slab, blocks, solution, plan),
                _ => unpack(&message, &mut slab),
            }
            if parcel.ends_slab {
                write(&mut |file| file.write_subdomains(&slab));
                slab.restart(parcel.subdomains.end);
            }
        },
    );
    comm.gather(
        &plan.group_owners(),
        |g| {
            let b = plan.groups[g];
            match (blocks.get(&b), solution.blocks.get(&b)) {
                (Some(owned), Some(solution)) => pack_contacts(owned, solution),
                _ => Message::default(),
            }
        },
        |_, message| {
            let rows = unpack_contacts(message);
            for row in &rows {
                contacts[row.contact].add(row);
            }
            write(&mut |file| file.write_contacts(&rows));
        },
    );
    write(&mut ResultFile::finish_step);
    comm.agree(failed.map_err(Failure::from))
}

fn pack_contacts(owned: &OwnedBlock, solution: &BlockSolution) -> Message {
    let mut message = Message::default();
    for (j, (row, condition)) in owned.rows.iter().zip(&owned.conditions).enumerate() {
        let gap = if solution.closed[j] {
            0.0
        } else {
            condition.gap_left(owned.block.dim, &solution.u).max(0.0)
        };
        message.integers.extend([
            i64::from(row.contact),
            i64::from(row.place),
            row.tag_a,
            row.tag_b,
            i64::from(solution.closed[j]),
        ]);
        message.reals.extend(row.position);
        message.reals.extend(row.acts_at);
        message.reals.extend(row.normal);
        message
            .reals
            .extend([gap, solution.forces[j], solution.forces[j] / row.share]);
    }
    message
}

fn unpack_contacts(message: Message) -> Vec<ContactResult> {
    let integers = message.integers.chunks(5);
    let reals = message.reals.chunks(12);
    integers
        .zip(reals)
        .map(|(i, r)| ContactResult {
            contact: i[0] as usize,
            place: i[1] as usize,
            tag_a: i[2],
            tag_b: i[3],
            position: [r[0], r[1], r[2]],
            acts_at: [r[3], r[4], r[5]],
            normal: [r[6], r[7], r[8]],
            gap: r[9],
            force: r[10],
            pressure: r[11],
            closed: i[4] != 0,
        })
        .collect()
}
