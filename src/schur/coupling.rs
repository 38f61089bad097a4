//! K_BI: the part of a sparse matrix that couples its boundary to its interior.

use super::pattern::SparseSymmetric;

/// K_BI, its entries by interior columns.
#[derive(Debug)]
pub(super) struct Coupling {
    /// Offset of the entries of each interior unknown, and the end of the last.
    offsets: Vec<u32>,
    /// Boundary unknown of each entry, counted from the first one of B.
    rows: Vec<u32>,
    values: Vec<f64>,
}

impl Coupling {
    /// K_BI of a matrix whose first `interior` unknowns are I.
    pub fn new(matrix: &SparseSymmetric, interior: usize) -> Self {
        let mut coupling = Self {
            offsets: vec![0],
            rows: Vec::new(),
            values: Vec::new(),
        };
        for j in 0..interior {
            let rows = matrix.pattern.rows_of(j);
            let first = rows.partition_point(|&i| (i as usize) < interior);
            let of_boundary = rows[first..].iter().map(|&i| i - interior as u32);
            coupling.rows.extend(of_boundary);
            let values = &matrix.values[matrix.pattern.column(j)];
            coupling.values.extend_from_slice(&values[first..]);
            coupling.offsets.push(coupling.rows.len() as u32);
        }
        coupling
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// The boundary unknowns and the entries of interior column `j`.
    fn column(&self, j: usize) -> impl Iterator<Item = (usize, f64)> {
        let places = self.offsets[j] as usize..self.offsets[j + 1] as usize;
        let rows = self.rows[places.clone()].iter();
        rows.zip(&self.values[places])
            .map(|(&i, &value)| (i as usize, value))
    }

    /// x_B ← x_B − K_BI x_I.
    pub fn subtract_product(&self, x_i: &[f64], x_b: &mut [f64]) {
        for (j, x) in x_i.iter().enumerate() {
            self.column(j).for_each(|(i, value)| x_b[i] -= value * x);
        }
    }

    /// K_IB x_B.
    pub fn transposed_product(&self, x_b: &[f64]) -> Vec<f64> {
        let row = |j: usize| self.column(j).map(|(i, value)| value * x_b[i]).sum();
        (0..self.offsets.len() - 1).map(row).collect()
    }
}
