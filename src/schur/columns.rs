//! Products of a vector with the columns of a matrix, several at a time.

use pulp::Simd;

/// Columns that are multiplied together, so that the vector is read once for all.
pub(super) const WIDTH: usize = 4;

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
