//! Closing motions: the rigid motions by which bodies come to rest.
//!
//! A body that falls 0.1 m until it touches another and deforms by 1 µm then has a displacement of
//! which elasticity is the last digits. So the closing motion is found from geometry and load alone
//! and taken out of the problem: what is left is small, and starts where contact holds.

use std::collections::BTreeMap;

use contact_dd_partition::element::geometry::{dot, length};
use nalgebra::{DMatrix, DVector};

use super::analysis::{BodyState, RigidRow};
use super::body_analysis::RigidBodyAnalysis;
use super::kinematics::Kinematics;
use super::motion::BodyFrame;
use super::nonnegative;
use crate::context::{Context, Loads};

/// Drive that is left, relative to all, that counts as none.
const BALANCED: f64 = 1e-9;
/// Distance, relative to the size of the scene, that counts as none.
const TOUCHING: f64 = 1e-12;
/// Cosine between a motion and a condition's row below which the motion doesn't close it.
const ALONG: f64 = 1e-12;
/// How much lighter than the heaviest body one may be that falls as fast.
const LIGHTEST: f64 = 1e-4;

/// Which rigid motion each of `bodies` makes until contact `rows` balance the load: first what its
/// supports prescribe, as far as no gap closes, then downhill along the load until one closes, and
/// again. Gaps that are closed from the beginning stay as they are.
pub(super) fn closing_motions(
    dim: usize,
    bodies: &[BodyState],
    rows: &[RigidRow],
) -> Vec<Vec<f64>> {
    let mut motions: Vec<Vec<f64>> = bodies.iter().map(|body| prescribed(dim, body)).collect();
    let round_off = ALONG
        * motions
            .iter()
            .flatten()
            .fold(0.0, |m: f64, z| m.max(z.abs()));
    let part = (rows.iter())
        .map(|row| (row.gap.max(0.0), jump(row, &motions)))
        .filter(|&(_, jump)| jump > round_off)
        .fold(1.0, |part: f64, (gap, jump)| part.min(gap / jump));
    motions.iter_mut().flatten().for_each(|z| *z *= part);
    let kinematics = Kinematics::new(dim, bodies);
    if kinematics.len == 0 || rows.is_empty() {
        return motions;
    }
    let speed = speeds(&kinematics, bodies);
    let b = kinematics.rows(rows) * DMatrix::from_diagonal(&speed);
    let load = kinematics.load(bodies).component_mul(&speed);
    let left = rows
        .iter()
        .map(|row| (row.gap - jump(row, &motions)).max(0.0));
    let left = left.collect();
    let size = bodies.iter().fold(0.0, |m: f64, b| m.max(b.frame.size));
    let y = fall(&b, &load, left, TOUCHING * size).component_mul(&speed);
    for (body, motion) in motions.iter_mut().enumerate() {
        for (z, fallen) in motion
            .iter_mut()
            .zip(kinematics.of_body(body, y.as_slice()))
        {
            *z += fallen;
        }
    }
    motions
}

/// The rigid motion that fits what the supports of a body prescribe best.
fn prescribed(dim: usize, body: &BodyState) -> Vec<f64> {
    let modes = BodyFrame::count(dim);
    let rows = &body.supports;
    if rows.iter().all(|row| row[modes] == 0.0) {
        return vec![0.0; modes];
    }
    let a = DMatrix::from_fn(rows.len(), modes, |i, j| rows[i][j]);
    let values = DVector::from_fn(rows.len(), |i, _| rows[i][modes]);
    let svd = a.svd(true, true);
    let tolerance = 1e-9 * svd.singular_values.amax();
    svd.solve(&values, tolerance)
        .map_or_else(|_| vec![0.0; modes], |z| z.iter().copied().collect())
}

/// How far motions close a gap.
fn jump(row: &RigidRow, motions: &[Vec<f64>]) -> f64 {
    let of_body = |(body, action): &(usize, Vec<f64>)| -> f64 {
        let terms = action.iter().zip(&motions[*body]);
        terms.map(|(a, z)| a * z).sum()
    };
    row.bodies.iter().map(of_body).sum()
}

