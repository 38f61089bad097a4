//! Closing motions: the rigid-body motions by which bodies come into contact.
//!
//! For a body that falls 0.1 m onto another and deforms by 1 µm, the elastic part is in the last digits of the
//! displacement. The closing motion is therefore computed from geometry and load alone and subtracted from the problem.
//! The remaining displacement is small, and the solver starts with contacts that hold the bodies.

use nalgebra::{DMatrix, DVector};

use super::forces::Forces;
use super::kinematics::Kinematics;
use super::many_bodies::{MANY, ManyBodies, SparseRow};
use super::null_space::{RANK_TOLERANCE, null_space};
use super::scene::{BodyState, Friction, RigidRow};
use crate::comm::is_asked_to_stop;
use crate::fem::body_frame::BodyFrame;

/// Unbalanced load, relative to all loads, that counts as zero.
const BALANCED: f64 = 1e-9;
/// Unbalanced load, relative to all loads, that counts as zero where regularizing springs of the sparse solver for many
/// bodies take a part of it: they move bodies by some thousand times their gaps.
const SPRINGS: f64 = 1e-6;
/// Number of motions from which on dense matrices would take gigabytes. If the sparse method doesn't find the rest
/// position of so many, they stay where they are, and the contact solver moves them.
const TOO_MANY: usize = 3000;
/// Distance, relative to the size of the scene, that counts as zero.
const TOUCHING: f64 = 1e-12;
/// Cosine between a motion and a constraint's row below which the motion doesn't close the contact.
const ALONG: f64 = 1e-12;
/// Weight, relative to the heaviest body, down to which bodies fall at the same speed.
const LEAST_WEIGHT: f64 = 1e-4;

/// The rigid motion of each of `bodies` until contact `rows` balance the load: first the displacement that its supports
/// prescribe, as far as no gap closes, then descent along the load until a gap closes, and so on. Initially closed gaps
/// stay closed.
///
/// Friction makes these motions path-dependent. They then continue from the motions `before`, zero in the first load
/// step; what friction holds stays in place, and bodies that come to rest on it slip as little as possible.
pub(super) fn closing_motions(
    dim: usize,
    bodies: &[BodyState],
    rows: &[RigidRow],
    before: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let has_friction = rows.iter().any(|row| row.friction.is_some());
    let start: Vec<Vec<f64>> = match before {
        before if has_friction && !before.is_empty() => before.to_vec(),
        _ => vec![vec![0.0; BodyFrame::count(dim)]; bodies.len()],
    };
    let mut motions = along_supports(dim, bodies, rows, &start);
    let kinematics = Kinematics::new(dim, bodies);
    if kinematics.len == 0 || rows.is_empty() {
        return motions;
    }
    let speed = speeds(&kinematics, bodies);
    let load = kinematics.load(bodies).component_mul(&speed);
    let size = bodies.iter().fold(0.0, |m: f64, b| m.max(b.frame.size));
    let touching = TOUCHING * size;
    let left = gaps_left(rows, &motions);
    let is_open = left.iter().any(|&left| left > touching && left.is_finite());
    let resting = match is_open {
        // All gaps are closed already.
        false => Some(DVector::zeros(load.len())),
        true if kinematics.len >= MANY => {
            let found = rest(&kinematics, rows, &speed, &load, &left, touching);
            let is_left = kinematics.len > TOO_MANY || is_asked_to_stop();
            found.or_else(|| is_left.then(|| DVector::zeros(load.len())))
        }
        true => None,
    };
    let fallen = resting.unwrap_or_else(|| {
        let fast = kinematics.rows(rows) * DMatrix::from_diagonal(&speed);
        fall(rows, &fast, &load, left, touching)
    });
    move_along(&mut motions, &kinematics, &fallen.component_mul(&speed));
    if has_friction {
        let slip = rows
            .iter()
            .map(|row| jump(row, &motions) - jump(row, &start));
        let back = without_slip(
            rows,
            &kinematics,
            &slip.collect::<Vec<f64>>(),
            &gaps_left(rows, &motions),
            touching,
        );
        move_along(&mut motions, &kinematics, &back);
    }
    motions
}

