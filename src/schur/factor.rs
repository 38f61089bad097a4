//! Sparse Cholesky with the boundary ordered last.
//!
//! K = L Lᵀ with the unknowns ordered [I | B] holds everything: L_II serves the interior solves,
//! and the trailing block is the Schur complement, S_BB = K_BB − K_BI K_II⁻¹ K_IB = L_BB L_BBᵀ.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::sparse::linalg::cholesky::simplicial;
use faer::sparse::linalg::cholesky::supernodal::{
    SymbolicSupernodalCholesky, factorize_supernodal_numeric_llt,
    factorize_supernodal_numeric_llt_scratch, factorize_supernodal_symbolic_cholesky,
    factorize_supernodal_symbolic_cholesky_scratch,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Accum, Mat, MatMut, MatRef, Par};

use super::pattern::SparseSymmetric;

/// Why a matrix couldn't be factorized.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FactorError {
    /// The matrix isn't positive definite.
    #[error("the pivot of unknown {0} isn't positive")]
    Pivot(usize),
    /// The factor needs more memory than there is, or more than 2³² entries.
    #[error("the factor is too large")]
    Size,
}

/// The Cholesky factor of a matrix whose last unknowns are its boundary B.
#[derive(Debug)]
pub struct BoundaryLastCholesky {
    symbolic: SymbolicSupernodalCholesky<u32>,
    values: Vec<f64>,
    interior: usize,
    smallest_pivot: f64,
}

