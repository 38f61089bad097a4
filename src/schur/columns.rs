//! Products of a vector with the columns of a matrix, several at a time.

use faer::MatRef;
use pulp::{Arch, Simd, WithSimd};

/// Columns that are multiplied together, so that the vector is read once for all.
pub(super) const WIDTH: usize = 4;

/// A x.
pub fn product(a: MatRef<'_, f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; a.nrows()];
    Arch::new().dispatch(Product { a, x, y: &mut y });
    y
}

/// Aᵀ x.
pub fn transposed_product(a: MatRef<'_, f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; a.ncols()];
    Arch::new().dispatch(TransposedProduct { a, x, y: &mut y });
    y
}

/// y ← y + A x.
struct Product<'a> {
    a: MatRef<'a, f64>,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let term = |j: usize| (self.x[j], column(self.a, j));
        let whole = self.x.len() / WIDTH * WIDTH;
        for j in (0..whole).step_by(WIDTH) {
            add_columns::<S, WIDTH>(simd, self.y, |p| term(j + p));
        }
        for j in whole..self.x.len() {
            add_columns::<S, 1>(simd, self.y, |_| term(j));
        }
    }
}

/// y ← Aᵀ x.
struct TransposedProduct<'a> {
    a: MatRef<'a, f64>,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for TransposedProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let whole = self.y.len() / WIDTH * WIDTH;
        for j in (0..whole).step_by(WIDTH) {
            let sums = dot_columns::<S, WIDTH>(simd, self.x, |p| column(self.a, j + p));
            self.y[j..j + WIDTH].copy_from_slice(&sums);
        }
        for j in whole..self.y.len() {
            [self.y[j]] = dot_columns::<S, 1>(simd, self.x, |_| column(self.a, j));
        }
    }
}

/// A column of a matrix, whose columns lie in one piece each.
fn column(a: MatRef<'_, f64>, j: usize) -> &[f64] {
    let column = a.col(j).try_as_col_major();
    column.map_or(&[], |column| column.as_slice())
}

/// The products of x with the columns that `column` gives, each as long as x.
#[inline(always)]
pub(super) fn dot_columns<'a, S: Simd, const N: usize>(
    simd: S,
    x: &[f64],
    column: impl Fn(usize) -> &'a [f64],
) -> [f64; N] {
    let (head, tail) = S::as_simd_f64s(x);
    let columns: [&[f64]; N] = std::array::from_fn(column);
    let parts = columns.map(|column| S::as_simd_f64s(column));
    let heads: [&[S::f64s]; N] = parts.map(|(part, _)| &part[..head.len()]);
    let mut sums = [simd.splat_f64s(0.0); N];
    for (i, &x) in head.iter().enumerate() {
        for p in 0..N {
            sums[p] = simd.mul_add_e_f64s(heads[p][i], x, sums[p]);
        }
    }
    if !tail.is_empty() {
        let x = simd.partial_load_f64s(tail);
        for p in 0..N {
            sums[p] = simd.mul_add_e_f64s(simd.partial_load_f64s(parts[p].1), x, sums[p]);
        }
    }
    sums.map(|sum| simd.reduce_sum_f64s(sum))
}

/// y ← y + Σ_p a_p c_p with the factors a_p and the columns c_p that `column` gives, each as long as y.
#[inline(always)]
pub(super) fn add_columns<'a, S: Simd, const N: usize>(
    simd: S,
    y: &mut [f64],
    column: impl Fn(usize) -> (f64, &'a [f64]),
) {
    let columns: [(f64, &[f64]); N] = std::array::from_fn(column);
    let factors = columns.map(|(x, _)| simd.splat_f64s(x));
    let parts = columns.map(|(_, column)| S::as_simd_f64s(column));
    let (head, tail) = S::as_mut_simd_f64s(y);
    let heads: [&[S::f64s]; N] = parts.map(|(part, _)| &part[..head.len()]);
    for (i, y) in head.iter_mut().enumerate() {
        let mut sum = *y;
        for p in 0..N {
            sum = simd.mul_add_e_f64s(factors[p], heads[p][i], sum);
        }
        *y = sum;
    }
    if !tail.is_empty() {
        let mut sum = simd.partial_load_f64s(tail);
        for p in 0..N {
            sum = simd.mul_add_e_f64s(factors[p], simd.partial_load_f64s(parts[p].1), sum);
        }
        simd.partial_store_f64s(tail, sum);
    }
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;

    #[test]
    fn products_are_those_of_the_definition() {
        for (m, n) in [(1, 1), (7, 4), (19, 9), (40, 3)] {
            let a = Mat::from_fn(m, n, |i, j| ((5 * i + 3 * j) % 7) as f64 - 3.0);
            let x: Vec<f64> = (0..n).map(|j| (j % 4) as f64 - 1.0).collect();
            let z: Vec<f64> = (0..m).map(|i| (i % 5) as f64 - 2.0).collect();
            let y: Vec<f64> = (0..m)
                .map(|i| (0..n).map(|j| a[(i, j)] * x[j]).sum())
                .collect();
            let w: Vec<f64> = (0..n)
                .map(|j| (0..m).map(|i| a[(i, j)] * z[i]).sum())
                .collect();
            assert_eq!(product(a.as_ref(), &x), y);
            assert_eq!(transposed_product(a.as_ref(), &z), w);
        }
    }
}
