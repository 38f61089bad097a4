//! Gathering what the analysis of rigid motions needs, and handing out what it found.

use std::collections::BTreeMap;

use contact_dd_partition::mesh::bounding_box::BoundingBox;
use contact_dd_partition::problem::{Catalog, ContactRow, Subdomain};
use nalgebra::DMatrix;

use super::analysis::{BodyState, FreeMotion, Pin, RigidMotions, RigidRow, Scene};
use super::descent::descent;
use super::energy::RigidDrive;
use super::inner::inner_motions;
use super::motion::BodyFrame;
use crate::comm::{Comm, Message, MessageReader};
use crate::error::Failure;
use crate::fem::owned::OwnedBlock;
use crate::plan::Plan;

/// Free rigid motions, and the frames that they are written in.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    /// The frame of every body.
    pub frames: Vec<BodyFrame>,
    /// Its free motions, their pins, and warnings; the latter on the root alone.
    pub motions: RigidMotions,
    /// The rigid motion by which every body comes to rest.
    pub descent: Vec<Vec<f64>>,
    /// For every cluster in contact of this rank, its conditions against the motions that supports
    /// leave to the bodies that lie wholly in it: what moves them costs the cluster no energy.
    pub inner_motions: BTreeMap<usize, RigidDrive>,
    /// Whether supports leave any rigid motion to any body.
    pub movable: bool,
    /// What all this follows from, on the root.
    pub scene: Option<Scene>,
}

impl Survey {
    /// The longest way of a body to rest (m).
    pub fn longest_descent(&self) -> f64 {
        let motions = self.descent.iter().flatten();
        motions.fold(0.0, |longest, z| longest.max(z.abs()))
    }
}

/// Finds the free rigid motions of the scene, and those by which its bodies come to rest.
/// Collective.
///
/// # Errors
/// The load drives a motion that nothing holds.
pub fn survey(
    comm: &Comm,
    blocks: &BTreeMap<usize, OwnedBlock>,
    catalog: &Catalog,
    plan: &Plan,
) -> Result<Survey, Failure> {
    let subdomains: BTreeMap<usize, &Subdomain> = blocks
        .values()
        .flat_map(|owned| owned.block.members.iter().map(|m| (m.index, m)))
        .collect();
    let owners = plan.subdomain_owners();
    // Below, what is asked of a subdomain is asked on its owner, which has read it.
    let frames = body_frames(comm, &subdomains, catalog, &owners);
    let (rows, conditions) = rigid_rows(comm, blocks, catalog, plan, &frames);
    let scene = Scene {
        dim: catalog.dim,
        bodies: body_states(comm, &subdomains, catalog, &owners, &frames),
        names: catalog.bodies.iter().map(|b| b.name.clone()).collect(),
        rows,
        conditions,
    };
    let found = if comm.is_root() {
        scene.analyse()
    } else {
        Ok(RigidMotions::default())
    };
    let mut motions = comm.agree(found)?;
    let modes = BodyFrame::count(catalog.dim);
    let mut message = if comm.is_root() {
        pack(&motions)
    } else {
        Message::default()
    };
    comm.broadcast(&mut message);
    if !comm.is_root() {
        motions = unpack(message, modes);
    }
    let mut message = Message::default();
    if comm.is_root() {
        message.integers.push(i64::from(scene.is_movable()));
        message.reals = descent(catalog.dim, &scene.bodies, &scene.rows).concat();
    }
    comm.broadcast(&mut message);
    Ok(Survey {
        frames,
        inner_motions: inner_motions(comm, &scene, &motions.pins, catalog, plan),
        motions,
        movable: message.integers.first() == Some(&1),
        descent: message.reals.chunks(modes).map(<[f64]>::to_vec).collect(),
        scene: comm.is_root().then_some(scene),
    })
}

fn body_frames(
    comm: &Comm,
    subdomains: &BTreeMap<usize, &Subdomain>,
    catalog: &Catalog,
    owners: &[usize],
) -> Vec<BodyFrame> {
    let mut bounds = vec![BoundingBox::EMPTY; catalog.bodies.len()];
    comm.gather(
        owners,
        |s| {
            let BoundingBox { low, high } = BoundingBox::around(&subdomains[&s].points);
            Message {
                integers: Vec::new(),
                reals: low.into_iter().chain(high).collect(),
            }
        },
        |s, message| {
            let mut reader = message.read();
            let mut corner = || std::array::from_fn(|_| reader.real());
            let (low, high) = (corner(), corner());
            bounds[catalog.subdomains[s].body].include(&BoundingBox { low, high });
        },
    );
    let mut message = Message::default();
    for BoundingBox { low, high } in bounds {
        let frame = BodyFrame::new(low, high);
        message.reals.extend(frame.center);
        message.reals.push(frame.size);
    }
    comm.broadcast(&mut message);
    message
        .reals
        .chunks(4)
        .map(|f| BodyFrame {
            center: [f[0], f[1], f[2]],
            size: f[3],
        })
        .collect()
}

