//! Results: from the ranks to the root and into the file.

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::geometry::dot;
use contact_dd_partition::error::OutputError;
use contact_dd_partition::problem::stage::Stage;
use contact_dd_partition::problem::{Catalog, SubdomainNode};

use super::parcel::Parcel;
use crate::comm::ROOT;
use crate::context::Context;
use crate::error::Failure;
use crate::fem::contact_group::ContactGroup;
use crate::fem::contact_state::{ContactRow, ContactState};
use crate::fem::resultants::ContactResultant;
use crate::output::result::SubdomainResults;
use crate::output::vtkhdf::ResultFile;
use crate::output::vtkhdf::beside::FileBeside;
use crate::recover::solution::Solution;
use crate::recover::{GroupSolution, Slips};

/// Writes all subdomains: every rank its own if all can write in parallel to `beside`; otherwise they are sent to the
/// root, which writes a slab as soon as it is complete. Rows of contact points are sent to the root. Collective; `file`
/// is the root's.
///
/// The root also adds the constraints to the resultants in `contacts`; rows of `absent` contact points are written
/// after the others.
///
/// The slabs don't depend on the owners: the numbers written are the same for any number of ranks.
///
/// # Errors
/// The file can't be written.
pub fn write_solution(
    context: &Context<'_>,
    (solution, slips): (&Solution, &Slips),
    (mut file, beside): (Option<&mut ResultFile>, Option<&mut FileBeside>),
    contacts: &mut [ContactResultant],
    absent: &[ContactRow],
) -> Result<(), Failure> {
    let &Context { comm, plan, .. } = context;
    let slabs = file.as_ref().map_or(Vec::new(), |file| file.slabs());
    let mut failed = Ok(());
    let mut write = |write: &mut dyn FnMut(&mut ResultFile) -> Result<(), OutputError>| {
        if let (Some(file), Ok(())) = (file.as_deref_mut(), &failed) {
            failed = write(file);
        }
    };
    let parcels = Parcel::cut(comm, &slabs, plan);
    match beside {
        None => stream(context, solution, &parcels, &mut write),
        Some(beside) => {
            let written = write_own(beside, &parcels, context, solution);
            let digests = comm.agree(written.map_err(Failure::from))?;
            let digests = comm.collect(&digests);
            write(&mut |file| {
                file.take_as_written(&digests);
                Ok(())
            });
        }
    }
    comm.gather(
        &plan.group_owners(),
        |g| {
            contact_rows(
                &context.groups[&g],
                &solution.discrete.groups[&g],
                slips.of(g),
            )
        },
        |_, rows| {
            for (point, state) in &rows {
                contacts[point.contact as usize].add(point, state);
            }
            write(&mut |file| file.write_contacts(&rows));
        },
    );
    write(&mut |file| file.write_contacts(absent));
    write(&mut ResultFile::finish_step);
    comm.agree(failed.map_err(Failure::from))
}

/// Sends the parcels of all ranks to the root, which writes a slab as soon as it is complete. Collective.
fn stream(
    context: &Context<'_>,
    solution: &Solution,
    parcels: &[Parcel],
    write: &mut impl FnMut(&mut dyn FnMut(&mut ResultFile) -> Result<(), OutputError>),
) {
    let comm = context.comm;
    let (mut sent, mut slab) = (SubdomainResults::default(), SubdomainResults::default());
    for parcel in parcels {
        match (parcel.owner, comm.is_root()) {
            // The root's own rows need no message.
            (ROOT, true) => parcel.append_to(&mut slab, context, solution),
            (owner, true) => slab.append(comm.receive(owner)),
            (owner, false) if owner == comm.rank() => {
                sent.restart(parcel.subdomains.start);
                parcel.append_to(&mut sent, context, solution);
                comm.send(ROOT, &sent);
            }
            _ => {}
        }
        if parcel.ends_slab && comm.is_root() {
            write(&mut |file| file.write_subdomains(&slab));
            slab.restart(parcel.subdomains.end);
        }
    }
}

/// Writes the parcels of this rank, in parallel to other ranks; returns the digests of the data written.
///
/// # Errors
/// The file can't be written.
fn write_own(
    beside: &mut FileBeside,
    parcels: &[Parcel],
    context: &Context<'_>,
    solution: &Solution,
) -> Result<Vec<u64>, OutputError> {
    let own = parcels
        .iter()
        .filter(|parcel| parcel.owner == context.comm.rank());
    let mut slab = SubdomainResults::default();
    for parcel in own {
        slab.restart(parcel.subdomains.start);
        parcel.append_to(&mut slab, context, solution);
        beside.write(&slab)?;
    }
    beside.finish_step(context.comm.hosts())
}

/// The rows of contact points of the problem that are absent in a `stage`: without forces and gaps.
pub fn absent_rows(whole: &Catalog, stage: &Stage<'_>) -> Vec<ContactRow> {
    let all = whole.points.iter().enumerate();
    let absent = all.filter(|(j, _)| stage.points.binary_search(j).is_err());
    let row = |(_, point): (usize, &ContactPoint<SubdomainNode>)| {
        let state = ContactState {
            gap: f64::NAN,
            ..ContactState::default()
        };
        (point.rename(|_| None), state)
    };
    absent.map(row).collect()
}

/// The points of a contact group and their solution, including slip and frictional work of its tangential constraints.
fn contact_rows(
    group: &ContactGroup,
    solution: &GroupSolution,
    (slips, work): (&[f64], &[f64]),
) -> Vec<ContactRow> {
    let points = group.points.iter().enumerate();
    let row = |(j, point): (usize, &ContactPoint<u32>)| {
        let closed = solution.closed[j];
        let state = ContactState {
            gap: if closed {
                0.0
            } else {
                solution.gaps[j].max(0.0)
            },
            force: solution.forces[j],
            closed,
            ..ContactState::default()
        };
        (point.clone(), state)
    };
    let mut rows: Vec<ContactRow> = points.map(row).collect();
    let tangential = group.conditions().enumerate().skip(rows.len());
    for (((number, condition), slip), work) in tangential.zip(slips).zip(work) {
        let state = &mut rows[condition.point].1;
        let force = solution.forces[number];
        let slips = state.closed && !solution.closed[number];
        let came_with = dot(group.points[condition.point].since, condition.direction);
        for (k, t) in condition.direction.iter().enumerate() {
            state.tangential_force[k] -= force * t;
            state.slip[k] += (slip - came_with) * t;
        }
        state.slipping |= slips;
        state.dissipated += work;
    }
    rows
}
