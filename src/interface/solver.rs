//! The linear interface problem A x = b with A = S_0 + S_CON' of the bilateral problem (16), solved directly.

use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, Mat, MatMut, Par};

use crate::schur::factor::BoundaryLastCholesky;

/// A = L Lᵀ.
#[derive(Debug)]
pub struct DirectSolver {
    factor: BoundaryLastCholesky,
    par: Par,
}

impl DirectSolver {
    /// The solver with the factor of A.
    pub fn new(factor: BoundaryLastCholesky, par: Par) -> Self {
        Self { factor, par }
    }

    /// x ← A⁻¹ x.
    pub fn solve(&self, x: &mut [f64]) {
        self.factor.solve(x);
    }

    /// H ← H − Wᵀ A⁻¹ W, lower triangle only; W has rows for the last unknowns only, the others are 0.
    pub fn condense(&self, mut w: Mat<f64>, h: MatMut<'_, f64>) {
        // Wᵀ A⁻¹ W = (L⁻¹ W)ᵀ L⁻¹ W takes half of a solve; rows above those of W remain 0.
        self.factor.forward_boundary(w.as_mut(), self.par);
        triangular::matmul(
            h,
            BlockStructure::TriangularLower,
            Accum::Add,
            w.transpose(),
            BlockStructure::Rectangular,
            w.as_ref(),
            BlockStructure::Rectangular,
            -1.0,
            self.par,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schur::pattern::{Cliques, LowerPattern, SparseSymmetric};

    const N: usize = 5;

    /// A chain of springs whose last node is held.
    fn solver() -> DirectSolver {
        let mut cliques = Cliques::default();
        (1..N as u32).for_each(|i| cliques.push([i - 1, i]));
        let mut a = SparseSymmetric::zeros(LowerPattern::new(N, &cliques).unwrap());
        for i in 1..N as u32 {
            a.add(&[i - 1, i], |i, j| if i == j { 1.0 } else { -1.0 });
        }
        a.add(&[N as u32 - 1], |_, _| 2.0);
        DirectSolver::new(
            BoundaryLastCholesky::new(&a, 2, Par::Seq).unwrap(),
            Par::Seq,
        )
    }

    #[test]
    fn a_chain_of_springs_gives_way_by_the_sum_of_its_parts() {
        let mut x = vec![1.0, 0.0, 0.0, 0.0, 0.0];
        solver().solve(&mut x);
        let expected = [4.5, 3.5, 2.5, 1.5, 0.5];
        assert!(x.iter().zip(expected).all(|(x, e)| (x - e).abs() < 1e-14));
    }

    #[test]
    fn condensing_takes_off_what_solving_says() {
        let w = Mat::from_fn(N - 2, 2, |i, j| (1.0 + i as f64).powi(j as i32 + 1));
        let mut h = Mat::zeros(2, 2);
        solver().condense(w.clone(), h.as_mut());
        let whole = Mat::from_fn(N, 2, |i, j| if i < 2 { 0.0 } else { w[(i - 2, j)] });
        let mut x = whole.clone();
        (0..2).for_each(|j| solver().solve(x.col_as_slice_mut(j)));
        let expected = whole.transpose() * x;
        for (i, j) in [(0, 0), (1, 0), (1, 1)] {
            assert!((h[(i, j)] + expected[(i, j)]).abs() < 1e-11, "{h:?}");
        }
    }
}
