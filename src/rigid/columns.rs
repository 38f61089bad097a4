//! QR factorization with insertion and removal of columns.

use crate::vector::axpy;
use nalgebra::{DMatrix, DVector};

/// Norm of the part of a column orthogonal to the others, relative to the column, below which it depends on them.
const DEPENDENT: f64 = 1e-12;

/// Q R of the columns pushed and not removed; each update costs O(rows · columns).
#[derive(Clone, Debug, Default)]
pub(super) struct Columns {
    /// Numbers of the columns, in the order of R.
    pub numbers: Vec<usize>,
    q: Vec<DVector<f64>>,
    /// Upper triangular, column by column.
    r: Vec<Vec<f64>>,
}

impl Columns {
    /// Appends column `number` of `a` if it is linearly independent of the others; returns whether it is.
    pub fn push(&mut self, a: &DMatrix<f64>, number: usize) -> bool {
        let mut column: DVector<f64> = a.column(number).into_owned();
        let size = column.norm();
        let mut r = vec![0.0; self.q.len()];
        // Two passes of Gram-Schmidt give orthogonality to round-off.
        for _ in 0..2 {
            for (r, q) in r.iter_mut().zip(&self.q) {
                let along = q.dot(&column);
                column.axpy(-along, q, 1.0);
                *r += along;
            }
        }
        let new = column.norm();
        if new <= DEPENDENT * size || self.q.len() >= a.nrows() {
            return false;
        }
        r.push(new);
        self.q.push(column / new);
        self.r.push(r);
        self.numbers.push(number);
        true
    }

    /// Removes the column at `place`.
    pub fn remove(&mut self, place: usize) {
        self.numbers.remove(place);
        self.r.remove(place);
        // Givens rotations zero the subdiagonal entries of the columns behind it.
        for k in place..self.r.len() {
            let (a, b) = (self.r[k][k], self.r[k][k + 1]);
            let size = a.hypot(b);
            let (cos, sin) = (a / size, b / size);
            for r in &mut self.r[k..] {
                let (a, b) = (r[k], r[k + 1]);
                (r[k], r[k + 1]) = (cos * a + sin * b, cos * b - sin * a);
            }
            let (above, below) = self.q.split_at_mut(k + 1);
            for (a, b) in above[k].iter_mut().zip(below[0].iter_mut()) {
                (*a, *b) = (cos * *a + sin * *b, cos * *b - sin * *a);
            }
        }
        for (k, r) in self.r.iter_mut().enumerate() {
            r.truncate(k + 1);
        }
        self.q.truncate(self.r.len());
    }

    /// Coefficients of the least-squares solution: the combination of columns nearest to `b`.
    pub fn solve(&self, b: &DVector<f64>) -> Vec<f64> {
        let mut x: Vec<f64> = self.q.iter().map(|q| q.dot(b)).collect();
        for k in (0..x.len()).rev() {
            let r = &self.r[k];
            x[k] /= r[k];
            let x_k = x[k];
            axpy(-x_k, r, &mut x[..k]);
        }
        x
    }

    /// The residual of that least-squares problem.
    pub fn residual(&self, b: &DVector<f64>) -> DVector<f64> {
        let mut left = b.clone();
        for _ in 0..2 {
            for q in &self.q {
                left.axpy(-q.dot(&left), q, 1.0);
            }
        }
        left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_come_and_go_solve_as_those_that_stay() {
        let noise = |s: usize| ((s as f64 * 78.233).sin() * 43758.5453).fract();
        let a = DMatrix::from_fn(9, 12, |i, j| noise(17 * i + j + 1));
        let b = DVector::from_fn(9, |i, _| noise(i + 500));
        let mut columns = Columns::default();
        for number in [3, 0, 7, 11, 5, 2, 9] {
            assert!(columns.push(&a, number));
        }
        assert!(!columns.push(&a, 7));
        for place in [1, 5, 2, 0] {
            columns.remove(place);
        }
        assert_eq!(columns.numbers, [7, 5, 2]);
        assert!(columns.push(&a, 4));
        let chosen = a.select_columns(&columns.numbers);
        let x = DVector::from_vec(columns.solve(&b));
        let left = &b - &chosen * x;
        assert!((chosen.transpose() * &left).amax() < 1e-14);
        assert!((left - columns.residual(&b)).amax() < 1e-14);
    }
}
