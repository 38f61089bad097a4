//! Proof that no contact forces balance a load: a motion along which it does more work than they can absorb.
//!
//! Contact forces with |λ_t| ≤ c + μ λ_n that balance a load f absorb the work f·z along every motion z; a point with
//! jumps z_n, z_t absorbs at most c |z_t| + λ_n (z_n + μ |z_t|). Thus none exist if z_n + μ |z_t| ≤ 0 at all points and
//! f·z > Σ c |z_t| (Farkas' lemma; Moreau's polar cone). With round-off, z_n + μ |z_t| ≤ ω shows that the sum of normal
//! forces would have to be (f·z − Σ c |z_t|) / ω at least.

use nalgebra::{DMatrix, DVector};

use super::columns::Columns;
use super::many_bodies::{SparseRow, jump};
use super::scene::RigidRow;
use crate::contact::friction::ForceBound;

/// Upper limit of the sum of normal forces, relative to all loads: a load that needs more has no equilibrium.
const MOST_FORCE: f64 = 1e2;
/// Work, relative to the sum of the magnitudes of its terms, that is round-off.
const ROUND_OFF: f64 = 1e-14;
/// Distances from the limit z_n + μ |z_t| = 0, relative to the largest possible jump, within which a point is moved to
/// it; a candidate motion is accurate to some digits only.
const AT_LIMIT: [f64; 5] = [0.0, 1e-12, 1e-9, 1e-6, 1e-3];
/// Most Newton updates of the slip directions of a motion at its limits; they converge quadratically.
const TURNS: usize = 5;
/// Force, relative to the largest, that counts as zero.
const NO_FORCE: f64 = 1e-9;
/// Slip, relative to the largest jump, up to which a point sticks.
const STICKING_SLIP: f64 = 1e-9;
/// Slip, relative to the largest jump, from which on a point slides, and tolerance of its limit.
const SLIDES: f64 = 1e-6;
/// Singular value, relative to the largest, that counts as zero.
const SINGULAR: f64 = 1e-12;
/// Smallest norm of a unit motion after projection onto the limits for which it counts as near to them.
const MOST_CHANGE: f64 = 0.5;

/// A contact point by its constraints.
struct FrictionPoint {
    normal: usize,
    tangents: Vec<usize>,
    bound: ForceBound,
}

/// The points of the constraints `rows`.
fn points(rows: &[RigidRow]) -> Vec<FrictionPoint> {
    let mut place = vec![None; rows.len()];
    let mut points = Vec::new();
    for (normal, _) in rows
        .iter()
        .enumerate()
        .filter(|(_, r)| r.friction.is_none())
    {
        place[normal] = Some(points.len());
        points.push(FrictionPoint {
            normal,
            tangents: Vec::new(),
            bound: ForceBound::default(),
        });
    }
    for (i, row) in rows.iter().enumerate() {
        if let Some(friction) = &row.friction
            && let Some(at) = place[friction.normal]
        {
            points[at].tangents.push(i);
            points[at].bound = friction.bound;
        }
    }
    points
}

impl FrictionPoint {
    /// |z_t|.
    fn slip(&self, jumps: &[f64]) -> f64 {
        let squares = self.tangents.iter().map(|&i| jumps[i] * jumps[i]);
        squares.sum::<f64>().sqrt()
    }

    /// z_n + μ |z_t|.
    fn opens(&self, jumps: &[f64]) -> f64 {
        jumps[self.normal] + self.bound.coefficient * self.slip(jumps)
    }
}

/// True if a motion with these `jumps` of the constraints `rows` proves that no forces balance a load; the load's
/// `work` along it is a sum of terms of total magnitude `terms`, and `scale` is the sum of all loads.
pub(super) fn proves(rows: &[RigidRow], jumps: &[f64], [work, terms, scale]: [f64; 3]) -> bool {
    let (mut taken, mut worst) = (0.0, 0.0);
    for point in points(rows) {
        taken += point.bound.cohesion * point.slip(jumps);
        worst = f64::max(worst, point.opens(jumps));
    }
    let surplus = work - taken;
    surplus > ROUND_OFF * (terms + taken) && surplus > MOST_FORCE * scale * worst
}

