//! Non-negative least squares: can contact forces λ ≥ 0 balance a load?

use nalgebra::{DMatrix, DVector};

use super::columns::Columns;

/// r = b − A λ for the λ ≥ 0 that minimizes ‖r‖₂, after Lawson and Hanson.
///
/// r = 0 up to round-off where b lies in the cone of A's columns; otherwise Aᵀ r ≤ 0 and
/// b·r = ‖r‖² > 0: a direction along which b drives and no column resists (Farkas).
pub fn residual(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    let n = a.ncols();
    let norms: Vec<f64> = a.column_iter().map(|c| c.norm()).collect();
    let largest = norms.iter().copied().fold(0.0, f64::max);
    let tolerance = 1e-13 * b.norm();
    // A column that is round-off would have a direction all the same.
    let mut candidates: Vec<usize> = (0..n).filter(|&j| norms[j] > 1e-12 * largest).collect();
    let mut passive = Columns::default();
    let mut is_passive = vec![false; n];
    let mut lambda = vec![0.0; n];
    let mut r = b.clone();
    for _ in 0..10 * (n + a.nrows()) + 10 {
        let slopes = a.tr_mul(&r);
        let best = (candidates.iter().copied())
            .filter(|&j| !is_passive[j])
            .map(|j| (slopes[j] / norms[j], j))
            .max_by(|x, y| x.0.total_cmp(&y.0).then(y.1.cmp(&x.1)));
        let Some((steepest, entering)) = best else {
            break;
        };
        if steepest <= tolerance {
            break;
        }
        if !passive.push(a, entering) {
            // It depends on those that are in: its slope is round-off.
            candidates.retain(|&j| j != entering);
            continue;
        }
        is_passive[entering] = true;
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
                    is_passive[j] = false;
                    passive.remove(place);
                }
            }
            if passive.numbers.is_empty() {
                break;
            }
        }
        r = passive.residual(b);
    }
    r
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
