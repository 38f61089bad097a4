//! The results on their way to the root and into the file.

mod parcel;

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::error::OutputError;

use self::parcel::{Parcel, pack, unpack};
use super::context::Context;
use super::load::StepProblem;
use super::recover::BlockSolution;
use super::solution::Solution;
use crate::comm::{Message, ROOT};
use crate::error::Failure;
use crate::fem::load::BlockLoads;
use crate::fem::owned::OwnedBlock;
use crate::output::result::{ContactRow, ContactState, SubdomainResults};
use crate::output::resultants::ContactResultant;
use crate::output::vtkhdf::ResultFile;

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
    context: &Context<'_>,
    step: &StepProblem<'_>,
    solution: &Solution,
    mut file: Option<&mut ResultFile>,
    contacts: &mut [ContactResultant],
) -> Result<(), Failure> {
    let &Context {
        comm, plan, blocks, ..
    } = context;
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
            let of_block = || {
                let (owned, loads) = (blocks.get(&b)?, step.loads.get(&b)?);
                Some(pack_contacts(owned, loads, solution.blocks.get(&b)?))
            };
            of_block().unwrap_or_default()
        },
        |_, message| {
            let rows = unpack_contacts(message);
            for (point, state) in &rows {
                contacts[point.contact as usize].add(point, state);
            }
            write(&mut |file| file.write_contacts(&rows));
        },
    );
    write(&mut ResultFile::finish_step);
    comm.agree(failed.map_err(Failure::from))
}

fn pack_contacts(owned: &OwnedBlock, loads: &BlockLoads, solution: &BlockSolution) -> Message {
    let mut message = Message::default();
    let gaps = loads.gaps_left(owned, &solution.u);
    for (j, point) in owned.points.iter().enumerate() {
        let closed = solution.closed[j];
        let gap = if closed { 0.0 } else { gaps[j].max(0.0) };
        message.integers.extend([
            i64::from(point.contact),
            i64::from(point.place),
            point.tag_a,
            point.tag_b,
            i64::from(closed),
        ]);
        message.reals.extend(point.position);
        message.reals.extend(point.force_point);
        message.reals.extend(point.normal());
        message.reals.extend([point.area, gap, solution.forces[j]]);
    }
    message
}

fn unpack_contacts(message: Message) -> Vec<ContactRow> {
    let integers = message.integers.chunks(5);
    let reals = message.reals.chunks(12);
    integers
        .zip(reals)
        .map(|(i, r)| {
            let vector = |k: usize| [r[k], r[k + 1], r[k + 2]];
            let point = ContactPoint {
                contact: i[0] as u32,
                place: i[1] as u32,
                tag_b: i[3],
                force_point: vector(3),
                area: r[9],
                ..ContactPoint::new(Vec::new(), vector(6), vector(0), i[2])
            };
            let state = ContactState {
                gap: r[10],
                force: r[11],
                closed: i[4] != 0,
            };
            (point, state)
        })
        .collect()
}