/// True if a `motion` of many bodies with sparse constraints is such a proof.
pub(super) fn proves_sparse(
    rows: &[RigidRow],
    sparse: &[SparseRow],
    load: &[f64],
    scale: f64,
    motion: &[f64],
) -> bool {
    let jumps: Vec<f64> = sparse.iter().map(|row| jump(row, motion)).collect();
    proves(rows, &jumps, work(load, motion, scale))
}

/// Work of a load along a motion, the sum of the magnitudes of its terms, and the scale of all loads.
fn work(load: &[f64], motion: &[f64], scale: f64) -> [f64; 3] {
    let terms = load.iter().zip(motion).map(|(f, z)| f * z);
    let (mut work, mut magnitudes) = (0.0, 0.0);
    for term in terms {
        work += term;
        magnitudes += term.abs();
    }
    [work, magnitudes, scale]
}

/// A load on the motions of bodies, and the constraints `rows` with their jumps B z.
pub(super) struct Loaded<'a> {
    /// The constraints.
    pub rows: &'a [RigidRow],
    /// B.
    pub b: &'a DMatrix<f64>,
    /// f.
    pub load: &'a DVector<f64>,
    /// Sum of all loads.
    pub scale: f64,
}

impl Loaded<'_> {
    /// The motion near `along` that proves that no forces balance the load; `None` if none is found. It is moved to the
    /// limits of nearby points, with the `forces` of the constraints if they are known.
    pub fn proof(&self, along: &DVector<f64>, forces: &[f64]) -> Option<DVector<f64>> {
        let points = points(self.rows);
        let along = along.try_normalize(0.0)?;
        let found = self.near_limits(&points, &along);
        let is_circular = |point: &FrictionPoint| point.tangents.len() == 2;
        if forces.is_empty() || !points.iter().any(is_circular) {
            return found;
        }
        // Polygonal cones have turned the motion. Near the limit its work is round-off of a sum, and left out.
        let turned = |has_work: bool| {
            let mut z = found.as_ref().unwrap_or(&along).clone();
            for _ in 0..TURNS {
                z = self.turned(&points, forces, &z, has_work)?;
            }
            self.near_limits(&points, &z)
        };
        let proofs = [turned(true), turned(false), found.clone()];
        let work = |z: &DVector<f64>| self.load.dot(z);
        let mut proofs = proofs.into_iter().flatten();
        let first = proofs.next()?;
        Some(proofs.fold(
            first,
            |best, z| if work(&z) > work(&best) { z } else { best },
        ))
    }

    /// The motion at the limits near to `along`, if it is a proof.
    fn near_limits(&self, points: &[FrictionPoint], along: &DVector<f64>) -> Option<DVector<f64>> {
        let sizes: Vec<f64> = self.b.row_iter().map(|row| row.norm()).collect();
        AT_LIMIT.into_iter().find_map(|near| {
            let mut z = along.clone();
            for _ in 0..TURNS {
                z = at_limits(points, self.b, &sizes, near, &z)?;
            }
            let jumps = self.b * &z;
            let work = work(self.load.as_slice(), z.as_slice(), self.scale);
            proves(self.rows, jumps.as_slice(), work).then_some(z)
        })
    }

    /// The motion z without the opening of points at their limit: bodies slide along their contacts rather than rise at
    /// the friction angle.
    pub fn along_sides(&self, z: &DVector<f64>) -> DVector<f64> {
        let jumps = self.b * z;
        let far = jumps.amax();
        let is_at_limit = |p: &FrictionPoint| {
            let slip = p.slip(jumps.as_slice());
            p.opens(jumps.as_slice()) >= -SLIDES * far && slip > SLIDES * far
        };
        let points = points(self.rows);
        let sliding = points.iter().filter(|p| is_at_limit(p));
        let normals: Vec<usize> = sliding.map(|p| p.normal).collect();
        if normals.is_empty() {
            return z.clone();
        }
        let normals = self.b.select_rows(&normals).transpose();
        let mut columns = Columns::default();
        for j in 0..normals.ncols() {
            columns.push(&normals, j);
        }
        columns.residual(z)
    }

    /// A step of Newton's method for the z of length 1 along which the load does the most work within the limits of the
    /// points with these normal `forces`:
    ///
    /// > f = ν z + Σ λ_n ∇(z_n + μ |z_t|),  z_n + μ |z_t| = 0
    fn turned(
        &self,
        points: &[FrictionPoint],
        forces: &[f64],
        z: &DVector<f64>,
        has_work: bool,
    ) -> Option<DVector<f64>> {
        let (b, n) = (self.b, z.len());
        let jumps = b * z;
        let jumps = jumps.as_slice();
        let most = forces.iter().fold(0.0, |most: f64, force| most.max(*force));
        let mut hessian = DMatrix::zeros(n, n);
        let mut limits: Vec<(DVector<f64>, f64)> = Vec::new();
        let row = |i: usize| b.row(i).transpose();
        for point in points.iter().filter(|p| forces[p.normal] > NO_FORCE * most) {
            let (slip, coefficient) = (point.slip(jumps), point.bound.coefficient);
            if slip <= STICKING_SLIP * jumps.iter().fold(0.0, |far: f64, jump| far.max(jump.abs()))
            {
                limits.push((row(point.normal), jumps[point.normal]));
                limits.extend(point.tangents.iter().map(|&i| (row(i), jumps[i])));
                continue;
            }
            let mut limit = row(point.normal);
            for &i in &point.tangents {
                limit.axpy(coefficient * jumps[i] / slip, &row(i), 1.0);
            }
            limits.push((limit, point.opens(jumps)));
            if let [t, s] = point.tangents[..] {
                let across = row(s) * (jumps[t] / slip) - row(t) * (jumps[s] / slip);
                let curvature = coefficient * forces[point.normal] / slip;
                hessian.ger(curvature, &across, &across, 1.0);
            }
        }
        let m = limits.len();
        let mut matrix = DMatrix::zeros(n + m, n + m);
        let mut right = DVector::zeros(n + m);
        let along = match has_work {
            true => self.load.dot(z).max(0.0),
            false => 0.0,
        };
        let own = hessian + DMatrix::identity(n, n) * along;
        matrix.view_mut((0, 0), (n, n)).copy_from(&own);
        right.rows_mut(0, n).copy_from(&(self.load - z * along));
        for (k, (limit, opens)) in limits.iter().enumerate() {
            matrix.view_mut((0, n + k), (n, 1)).copy_from(limit);
            matrix
                .view_mut((n + k, 0), (1, n))
                .copy_from(&limit.transpose());
            right[n + k] = -opens;
        }
        if !matrix.iter().all(|x| x.is_finite()) {
            return None;
        }
        let svd = matrix.svd(true, true);
        let least = SINGULAR * svd.singular_values.max();
        let change = svd.solve(&right, least).ok()?;
        (z + change.rows(0, n)).try_normalize(0.0)
    }
}

