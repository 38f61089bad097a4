//! The first columns of a dense Cholesky factor, packed, and solving with them.

use faer::{Mat, Par};
use pulp::{Arch, Simd, WithSimd};

use super::columns::{WIDTH, add_columns, dot_columns};
use super::front::partial_cholesky;
use super::panel::packed_len;

/// A symmetric matrix isn't positive definite where its first unknowns are eliminated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotDefinite;

/// L above P of a symmetric matrix whose first unknowns are eliminated, column after column, each from the diagonal on.
#[derive(Clone, Debug)]
pub struct Trapezoid {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Trapezoid {
    /// Eliminates the first `count` unknowns of a symmetric matrix, whose lower triangle counts, and returns what they
    /// leave to the others, its lower triangle.
    ///
    /// # Errors
    /// It isn't positive definite there.
    pub fn new(
        mut matrix: Mat<f64>,
        count: usize,
        par: Par,
    ) -> Result<(Self, Mat<f64>), NotDefinite> {
        let rows = matrix.nrows();
        let (columns, rest) = matrix.as_mut().split_at_col_mut(count);
        let mut rest = rest.subrows_mut(count, rows - count);
        partial_cholesky(columns, rest.as_mut(), par).map_err(|_| NotDefinite)?;
        let mut values = Vec::with_capacity(packed_len(rows, count));
        for j in 0..count {
            values.extend_from_slice(&matrix.col_as_slice(j)[j..]);
        }
        let s = match count {
            0 => matrix,
            _ => matrix
                .submatrix(count, count, rows - count, rows - count)
                .to_owned(),
        };
        let trapezoid = Self {
            rows,
            columns: count,
            values,
        };
        Ok((trapezoid, s))
    }

    /// The smallest pivot relative to the entries of the `diagonal`, min L_jj² / d_j.
    pub fn smallest_pivot(&self, diagonal: &[f64]) -> f64 {
        let pivot = |(j, d): (usize, &f64)| self.column(j, j)[0].powi(2) / d;
        let pivots = diagonal.iter().enumerate().map(pivot);
        pivots.fold(f64::INFINITY, f64::min)
    }

    /// Number of unknowns that are eliminated.
    pub fn eliminated(&self) -> usize {
        self.columns
    }

    /// Number of all unknowns.
    pub fn size(&self) -> usize {
        self.rows
    }

    /// Carries a load on the first unknowns to the others: x ← [L⁻¹ x_1; x_2 − P L⁻¹ x_1].
    pub fn forward(&self, x: &mut [f64]) {
        Arch::new().dispatch(Forward { factor: self, x });
    }

    /// Solves for the first unknowns where the others are known: x_1 ← L⁻ᵀ (x_1 − Pᵀ x_2).
    pub fn backward(&self, x: &mut [f64]) {
        Arch::new().dispatch(Backward { factor: self, x });
    }

    /// Column j from row `first` on.
    fn column(&self, j: usize, first: usize) -> &[f64] {
        let begin = packed_len(self.rows, j);
        &self.values[begin + first - j..begin + self.rows - j]
    }
}

struct Forward<'a> {
    factor: &'a Trapezoid,
    x: &'a mut [f64],
}

impl WithSimd for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { factor, x } = self;
        for j in (0..factor.columns).step_by(WIDTH) {
            let end = (j + WIDTH).min(factor.columns);
            let (before, rest) = x.split_at_mut(end);
            for p in j..end {
                let column = factor.column(p, p);
                before[p] /= column[0];
                for i in p + 1..end {
                    before[i] -= column[i - p] * before[p];
                }
            }
            let term = |p: usize| (-before[p], factor.column(p, end));
            match end - j {
                WIDTH => add_columns::<S, WIDTH>(simd, rest, |p| term(j + p)),
                _ => (j..end).for_each(|p| add_columns::<S, 1>(simd, rest, |_| term(p))),
            }
        }
    }
}

struct Backward<'a> {
    factor: &'a Trapezoid,
    x: &'a mut [f64],
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { factor, x } = self;
        for j in (0..factor.columns).step_by(WIDTH).rev() {
            let end = (j + WIDTH).min(factor.columns);
            let (before, rest) = x.split_at_mut(end);
            let column = |p: usize| factor.column(p, end);
            let mut sums = [0.0; WIDTH];
            match end - j {
                WIDTH => sums = dot_columns::<S, WIDTH>(simd, rest, |p| column(j + p)),
                count => {
                    for (p, sum) in sums[..count].iter_mut().enumerate() {
                        [*sum] = dot_columns::<S, 1>(simd, rest, |_| column(j + p));
                    }
                }
            }
            for p in (j..end).rev() {
                let column = factor.column(p, p);
                let within = (p + 1..end).map(|i| column[i - p] * before[i]);
                before[p] = (before[p] - sums[p - j] - within.sum::<f64>()) / column[0];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use faer::linalg::solvers::Solve;

    use super::*;

    #[test]
    fn eliminating_some_and_solving_for_the_rest_solves_for_all() {
        for (n, count) in [(1, 1), (9, 4), (23, 18), (23, 23), (40, 7)] {
            let root = Mat::from_fn(n, n, |i, j| ((17 * i + 5 * j) as f64).sin());
            let a = &root * root.transpose() + Mat::<f64>::identity(n, n);
            let b: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
            let (factor, s) = Trapezoid::new(a.clone(), count, Par::Seq).unwrap();
            let mut x = b.clone();
            factor.forward(&mut x);
            if count < n {
                let rest = Mat::from_fn(n - count, 1, |i, _| x[count + i]);
                let rest = s.llt(faer::Side::Lower).unwrap().solve(&rest);
                (count..n).for_each(|i| x[i] = rest[(i - count, 0)]);
            }
            factor.backward(&mut x);
            let exact = a
                .llt(faer::Side::Lower)
                .unwrap()
                .solve(&Mat::from_fn(n, 1, |i, _| b[i]));
            (0..n).for_each(|i| assert!((x[i] - exact[(i, 0)]).abs() < 1e-12));
        }
    }
}
