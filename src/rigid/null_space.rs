//! The null space of a matrix: all x with B x = 0.

use faer::Mat;
use nalgebra::DMatrix;

/// Relative size below which a singular value is zero: a support so much shorter than its body doesn't restrain
/// rotation.
pub(super) const RANK_TOLERANCE: f64 = 1e-9;

/// An orthonormal basis of the x with B x = 0.
pub(super) fn null_space(b: &DMatrix<f64>) -> DMatrix<f64> {
    let n = b.ncols();
    if b.nrows() == 0 {
        return DMatrix::identity(n, n);
    }
    // Padded with zero rows to be square at least, then reduced by QR: R x = 0 is B x = 0.
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