fn body_states(
    comm: &Comm,
    subdomains: &BTreeMap<usize, &Subdomain>,
    catalog: &Catalog,
    owners: &[usize],
    frames: &[BodyFrame],
) -> Vec<BodyState> {
    let dim = catalog.dim;
    let modes = BodyFrame::count(dim);
    let mut states: Vec<BodyState> = frames
        .iter()
        .map(|&frame| BodyState {
            frame,
            supports: Vec::new(),
            load: vec![0.0; modes],
            load_scale: 0.0,
            candidates: Vec::new(),
        })
        .collect();
    comm.gather(
        owners,
        |s| pack_subdomain(subdomains[&s], dim, &frames[catalog.subdomains[s].body]),
        |s, message| {
            let state = &mut states[catalog.subdomains[s].body];
            let mut reader = message.read();
            let rows = reader.count();
            for _ in 0..rows {
                state.supports.push(reader.reals(modes + 1));
            }
            for (sum, part) in state.load.iter_mut().zip(reader.reals(modes)) {
                *sum += part;
            }
            state.load_scale += reader.real();
            for _ in 0..reader.count() {
                let node = reader.integer() as u32;
                let x = std::array::from_fn(|_| reader.real());
                state.candidates.push((s as u32, node, x));
            }
        },
    );
    states.iter_mut().for_each(BodyState::drop_round_off);
    states
}

fn pack_subdomain(subdomain: &Subdomain, dim: usize, frame: &BodyFrame) -> Message {
    let modes = BodyFrame::count(dim);
    let points = &subdomain.points;
    let rows: Vec<Vec<f64>> = subdomain
        .supports
        .iter()
        .map(|s| {
            let mut row = frame.action(dim, &points[s.node as usize], &s.direction);
            row.push(s.value);
            row
        })
        .collect();
    let rows = compressed(rows, modes + 1);
    let mut load = vec![0.0; modes];
    let mut load_scale = 0.0;
    for (node, force) in &subdomain.forces {
        let action = frame.action(dim, &points[*node as usize], force);
        for (sum, part) in load.iter_mut().zip(action) {
            *sum += part;
        }
        load_scale += force.iter().map(|f| f.abs()).sum::<f64>();
    }
    let candidates = extreme_nodes(points, dim);
    let mut message = Message::default();
    message.integers.push(rows.len() as i64);
    message.reals.extend(rows.iter().flatten());
    message.reals.extend(load);
    message.reals.push(load_scale);
    message.integers.push(candidates.len() as i64);
    for node in candidates {
        message.integers.push(node as i64);
        message.reals.extend(points[node]);
    }
    message
}

/// Rows with the same null space and least squares solution as `rows`, at most as many as their
/// `entries`.
fn compressed(rows: Vec<Vec<f64>>, entries: usize) -> Vec<Vec<f64>> {
    if rows.len() <= entries {
        return rows;
    }
    let r = DMatrix::from_fn(rows.len(), entries, |i, j| rows[i][j])
        .qr()
        .r();
    r.row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}

/// The first and last node along every axis.
fn extreme_nodes(points: &[[f64; 3]], dim: usize) -> Vec<usize> {
    let mut nodes: Vec<usize> = (0..dim)
        .flat_map(|axis| {
            let along = |a: &usize, b: &usize| points[*a][axis].total_cmp(&points[*b][axis]);
            let first = (0..points.len()).min_by(along);
            let last = (0..points.len()).max_by(along);
            first.into_iter().chain(last)
        })
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

fn rigid_rows(
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
                for row in &owned.rows {
                    pack_row(owned, row, catalog, frames, &mut message);
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
    row: &ContactRow,
    catalog: &Catalog,
    frames: &[BodyFrame],
    message: &mut Message,
) {
    let entries: Vec<_> = row
        .entries
        .iter()
        .filter_map(|entry| Some((entry, owned.block.member(entry.subdomain as usize)?)))
        .collect();
    message.integers.push(entries.len() as i64);
    for (entry, m) in entries {
        let member = &owned.block.members[m];
        let x = &member.points[entry.node as usize];
        message.integers.push(member.body as i64);
        message
            .reals
            .extend(frames[member.body].action(catalog.dim, x, &entry.coefficient));
    }
    message.reals.push(row.gap);
}

fn pack(motions: &RigidMotions) -> Message {
    let mut message = Message::default();
    message.integers.push(motions.pins.len() as i64);
    for pin in &motions.pins {
        message
            .integers
            .extend([pin.subdomain, pin.node, pin.component].map(i64::from));
    }
    pack_motions(&motions.free, &mut message);
    message
}

/// Appends motions to a message.
pub fn pack_motions(motions: &[FreeMotion], message: &mut Message) {
    message.integers.push(motions.len() as i64);
    for motion in motions {
        message.integers.push(motion.bodies.len() as i64);
        for (body, z) in &motion.bodies {
            message.integers.push(*body as i64);
            message.reals.extend(z);
        }
    }
}

/// Motions from a message, of bodies that have so many `modes` each.
pub fn unpack_motions(reader: &mut MessageReader, modes: usize) -> Vec<FreeMotion> {
    (0..reader.count())
        .map(|_| FreeMotion {
            bodies: (0..reader.count())
                .map(|_| (reader.count(), reader.reals(modes)))
                .collect(),
        })
        .collect()
}

fn unpack(message: Message, modes: usize) -> RigidMotions {
    let mut reader = message.read();
    let pins = (0..reader.count())
        .map(|_| Pin {
            subdomain: reader.integer() as u32,
            node: reader.integer() as u32,
            component: reader.integer() as u32,
        })
        .collect();
    let free = unpack_motions(&mut reader, modes);
    RigidMotions {
        free,
        pins,
        warnings: Vec::new(),
    }
}
