//! A few columns at once, so that what they are added to is read and written once for all.

use pulp::Simd;

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