impl BoundaryLastCholesky {
    /// Factorizes `matrix`, whose first `interior` unknowns are I.
    ///
    /// `shift` is added to the diagonal of B, so that S_BB may be singular;
    /// [`schur_complement`](Self::schur_complement) takes it off again.
    ///
    /// # Errors
    /// K_II isn't positive definite, or the factor is too large.
    pub fn new(
        mut matrix: SparseSymmetric,
        interior: usize,
        shift: &[f64],
        par: Par,
    ) -> Result<Self, FactorError> {
        let n = matrix.pattern.n();
        debug_assert_eq!(shift.len(), n - interior);
        for (j, s) in (interior..n).zip(shift) {
            let diagonal = matrix.pattern.column(j).start;
            matrix.values[diagonal] += s;
        }
        let symbolic = symbolic(&matrix)?;
        let lower = SparseColMatRef::new(
            SymbolicSparseColMatRef::new_checked(
                n,
                n,
                &matrix.pattern.columns,
                None,
                &matrix.pattern.rows,
            ),
            &matrix.values,
        );
        let mut values = Vec::new();
        values
            .try_reserve_exact(symbolic.len_val())
            .map_err(|_| FactorError::Size)?;
        values.resize(symbolic.len_val(), 0.0);
        let scratch = factorize_supernodal_numeric_llt_scratch::<u32, f64>(
            &symbolic,
            par,
            Default::default(),
        );
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| FactorError::Size)?;
        factorize_supernodal_numeric_llt(
            &mut values,
            lower,
            LltRegularization::default(),
            &symbolic,
            par,
            MemStack::new(&mut memory),
            Default::default(),
        )
        .map_err(|LltError::NonPositivePivot { index }| FactorError::Pivot(index))?;
        let mut factor = Self {
            symbolic,
            values,
            interior,
            smallest_pivot: f64::INFINITY,
        };
        let unshifted = if shift.iter().all(|&s| s == 0.0) {
            n
        } else {
            interior
        };
        factor.smallest_pivot = factor.find_smallest_pivot(&matrix, unshifted);
        Ok(factor)
    }

    /// The smallest pivot relative to its diagonal entry, min L_jj² / K_jj, of I or, where B wasn't
    /// shifted, of all unknowns: how close the matrix is to a singular one whatever its scaling.
    pub fn smallest_pivot(&self) -> f64 {
        self.smallest_pivot
    }

    fn find_smallest_pivot(&self, matrix: &SparseSymmetric, count: usize) -> f64 {
        let diagonal = matrix.diagonal();
        let mut smallest = f64::INFINITY;
        for panel in self.panels() {
            for j in 0..panel.columns_before(count) {
                let pivot = panel.column(j)[j].powi(2) / diagonal[panel.start + j];
                smallest = smallest.min(pivot);
            }
        }
        smallest
    }

    fn panels(&self) -> impl DoubleEndedIterator<Item = Panel<'_>> {
        let begin = self.symbolic.supernode_begin();
        let end = self.symbolic.supernode_end();
        let places = self.symbolic.col_ptr_for_val();
        (0..self.symbolic.n_supernodes()).map(move |s| Panel {
            start: begin[s] as usize,
            columns: (end[s] - begin[s]) as usize,
            below: self.symbolic.supernode(s).pattern(),
            values: &self.values[places[s] as usize..places[s + 1] as usize],
        })
    }

    /// S_BB = L_BB L_BBᵀ less the `shift` it was factorized with; both triangles are filled.
    pub fn schur_complement(&self, shift: &[f64], par: Par) -> Mat<f64> {
        let n = self.interior + shift.len();
        let mut l_bb = Mat::<f64>::zeros(shift.len(), shift.len());
        for panel in self.panels() {
            for j in panel.columns_before(self.interior)..panel.columns {
                let column = panel.column(j);
                let to = panel.start + j - self.interior;
                for i in j..panel.columns {
                    l_bb[(panel.start + i - self.interior, to)] = column[i];
                }
                for (&i, &value) in panel.below.iter().zip(&column[panel.columns..]) {
                    l_bb[(i as usize - self.interior, to)] = value;
                }
            }
        }
        let m = n - self.interior;
        let mut s = Mat::<f64>::zeros(m, m);
        triangular::matmul(
            s.as_mut(),
            BlockStructure::TriangularLower,
            Accum::Replace,
            l_bb.as_ref(),
            BlockStructure::TriangularLower,
            l_bb.transpose(),
            BlockStructure::TriangularUpper,
            1.0,
            par,
        );
        for j in 0..m {
            s[(j, j)] -= shift[j];
            for i in j + 1..m {
                s[(j, i)] = s[(i, j)];
            }
        }
        s
    }

    /// x_I ← L_II⁻¹ x_I and x_B ← x_B − L_BI x_I: condenses a load onto B.
    pub fn forward(&self, x: &mut [f64]) {
        self.forward_before(self.interior, x);
    }

    /// The same with the first `count` unknowns in the place of I.
    fn forward_before(&self, count: usize, x: &mut [f64]) {
        for panel in self.panels() {
            for j in 0..panel.columns_before(count) {
                let column = panel.column(j);
                let xj = x[panel.start + j] / column[j];
                x[panel.start + j] = xj;
                let (top, bottom) = column.split_at(panel.columns);
                let inside = panel.start + j + 1..panel.start + panel.columns;
                for (xi, l) in x[inside].iter_mut().zip(&top[j + 1..]) {
                    *xi -= l * xj;
                }
                for (&i, l) in panel.below.iter().zip(bottom) {
                    x[i as usize] -= l * xj;
                }
            }
        }
    }

    /// X ← L_BB⁻¹ X, where X has a row for every unknown of B. Only where B wasn't shifted.
    pub fn forward_boundary(&self, mut x: MatMut<'_, f64>, par: Par) {
        for panel in self.panels() {
            let skipped = panel.columns_before(self.interior);
            let (first, count) = (panel.start + skipped, panel.columns - skipped);
            if count == 0 {
                continue;
            }
            let rows = panel.columns + panel.below.len();
            let values = MatRef::from_column_major_slice(panel.values, rows, panel.columns);
            let own = values.submatrix(skipped, skipped, count, count);
            let mut top = x.as_mut().subrows_mut(first - self.interior, count);
            solve_lower_triangular_in_place(own, top.as_mut(), par);
            let below = values.submatrix(panel.columns, skipped, panel.below.len(), count);
            let product = below * top.as_ref();
            for (&i, row) in panel.below.iter().zip(product.row_iter()) {
                let to = x.as_mut().row_mut(i as usize - self.interior);
                for (x, p) in to.iter_mut().zip(row.iter()) {
                    *x -= p;
                }
            }
        }
    }

    /// x_I ← L_II⁻ᵀ (x_I − L_BIᵀ x_B): recovers the interior from what `forward` left there and
    /// the solution on B.
    pub fn backward(&self, x: &mut [f64]) {
        self.backward_before(self.interior, x);
    }

    /// x ← K⁻¹ x. Only where B wasn't shifted.
    pub fn solve(&self, x: &mut [f64]) {
        self.forward_before(x.len(), x);
        self.backward_before(x.len(), x);
    }

    /// `backward` with the first `count` unknowns in the place of I.
    fn backward_before(&self, count: usize, x: &mut [f64]) {
        for panel in self.panels().rev() {
            for j in (0..panel.columns_before(count)).rev() {
                let column = panel.column(j);
                let (top, bottom) = column.split_at(panel.columns);
                let inside = panel.start + j + 1..panel.start + panel.columns;
                let mut sum = x[panel.start + j];
                for (xi, l) in x[inside].iter().zip(&top[j + 1..]) {
                    sum -= l * xi;
                }
                for (&i, l) in panel.below.iter().zip(bottom) {
                    sum -= l * x[i as usize];
                }
                x[panel.start + j] = sum / column[j];
            }
        }
    }
}

/// The columns of one supernode: a dense lower trapezoid over its own rows and those `below`.
struct Panel<'a> {
    start: usize,
    columns: usize,
    below: &'a [u32],
    values: &'a [f64],
}

impl<'a> Panel<'a> {
    fn column(&self, j: usize) -> &'a [f64] {
        let rows = self.columns + self.below.len();
        &self.values[j * rows..(j + 1) * rows]
    }

    /// How many of its columns are among the first `count`; a supernode may reach from I into B.
    fn columns_before(&self, count: usize) -> usize {
        count.saturating_sub(self.start).min(self.columns)
    }
}

