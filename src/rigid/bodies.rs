//! What the analysis of rigid motions needs of bodies, from the ranks that have their subdomains.

use std::collections::BTreeMap;

use contact_dd_partition::mesh::bounding_box::BoundingBox;
use contact_dd_partition::problem::{Catalog, Subdomain};
use nalgebra::DMatrix;

use super::analysis::BodyState;
use super::motion::BodyFrame;
use crate::comm::{Comm, Message};

/// The frame of every body. Collective; what is asked of a subdomain is asked on its owner, which has
/// read it.
pub(super) fn body_frames(
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

/// Every body as the analysis sees it in a load step, on the root. Collective.
pub(super) fn body_states(
    comm: &Comm,
    subdomains: &BTreeMap<usize, &Subdomain>,
    catalog: &Catalog,
    owners: &[usize],
    frames: &[BodyFrame],
    step: usize,
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
        |s| {
            let frame = &frames[catalog.subdomains[s].body];
            pack_subdomain(subdomains[&s], dim, frame, step)
        },
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

fn pack_subdomain(subdomain: &Subdomain, dim: usize, frame: &BodyFrame, step: usize) -> Message {
    let modes = BodyFrame::count(dim);
    let points = &subdomain.points;
    let rows: Vec<Vec<f64>> = subdomain
        .supports_in(step)
        .map(|s| {
            let mut row = frame.action(dim, &points[s.node as usize], &s.direction);
            row.push(s.value);
            row
        })
        .collect();
    let rows = compressed(rows, modes + 1);
    let mut load = vec![0.0; modes];
    let mut load_scale = 0.0;
    for (node, force) in subdomain.forces_in(step) {
        let action = frame.action(dim, &points[node as usize], &force);
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
