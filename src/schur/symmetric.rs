//! Packed storage of a symmetric matrix, in half of the memory.

use faer::Mat;
use pulp::{Arch, Simd, WithSimd};
use serde::{Deserialize, Serialize};

use super::columns::{Number, WIDTH};
use super::panel::packed_len;

/// The lower triangle of a symmetric matrix, column after column, each from the diagonal on.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PackedSymmetric {
    size: usize,
    #[serde(with = "crate::bytes")]
    values: Vec<f64>,
}

impl PackedSymmetric {
    /// The packed form of a matrix given by its lower triangle.
    pub fn new(s: &Mat<f64>) -> Self {
        Self::trailing(s, 0)
    }

    /// The packed form of the rows and columns of a matrix from `first` on.
    pub fn trailing(s: &Mat<f64>, first: usize) -> Self {
        let size = s.nrows() - first;
        let mut values = Vec::with_capacity(packed_len(size, size));
        for j in first..s.nrows() {
            values.extend_from_slice(&s.col_as_slice(j)[j..]);
        }
        Self { size, values }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Column j, from the diagonal on.
    pub fn column(&self, j: usize) -> &[f64] {
        let begin = packed_len(self.size, j);
        &self.values[begin..begin + self.size - j]
    }

    /// S x.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        Arch::new().dispatch(Product {
            s: self,
            x,
            y: &mut y,
        });
        y
    }
}

/// y ← y + S x; every column is read once and used for both triangles.
struct Product<'a> {
    s: &'a PackedSymmetric,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let n = self.x.len();
        for j in (0..n).step_by(WIDTH) {
            let below = (j + WIDTH).min(n);
            for p in j..below {
                let column = &self.s.column(p)[..below - p];
                self.y[p] += column[0] * self.x[p];
                for (i, s) in (p + 1..below).zip(&column[1..]) {
                    self.y[i] += s * self.x[p];
                    self.y[p] += s * self.x[i];
                }
            }
            if below == n {
                break;
            }
            let (of_block, of_others) = self.y.split_at_mut(below);
            let column = |p: usize| &self.s.column(j + p)[below - j - p..];
            let sums = f64::dot::<S, WIDTH>(simd, &self.x[below..], column);
            for (y, sum) in of_block[j..].iter_mut().zip(sums) {
                *y += sum;
            }
            f64::add::<S, WIDTH>(simd, of_others, |p| (self.x[j + p], column(p)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_upper_triangle_is_that_of_the_lower_one() {
        for n in [0, 1, 4, 5, 23, 40] {
            let entry = |i: usize, j: usize| ((i.max(j) * 31 + i.min(j) * 7) % 17) as f64 - 8.0;
            let s = Mat::from_fn(n, n, |i, j| if i < j { f64::NAN } else { entry(i, j) });
            let x: Vec<f64> = (0..n).map(|i| (i % 5) as f64 - 2.0).collect();
            let expected = |i: usize| (0..n).map(|j| entry(i, j) * x[j]).sum::<f64>();
            let expected: Vec<f64> = (0..n).map(expected).collect();
            assert_eq!(PackedSymmetric::new(&s).multiply(&x), expected);
        }
    }
}