/// The motions from `start` along the displacements that supports prescribe, as far as no gap closes.
fn along_supports(
    dim: usize,
    bodies: &[BodyState],
    rows: &[RigidRow],
    start: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let of_supports: Vec<Vec<f64>> = (bodies.iter().zip(start))
        .map(|(body, start)| prescribed(dim, body, start))
        .collect();
    let round_off = ALONG
        * of_supports
            .iter()
            .flatten()
            .fold(0.0, |m: f64, z| m.max(z.abs()));
    let part = (rows.iter().zip(gaps_left(rows, start)))
        .map(|(row, gap)| (gap, jump(row, &of_supports)))
        .filter(|&(_, jump)| jump > round_off)
        .fold(1.0, |part: f64, (gap, jump)| part.min(gap / jump));
    let mut motions = start.to_vec();
    for (z, change) in motions
        .iter_mut()
        .flatten()
        .zip(of_supports.iter().flatten())
    {
        *z += change * part;
    }
    motions
}

/// The gaps left after motions; infinite for tangential constraints, which have none.
fn gaps_left(rows: &[RigidRow], motions: &[Vec<f64>]) -> Vec<f64> {
    let left = |row: &RigidRow| match row.friction {
        None => (row.gap - jump(row, motions)).max(0.0),
        Some(_) => f64::INFINITY,
    };
    rows.iter().map(left).collect()
}

fn move_along(motions: &mut [Vec<f64>], kinematics: &Kinematics, y: &DVector<f64>) {
    for (body, motion) in motions.iter_mut().enumerate() {
        for (z, moved) in motion
            .iter_mut()
            .zip(kinematics.of_body(body, y.as_slice()))
        {
            *z += moved;
        }
    }
}

/// Difference from `start` to the rigid motion that fits the prescribed displacements of a body's supports best.
fn prescribed(dim: usize, body: &BodyState, start: &[f64]) -> Vec<f64> {
    let modes = BodyFrame::count(dim);
    let rows = &body.supports;
    let missing = |row: &Vec<f64>| {
        let there: f64 = row.iter().zip(start).map(|(a, z)| a * z).sum();
        row[modes] - there
    };
    let values = DVector::from_iterator(rows.len(), rows.iter().map(missing));
    if body.has_springs || values.iter().all(|&value| value == 0.0) {
        return vec![0.0; modes];
    }
    let a = DMatrix::from_fn(rows.len(), modes, |i, j| rows[i][j]);
    let svd = a.svd(true, true);
    let tolerance = 1e-9 * svd.singular_values.amax();
    svd.solve(&values, tolerance)
        .map_or_else(|_| vec![0.0; modes], |z| z.iter().copied().collect())
}

/// Amount by which motions close a gap.
fn jump(row: &RigidRow, motions: &[Vec<f64>]) -> f64 {
    let of_body = |(body, action): &(usize, Vec<f64>)| -> f64 {
        let terms = action.iter().zip(&motions[*body]);
        terms.map(|(a, z)| a * z).sum()
    };
    row.bodies.iter().map(of_body).sum()
}

/// Reciprocal of the load of each unknown's body, so that light bodies fall as fast as heavy ones.
fn speeds(kinematics: &Kinematics, bodies: &[BodyState]) -> DVector<f64> {
    let heaviest = bodies.iter().fold(0.0, |m: f64, b| m.max(b.load_scale));
    let mut speed = DVector::from_element(kinematics.len, 1.0);
    for (b, body) in bodies.iter().enumerate().filter(|_| heaviest > 0.0) {
        let weight = if body.load_scale > 0.0 {
            body.load_scale.max(LEAST_WEIGHT * heaviest)
        } else {
            heaviest
        };
        for i in kinematics.unknowns(b) {
            speed[i] = 1.0 / weight;
        }
    }
    // Scaled so that the fastest body moves as fast as its load says.
    let fastest = speed.amax();
    speed / fastest
}

