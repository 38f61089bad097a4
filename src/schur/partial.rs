//! A_EE = L Lᵀ, P = A_KE L⁻ᵀ, A_KK − P Pᵀ: the partial Cholesky factorization of a dense front, by faer.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, Par};

/// Flops from which threads gain more than they cost.
const WORTH_THREADS: f64 = 1e8;

/// Factorizes A_EE = L Lᵀ in the upper `e` rows of `columns`, makes P = A_KE L⁻ᵀ of those below, and
/// subtracts P Pᵀ from `update`. Lower triangles alone count.
///
/// # Errors
/// The column whose pivot isn't positive.
pub(super) fn partial_cholesky(
    columns: MatMut<'_, f64>,
    update: MatMut<'_, f64>,
    par: Par,
) -> Result<(), usize> {
    let (e, k) = (columns.ncols(), update.nrows());
    let (reals_e, reals_k) = (e as f64, k as f64);
    let flops = reals_e * (reals_e * reals_e / 3.0 + reals_e * reals_k + reals_k * reals_k);
    let par = match flops < WORTH_THREADS {
        true => Par::Seq,
        false => par,
    };
    let (mut top, mut below) = columns.split_at_row_mut(e);
    let scratch = cholesky_in_place_scratch::<f64>(e, par, Default::default());
    cholesky_in_place(
        top.as_mut(),
        Default::default(),
        par,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    )
    .map_err(|LltError::NonPositivePivot { index }| index)?;
    if k == 0 {
        return Ok(());
    }
    solve_lower_triangular_in_place(top.as_ref(), below.as_mut().transpose_mut(), par);
    triangular::matmul(
        update,
        BlockStructure::TriangularLower,
        Accum::Add,
        below.as_ref(),
        BlockStructure::Rectangular,
        below.as_ref().transpose(),
        BlockStructure::Rectangular,
        -1.0,
        par,
    );
    Ok(())
}
