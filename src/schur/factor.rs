//! Sparse multifrontal Cholesky factorization with the boundary ordered last.
//!
//! In K = L Lᵀ with the unknowns ordered [I | B], L_II solves on the interior and L_BI condenses loads; the update that
//! the fronts of I leave on B is the Schur complement, S_BB = K_BB − K_BI K_II⁻¹ K_IB.

use faer::{Mat, MatMut, Par};

use super::coupling::Coupling;
use super::fronts::Fronts;
use super::panel::Panel;
use super::pattern::SparseSymmetric;
use super::supernodes::Supernodes;

/// Reason why a matrix couldn't be factorized.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FactorError {
    /// The matrix isn't positive definite.
    #[error("the pivot of unknown {0} isn't positive")]
    Pivot(usize),
    /// The factor needs more memory than available, or has more than 2³² entries.
    #[error("the factor is too large")]
    Size,
}

/// Entries of L_BI up to which it is kept, 1 MB: loads are condensed a little more accurately with it.
const LARGE: usize = 1 << 17;

/// The Cholesky factor of a matrix whose last unknowns are its boundary B.
#[derive(Debug)]
pub struct BoundaryLastCholesky {
    supernodes: Supernodes,
    values: Vec<f64>,
    interior: usize,
    smallest_pivot: f64,
    /// K_BI, where the factor has no L_BI: L_BI = K_BI L_II⁻ᵀ.
    coupling: Option<Coupling>,
}

impl BoundaryLastCholesky {
    /// Factorizes all of `matrix`, whose first `interior` unknowns are I.
    ///
    /// # Errors
    /// The matrix isn't positive definite, or the factor is too large.
    pub fn new(matrix: &SparseSymmetric, interior: usize, par: Par) -> Result<Self, FactorError> {
        let n = matrix.pattern.n();
        let mut nothing = Mat::new();
        let mut factor = Self::eliminate(matrix, n, nothing.as_mut(), par)?;
        factor.interior = interior;
        Ok(factor)
    }

    /// Factorizes the first `interior` columns of `matrix` only, and returns the lower triangle of S_BB with the
    /// factor, which has no L_BB, and no L_BI either where that is large and has more entries than L_II and K_BI.
    ///
    /// # Errors
    /// K_II isn't positive definite, or the factor is too large.
    pub fn condense(
        matrix: &SparseSymmetric,
        interior: usize,
        par: Par,
    ) -> Result<(Self, Mat<f64>), FactorError> {
        let m = matrix.pattern.n() - interior;
        let mut s = Mat::zeros(m, m);
        for j in 0..m {
            let column = matrix.pattern.column(interior + j);
            for (place, &i) in column.zip(matrix.pattern.rows_of(interior + j)) {
                s[(i as usize - interior, j)] = matrix.values[place];
            }
        }
        let factor = Self::eliminate(matrix, interior, s.as_mut(), par)?;
        Ok((factor, s))
    }

    /// Eliminates the first `count` unknowns and adds their update to the lower triangle of `rest`.
    fn eliminate(
        matrix: &SparseSymmetric,
        count: usize,
        rest: MatMut<'_, f64>,
        par: Par,
    ) -> Result<Self, FactorError> {
        let supernodes = Supernodes::new(&matrix.pattern, count);
        let (within, coupling) = (supernodes.before(count), Coupling::new(matrix, count));
        let beyond = supernodes.values() - within.values();
        let is_worth_it = beyond > LARGE && beyond > within.values() + coupling.len();
        let (kept, coupling) = match is_worth_it {
            true => (within, Some(coupling)),
            false => (supernodes.clone(), None),
        };
        let mut values = Vec::new();
        values
            .try_reserve_exact(kept.values())
            .map_err(|_| FactorError::Size)?;
        Fronts::new(matrix, &supernodes, count)
            .run(&kept, &mut values, rest, par)
            .map_err(FactorError::Pivot)?;
        let mut factor = Self {
            supernodes: kept,
            values,
            interior: count,
            smallest_pivot: f64::INFINITY,
            coupling,
        };
        factor.smallest_pivot = factor.find_smallest_pivot(matrix, count);
        Ok(factor)
    }

    /// The smallest pivot of the eliminated unknowns relative to its diagonal entry, min L_jj² / K_jj: a measure of the
    /// distance to a singular matrix that doesn't depend on scaling.
    pub fn smallest_pivot(&self) -> f64 {
        self.smallest_pivot
    }

    fn find_smallest_pivot(&self, matrix: &SparseSymmetric, count: usize) -> f64 {
        let mut smallest = f64::INFINITY;
        for panel in self.panels() {
            for j in 0..panel.columns_before(count) {
                let diagonal = matrix.pattern.column(panel.start + j).start;
                let pivot = panel.column(j)[0].powi(2) / matrix.values[diagonal];
                smallest = smallest.min(pivot);
            }
        }
        smallest
    }