/// Rest position of many bodies; `None` if it isn't found. They stay in place if the closed contacts balance the load,
/// which is the only case handled with friction.
fn rest(
    kinematics: &Kinematics,
    rows: &[RigidRow],
    speed: &DVector<f64>,
    load: &DVector<f64>,
    left: &[f64],
    touching: f64,
) -> Option<DVector<f64>> {
    let fast = |row: &RigidRow| {
        let mut sparse = kinematics.sparse_row(row);
        sparse.iter_mut().for_each(|(i, b)| *b *= speed[*i]);
        sparse
    };
    let sparse: Vec<SparseRow> = rows.iter().map(fast).collect();
    let with = |rows: Vec<SparseRow>, gaps: &[f64], missing: f64| {
        let rest = ManyBodies::new(&kinematics.centers, rows)?.rest(load.as_slice(), gaps);
        rest.filter(|rest| rest.unbalanced() <= missing * load.norm())
    };
    let is_normal = |j: &usize| rows[*j].friction.is_none();
    let closed = (0..rows.len()).filter(|&j| is_normal(&j) && left[j] <= touching);
    let closed: Vec<SparseRow> = closed.map(|j| sparse[j].clone()).collect();
    let none = vec![0.0; closed.len()];
    if with(closed, &none, BALANCED).is_some() {
        return Some(DVector::zeros(load.len()));
    }
    let forces = Forces::new(rows, |j| left[j] <= touching);
    if forces.has_friction {
        let cones = forces.cones(&sparse, false);
        let none = vec![0.0; cones.len()];
        return with(cones, &none, BALANCED).map(|_| DVector::zeros(load.len()));
    }
    let gaps = left
        .iter()
        .map(|&left| if left <= touching { 0.0 } else { left });
    let gaps: Vec<f64> = gaps.collect();
    with(sparse, &gaps, SPRINGS).map(|rest| DVector::from_vec(rest.motion))
}

/// Descent along `load` within B y ≤ `left`: along the part of the load that closed contacts don't balance, until the
/// next row closes. This drive shrinks with every row, so that the descent ends.
fn fall(
    rows: &[RigidRow],
    b: &DMatrix<f64>,
    load: &DVector<f64>,
    mut left: Vec<f64>,
    touching: f64,
) -> DVector<f64> {
    let mut y = DVector::zeros(load.len());
    let norms: Vec<f64> = b.row_iter().map(|row| row.norm()).collect();
    for _ in 0..b.nrows() + load.len() {
        let drive = Forces::new(rows, |j| left[j] <= touching).drive(b, load);
        if drive.norm() <= BALANCED * load.norm() || is_asked_to_stop() {
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

/// Removes as much of the `slip` of closed contacts as motions allow: sides that stick once they touch have no slip,
/// independent of the path of the bodies.
fn without_slip(
    rows: &[RigidRow],
    kinematics: &Kinematics,
    slip: &[f64],
    left: &[f64],
    touching: f64,
) -> DVector<f64> {
    let is_closed = |j: usize| left[j] <= touching;
    let closed: Vec<usize> = (0..rows.len()).filter(|&j| is_closed(j)).collect();
    let acts = |friction: &Friction| !friction.bound.only_closed || is_closed(friction.normal);
    let held: Vec<usize> = (0..rows.len())
        .filter(|&i| rows[i].friction.as_ref().is_some_and(acts))
        .collect();
    let slip = DVector::from_iterator(held.len(), held.iter().map(|&i| slip[i]));
    if slip.iter().all(|slip| slip.abs() <= touching) {
        return DVector::zeros(kinematics.len);
    }
    let b = kinematics.rows(rows);
    let kept = null_space(&b.select_rows(&closed));
    if kept.is_empty() {
        return DVector::zeros(b.ncols());
    }
    let svd = (b.select_rows(&held) * &kept).svd(true, true);
    let tolerance = RANK_TOLERANCE * svd.singular_values.amax();
    let Ok(back) = svd.solve(&-slip, tolerance) else {
        return DVector::zeros(b.ncols());
    };
    let back = kept * back;
    let closing = &b * &back;
    let part = (0..rows.len())
        .filter(|&j| !is_closed(j) && closing[j] > ALONG * back.norm())
        .fold(1.0, |part: f64, j| part.min(left[j] / closing[j]));
    back * part
}

#[cfg(test)]
mod tests;
