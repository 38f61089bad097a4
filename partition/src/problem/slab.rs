//! Rows of a dataset in memory, from which the slices of several subdomains are taken.

use std::ops::Range;

use super::dataset::Dataset;
use crate::element::geometry::padded;
use crate::error::InputError;

/// Consecutive rows of a dataset; rows are counted as in the dataset.
pub(super) struct Slab<T> {
    /// Says what is wrong, and where.
    pub dataset: Dataset,
    first: usize,
    width: usize,
    values: Vec<T>,
}

impl<T> Slab<T> {
    /// Number of numbers a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The numbers in some of the rows.
    pub fn rows(&self, rows: Range<usize>) -> &[T] {
        let at = |row: usize| self.width * (row - self.first);
        &self.values[at(rows.start)..at(rows.end)]
    }
}

impl Slab<i64> {
    /// Reads integers of any width, one a row.
    pub fn integers(dataset: Dataset, rows: Range<usize>) -> Result<Self, InputError> {
        Ok(Self {
            first: rows.start,
            width: 1,
            values: dataset.integers(rows)?,
            dataset,
        })
    }

    /// Integers that are `what` below `count`.
    pub fn indices(
        &self,
        rows: Range<usize>,
        count: usize,
        what: &str,
    ) -> Result<Vec<u32>, InputError> {
        let start = rows.start;
        self.dataset.indices_of(self.rows(rows), start, count, what)
    }
}

impl Slab<f64> {
    /// Reads finite numbers, `width` a row.
    pub fn floats(dataset: Dataset, rows: Range<usize>, width: usize) -> Result<Self, InputError> {
        Ok(Self {
            first: rows.start,
            width,
            values: dataset.floats(rows)?,
            dataset,
        })
    }

    /// Reads unit vectors of `width` components.
    pub fn unit_vectors(
        dataset: Dataset,
        rows: Range<usize>,
        width: usize,
    ) -> Result<Self, InputError> {
        let slab = Self::floats(dataset, rows.clone(), width)?;
        slab.dataset
            .check_unit(&slab.vectors(rows.clone()), rows.start)?;
        Ok(slab)
    }

    /// The vectors in some of the rows; components beyond the width are zero.
    pub fn vectors(&self, rows: Range<usize>) -> Vec<[f64; 3]> {
        self.rows(rows)
            .chunks_exact(self.width)
            .map(padded)
            .collect()
    }
}
