//! A sparse system of equations, solved by LU and refined with twice the digits of double precision.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::Lu;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Par};

use super::twofold::Twofold;

/// Most corrections of a solution.
const REFINEMENTS: usize = 12;

/// A sparse matrix with its factor.
pub struct SparseSystem {
    entries: Vec<Triplet<usize, usize, f64>>,
    lu: Lu<usize, f64>,
    n: usize,
}

impl SparseSystem {
    /// The system of `n` equations, with `slack` in the factor's rows from `first` on.
    pub fn new(
        n: usize,
        entries: Vec<Triplet<usize, usize, f64>>,
        first: usize,
        slack: f64,
    ) -> Self {
        faer::set_global_parallelism(Par::Seq);
        let mut factorized = entries.clone();
        factorized.extend((first..n).map(|row| Triplet::new(row, row, -slack)));
        let matrix = SparseColMat::try_new_from_triplets(n, n, &factorized).unwrap();
        let lu = matrix.sp_lu().unwrap();
        Self { entries, lu, n }
    }

    /// The solution, refined.
    pub fn solve(&self, rhs: &[f64]) -> Vec<f64> {
        let n = self.n;
        let mut x = vec![0.0; n];
        let mut last = f64::INFINITY;
        for _ in 0..REFINEMENTS {
            let mut sums = vec![Twofold::default(); n];
            for (sum, b) in sums.iter_mut().zip(rhs) {
                sum.add(*b);
            }
            for t in &self.entries {
                sums[t.row].add_product(-t.val, x[t.col]);
            }
            let residual = Mat::from_fn(n, 1, |i, _| sums[i].value());
            let correction = self.lu.solve(&residual);
            let largest = |m: f64, x: &f64| m.max(x.abs());
            let change = (0..n).fold(0.0, |m, i| largest(m, &correction[(i, 0)]));
            // A growing correction means that the matrix is singular to round-off.
            if !change.is_finite() || change > last {
                break;
            }
            for (i, x) in x.iter_mut().enumerate() {
                *x += correction[(i, 0)];
            }
            if change <= f64::EPSILON * x.iter().fold(0.0, largest) {
                break;
            }
            last = change;
        }
        x
    }
}