fn symbolic(matrix: &SparseSymmetric) -> Result<SymbolicSupernodalCholesky<u32>, FactorError> {
    let n = matrix.pattern.n();
    let (columns, rows) = matrix.pattern.upper();
    let upper = SymbolicSparseColMatRef::new_checked(n, n, &columns, None, &rows);
    let mut parents = vec![0i32; n];
    let mut counts = vec![0u32; n];
    let scratch = simplicial::prefactorize_symbolic_cholesky_scratch::<u32>(n, rows.len())
        .or(factorize_supernodal_symbolic_cholesky_scratch::<u32>(n));
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| FactorError::Size)?;
    let stack = MemStack::new(&mut memory);
    let tree = simplicial::prefactorize_symbolic_cholesky(&mut parents, &mut counts, upper, stack);
    factorize_supernodal_symbolic_cholesky(upper, tree, &counts, stack, Default::default())
        .map_err(|_| FactorError::Size)
}

#[cfg(test)]
mod tests {
    use faer::Side;
    use faer::linalg::solvers::Solve;

    use super::super::pattern::{Cliques, LowerPattern};
    use super::*;

    /// A chain of springs with stiffness 1, 2, 3 … between unknowns 0 … n − 1, the first one tied
    /// to the ground by 1.
    fn chain(n: usize) -> SparseSymmetric {
        let mut cliques = Cliques::default();
        for i in 0..n as u32 - 1 {
            cliques.push([i, i + 1]);
        }
        let mut matrix = SparseSymmetric::zeros(LowerPattern::new(n, &cliques).unwrap());
        for i in 0..n - 1 {
            let k = (i + 1) as f64;
            matrix.add(
                &[i as u32, i as u32 + 1],
                |a, b| if a == b { k } else { -k },
            );
        }
        matrix.add(&[0], |_, _| 1.0);
        matrix
    }

    fn dense(matrix: &SparseSymmetric) -> nalgebra::DMatrix<f64> {
        let n = matrix.pattern.n();
        let mut a = nalgebra::DMatrix::zeros(n, n);
        for j in 0..n {
            for (place, &i) in matrix.pattern.column(j).zip(matrix.pattern.rows_of(j)) {
                a[(i as usize, j)] = matrix.values[place];
                a[(j, i as usize)] = matrix.values[place];
            }
        }
        a
    }

    #[test]
    fn the_trailing_block_is_the_schur_complement() {
        let matrix = chain(12);
        let a = dense(&matrix);
        let shift = [3.0, 7.0, 2.0];
        let factor = BoundaryLastCholesky::new(matrix, 9, &shift, Par::Seq).unwrap();
        let s = factor.schur_complement(&shift, Par::Seq);
        let k_ii = a.view((0, 0), (9, 9)).clone_owned();
        let k_ib = a.view((0, 9), (9, 3)).clone_owned();
        let exact =
            a.view((9, 9), (3, 3)) - k_ib.transpose() * k_ii.cholesky().unwrap().solve(&k_ib);
        for i in 0..3 {
            for j in 0..3 {
                assert!((s[(i, j)] - exact[(i, j)]).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn forward_and_backward_solve_with_the_boundary_given() {
        let matrix = chain(10);
        let a = dense(&matrix);
        let factor = BoundaryLastCholesky::new(matrix, 7, &[0.0; 3], Par::Seq).unwrap();
        let exact = nalgebra::DVector::from_fn(10, |i, _| (i as f64).sin() + 2.0);
        let mut x: Vec<f64> = (&a * &exact).iter().copied().collect();
        factor.forward(&mut x);
        x[7..].copy_from_slice(&exact.as_slice()[7..]);
        factor.backward(&mut x);
        for (x, e) in x.iter().zip(exact.iter()) {
            assert!((x - e).abs() < 1e-12);
        }
    }

    #[test]
    fn half_of_a_solve_on_the_boundary_is_half_of_its_schur_complement() {
        let factor = BoundaryLastCholesky::new(chain(12), 8, &[0.0; 4], Par::Seq).unwrap();
        let s = factor.schur_complement(&[0.0; 4], Par::Seq);
        let x = Mat::from_fn(4, 3, |i, j| ((3 * i + 5 * j) as f64).sin());
        let mut w = x.clone();
        factor.forward_boundary(w.as_mut(), Par::Seq);
        let exact = x.transpose() * s.llt(Side::Lower).unwrap().solve(&x);
        assert!((w.transpose() * &w - exact).norm_max() < 1e-13);
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_refused() {
        let mut matrix = chain(4);
        matrix.add(&[2], |_, _| -100.0);
        let error = BoundaryLastCholesky::new(matrix, 4, &[], Par::Seq).unwrap_err();
        assert!(matches!(error, FactorError::Pivot(_)));
    }
}
