//! Least squares with bounds, min ‖b − A λ‖₂ over 0 ≤ λ ≤ c; non-negative least squares if no c is finite. It decides
//! whether contact forces balance a load.

use faer::Mat;
use nalgebra::{DMatrix, DVector};

use super::columns::Columns;
use crate::comm::is_asked_to_stop;

/// Slope of ‖r‖ along a column, relative to b, that is round-off.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// Minimizer λ and its residual.
#[derive(Clone, Debug)]
pub struct Nearest {
    /// λ.
    pub lambda: Vec<f64>,
    /// r = b − A λ.
    pub left: DVector<f64>,
}

/// r = b − A λ of the λ ≥ 0 that minimizes ‖r‖₂.
pub fn residual(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    nearest(a, b, &vec![f64::INFINITY; a.ncols()]).left
}

/// The λ with 0 ≤ λ ≤ `largest` that minimizes ‖r‖₂, r = b − A λ: Lawson and Hanson's active-set method with the upper
/// bounds of Stark and Parker.
///
/// r = 0 up to round-off if such λ balance b. Otherwise b does more work along r than any such λ absorb: b·r = ‖r‖² + Σ
/// c (a·r) over the columns a at their upper bound, with a·r ≥ 0 for these and a·r ≤ 0 for those at 0 (Farkas' lemma).
pub fn nearest(a: &DMatrix<f64>, b: &DVector<f64>, largest: &[f64]) -> Nearest {
    let n = a.ncols();
    let norms: Vec<f64> = a.column_iter().map(|c| c.norm()).collect();
    let longest = norms.iter().copied().fold(0.0, f64::max);
    // A column of round-off must not be normalized.
    let is_column: Vec<bool> = norms.iter().map(|&norm| norm > 1e-12 * longest).collect();
    let mut point = Iterate {
        passive: Columns::default(),
        at_largest: vec![false; n],
        lambda: vec![0.0; n],
        b: b.clone(),
        r: b.clone(),
    };
    // Columns whose slope was round-off at the current r.
    let mut is_tried = vec![false; n];
    for _ in 0..10 * (n + a.nrows()) + 10 {
        let slopes = a.tr_mul(&point.r);
        let best = (0..n)
            .filter(|&j| is_column[j] && !is_tried[j])
            .filter_map(|j| Some((point.inward(j)? * slopes[j] / norms[j], j)))
            .max_by(|x, y| x.0.total_cmp(&y.0).then(y.1.cmp(&x.1)));
        let Some((steepest, entering)) = best else {
            break;
        };
        // After a signal no result is needed.
        if steepest <= ROUND_OFF * b.norm() || is_asked_to_stop() {
            break;
        }
        match point.entered(a, largest, entering) {
            Some(nearer) => {
                point = nearer;
                is_tried.fill(false);
            }
            None => is_tried[entering] = true,
        }
    }
    Nearest {
        lambda: point.lambda,
        left: point.r,
    }
}

/// r where it is zero or nearly so, computed with orthonormal rows of A: these tell a direction in which columns act
/// weakly from one in which they don't act.
///
/// With A = V Σ Uᵀ, A λ = b means Uᵀ λ = Σ⁻¹ Vᵀ b; r is V Σ times the residual of that equation. The part of b outside
/// the span of A's columns, with singular values up to `least` of the largest, is left out.
pub fn residual_in_span(
    a: &DMatrix<f64>,
    b: &DVector<f64>,
    largest: &[f64],
    least: f64,
) -> Option<InSpan> {
    let rows = Mat::from_fn(a.ncols(), a.nrows(), |i, j| a[(j, i)]);
    let svd = rows.thin_svd().ok()?;
    let (u, sizes, v) = (svd.U(), svd.S().column_vector(), svd.V());
    let first = sizes.iter().copied().fold(0.0, f64::max);
    let kept: Vec<usize> = (0..sizes.nrows())
        .filter(|&i| sizes[i] > least * first)
        .collect();
    let turned = DMatrix::from_fn(kept.len(), a.ncols(), |k, j| u[(j, kept[k])]);
    let along = |i: usize| (0..a.nrows()).map(|row| v[(row, i)] * b[row]).sum::<f64>();
    let scaled = DVector::from_fn(kept.len(), |k, _| along(kept[k]) / sizes[kept[k]]);
    let left = nearest(&turned, &scaled, largest).left;
    let back = |row: usize| {
        let terms = kept.iter().zip(left.iter());
        terms.map(|(&i, left)| v[(row, i)] * sizes[i] * left).sum()
    };
    let spanned = |row: usize| kept.iter().map(|&i| v[(row, i)] * along(i)).sum::<f64>();
    let outside = DVector::from_fn(a.nrows(), |row, _| b[row] - spanned(row));
    let along = |row: usize| {
        let terms = kept.iter().zip(left.iter());
        terms.map(|(&i, left)| v[(row, i)] / sizes[i] * left).sum()
    };
    Some(InSpan {
        drive: DVector::from_fn(a.nrows(), |row, _| along(row)),
        left: DVector::from_fn(a.nrows(), |row, _| back(row)),
        outside,
    })
}

