//! Bodies for the rigid-body analysis, summed over the ranks that own their subdomains.

use contact_dd_partition::element::geometry::{cross, difference, length};
use contact_dd_partition::mesh::bounding_box::BoundingBox;
use contact_dd_partition::model::{PlaneState, Support};
use contact_dd_partition::problem::Catalog;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::scene::BodyState;
use crate::context::{Context, Loads};
use crate::fem::block::Block;
use crate::fem::body_frame::BodyFrame;
use crate::fem::load::BlockLoads;
use crate::fem::springs::against_motions;
use crate::vector::axpy;

/// Stiffness of springs in a motion, relative to the largest, up to which it is round-off.
const NO_SPRING: f64 = 1e-12;

/// The frame of every body, from the bounding boxes of its subdomains on their owners. Collective.
pub(super) fn body_frames(context: &Context<'_>) -> Vec<BodyFrame> {
    let Context { comm, catalog, .. } = *context;
    let mut bounds = vec![BoundingBox::EMPTY; catalog.bodies.len()];
    comm.gather(
        &context.plan.owners(),
        |s| {
            let BoundingBox { low, high } = BoundingBox::around(context.blocks[&s].points());
            (low, high)
        },
        |s, (low, high)| {
            bounds[catalog.body_of(s)].include(&BoundingBox { low, high });
        },
    );
    let frame = |BoundingBox { low, high }| BodyFrame::new(low, high);
    let mut frames = bounds.into_iter().map(frame).collect();
    comm.broadcast(&mut frames);
    frames
}

/// The state of every body under `loads` for the rigid-body analysis, on the root. Collective.
pub(super) fn body_states(
    context: &Context<'_>,
    frames: &[BodyFrame],
    loads: &Loads,
) -> Vec<BodyState> {
    let Context { comm, catalog, .. } = *context;
    let dim = catalog.dim;
    let modes = BodyFrame::count(dim);
    let mut states: Vec<BodyState> = frames
        .iter()
        .map(|&frame| BodyState {
            frame,
            units: catalog.units,
            supports: held_by_symmetry(catalog),
            has_springs: false,
            load: vec![0.0; modes],
            load_scale: 0.0,
            candidates: Vec::new(),
        })
        .collect();
    let mut of_springs = vec![vec![0.0; modes * modes]; states.len()];
    comm.gather(
        &context.plan.owners(),
        |s| {
            let frame = &frames[catalog.body_of(s)];
            let block = &context.blocks[&s];
            let mut part = of_subdomain(block, &loads.blocks[&s], frame);
            part.springs = against_motions(block, frame);
            // Symmetry excludes these motions already, so that supports don't act along them.
            for held in held_by_symmetry(catalog) {
                for row in &mut part.supports {
                    let free = row.iter_mut().zip(&held);
                    free.for_each(|(entry, held)| *entry *= 1.0 - held);
                }
            }
            part
        },
        |s, part| {
            let state = &mut states[catalog.body_of(s)];
            axpy(1.0, &part.springs, &mut of_springs[catalog.body_of(s)]);
            state.supports.extend(part.supports);
            axpy(1.0, &part.load, &mut state.load);
            state.load_scale += part.load_scale;
            let candidates = part.candidates.into_iter();
            (state.candidates).extend(candidates.map(|(node, x)| (s.index() as u32, node, x)));
        },
    );
    for (state, of_springs) in states.iter_mut().zip(&of_springs) {
        let rows = held_by_springs(catalog, DMatrix::from_row_slice(modes, modes, of_springs));
        state.has_springs = !rows.is_empty();
        state.supports.extend(rows);
    }
    states.iter_mut().for_each(BodyState::drop_round_off);
    states
}

/// Rows that restrain the rigid motions excluded by symmetry: around an axis all but the translation along it.
fn held_by_symmetry(catalog: &Catalog) -> Vec<Vec<f64>> {
    match catalog.plane {
        Some(PlaneState::Axisymmetric) => {
            vec![vec![1.0, 0.0, 0.0, 0.0], vec![0.0, 0.0, 1.0, 0.0]]
        }
        _ => Vec::new(),
    }
}