/// The unit motion nearest to z with those points at their limits whose distance from it in z is up to `near`,
/// linearized at their slip directions in z; `None` if it is far from z.
fn at_limits(
    points: &[FrictionPoint],
    b: &DMatrix<f64>,
    sizes: &[f64],
    near: f64,
    z: &DVector<f64>,
) -> Option<DVector<f64>> {
    let jumps = b * z;
    let jumps = jumps.as_slice();
    let mut limits: Vec<DVector<f64>> = Vec::new();
    for point in points {
        let coefficient = point.bound.coefficient;
        let of_tangents: f64 = point.tangents.iter().map(|&i| sizes[i]).sum();
        let size = sizes[point.normal] + coefficient * of_tangents;
        if point.opens(jumps) < -near * size {
            continue;
        }
        let row = |i: usize| b.row(i).transpose();
        let slip = point.slip(jumps);
        if slip <= near * of_tangents {
            limits.push(row(point.normal));
            limits.extend(
                point
                    .tangents
                    .iter()
                    .filter(|_| coefficient > 0.0)
                    .map(|&i| row(i)),
            );
            continue;
        }
        let mut limit = row(point.normal);
        for &i in &point.tangents {
            limit.axpy(coefficient * jumps[i] / slip, &b.row(i).transpose(), 1.0);
        }
        limits.push(limit);
    }
    if limits.is_empty() {
        return Some(z.clone());
    }
    let limits = DMatrix::from_columns(&limits);
    let mut columns = Columns::default();
    for j in 0..limits.ncols() {
        columns.push(&limits, j);
    }
    let left = columns.residual(z);
    (left.norm() > MOST_CHANGE).then(|| left.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::nonnegative;
    use crate::rigid::scene::Friction;
    use crate::rigid::squares::coulomb;

    fn noise(s: usize) -> f64 {
        ((s as f64 * 78.233).sin() * 43758.5453).fract()
    }

    /// Points with a normal and two tangents each for some motions: their constraints, and B.
    fn random(seed: usize, points: usize, motions: usize) -> (Vec<RigidRow>, DMatrix<f64>) {
        let coefficient = 0.1 + noise(seed + 1).abs();
        let bound = coulomb(coefficient);
        let rows = (0..3 * points).map(|i| RigidRow {
            is_tied: false,
            bodies: Vec::new(),
            gap: 0.0,
            friction: (i % 3 > 0).then_some(Friction {
                normal: i - i % 3,
                bound,
            }),
        });
        let b = DMatrix::from_fn(3 * points, motions, |i, j| {
            noise(1000 * seed + 10 * i + j + 1)
        });
        (rows.collect(), b)
    }

    /// Norm of the load left by cones with polygons of 256 corners, `reach` times as wide as the circle.
    fn left(rows: &[RigidRow], b: &DMatrix<f64>, load: &DVector<f64>, reach: f64) -> f64 {
        let corners = 256;
        let mut columns = Vec::new();
        for point in points(rows) {
            let [t, s] = point.tangents[..] else {
                continue;
            };
            for k in 0..corners {
                let angle = std::f64::consts::TAU * k as f64 / corners as f64;
                let (sin, cos) = angle.sin_cos();
                let along = b.row(t) * cos + b.row(s) * sin;
                let edge = b.row(point.normal) + along * (reach * point.bound.coefficient);
                columns.push(edge.transpose());
            }
        }
        nonnegative::residual(&DMatrix::from_columns(&columns), load).norm() / load.norm()
    }

    /// Inscribed polygons that balance a load, and circumscribed ones that don't, agree with the proof.
    #[test]
    fn a_proof_is_found_where_nothing_balances_a_load_and_nowhere_else() {
        let around = 1.0 / (std::f64::consts::PI / 256.0).cos();
        let (mut held, mut driven) = (0, 0);
        for seed in 0..60 {
            let (rows, b) = random(seed, 2 + seed % 3, 6);
            let inside = b.tr_mul(&DVector::from_fn(b.nrows(), |i, _| match i % 3 {
                0 => 1.0,
                _ => 0.05 * noise(seed + i),
            }));
            let any = DVector::from_fn(6, |i, _| noise(77 * seed + i));
            let load = if seed % 2 == 0 { inside } else { any };
            let loaded = Loaded {
                rows: &rows,
                b: &b,
                load: &load,
                scale: load.norm(),
            };
            let nothing = 1e-13 * load.norm();
            let found = crate::rigid::forces::Forces::new(&rows, |_| true);
            let found = { found }.unbalanced(&loaded, nothing);
            if left(&rows, &b, &load, 1.0) < 1e-12 {
                assert!(found.proof.is_none(), "{seed}");
                assert!(found.left.norm() <= nothing, "{seed}: {}", found.left);
                held += 1;
            } else if left(&rows, &b, &load, around) > 1e-9 {
                let z = found.proof.expect("a proof");
                let jumps = &b * &z;
                let opens = points(&rows).into_iter().map(|p| p.opens(jumps.as_slice()));
                let worst = opens.fold(0.0, f64::max);
                assert!(load.dot(&z) > 1e2 * worst, "{seed}");
                driven += 1;
            }
        }
        assert!(held > 20 && driven > 20, "{held} {driven}");
    }
}
