//! The columns of one supernode of a Cholesky factor, and substitution with them.

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, MatMut, Par};
use pulp::{Arch, Simd, WithSimd};

use super::columns::{Number, WIDTH};

/// The columns of one supernode: a dense lower trapezoid over its own rows and those `below`, packed by columns, each
/// from the diagonal on.
pub(super) struct Panel<'a> {
    pub start: usize,
    pub columns: usize,
    pub below: &'a [u32],
    pub values: &'a [f64],
}

/// Number of values of a panel with these numbers of rows and columns.
pub(super) fn packed_len(rows: usize, columns: usize) -> usize {
    columns * rows - columns * columns.saturating_sub(1) / 2
}

impl<'a> Panel<'a> {
    fn rows(&self) -> usize {
        self.columns + self.below.len()
    }

    /// Column `j`, from the diagonal on.
    pub fn column(&self, j: usize) -> &'a [f64] {
        let begin = packed_len(self.rows(), j);
        &self.values[begin..begin + self.rows() - j]
    }

    /// Column `j` in the rows below the supernode's own.
    fn column_below(&self, j: usize) -> &'a [f64] {
        &self.column(j)[self.columns - j..]
    }

    /// Number of its columns among the first `count`; a supernode may extend from I into B.
    pub fn columns_before(&self, count: usize) -> usize {
        count.saturating_sub(self.start).min(self.columns)
    }

    /// The part of x ← L⁻¹ x due to its first `count` columns.
    pub fn forward(&self, count: usize, x: &mut [f64], work: &mut Vec<f64>) {
        let own = &mut x[self.start..self.start + self.columns];
        for j in 0..count {
            let column = self.column(j);
            let xj = own[j] / column[0];
            own[j] = xj;
            for (x, l) in own[j + 1..].iter_mut().zip(&column[1..]) {
                *x -= l * xj;
            }
        }
        work.clear();
        work.resize(self.below.len(), 0.0);
        Arch::new().dispatch(Product {
            panel: self,
            x: &own[..count],
            y: work,
        });
        for (&i, y) in self.below.iter().zip(work.iter()) {
            x[i as usize] -= y;
        }
    }

    /// The part of x ← L⁻ᵀ x due to its first `count` columns.
    pub fn backward(&self, count: usize, x: &mut [f64], work: &mut Vec<f64>) {
        work.clear();
        work.extend(self.below.iter().map(|&i| x[i as usize]));
        let own = &mut x[self.start..self.start + self.columns];
        Arch::new().dispatch(TransposedProduct {
            panel: self,
            x: work,
            y: &mut own[..count],
        });
        for j in (0..count).rev() {
            let column = self.column(j);
            let (before, after) = own.split_at_mut(j + 1);
            let mut sum = before[j];
            for (x, l) in after.iter().zip(&column[1..]) {
                sum -= l * x;
            }
            before[j] = sum / column[0];
        }
    }

    /// The part of X ← L_BB⁻¹ X due to its columns from `interior` on; X has a row for every unknown of B.
    pub fn forward_boundary(&self, interior: usize, mut x: MatMut<'_, f64>, par: Par) {
        let skipped = self.columns_before(interior);
        let (first, count) = (self.start + skipped, self.columns - skipped);
        if count == 0 {
            return;
        }
        let mut values = Mat::zeros(self.rows() - skipped, count);
        for j in 0..count {
            values.col_as_slice_mut(j)[j..].copy_from_slice(self.column(skipped + j));
        }
        let (own, below) = values.as_ref().split_at_row(count);
        let mut top = x.as_mut().subrows_mut(first - interior, count);
        solve_lower_triangular_in_place(own, top.as_mut(), par);
        let product = below * top.as_ref();
        for (&i, row) in self.below.iter().zip(product.row_iter()) {
            let to = x.as_mut().row_mut(i as usize - interior);
            for (x, p) in to.iter_mut().zip(row.iter()) {
                *x -= p;
            }
        }
    }
}

/// y ← y + L x with the rows below a panel's own.
struct Product<'a> {
    panel: &'a Panel<'a>,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let below = |j: usize| self.panel.column_below(j);
        let whole = self.x.len() / WIDTH * WIDTH;
        for j in (0..whole).step_by(WIDTH) {
            f64::add::<S, WIDTH>(simd, self.y, |p| (self.x[j + p], below(j + p)));
        }
        for j in whole..self.x.len() {
            f64::add::<S, 1>(simd, self.y, |_| (self.x[j], below(j)));
        }
    }
}

/// y ← y − Lᵀ x with the rows below a panel's own.
struct TransposedProduct<'a> {
    panel: &'a Panel<'a>,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for TransposedProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let below = |j: usize| self.panel.column_below(j);
        let whole = self.y.len() / WIDTH * WIDTH;
        for j in (0..whole).step_by(WIDTH) {
            let sums = f64::dot::<S, WIDTH>(simd, self.x, |p| below(j + p));
            for (y, sum) in self.y[j..].iter_mut().zip(sums) {
                *y -= sum;
            }
        }
        for j in whole..self.y.len() {
            let [sum] = f64::dot::<S, 1>(simd, self.x, |_| below(j));
            self.y[j] -= sum;
        }
    }
}
