//! Sums, products and norms of vectors.

use std::collections::BTreeMap;

/// x·y over the components that both vectors have.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// y ← y + a x, over the components that both vectors have.
#[inline]
pub fn axpy(a: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

/// y ← y + a x, for vectors in parts, over the parts that both have.
pub fn add_multiple<K: Ord>(a: f64, x: &BTreeMap<K, Vec<f64>>, y: &mut BTreeMap<K, Vec<f64>>) {
    for (key, y) in y {
        if let Some(x) = x.get(key) {
            axpy(a, x, y);
        }
    }
}

/// a x, for a vector in parts.
pub fn multiple<K: Copy + Ord>(a: f64, x: &BTreeMap<K, Vec<f64>>) -> BTreeMap<K, Vec<f64>> {
    let parts = x.iter();
    parts
        .map(|(&key, x)| (key, x.iter().map(|x| a * x).collect()))
        .collect()
}

/// The vector x + `part` (y − x).
pub fn between(x: &[f64], y: &[f64], part: f64) -> Vec<f64> {
    x.iter().zip(y).map(|(x, y)| x + part * (y - x)).collect()
}

/// Fraction of the largest scale, of the load or of the load steps before, below which a scale is that of round-off.
pub const NOTHING: f64 = 1e-12;

/// ‖x‖∞; NaN if x contains a NaN.
pub fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, &x| larger(most, x))
}

/// max(|a|, |b|); NaN if either is.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.abs().max(b.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_not_lost_among_numbers() {
        assert_eq!(largest(&[1.0, -3.0, 2.0]), 3.0);
        assert!(largest(&[1.0, f64::NAN, 2.0]).is_nan());
        assert!(larger(f64::NAN, 1.0).is_nan() && larger(1.0, f64::NAN).is_nan());
    }
}