/// One over the load of each unknown's body, so that light bodies fall as fast as heavy ones.
fn speeds(kinematics: &Kinematics, bodies: &[BodyState]) -> DVector<f64> {
    let heaviest = bodies.iter().fold(0.0, |m: f64, b| m.max(b.load_scale));
    let mut speed = DVector::from_element(kinematics.len, 1.0);
    for (b, body) in bodies.iter().enumerate().filter(|_| heaviest > 0.0) {
        let weight = if body.load_scale > 0.0 {
            body.load_scale.max(LIGHTEST * heaviest)
        } else {
            heaviest
        };
        for i in kinematics.unknowns(b) {
            speed[i] = 1.0 / weight;
        }
    }
    // The fastest moves as fast as the load says.
    let fastest = speed.amax();
    speed / fastest
}

/// How far to go along `load` within B y ≤ `left`: along what closed rows leave of the load, until
/// the next row closes. That drive becomes smaller with every row, so that this ends.
fn fall(b: &DMatrix<f64>, load: &DVector<f64>, mut left: Vec<f64>, touching: f64) -> DVector<f64> {
    let mut y = DVector::zeros(load.len());
    let norms: Vec<f64> = b.row_iter().map(|row| row.norm()).collect();
    for _ in 0..b.nrows() + load.len() {
        let closed: Vec<usize> = (0..left.len()).filter(|&j| left[j] <= touching).collect();
        let drive = nonnegative::residual(&b.select_rows(&closed).transpose(), load);
        if drive.norm() <= BALANCED * load.norm() {
            break;
        }
        let closing = b * &drive;
        let steepest = ALONG * drive.norm();
        let step = (0..left.len())
            .filter(|&j| left[j] > touching && closing[j] > steepest * norms[j])
            .map(|j| left[j] / closing[j])
            .fold(f64::INFINITY, f64::min);
        if step.is_infinite() {
            break;
        }
        y.axpy(step, &drive, 1.0);
        for (left, closing) in left.iter_mut().zip(closing.iter()) {
            *left = (*left - step * closing).max(0.0);
        }
    }
    y
}

/// What is left of a length after a motion, relative to both, that is round-off: a body is stiff
/// enough to make forces of it.
const ROUND_OFF: f64 = 1e-14;

/// What acts on the blocks once the bodies' closing motions is taken out of gaps and supports.
pub fn without_closing_motions(
    context: &Context<'_>,
    mut loads: Loads,
    analysis: &RigidBodyAnalysis,
) -> Loads {
    if analysis.longest_closing_motion() == 0.0 {
        return loads;
    }
    let dim = context.catalog.dim;
    for (b, loads) in &mut loads.blocks {
        let block = &context.blocks[b];
        for support in &mut loads.supports {
            let at = &block.points()[support.node as usize];
            let moved = moved(analysis, dim, block.subdomain.body, at);
            reduce(&mut support.value, &support.direction, &moved);
        }
    }
    for (g, loads) in &mut loads.groups {
        let group = &context.groups[g];
        let nodes = group.nodes.iter();
        let moved: Vec<[f64; 3]> = nodes
            .map(|node| moved(analysis, dim, node.body, &node.at))
            .collect();
        for (point, gap) in group.points.iter().zip(&mut loads.gaps) {
            for (node, row) in point.row() {
                reduce(gap, &row, &moved[node as usize]);
            }
        }
        for ((node, held), moved) in group.nodes.iter().zip(&mut loads.held).zip(&moved) {
            for ((direction, _), value) in node.supports.iter().zip(held) {
                reduce(value, direction, moved);
            }
        }
    }
    loads
}

/// Takes the part of a motion along `row` out of a length.
fn reduce(whole: &mut f64, row: &[f64; 3], moved: &[f64; 3]) {
    let given = whole.abs() + length(*row) * length(*moved);
    *whole -= dot(*row, *moved);
    if whole.abs() <= ROUND_OFF * given {
        *whole = 0.0;
    }
}

/// The displacement of every block, node by node: that of its solution and the bodies' closing motions.
pub fn with_closing_motions<'a>(
    context: &Context<'_>,
    solutions: impl Iterator<Item = (usize, &'a [f64])>,
    analysis: &RigidBodyAnalysis,
) -> BTreeMap<usize, Vec<f64>> {
    let (dim, stays) = (
        context.catalog.dim,
        analysis.longest_closing_motion() == 0.0,
    );
    let of_block = |(b, u): (usize, &[f64])| {
        let block = context.blocks.get(&b)?;
        let mut u = u.to_vec();
        if stays {
            return Some((b, u));
        }
        for (x, u) in block.points().iter().zip(u.chunks_exact_mut(dim)) {
            let moved = moved(analysis, dim, block.subdomain.body, x);
            u.iter_mut().zip(moved).for_each(|(u, m)| *u += m);
        }
        Some((b, u))
    };
    solutions.filter_map(of_block).collect()
}

