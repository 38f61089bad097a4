//! The first columns of a dense Cholesky factor, packed, and substitution with them.

use faer::{Mat, Par};
use pulp::{Arch, Simd, WithSimd};

use super::columns::{Number, WIDTH};
use super::front::partial_cholesky;
use super::panel::packed_len;

/// Error: the block of the unknowns to eliminate isn't positive definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotDefinite;

/// L above P of a partially eliminated symmetric matrix, in single precision if the values are `f32`.
#[derive(Clone, Debug)]
pub struct Trapezoid<T> {
    rows: usize,
    /// The diagonal of L.
    pivots: Vec<f64>,
    /// Columns divided by their pivots, packed, each from the diagonal on.
    values: Vec<T>,
}

impl<T: Number> Trapezoid<T> {
    /// Eliminates the first `count` unknowns of a symmetric matrix, given by its lower triangle, and returns the matrix
    /// with the lower triangle of the Schur complement in the place of the others.
    ///
    /// # Errors
    /// The block of these unknowns isn't positive definite.
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
        let pivots: Vec<f64> = (0..count).map(|j| matrix[(j, j)]).collect();
        for (j, pivot) in pivots.iter().enumerate() {
            let column = matrix.col_as_slice(j)[j..].iter();
            values.extend(column.map(|l| T::of(l / pivot)));
        }
        let trapezoid = Self {
            rows,
            pivots,
            values,
        };
        Ok((trapezoid, matrix))
    }

    /// The smallest pivot relative to the entries of the `diagonal`, min L_jj² / d_j.
    pub fn smallest_pivot(&self, diagonal: &[f64]) -> f64 {
        let pivots = self.pivots.iter().zip(diagonal);
        let relative = pivots.map(|(pivot, d)| pivot.powi(2) / d);
        relative.fold(f64::INFINITY, f64::min)
    }

    /// Number of eliminated unknowns.
    pub fn eliminated(&self) -> usize {
        self.pivots.len()
    }

    /// Number of all unknowns.
    pub fn size(&self) -> usize {
        self.rows
    }

    /// Forward substitution, which condenses a load onto the other unknowns: x ← [L⁻¹ x_1; x_2 − P L⁻¹ x_1].
    pub fn forward(&self, x: &mut [f64]) {
        in_precision(x, |x: &mut [T]| {
            Arch::new().dispatch(Forward { factor: self, x });
        });
        self.scale(x);
    }

    /// Back-substitution for the first unknowns with the others known: x_1 ← L⁻ᵀ (x_1 − Pᵀ x_2).
    pub fn backward(&self, x: &mut [f64]) {
        self.scale(x);
        in_precision(x, |x: &mut [T]| {
            Arch::new().dispatch(Backward { factor: self, x });
        });
    }

    /// Divides the first unknowns by their pivots.
    fn scale(&self, x: &mut [f64]) {
        let pivots = x.iter_mut().zip(&self.pivots);
        pivots.for_each(|(x, pivot)| *x /= pivot);
    }

    /// Column j from row `first` on.
    fn column(&self, j: usize, first: usize) -> &[T] {
        let begin = packed_len(self.rows, j);
        &self.values[begin + first - j..begin + self.rows - j]
    }
}

/// Applies `change` to x in another precision, scaled against overflow and underflow.
fn in_precision<T: Number>(x: &mut [f64], change: impl FnOnce(&mut [T])) {
    let largest = x.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let scale = match largest > 0.0 && largest.is_finite() {
        true => largest.log2().floor().exp2(),
        false => 1.0,
    };
    let mut scaled: Vec<T> = x.iter().map(|x| T::of(x / scale)).collect();
    change(&mut scaled);
    let back = x.iter_mut().zip(scaled);
    back.for_each(|(x, y)| *x = y.value() * scale);
}

struct Forward<'a, T> {
    factor: &'a Trapezoid<T>,
    x: &'a mut [T],
}

impl<T: Number> WithSimd for Forward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { factor, x } = self;
        let count = factor.eliminated();
        for j in (0..count).step_by(WIDTH) {
            let end = (j + WIDTH).min(count);
            let (before, rest) = x.split_at_mut(end);
            for p in j..end {
                let column = factor.column(p, p);
                for i in p + 1..end {
                    let term = column[i - p] * before[p];
                    before[i] -= term;
                }
            }
            let term = |p: usize| (-before[p], factor.column(p, end));
            match end - j {
                WIDTH => T::add::<S, WIDTH>(simd, rest, |p| term(j + p)),
                _ => (j..end).for_each(|p| T::add::<S, 1>(simd, rest, |_| term(p))),
            }
        }
    }
}

struct Backward<'a, T> {
    factor: &'a Trapezoid<T>,
    x: &'a mut [T],
}

impl<T: Number> WithSimd for Backward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { factor, x } = self;
        let count = factor.eliminated();
        for j in (0..count).step_by(WIDTH).rev() {
            let end = (j + WIDTH).min(count);
            let (before, rest) = x.split_at_mut(end);
            let column = |p: usize| factor.column(p, end);
            let mut sums = [T::default(); WIDTH];
            match end - j {
                WIDTH => sums = T::dot::<S, WIDTH>(simd, rest, |p| column(j + p)),
                count => {
                    for (p, sum) in sums[..count].iter_mut().enumerate() {
                        [*sum] = T::dot::<S, 1>(simd, rest, |_| column(j + p));
                    }
                }
            }
            for p in (j..end).rev() {
                let column = factor.column(p, p);
                let within = (p + 1..end).map(|i| column[i - p] * before[i]);
                let within: T = within.sum();
                before[p] -= sums[p - j];
                before[p] -= within;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use faer::linalg::solvers::Solve;

    use super::*;

    /// The largest error of a solution with factors of this precision.
    fn error<T: Number>(n: usize, count: usize) -> f64 {
        let root = Mat::from_fn(n, n, |i, j| ((17 * i + 5 * j) as f64).sin());
        let a = &root * root.transpose() + Mat::<f64>::identity(n, n);
        let b: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
        let (factor, whole) = Trapezoid::<T>::new(a.clone(), count, Par::Seq).unwrap();
        let s = whole.submatrix(count, count, n - count, n - count);
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
        let differences = (0..n).map(|i| (x[i] - exact[(i, 0)]).abs());
        differences.fold(0.0, f64::max)
    }

    #[test]
    fn eliminating_some_and_solving_for_the_rest_solves_for_all() {
        for (n, count) in [(1, 1), (9, 4), (23, 18), (23, 23), (40, 7)] {
            assert!(error::<f64>(n, count) < 1e-12);
            assert!(error::<f32>(n, count) < 1e-4);
        }
    }
}
