//! The rigid-body motions that supports leave to the bodies of a scene.

use nalgebra::{DMatrix, DVector};

use super::free_motion::FreeMotion;
use super::many_bodies::{MANY, SparseRow};
use super::null_space::null_space;
use super::scene::{BodyState, RigidRow};
use super::unheld_motions::unheld_motions;
use crate::fem::body_frame::BodyFrame;

/// The motions that supports leave to all bodies; their coefficients are the unknowns of the analysis.
pub(super) struct Kinematics {
    /// Dimension of space.
    pub dim: usize,
    /// Basis of the motions of each body, modes × kept.
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

impl Kinematics {
    /// The motions that supports leave to `bodies`.
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

    /// The kinematics of bodies with these bases of motions about `centers`.
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

    /// B on these motions, a row for each constraint.
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

    /// The jumps of constraints in `motions`, one motion per column.
    pub fn jumps(&self, rows: &[RigidRow], motions: &DMatrix<f64>) -> DMatrix<f64> {
        if self.len < MANY {
            return self.rows(rows) * motions;
        }
        let mut jumps = DMatrix::zeros(rows.len(), motions.ncols());
        for (j, row) in rows.iter().enumerate() {
            let row = self.sparse_row(row);
            for (k, motion) in motions.column_iter().enumerate() {
                jumps[(j, k)] = row.iter().map(|&(i, b)| b * motion[i]).sum();
            }
        }
        jumps
    }

    /// An orthonormal basis of the motions that the constraints `rows` don't restrain, orthogonal to those `known`, one
    /// per column; `None` if a signal stopped the computation.
    pub fn unheld(&self, rows: &[RigidRow], known: &[FreeMotion]) -> Option<DMatrix<f64>> {
        if self.len < MANY {
            let mut b = self.rows(rows).insert_rows(0, known.len(), 0.0);
            for (i, motion) in known.iter().enumerate() {
                let x = self.unknowns_of(motion).normalize();
                b.row_mut(i).copy_from(&x.transpose());
            }
            return Some(null_space(&b));
        }
        let of_known = |motion: &FreeMotion| -> SparseRow {
            let mut x = self.sparse_motion(motion);
            let size = x.iter().map(|(_, z)| z * z).sum::<f64>().sqrt();
            x.iter_mut().for_each(|(_, z)| *z /= size);
            x
        };
        let mut sparse: Vec<SparseRow> = known.iter().map(of_known).collect();
        sparse.extend(rows.iter().map(|row| self.sparse_row(row)));
        let motions = unheld_motions(&self.centers, &sparse)?;
        let mut unheld = DMatrix::zeros(self.len, motions.len());
        for (motion, mut column) in motions.iter().zip(unheld.column_iter_mut()) {
            motion.iter().for_each(|&(i, z)| column[i] = z);
        }
        Some(unheld)
    }

    /// A row of B, sparse because it touches few bodies.
    pub fn sparse_row(&self, row: &RigidRow) -> SparseRow {
        let mut sparse = SparseRow::new();
        for (body, action) in &row.bodies {
            let action = DVector::from_column_slice(action);
            let along = self.bases[*body].tr_mul(&action);
            sparse.extend(self.unknowns(*body).zip(along.iter().copied()));
        }
        // A body with two nodes in the constraint occurs twice.
        sparse.sort_by_key(|&(i, _)| i);
        sparse.dedup_by(|(i, value), (kept, sum)| {
            let same = i == kept;
            *sum += if same { *value } else { 0.0 };
            same
        });
        sparse
    }

    /// The motions of the bodies that the constraints `rows` touch, and the motions that no constraint touches, which
    /// are free.
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

    /// The load along the motions.
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

    /// The part of motion `x` of body `b`, in its frame.
    pub fn of_body(&self, b: usize, x: &[f64]) -> Vec<f64> {
        let basis = &self.bases[b];
        let own = DVector::from_column_slice(&x[self.first[b]..self.first[b] + basis.ncols()]);
        (basis * own).iter().copied().collect()
    }

    /// Number of bodies.
    pub fn bodies(&self) -> usize {
        self.bases.len()
    }

    /// A motion, given body by body, as sparse coefficients on the unknowns.
    pub fn sparse_motion(&self, motion: &FreeMotion) -> SparseRow {
        let mut sparse = SparseRow::new();
        for (b, z) in &motion.bodies {
            let own = self.bases[*b].tr_mul(&DVector::from_column_slice(z));
            sparse.extend(self.unknowns(*b).zip(own.iter().copied()));
        }
        sparse
    }

    /// A motion, given body by body, as coefficients on the unknowns.
    pub fn unknowns_of(&self, motion: &FreeMotion) -> DVector<f64> {
        let mut x = DVector::zeros(self.len);
        for (b, z) in &motion.bodies {
            let own = self.bases[*b].tr_mul(&DVector::from_column_slice(z));
            x.rows_mut(self.first[*b], own.len()).copy_from(&own);
        }
        x
    }
}
