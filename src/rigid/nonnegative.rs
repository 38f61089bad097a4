//! min ‖b − A λ‖₂ over 0 ≤ λ ≤ c, non-negative least squares where no c is finite: can contact forces
//! balance a load?

use faer::Mat;
use nalgebra::{DMatrix, DVector};

use super::columns::Columns;
use crate::comm::is_asked_to_stop;

/// Slope along a column, relative to b, that is round-off of r.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// The λ that come nearest.
#[derive(Clone, Debug)]
pub struct Nearest {
    /// λ.
    pub lambda: Vec<f64>,
    /// r = b − A λ.
    pub left: DVector<f64>,
}

/// r = b − A λ for the λ ≥ 0 that minimizes ‖r‖₂.
pub fn residual(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    nearest(a, b, &vec![f64::INFINITY; a.ncols()]).left
}

/// The λ between 0 and `largest` that minimizes the ‖r‖₂ of r = b − A λ, after Lawson and Hanson, with upper
/// bounds after Stark and Parker.
///
/// r = 0 up to round-off where such λ balance b. Otherwise r is a direction along which b does more work than
/// any of them could take up: b·r = ‖r‖² + Σ c (a·r) over the columns a at their bound, along which a·r ≥ 0,
/// and a·r ≤ 0 for those at 0 (Farkas).
pub fn nearest(a: &DMatrix<f64>, b: &DVector<f64>, largest: &[f64]) -> Nearest {
    let n = a.ncols();
    let norms: Vec<f64> = a.column_iter().map(|c| c.norm()).collect();
    let longest = norms.iter().copied().fold(0.0, f64::max);
    // A column that is round-off would have a direction all the same.
    let is_column: Vec<bool> = norms.iter().map(|&norm| norm > 1e-12 * longest).collect();
    let mut point = Iterate {
        passive: Columns::default(),
        at_largest: vec![false; n],
        lambda: vec![0.0; n],
        b: b.clone(),
        r: b.clone(),
    };
    // Columns whose slope has turned out to be round-off where r is.
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
        // Whoever is asked to stop asks for no answer.
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

/// The same r where that is zero, or nearly so: found where A's rows are orthonormal, so that it
/// tells a direction in which columns hardly act from one in which they don't.
///
/// With A = V Σ Uᵀ, A λ = b where Uᵀ λ = Σ⁻¹ Vᵀ b; what is left there is V Σ times it here. What
/// A's columns don't span at all, singular values up to `least` of the largest, is left out.
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

/// The residual that [`residual_in_span`] finds.
pub struct InSpan {
    /// r.
    pub left: DVector<f64>,
    /// Part of b that A's columns don't span.
    pub outside: DVector<f64>,
    /// The direction that r is in the turned problem, V Σ⁻¹ times it: along it b does more work than such λ take up, as
    /// Farkas says of r in [`nearest`].
    pub drive: DVector<f64>,
}

/// The part of the way of some columns from λ to `trial` at which the first of them reaches a bound; infinite where none
/// does.
fn way_to_bound(numbers: &[usize], trial: &[f64], lambda: &[f64], largest: &[f64]) -> f64 {
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

/// A λ within its bounds whose entries between these, those of the passive columns, come nearest to b.
#[derive(Clone)]
struct Iterate {
    passive: Columns,
    at_largest: Vec<bool>,
    lambda: Vec<f64>,
    /// b without what the columns at their bound make.
    b: DVector<f64>,
    r: DVector<f64>,
}

impl Iterate {
    /// Into which direction λ of a column can move; `None` where that is settled.
    fn inward(&self, j: usize) -> Option<f64> {
        match self.lambda[j] {
            0.0 => Some(1.0),
            _ if self.at_largest[j] => Some(-1.0),
            _ => None,
        }
    }

    /// The point with a column more between its bounds, and without those that λ reaches the bound of; `None`
    /// where that is no nearer to b.
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
            let blocking = way_to_bound(&passive.numbers, &trial, lambda, largest);
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
