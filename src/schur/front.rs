//! The dense part of a sparse factorization: the columns of a supernode, and their update of the rows below.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, Par};
use pulp::{Arch, Simd, WithSimd};

use super::columns::Number;

/// Rows of a front up to which it is factorized in place, four columns at a time; larger fronts use faer's blocked
/// algorithms.
const SMALL: usize = 96;

/// Factorizes `panel`, the `columns` columns of a front with `rows` rows, in place, and subtracts their contribution
/// from `update`, the square of the rows below. Only lower triangles are used.
///
/// # Errors
/// The column whose pivot isn't positive.
pub(super) fn factorize(
    panel: &mut [f64],
    rows: usize,
    columns: usize,
    update: &mut [f64],
    par: Par,
) -> Result<(), usize> {
    if rows <= SMALL {
        Arch::new().dispatch(InPlace {
            panel,
            rows,
            columns,
            update,
        })
    } else {
        let below = rows - columns;
        partial_cholesky(
            MatMut::from_column_major_slice_mut(panel, rows, columns),
            MatMut::from_column_major_slice_mut(update, below, below),
            par,
        )
    }
}

/// Number of columns eliminated together, so that the rest of the front is read and written once for all of them.
const WIDTH: usize = 4;

struct InPlace<'a> {
    panel: &'a mut [f64],
    rows: usize,
    columns: usize,
    update: &'a mut [f64],
}

impl WithSimd for InPlace<'_> {
    type Output = Result<(), usize>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self {
            panel,
            rows,
            columns,
            update,
        } = self;
        let below = rows - columns;
        for first in (0..columns).step_by(WIDTH) {
            let width = WIDTH.min(columns - first);
            let (done, rest) = panel.split_at_mut((first + width) * rows);
            eliminate(simd, &mut done[first * rows..], rows, first)?;
            let done = &done[first * rows..];
            for (j, column) in (first + width..).zip(rest.chunks_exact_mut(rows)) {
                subtract(simd, &mut column[j..], done, rows, j);
            }
            for (j, column) in (0..below).zip(update.chunks_exact_mut(below.max(1))) {
                subtract(simd, &mut column[j..], done, rows, columns + j);
            }
        }
        Ok(())
    }
}

/// Eliminates the columns of `block`, at most `WIDTH`; its first diagonal entry is in row `first`.
#[inline(always)]
fn eliminate<S: Simd>(simd: S, block: &mut [f64], rows: usize, first: usize) -> Result<(), usize> {
    for j in 0..block.len() / rows {
        let (done, rest) = block.split_at_mut(j * rows);
        let column = &mut rest[first + j..rows];
        subtract(simd, column, done, rows, first + j);
        let pivot = column[0];
        if pivot <= 0.0 || pivot.is_nan() {
            return Err(first + j);
        }
        let root = pivot.sqrt();
        let inverse = 1.0 / root;
        column[0] = root;
        for x in &mut column[1..] {
            *x *= inverse;
        }
    }
    Ok(())
}

/// `to` ← `to` − Σ_p L_ip L_jp over the columns p of `block`, at most four; i ≥ j.
#[inline(always)]
fn subtract<S: Simd>(simd: S, to: &mut [f64], block: &[f64], rows: usize, j: usize) {
    let column = |p: usize| {
        let below = &block[p * rows + j..(p + 1) * rows];
        (-below[0], below)
    };
    match block.len() / rows {
        0 => {}
        1 => f64::add::<S, 1>(simd, to, column),
        2 => f64::add::<S, 2>(simd, to, column),
        3 => f64::add::<S, 3>(simd, to, column),
        _ => f64::add::<S, WIDTH>(simd, to, column),
    }
}

/// Number of flops from which on threads pay.
const WORTH_THREADS: f64 = 1e8;

/// Partial Cholesky factorization of a dense front, by faer: factorizes A_EE = L Lᵀ in the upper `e` rows of `columns`,
/// computes P = A_KE L⁻ᵀ in those below, and subtracts P Pᵀ from `update`, A_KK. Only lower triangles are used.
///
/// # Errors
/// The column whose pivot isn't positive.
pub(crate) fn partial_cholesky(
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