/// Rows of the motions that springs of this `stiffness` restrain, each with a prescribed displacement of 0.
fn held_by_springs(catalog: &Catalog, stiffness: DMatrix<f64>) -> Vec<Vec<f64>> {
    let eigen = stiffness.symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let columns = eigen
        .eigenvectors
        .column_iter()
        .zip(eigen.eigenvalues.iter());
    let held = columns.filter(|(_, value)| **value > NO_SPRING * largest);
    let mut rows: Vec<Vec<f64>> = held
        .map(|(column, _)| column.iter().copied().chain([0.0]).collect())
        .collect();
    for held in held_by_symmetry(catalog) {
        for row in &mut rows {
            let free = row.iter_mut().zip(&held);
            free.for_each(|(entry, held)| *entry *= 1.0 - held);
        }
    }
    rows
}

/// The contribution of a subdomain to its body.
#[derive(Serialize, Deserialize)]
struct BodyPart {
    supports: Vec<Vec<f64>>,
    load: Vec<f64>,
    load_scale: f64,
    candidates: Vec<(u32, [f64; 3])>,
    springs: Vec<f64>,
}

fn of_subdomain(block: &Block, loads: &BlockLoads, frame: &BodyFrame) -> BodyPart {
    let (points, dim) = (block.body_points(), block.dim);
    let modes = BodyFrame::count(dim);
    let of_body = |support: &&Support| (support.node as usize) < points.len();
    let rows: Vec<Vec<f64>> = (loads.supports.iter().filter(of_body))
        .map(|s| {
            let mut row = frame.action(dim, &points[s.node as usize], &s.direction);
            row.push(s.value);
            row
        })
        .collect();
    let mut load = vec![0.0; modes];
    let mut load_scale = 0.0;
    for (node, force) in &loads.forces {
        let action = frame.action(dim, &points[*node as usize], force);
        axpy(1.0, &action, &mut load);
        load_scale += force.iter().map(|f| f.abs()).sum::<f64>();
    }
    // Nodes without cells would not fix the body.
    let candidates = extreme_nodes(&points[..block.subdomain.cell_nodes()], dim).into_iter();
    BodyPart {
        supports: compressed(rows, modes + 1),
        load,
        load_scale,
        candidates: (candidates.map(|node| (node as u32, points[node]))).collect(),
        springs: Vec::new(),
    }
}

/// Equivalent rows, at most `entries` of them, with the null space and the least-squares solution of `rows`.
pub(super) fn compressed(rows: Vec<Vec<f64>>, entries: usize) -> Vec<Vec<f64>> {
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

/// The first and last node along every axis; in space also three nodes that aren't collinear, if there are any.
fn extreme_nodes(points: &[[f64; 3]], dim: usize) -> Vec<usize> {
    let mut nodes: Vec<usize> = (0..dim)
        .flat_map(|axis| {
            let along = |a: &usize, b: &usize| points[*a][axis].total_cmp(&points[*b][axis]);
            let first = (0..points.len()).min_by(along);
            let last = (0..points.len()).max_by(along);
            first.into_iter().chain(last)
        })
        .collect();
    if dim == 3 {
        let farthest = |far: &dyn Fn([f64; 3]) -> f64| {
            (0..points.len()).max_by(|&a, &b| far(points[a]).total_cmp(&far(points[b])))
        };
        let first = points.first().copied().unwrap_or_default();
        let start = farthest(&|x| length(difference(x, first)));
        let from = start.map_or(first, |node| points[node]);
        let end = farthest(&|x| length(difference(x, from)));
        let along = end.map_or(from, |node| difference(points[node], from));
        let aside = farthest(&|x| length(cross(difference(x, from), along)));
        nodes.extend([start, end, aside].into_iter().flatten());
    }
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}
