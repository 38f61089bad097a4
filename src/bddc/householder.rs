//! An orthogonal matrix whose first columns span those of another: a product of reflections, as many as it has columns.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::householder::{
    apply_block_householder_sequence_on_the_right_in_place_scratch,
    apply_block_householder_sequence_on_the_right_in_place_with_conj,
};
use faer::{Conj, Mat, MatMut, Par};
use serde::{Deserialize, Serialize};

use crate::vector::{axpy, dot};

/// An orthogonal matrix Q whose first columns span those of another.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Householder {
    #[serde(with = "crate::bytes::matrix")]
    basis: Mat<f64>,
    #[serde(with = "crate::bytes::matrix")]
    factor: Mat<f64>,
}

impl Householder {
    /// The reflections of independent columns.
    pub fn new(columns: &Mat<f64>) -> Self {
        let qr = columns.qr();
        Self {
            basis: qr.Q_basis().to_owned(),
            factor: qr.Q_coeff().to_owned(),
        }
    }

    /// A ← A Q.
    pub fn multiply_right(&self, a: MatMut<'_, f64>) {
        if self.basis.ncols() == 0 {
            return;
        }
        let block = self.factor.nrows();
        let scratch = apply_block_householder_sequence_on_the_right_in_place_scratch::<f64>(
            self.basis.nrows(),
            block,
            a.nrows(),
        );
        apply_block_householder_sequence_on_the_right_in_place_with_conj(
            self.basis.as_ref(),
            self.factor.as_ref(),
            Conj::No,
            a,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
    }

    /// x ← Q x.
    pub fn turn(&self, x: &mut [f64]) {
        (0..self.basis.ncols())
            .rev()
            .for_each(|k| self.reflect(k, x));
    }

    /// x ← Qᵀ x.
    pub fn turn_back(&self, x: &mut [f64]) {
        (0..self.basis.ncols()).for_each(|k| self.reflect(k, x));
    }

    /// Reflection k of x, x − v (vᵀ x) / τ; v begins with 1 at k.
    fn reflect(&self, k: usize, x: &mut [f64]) {
        let tau = self.factor[(k % self.factor.nrows(), k)];
        let v = &self.basis.col_as_slice(k)[k + 1..];
        let factor = (x[k] + dot(v, &x[k + 1..])) / tau;
        x[k] -= factor;
        axpy(-factor, v, &mut x[k + 1..]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_columns_span_the_given_ones_and_all_are_orthonormal() {
        let given = Mat::from_fn(9, 3, |i, j| ((3 * i + 7 * j) as f64).sin());
        let mut q = Mat::<f64>::identity(9, 9);
        let reflections = Householder::new(&given);
        reflections.multiply_right(q.as_mut());
        assert!((q.transpose() * &q - Mat::<f64>::identity(9, 9)).norm_max() < 1e-14);
        assert!((q.subcols(3, 6).transpose() * given).norm_max() < 1e-14);
        let mut x: Vec<f64> = (0..9).map(f64::from).collect();
        let before = Mat::from_fn(9, 1, |i, _| x[i]);
        reflections.turn(&mut x);
        let turned = Mat::from_fn(9, 1, |i, _| x[i]);
        assert!((&q * &before - turned).norm_max() < 1e-13);
        reflections.turn_back(&mut x);
        assert!((0..9).all(|i| (x[i] - before[(i, 0)]).abs() < 1e-13));
    }
}
