//! An orthogonal matrix whose first columns span those of another: a product of reflections, as many as it has columns.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::householder::{
    apply_block_householder_sequence_on_the_right_in_place_scratch,
    apply_block_householder_sequence_on_the_right_in_place_with_conj,
};
use faer::{Conj, Mat, MatMut, Par};
use serde::{Deserialize, Serialize};

/// An orthogonal matrix Q whose first columns span those of another.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Reflections {
    #[serde(with = "crate::bytes::matrix")]
    basis: Mat<f64>,
    #[serde(with = "crate::bytes::matrix")]
    factor: Mat<f64>,
}

impl Reflections {
    /// That of independent columns.
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_columns_span_the_given_ones_and_all_are_orthonormal() {
        let given = Mat::from_fn(9, 3, |i, j| ((3 * i + 7 * j) as f64).sin());
        let mut q = Mat::<f64>::identity(9, 9);
        Reflections::new(&given).multiply_right(q.as_mut());
        assert!((q.transpose() * &q - Mat::<f64>::identity(9, 9)).norm_max() < 1e-14);
        assert!((q.subcols(3, 6).transpose() * given).norm_max() < 1e-14);
    }
}
