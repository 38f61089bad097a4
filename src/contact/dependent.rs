//! Conditions that depend on several normal jumps: D t ≤ d.
//!
//! At a node with more conditions than directions, the normal jumps of some bound those of the others.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

/// Linear combination: numbers and factors.
pub type Terms = Vec<(usize, f64)>;

/// D, row by row.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DependentConstraints {
    rows: Vec<Terms>,
}

impl DependentConstraints {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Appends the row Σ factor·t.
    pub fn push(&mut self, terms: Terms) {
        self.rows.push(terms);
    }

    /// Appends the rows of `others`, whose first normal jump is number `first` here.
    pub fn append(&mut self, others: &Self, first: usize) {
        let shifted = |row: &Terms| row.iter().map(|&(i, c)| (first + i, c)).collect();
        self.rows.extend(others.rows.iter().map(shifted));
    }

    /// The rows.
    pub fn iter(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        self.rows.iter().map(Vec::as_slice)
    }

    /// Normal jumps and factors of row j.
    pub fn row(&self, j: usize) -> &[(usize, f64)] {
        &self.rows[j]
    }

    /// (D t)_j.
    pub fn value(&self, j: usize, t: &[f64]) -> f64 {
        self.rows[j].iter().map(|&(i, c)| c * t[i]).sum()
    }

    /// Sum of the absolute factors of row j.
    pub fn size(&self, j: usize) -> f64 {
        self.rows[j].iter().map(|(_, c)| c.abs()).sum()
    }

    /// y ← y − Dᵀ μ. Returns the absolute terms of each changed entry.
    pub fn subtract_transposed(&self, mu: &[f64], y: &mut [f64]) -> HashMap<usize, f64> {
        let mut scale: HashMap<usize, f64> = HashMap::new();
        for (row, mu) in self.rows.iter().zip(mu).filter(|(_, mu)| **mu != 0.0) {
            for &(i, c) in row {
                y[i] -= c * mu;
                *scale.entry(i).or_default() += (c * mu).abs();
            }
        }
        scale
    }
}