    fn panels(&self) -> impl DoubleEndedIterator<Item = Panel<'_>> {
        (0..self.supernodes.len()).map(|s| {
            let columns = self.supernodes.columns(s);
            Panel {
                start: columns.start,
                columns: columns.len(),
                below: self.supernodes.below(s),
                values: &self.values[self.supernodes.places(s)],
            }
        })
    }

    /// x_I ← L_II⁻¹ x_I and x_B ← x_B − L_BI x_I: condenses a load onto B.
    pub fn forward(&self, x: &mut [f64]) {
        self.forward_before(self.interior, x);
        if let Some(k_bi) = &self.coupling {
            let (x_i, x_b) = x.split_at_mut(self.interior);
            let mut u_i = x_i.to_vec();
            self.backward_before(self.interior, &mut u_i);
            k_bi.subtract_product(&u_i, x_b);
        }
    }

    /// Forward substitution with the first `count` unknowns as I.
    fn forward_before(&self, count: usize, x: &mut [f64]) {
        let mut work = Vec::new();
        for panel in self.panels() {
            panel.forward(panel.columns_before(count), x, &mut work);
        }
    }

    /// X ← L_BB⁻¹ X, where X has a row for every unknown of B; only if B was factorized.
    pub fn forward_boundary(&self, mut x: MatMut<'_, f64>, par: Par) {
        for panel in self.panels() {
            panel.forward_boundary(self.interior, x.as_mut(), par);
        }
    }

    /// x_I ← L_II⁻ᵀ (x_I − L_BIᵀ x_B): recovers the interior from the result of `forward` on I and the solution on B.
    pub fn backward(&self, x: &mut [f64]) {
        if let Some(k_bi) = &self.coupling {
            let (x_i, x_b) = x.split_at_mut(self.interior);
            let mut reduced = k_bi.transposed_product(x_b);
            self.forward_before(self.interior, &mut reduced);
            for (x, reduced) in x_i.iter_mut().zip(reduced) {
                *x -= reduced;
            }
        }
        self.backward_before(self.interior, x);
    }

    /// x ← K⁻¹ x; only if B was factorized.
    pub fn solve(&self, x: &mut [f64]) {
        debug_assert_eq!(
            self.supernodes.begin.last().copied().unwrap_or(0) as usize,
            x.len()
        );
        self.forward_before(x.len(), x);
        self.backward_before(x.len(), x);
    }

    /// `backward` with the first `count` unknowns as I.
    fn backward_before(&self, count: usize, x: &mut [f64]) {
        let mut work = Vec::new();
        for panel in self.panels().rev() {
            panel.backward(panel.columns_before(count), x, &mut work);
        }
    }
}

#[cfg(test)]
mod tests {
    use faer::Side;
    use faer::linalg::solvers::Solve;

    use super::super::pattern::{Cliques, LowerPattern};
    use super::*;

    /// A chain of springs with stiffness 1, 2, 3 … between unknowns 0 … n − 1; a spring of stiffness 1 connects the
    /// first one to the ground.
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
    fn what_the_interior_leaves_is_the_schur_complement() {
        let matrix = chain(12);
        let a = dense(&matrix);
        let (_, s) = BoundaryLastCholesky::condense(&matrix, 9, Par::Seq).unwrap();
        let k_ii = a.view((0, 0), (9, 9)).clone_owned();
        let k_ib = a.view((0, 9), (9, 3)).clone_owned();
        let exact =
            a.view((9, 9), (3, 3)) - k_ib.transpose() * k_ii.cholesky().unwrap().solve(&k_ib);
        for i in 0..3 {
            for j in 0..=i {
                assert!((s[(i, j)] - exact[(i, j)]).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn forward_and_backward_solve_with_the_boundary_given() {
        let matrix = chain(10);
        let a = dense(&matrix);
        let factor = BoundaryLastCholesky::new(&matrix, 7, Par::Seq).unwrap();
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
    fn a_long_boundary_is_coupled_by_the_matrix_itself() {
        // Rungs between two chains: L_BI is full, K_BI has an entry a column.
        let (n, interior) = (1200, 600);
        let mut cliques = Cliques::default();
        let bars = |i: u32| [[i, i + 1], [i, i + 600], [i + 599, i + 600]];
        (0..599).flat_map(bars).for_each(|bar| cliques.push(bar));
        let mut matrix = SparseSymmetric::zeros(LowerPattern::new(n, &cliques).unwrap());
        for bar in (0..599).flat_map(bars) {
            let k = f64::from(1 + bar[1] % 7);
            matrix.add(&bar, |a, b| if a == b { k } else { -k });
        }
        matrix.add(&[0], |_, _| 1.0);
        let (factor, s) = BoundaryLastCholesky::condense(&matrix, interior, Par::Seq).unwrap();
        assert!(factor.coupling.is_some());
        let whole = Supernodes::new(&matrix.pattern, interior);
        assert!(2 * factor.values.len() < whole.values());

        let a = dense(&matrix);
        let exact = nalgebra::DVector::from_fn(n, |i, _| (i as f64).sin() + 2.0);
        let load: Vec<f64> = (&a * &exact).iter().copied().collect();
        let mut x = load.clone();
        factor.forward(&mut x);
        for i in interior..n {
            let entry = |j: usize| s[(i.max(j) - interior, i.min(j) - interior)];
            let held: f64 = (interior..n).map(|j| entry(j) * exact[j]).sum();
            assert!((held - x[i]).abs() < 1e-12, "{i}: {held}, {}", x[i]);
        }
        x[interior..].copy_from_slice(&exact.as_slice()[interior..]);
        factor.backward(&mut x);
        for (x, e) in x.iter().zip(exact.iter()) {
            assert!((x - e).abs() < 1e-12);
        }
    }

    #[test]
    fn half_of_a_solve_on_the_boundary_is_half_of_its_schur_complement() {
        let factor = BoundaryLastCholesky::new(&chain(12), 8, Par::Seq).unwrap();
        let (_, s) = BoundaryLastCholesky::condense(&chain(12), 8, Par::Seq).unwrap();
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
        let error = BoundaryLastCholesky::new(&matrix, 4, Par::Seq).unwrap_err();
        assert!(matches!(error, FactorError::Pivot(_)));
    }
}