fn moved(analysis: &RigidBodyAnalysis, dim: usize, body: usize, x: &[f64; 3]) -> [f64; 3] {
    analysis.frames[body].displacement(dim, x, &analysis.closing_motions[body])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(load: [f64; 3], supports: Vec<Vec<f64>>) -> BodyState {
        BodyState {
            frame: BodyFrame::new([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]),
            supports,
            load: load.to_vec(),
            load_scale: load.iter().map(|f| f.abs()).sum(),
            candidates: Vec::new(),
        }
    }

    /// A floor below the lower corners of a square, with these gaps.
    fn floor(body: &BodyState, gaps: [f64; 2]) -> Vec<RigidRow> {
        let row = |(x, gap): (f64, f64)| {
            let action = body.frame.action(2, &[x, -1.0, 0.0], &[0.0, -1.0, 0.0]);
            RigidRow {
                bodies: vec![(0, action)],
                gap,
            }
        };
        [(-1.0, gaps[0]), (1.0, gaps[1])].map(row).to_vec()
    }

    #[track_caller]
    fn close(found: &[f64], expected: &[f64]) {
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).abs() < 1e-14, "{found:?}, expected {expected:?}");
        }
    }

    #[test]
    fn a_square_falls_onto_an_uneven_floor_and_leans_on_it() {
        let body = square([0.0, -2.0, 0.1], vec![]);
        let rows = floor(&body, [0.1, 0.3]);
        let z = closing_motions(2, std::slice::from_ref(&body), &rows).remove(0);
        let motions = [z.clone()];
        close(&[0, 1].map(|j| jump(&rows[j], &motions)), &[0.1, 0.3]);
        // It sinks by the mean, and turns by the difference over its width.
        close(&z[1..], &[-0.2, -0.1 * body.frame.size]);
    }

    #[test]
    fn what_rests_stays() {
        let body = square([0.0, -2.0, 0.1], vec![]);
        let rows = floor(&body, [0.0, 0.0]);
        close(&closing_motions(2, &[body], &rows)[0], &[0.0; 3]);
    }

    #[test]
    fn supports_push_no_body_into_another() {
        let frame = BodyFrame::new([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]);
        let mut support = frame.action(2, &[0.0; 3], &[0.0, 1.0, 0.0]);
        support.push(-0.4);
        let body = square([0.0; 3], vec![support]);
        let rows = floor(&body, [0.1, 0.3]);
        close(&closing_motions(2, &[body], &rows)[0], &[0.0, -0.1, 0.0]);
    }

    #[test]
    fn a_body_follows_its_supports() {
        let frame = BodyFrame::new([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]);
        let support = |x: f64| {
            let mut row = frame.action(2, &[x, 0.0, 0.0], &[0.0, 1.0, 0.0]);
            row.push(0.3 + 0.1 * x);
            row
        };
        let body = square([0.0, 5.0, 0.0], vec![support(-1.0), support(1.0)]);
        close(
            &closing_motions(2, &[body], &[])[0],
            &[0.0, 0.3, 0.1 * frame.size],
        );
    }

    #[test]
    fn a_body_without_load_is_pushed_by_the_one_that_falls_on_it() {
        let bodies = [square([0.0, -1.0, 0.0], vec![]), square([0.0; 3], vec![])];
        let row = |entries: &[(usize, f64)], x: f64, gap: f64| RigidRow {
            bodies: (entries.iter())
                .map(|&(b, n)| (b, bodies[b].frame.action(2, &[x, 0.0, 0.0], &[0.0, n, 0.0])))
                .collect(),
            gap,
        };
        let rows: Vec<RigidRow> = [-1.0, 1.0]
            .into_iter()
            .flat_map(|x| {
                [
                    row(&[(0, -1.0), (1, 1.0)], x, 0.5),
                    row(&[(1, -1.0)], x, 0.25),
                ]
            })
            .collect();
        let motions = closing_motions(2, &bodies, &rows);
        close(&motions[0], &[0.0, -0.75, 0.0]);
        close(&motions[1], &[0.0, -0.25, 0.0]);
    }
}
