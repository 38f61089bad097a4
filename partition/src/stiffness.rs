//! The stiffness of a material in Voigt's notation.

use std::ops::Index;

use nalgebra::{Cholesky, DMatrix};

use crate::magnitude::SMALLEST_STIFFNESS;

/// Largest difference of a stiffness from its transpose, relative to its largest entry.
const SYMMETRY_TOLERANCE: f64 = 1e-10;

/// C of σ = C ε (Pa), a row for each component of a stress.
#[derive(Clone, Debug, PartialEq)]
pub struct Stiffness {
    size: usize,
    values: Vec<f64>,
}

impl Stiffness {
    /// The matrix of `values`, row by row, with `size` rows.
    pub fn new(size: usize, values: &[f64]) -> Self {
        Self {
            size,
            values: values.to_vec(),
        }
    }

    /// Number of components of a strain.
    pub fn size(&self) -> usize {
        self.size
    }

    /// All entries, row by row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Rows as arrays of a fixed length.
    pub fn rows<const V: usize>(&self) -> [[f64; V]; V] {
        std::array::from_fn(|i| std::array::from_fn(|j| self[i][j]))
    }

    /// Largest entry on the diagonal.
    pub fn largest(&self) -> f64 {
        (0..self.size).map(|i| self[i][i]).fold(0.0, f64::max)
    }

    /// Smallest eigenvalue: the stiffness against the least resisted strain.
    pub fn smallest(&self) -> f64 {
        let c = DMatrix::from_row_slice(self.size, self.size, &self.values);
        c.symmetric_eigenvalues().min()
    }

    /// True if it is symmetric positive definite.
    pub fn is_elastic(&self) -> bool {
        let c = DMatrix::from_row_slice(self.size, self.size, &self.values);
        let largest = c.amax();
        let symmetric = (&c - c.transpose()).amax() <= SYMMETRY_TOLERANCE * largest;
        // Scaled first, so that no product overflows or underflows.
        symmetric && largest >= SMALLEST_STIFFNESS && Cholesky::new(c / largest).is_some()
    }
}

impl Index<usize> for Stiffness {
    type Output = [f64];

    fn index(&self, row: usize) -> &[f64] {
        &self.values[row * self.size..(row + 1) * self.size]
    }
}

impl<const V: usize> From<[[f64; V]; V]> for Stiffness {
    fn from(rows: [[f64; V]; V]) -> Self {
        Self {
            size: V,
            values: rows.concat(),
        }
    }
}
