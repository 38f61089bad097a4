//! min ‖b − A λ‖₂ over λ ≥ 0, non-negative least squares: can contact forces balance a load?

use faer::Mat;
use nalgebra::{DMatrix, DVector};

use super::columns::Columns;

/// Slope along a column, relative to b, that is round-off of r.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// r = b − A λ for the λ ≥ 0 that minimizes ‖r‖₂, after Lawson and Hanson.
///
/// r = 0 up to round-off where b lies in the cone of A's columns; otherwise Aᵀ r ≤ 0 and
/// b·r = ‖r‖² > 0: a direction along which b drives and no column resists (Farkas).
pub fn residual(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    let n = a.ncols();
    let norms: Vec<f64> = a.column_iter().map(|c| c.norm()).collect();
    let largest = norms.iter().copied().fold(0.0, f64::max);
    // A column that is round-off would have a direction all the same.
    let is_column: Vec<bool> = norms.iter().map(|&norm| norm > 1e-12 * largest).collect();
    let mut point = Point {
        passive: Columns::default(),
        lambda: vec![0.0; n],
        r: b.clone(),
    };
    // Columns whose slope has turned out to be round-off where r is.
    let mut is_tried = vec![false; n];
    for _ in 0..10 * (n + a.nrows()) + 10 {
        let slopes = a.tr_mul(&point.r);
        let best = (0..n)
            .filter(|&j| is_column[j] && !is_tried[j] && point.lambda[j] == 0.0)
            .map(|j| (slopes[j] / norms[j], j))
            .max_by(|x, y| x.0.total_cmp(&y.0).then(y.1.cmp(&x.1)));
        let Some((steepest, entering)) = best else {
            break;
        };
        if steepest <= ROUND_OFF * b.norm() {
            break;
        }
        match point.entered(a, b, entering) {
            Some(nearer) => {
                point = nearer;
                is_tried.fill(false);
            }
            None => is_tried[entering] = true,
        }
    }
    point.r
}

/// The same r where that is zero, or nearly so: found where A's rows are orthonormal, so that it
/// tells a direction in which columns hardly act from one in which they don't.
///
/// With A = V Σ Uᵀ, A λ = b where Uᵀ λ = Σ⁻¹ Vᵀ b; what is left there is V Σ times it here. What
/// A's columns don't span at all, singular values up to `least` of the largest, is left out.
pub fn residual_in_span(a: &DMatrix<f64>, b: &DVector<f64>, least: f64) -> Option<DVector<f64>> {
    let rows = Mat::from_fn(a.ncols(), a.nrows(), |i, j| a[(j, i)]);
    let svd = rows.thin_svd().ok()?;
    let (u, sizes, v) = (svd.U(), svd.S().column_vector(), svd.V());
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    let kept: Vec<usize> = (0..sizes.nrows())
        .filter(|&i| sizes[i] > least * largest)
        .collect();
    let turned = DMatrix::from_fn(kept.len(), a.ncols(), |k, j| u[(j, kept[k])]);
    let along = |i: usize| (0..a.nrows()).map(|row| v[(row, i)] * b[row]).sum::<f64>();
    let scaled = DVector::from_fn(kept.len(), |k, _| along(kept[k]) / sizes[kept[k]]);
    let left = residual(&turned, &scaled);
    let back = |row: usize| {
        let terms = kept.iter().zip(left.iter());
        terms.map(|(&i, left)| v[(row, i)] * sizes[i] * left).sum()
    };
    Some(DVector::from_fn(a.nrows(), |row, _| back(row)))
}

/// A λ ≥ 0 whose positive entries, those of the passive columns, come nearest to b.
#[derive(Clone)]
struct Point {
    passive: Columns,
    lambda: Vec<f64>,
    r: DVector<f64>,
}

impl Point {
    /// The point with a column more, and without those whose λ would become negative; `None` where
    /// that is no nearer to b.
    fn entered(&self, a: &DMatrix<f64>, b: &DVector<f64>, entering: usize) -> Option<Self> {
        let mut point = self.clone();
        let Self { passive, lambda, r } = &mut point;
        if !passive.push(a, entering) {
            return None;
        }
        loop {
            let trial = passive.solve(b);
            let blocking = (passive.numbers.iter().zip(&trial))
                .filter(|(_, t)| **t <= 0.0)
                .map(|(&j, t)| lambda[j] / (lambda[j] - t))
                .fold(f64::INFINITY, f64::min);
            if blocking.is_infinite() {
                for (&j, t) in passive.numbers.iter().zip(&trial) {
                    lambda[j] = *t;
                }
                break;
            }
            let step = if blocking.is_nan() { 0.0 } else { blocking };
            for (&j, t) in passive.numbers.iter().zip(&trial) {
                lambda[j] += step * (t - lambda[j]);
            }
            let largest = lambda.iter().fold(0.0, |m: f64, l| m.max(l.abs()));
            for place in (0..passive.numbers.len()).rev() {
                let j = passive.numbers[place];
                if lambda[j] <= 1e-14 * largest {
                    lambda[j] = 0.0;
                    passive.remove(place);
                }
            }
            if passive.numbers.is_empty() {
                break;
            }
        }
        *r = passive.residual(b);
        (r.norm() < self.r.norm()).then_some(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_within_the_cone_is_balanced() {
        let a = DMatrix::from_row_slice(2, 3, &[1.0, 0.0, -1.0, 0.0, 1.0, 1.0]);
        let b = DVector::from_column_slice(&[-0.5, 2.0]);
        assert!(residual(&a, &b).norm() < 1e-14);
    }

    #[test]
    fn a_load_outside_the_cone_drives_along_its_residual() {
        let a = DMatrix::from_row_slice(2, 3, &[1.0, 1.0, 2.0, 0.0, 1.0, 1.0]);
        let b = DVector::from_column_slice(&[-1.0, -0.5]);
        let r = residual(&a, &b);
        assert!((b.dot(&r) - r.norm_squared()).abs() < 1e-14);
        assert!((a.transpose() * &r).max() < 1e-14);
    }

    #[test]
    fn random_cones_obey_farkas() {
        let noise = |s: usize| ((s as f64 * 78.233).sin() * 43758.5453).fract();
        for seed in 0..200 {
            let (n, m) = (1 + seed % 6, 1 + seed % 9);
            let a = DMatrix::from_fn(n, m, |i, j| noise(seed * 100 + i * 10 + j));
            let b = DVector::from_fn(n, |i, _| noise(seed * 31 + i + 7));
            let r = residual(&a, &b);
            assert!((a.transpose() * &r).max() < 1e-11);
            assert!((b.dot(&r) - r.norm_squared()).abs() < 1e-11);
        }
    }

    #[test]
    fn a_column_of_round_off_does_not_keep_the_others_from_balancing() {
        let a = DMatrix::from_row_slice(2, 4, &[3e-17, 1.0, -1.0, 0.0, 2e-17, 0.0, 1.0, -1.0]);
        let b = DVector::from_column_slice(&[0.7, 0.6]);
        assert!(residual(&a, &b).norm() < 1e-14);
    }
}
