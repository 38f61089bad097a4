//! The motions that supports leave to the bodies of a scene.

use faer::Mat;
use nalgebra::{DMatrix, DVector};

use super::analysis::{BodyState, RigidRow};
use super::free_motion::FreeMotion;
use super::many_bodies::SparseRow;
use super::motion::BodyFrame;

/// Relative size below which a singular value is zero: a support that is this much shorter than
/// the body it holds doesn't hold it.
pub(super) const RANK_TOLERANCE: f64 = 1e-9;

/// The motions that supports leave to all bodies, side by side.
pub(super) struct Kinematics {
    /// Dimension of space.
    pub dim: usize,
    /// For each body its basis of motions, modes × kept.
    bases: Vec<DMatrix<f64>>,
    /// First unknown of each body.
    first: Vec<usize>,
    /// The center of the body of each unknown (m).
    pub centers: Vec<[f64; 3]>,
    /// The center of each body (m).
    of_bodies: Vec<[f64; 3]>,
    /// Number of unknowns.
    pub len: usize,
}

/// An orthonormal basis of the x with B x = 0.
pub(super) fn null_space(b: &DMatrix<f64>) -> DMatrix<f64> {
    let n = b.ncols();
    if b.nrows() == 0 {
        return DMatrix::identity(n, n);
    }
    // Rows beyond the number of unknowns are folded into R first: R x = 0 is B x = 0.
    let full = Mat::from_fn(b.nrows().max(n), n, |i, j| {
        if i < b.nrows() { b[(i, j)] } else { 0.0 }
    });
    let r = full.qr().thin_R().to_owned();
    let upper = Mat::from_fn(n, n, |i, j| if i <= j { r[(i, j)] } else { 0.0 });
    let Ok(svd) = upper.svd() else {
        return DMatrix::zeros(n, 0);
    };
    let (sizes, v) = (svd.S().column_vector(), svd.V());
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    let kept: Vec<usize> = (0..n)
        .filter(|&i| sizes[i] <= RANK_TOLERANCE * largest)
        .collect();
    DMatrix::from_fn(n, kept.len(), |i, j| v[(i, kept[j])])
}

impl Kinematics {
    /// Those of `bodies`.
    pub fn new(dim: usize, bodies: &[BodyState]) -> Self {
        let modes = BodyFrame::count(dim);
        let bases: Vec<DMatrix<f64>> = bodies
            .iter()
            .map(|body| {
                let rows = &body.supports;
                null_space(&DMatrix::from_fn(rows.len(), modes, |i, j| rows[i][j]))
            })
            .collect();
        Self::of_bases(dim, bases, bodies.iter().map(|body| body.frame.center))
    }

    /// Those of bodies about these `centers` that have these bases of motions.
    fn of_bases(
        dim: usize,
        bases: Vec<DMatrix<f64>>,
        of_bodies: impl Iterator<Item = [f64; 3]>,
    ) -> Self {
        let mut first = Vec::with_capacity(bases.len());
        let mut centers = Vec::new();
        let of_bodies: Vec<[f64; 3]> = of_bodies.collect();
        for (center, basis) in of_bodies.iter().zip(&bases) {
            first.push(centers.len());
            centers.extend(std::iter::repeat_n(*center, basis.ncols()));
        }
        Self {
            dim,
            bases,
            first,
            len: centers.len(),
            centers,
            of_bodies,
        }
    }

    /// B against them, a row a condition.
    pub fn rows(&self, rows: &[RigidRow]) -> DMatrix<f64> {
        let mut b = DMatrix::zeros(rows.len(), self.len);
        for (i, row) in rows.iter().enumerate() {
            for (body, action) in &row.bodies {
                let basis = &self.bases[*body];
                for k in 0..basis.ncols() {
                    let value: f64 = action
                        .iter()
                        .zip(basis.column(k).iter())
                        .map(|(a, z)| a * z)
                        .sum();
                    b[(i, self.first[*body] + k)] += value;
                }
            }
        }
        b
    }

    /// The same where a row touches few bodies.
    pub fn sparse_row(&self, row: &RigidRow) -> SparseRow {
        let mut sparse = SparseRow::new();
        for (body, action) in &row.bodies {
            let action = DVector::from_column_slice(action);
            let along = self.bases[*body].tr_mul(&action);
            sparse.extend(self.unknowns(*body).zip(along.iter().copied()));
        }
        // A body comes twice where two of its nodes do.
        sparse.sort_by_key(|&(i, _)| i);
        sparse.dedup_by(|(i, value), (kept, sum)| {
            let same = i == kept;
            *sum += if same { *value } else { 0.0 };
            same
        });
        sparse
    }

    /// Of every body the motions that conditions `rows` touch, and those that none does, which are free.
    pub fn touched(&self, rows: &[RigidRow]) -> (Self, Vec<FreeMotion>) {
        let mut of_body: Vec<Vec<Vec<f64>>> = vec![Vec::new(); self.bodies()];
        for (body, action) in rows.iter().flat_map(|row| &row.bodies) {
            let along = self.bases[*body].tr_mul(&DVector::from_column_slice(action));
            of_body[*body].push(along.iter().copied().collect());
        }
        let mut free = Vec::new();
        let mut bases = Vec::with_capacity(self.bodies());
        for (body, (basis, rows)) in self.bases.iter().zip(&of_body).enumerate() {
            let rows = DMatrix::from_fn(rows.len(), basis.ncols(), |i, k| rows[i][k]);
            let untouched = null_space(&rows);
            bases.push(basis * null_space(&untouched.transpose()));
            free.extend((basis * untouched).column_iter().map(|z| FreeMotion {
                bodies: vec![(body, z.iter().copied().collect())],
            }));
        }
        let centers = self.of_bodies.iter().copied();
        (Self::of_bases(self.dim, bases, centers), free)
    }

    /// The load against them.
    pub fn load(&self, bodies: &[BodyState]) -> DVector<f64> {
        let mut load = DVector::zeros(self.len);
        for (body, (basis, &first)) in bodies.iter().zip(self.bases.iter().zip(&self.first)) {
            let resultant = DVector::from_column_slice(&body.load);
            load.rows_mut(first, basis.ncols())
                .copy_from(&(basis.transpose() * resultant));
        }
        load
    }

    /// The unknowns of body `b`.
    pub fn unknowns(&self, b: usize) -> std::ops::Range<usize> {
        self.first[b]..self.first[b] + self.bases[b].ncols()
    }

    /// The part of motion `x` that body `b` takes, in its own frame.
    pub fn of_body(&self, b: usize, x: &[f64]) -> Vec<f64> {
        let basis = &self.bases[b];
        let own = DVector::from_column_slice(&x[self.first[b]..self.first[b] + basis.ncols()]);
        (basis * own).iter().copied().collect()
    }

    /// Number of bodies.
    pub fn bodies(&self) -> usize {
        self.bases.len()
    }

    /// A motion, given body by body, in the unknowns.
    pub fn unknowns_of(&self, motion: &FreeMotion) -> DVector<f64> {
        let mut x = DVector::zeros(self.len);
        for (b, z) in &motion.bodies {
            let own = self.bases[*b].tr_mul(&DVector::from_column_slice(z));
            x.rows_mut(self.first[*b], own.len()).copy_from(&own);
        }
        x
    }
}