/// Result of [`residual_in_span`].
pub struct InSpan {
    /// r.
    pub left: DVector<f64>,
    /// Part of b outside the span of A's columns.
    pub outside: DVector<f64>,
    /// V Σ⁻¹ times the residual of the equation with orthonormal rows: a direction along which b does more work than
    /// any such λ absorb, as with r in [`nearest`].
    pub drive: DVector<f64>,
}

/// Fraction of the step of some columns from λ to `trial` at which the first of them reaches a bound; infinite if none
/// does.
fn step_to_bound(numbers: &[usize], trial: &[f64], lambda: &[f64], largest: &[f64]) -> f64 {
    let reached = |(&j, t): (&usize, &f64)| {
        if *t <= 0.0 {
            Some(lambda[j] / (lambda[j] - t))
        } else if *t >= largest[j] {
            Some((largest[j] - lambda[j]) / (t - lambda[j]))
        } else {
            None
        }
    };
    (numbers.iter().zip(trial))
        .filter_map(reached)
        .fold(f64::INFINITY, f64::min)
}

/// An admissible λ that minimizes ‖r‖₂ over its passive entries, which lie strictly between their bounds.
#[derive(Clone)]
struct Iterate {
    passive: Columns,
    at_largest: Vec<bool>,
    lambda: Vec<f64>,
    /// b without the contribution of the columns at their upper bound.
    b: DVector<f64>,
    r: DVector<f64>,
}

impl Iterate {
    /// Sign of the change that moves λ of a column off its bound; `None` if it is passive.
    fn inward(&self, j: usize) -> Option<f64> {
        match self.lambda[j] {
            0.0 => Some(1.0),
            _ if self.at_largest[j] => Some(-1.0),
            _ => None,
        }
    }

    /// The iterate with one more passive column, without those whose λ reaches a bound; `None` if it is no nearer to b.
    fn entered(&self, a: &DMatrix<f64>, largest: &[f64], entering: usize) -> Option<Self> {
        let mut point = self.clone();
        if !point.passive.push(a, entering) {
            return None;
        }
        if point.at_largest[entering] {
            point.at_largest[entering] = false;
            point.b.axpy(largest[entering], &a.column(entering), 1.0);
        }
        let Self {
            passive,
            at_largest,
            lambda,
            b,
            r,
        } = &mut point;
        loop {
            let trial = passive.solve(b);
            let blocking = step_to_bound(&passive.numbers, &trial, lambda, largest);
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
            let most = lambda.iter().fold(0.0, |m: f64, l| m.max(l.abs()));
            for place in (0..passive.numbers.len()).rev() {
                let j = passive.numbers[place];
                if lambda[j] <= 1e-14 * most.min(largest[j]) {
                    lambda[j] = 0.0;
                } else if lambda[j] >= (1.0 - 1e-14) * largest[j] {
                    lambda[j] = largest[j];
                    at_largest[j] = true;
                    b.axpy(-largest[j], &a.column(j), 1.0);
                } else {
                    continue;
                }
                passive.remove(place);
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
    fn bounded_forces_obey_farkas_and_balance_what_some_of_them_make() {
        let noise = |s: usize| ((s as f64 * 78.233).sin() * 43758.5453).fract();
        for seed in 0..400 {
            let (n, m) = (1 + seed % 6, 1 + seed % 11);
            let a = DMatrix::from_fn(n, m, |i, j| noise(seed * 100 + i * 10 + j));
            let largest: Vec<f64> = (0..m)
                .map(|j| match noise(seed * 57 + j) {
                    c if c > 0.0 => c,
                    _ => f64::INFINITY,
                })
                .collect();
            let b = DVector::from_fn(n, |i, _| 2.0 * noise(seed * 31 + i + 7));
            let Nearest { lambda, left } = nearest(&a, &b, &largest);
            let made = &b - &a * DVector::from_column_slice(&lambda);
            assert!((made - &left).amax() < 1e-11, "{seed}");
            for (j, slope) in (a.transpose() * &left).iter().enumerate() {
                assert!((0.0..=largest[j]).contains(&lambda[j]), "{seed}");
                assert!(lambda[j] == largest[j] || *slope < 1e-11, "{seed}");
                assert!(lambda[j] == 0.0 || *slope > -1e-11, "{seed}");
            }
            let some = |j: usize| noise(seed * 13 + j).abs() * largest[j].min(1.0);
            let inside = &a * DVector::from_fn(m, |j, _| some(j));
            assert!(nearest(&a, &inside, &largest).left.norm() < 1e-13, "{seed}");
            let in_span = residual_in_span(&a, &inside, &largest, 1e-9).unwrap();
            assert!(in_span.left.norm() < 1e-12, "{seed}: {}", in_span.left);
            let outside = in_span.outside;
            assert!(outside.norm() < 1e-12, "{seed}: {outside}");
        }
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
