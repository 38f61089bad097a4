//! Jumps and forces for a unit of the zero quantity of each limit: a column each, in product form.
//!
//! When limit i gets another zero quantity, aᵀ x of the jumps and forces x, every column becomes
//!
//! ```text
//! x ← x − c aᵀ x,    column i   c = x / aᵀ x
//! ```
//!
//! A pivot needs a single column. So c and a are stored, a column is computed on demand, and all of them
//! after many pivots, by products of matrices.

use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{Mat, Par};

use crate::vector::axpy;

/// Maximum number of stored pivots.
const MOST_PIVOTS: usize = 64;

/// Combination of three jumps and forces, by their number.
pub(super) type Terms = [(usize, f64); 3];

/// The columns.
pub(super) struct Responses {
    /// Columns before the stored pivots.
    columns: Mat<f64>,
    pivots: Vec<Pivot>,
}

/// Replacement of the zero quantity of a limit.
struct Pivot {
    limit: usize,
    /// a.
    terms: Terms,
    /// c.
    column: Vec<f64>,
}

fn sum(terms: &Terms, x: &[f64]) -> f64 {
    terms.iter().map(|&(i, c)| c * x[i]).sum()
}

impl Responses {
    pub(super) fn new(columns: Mat<f64>) -> Self {
        Self {
            columns,
            pivots: Vec::new(),
        }
    }

    /// Origin of column i: the stored one, and the first pivot after it.
    fn origin(&self, i: usize) -> (&[f64], usize) {
        match self.pivots.iter().rposition(|one| one.limit == i) {
            Some(k) => (&self.pivots[k].column, k + 1),
            None => (self.columns.col_as_slice(i), 0),
        }
    }

    /// Column i.
    fn column(&self, i: usize) -> Vec<f64> {
        let (origin, since) = self.origin(i);
        let mut column = origin.to_vec();
        for pivot in &self.pivots[since..] {
            let share = sum(&pivot.terms, &column);
            axpy(-share, &pivot.column, &mut column);
        }
        column
    }

    /// Value of a combination for a unit of the i-th quantity.
    pub(super) fn share(&self, i: usize, terms: &Terms) -> f64 {
        sum(terms, &self.column(i))
    }

    /// Replaces the i-th zero quantity, and returns its column.
    pub(super) fn pivot(&mut self, i: usize, terms: Terms) -> &[f64] {
        if self.pivots.len() == MOST_PIVOTS {
            self.apply_pivots();
        }
        let mut column = self.column(i);
        let own = sum(&terms, &column);
        column.iter_mut().for_each(|x| *x /= own);
        self.pivots.push(Pivot {
            limit: i,
            terms,
            column,
        });
        &self.pivots[self.pivots.len() - 1].column
    }

    /// Computes all columns: with the shares s of the pivots in them, s_k = a_kᵀ (x − Σ s_l c_l) for l < k.
    fn apply_pivots(&mut self) {
        let (rows, count, exchanges) = (
            self.columns.nrows(),
            self.columns.ncols(),
            self.pivots.len(),
        );
        let mut shares = Mat::zeros(exchanges, count);
        let mut origins: Vec<Option<usize>> = vec![None; count];
        for (k, pivot) in self.pivots.iter().enumerate() {
            origins[pivot.limit] = Some(k);
        }
        for (i, origin) in origins.into_iter().enumerate() {
            if let Some(k) = origin {
                let own = self.pivots[k].column.iter();
                let column = self.columns.col_as_slice_mut(i).iter_mut();
                column.zip(own).for_each(|(x, own)| *x = *own);
            }
            let column = self.columns.col_as_slice(i);
            let since = origin.map_or(0, |k| k + 1);
            for (k, pivot) in self.pivots.iter().enumerate().skip(since) {
                shares[(k, i)] = sum(&pivot.terms, column);
            }
        }
        let of_each = Mat::from_fn(exchanges, exchanges, |k, l| {
            sum(&self.pivots[k].terms, &self.pivots[l].column)
        });
        solve_unit_lower_triangular_in_place(of_each.as_ref(), shares.as_mut(), Par::Seq);
        let columns = Mat::from_fn(rows, exchanges, |i, k| self.pivots[k].column[i]);
        self.columns -= &columns * &shares;
        self.pivots.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::friction::points::noise;

    #[test]
    fn columns_in_product_form_are_those_of_one_pivot_after_the_other() {
        let (rows, count) = (24, 12);
        let mut dense = Mat::from_fn(rows, count, |i, j| noise(7 * i + 131 * j));
        let mut responses = Responses::new(dense.clone());
        let mut pivots = 0;
        for k in 0..2000 {
            let (i, j) = ((5 * k + k / 7) % count, (11 * k + k / 3) % rows);
            let terms = [(j, 1.0), ((j + 5) % rows, 0.5), ((j + 3) % rows, 0.2)];
            let share: Vec<f64> = (0..count)
                .map(|q| sum(&terms, dense.col_as_slice(q)))
                .collect();
            // Others would make the columns grow.
            if share[i].abs() < 0.5 * share.iter().fold(0.0, |m: f64, x| m.max(x.abs())) {
                continue;
            }
            pivots += 1;
            let column: Vec<f64> = (0..rows).map(|p| dense[(p, i)] / share[i]).collect();
            for q in (0..count).filter(|&q| q != i) {
                axpy(-share[q], &column, dense.col_as_slice_mut(q));
            }
            dense.col_as_slice_mut(i).copy_from_slice(&column);
            let scale = column.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            for (a, b) in responses.pivot(i, terms).iter().zip(&column) {
                assert!((a - b).abs() < 1e-9 * scale, "{k}: {a:e} {b:e}");
            }
        }
        assert!(pivots > 2 * MOST_PIVOTS, "{pivots}");
    }
}
