//! The numerical factorization front by front; each passes its update to its parent.

use std::ops::Range;

use faer::{MatMut, Par};

use super::children::{Children, NO_PARENT};
use super::front;
use super::pattern::SparseSymmetric;
use super::supernodes::Supernodes;

/// The fronts of a factorization in progress.
pub(super) struct Fronts<'a> {
    matrix: &'a SparseSymmetric,
    supernodes: &'a Supernodes,
    count: usize,
    children: Children,
    /// Updates by eliminated supernodes of the rows below, until added to their parents.
    updates: Vec<Vec<f64>>,
    /// Memory of updates already added, for reuse.
    free: Vec<Vec<f64>>,
    /// Row in the current front of every unknown below it.
    place: Vec<u32>,
    targets: Targets,
}

impl<'a> Fronts<'a> {
    /// Fronts of the first `count` columns of `matrix`.
    pub fn new(matrix: &'a SparseSymmetric, supernodes: &'a Supernodes, count: usize) -> Self {
        Self {
            matrix,
            supernodes,
            count,
            children: Children::new(&supernodes.parents),
            updates: vec![Vec::new(); supernodes.len()],
            free: Vec::new(),
            place: vec![0; matrix.pattern.n()],
            targets: Targets::default(),
        }
    }

    /// Appends the panels of the factor, with the rows that are `kept`, to `values` and adds the remaining update to the
    /// lower triangle of `rest`, whose rows are the unknowns not eliminated.
    ///
    /// # Errors
    /// The column whose pivot isn't positive.
    pub fn run(
        mut self,
        kept: &Supernodes,
        values: &mut Vec<f64>,
        mut rest: MatMut<'_, f64>,
        par: Par,
    ) -> Result<(), usize> {
        let mut panel = Vec::new();
        for s in 0..self.supernodes.len() {
            let columns = self.supernodes.columns(s);
            let below = self.supernodes.below(s).len();
            let rows = columns.len() + below;
            self.gather(s, &mut panel);
            let mut update = self.zeros(below * below);
            for child in self.children.of(s) {
                let taken = std::mem::take(&mut self.updates[child]);
                self.targets.set(self.supernodes.below(child), &self.place);
                let split = self.targets.before(columns.len());
                self.targets.add(&taken, 0..split, &mut panel, rows, 0);
                let passed = split..self.targets.rows.len();
                self.targets
                    .add(&taken, passed, &mut update, below, columns.len());
                self.free.push(taken);
            }
            front::factorize(&mut panel, rows, columns.len(), &mut update, par)
                .map_err(|column| columns.start + column)?;
            let end = columns.len() + kept.below(s).len();
            for (j, column) in panel.chunks_exact(rows).enumerate() {
                values.extend_from_slice(&column[j..end]);
            }
            if self.supernodes.parents[s] == NO_PARENT {
                self.leave(s, &update, rest.as_mut());
                self.free.push(update);
            } else {
                self.updates[s] = update;
            }
        }
        Ok(())
    }

    /// Copies the matrix's entries in the columns of supernode `s`, and records the places of its rows.
    fn gather(&mut self, s: usize, panel: &mut Vec<f64>) {
        let columns = self.supernodes.columns(s);
        let below = self.supernodes.below(s);
        let rows = columns.len() + below.len();
        for (k, i) in columns.clone().enumerate() {
            self.place[i] = k as u32;
        }
        for (k, &i) in below.iter().enumerate() {
            self.place[i as usize] = (columns.len() + k) as u32;
        }
        panel.clear();
        panel.resize(rows * columns.len(), 0.0);
        let pattern = &self.matrix.pattern;
        for (column, j) in panel.chunks_exact_mut(rows).zip(columns) {
            for (place, &i) in pattern.column(j).zip(pattern.rows_of(j)) {
                column[self.place[i as usize] as usize] = self.matrix.values[place];
            }
        }
    }

    /// Zeros in reused memory if there is any, because touching new pages costs more than clearing.
    fn zeros(&mut self, len: usize) -> Vec<f64> {
        let fit = (self.free.iter()).rposition(|free| free.capacity() >= len);
        let Some(fit) = fit else {
            return vec![0.0; len];
        };
        let mut memory = self.free.remove(fit);
        memory.clear();
        memory.resize(len, 0.0);
        memory
    }

    /// Adds the update of a front without parent to `rest`.
    fn leave(&self, s: usize, update: &[f64], mut rest: MatMut<'_, f64>) {
        let below = self.supernodes.below(s);
        for (j, column) in update.chunks_exact(below.len().max(1)).enumerate() {
            let to = rest.as_mut().col_mut(below[j] as usize - self.count);
            let Some(to) = to.try_as_col_major_mut() else {
                continue;
            };
            let to = to.as_slice_mut();
            for (&i, value) in below[j..].iter().zip(&column[j..]) {
                to[i as usize - self.count] += value;
            }
        }
    }
}

/// Positions of a child's rows in its parent's front.
#[derive(Debug, Default)]
struct Targets {
    rows: Vec<u32>,
}

impl Targets {
    fn set(&mut self, below: &[u32], place: &[u32]) {
        self.rows.clear();
        self.rows.extend(below.iter().map(|&i| place[i as usize]));
    }

    /// Number of rows of the child before row `row` of the front.
    fn before(&self, row: usize) -> usize {
        self.rows.partition_point(|&to| (to as usize) < row)
    }

    /// Adds the columns `which` of a child's update, lower triangle, to columns with `rows` rows whose first row and
    /// column are row `first` of the front.
    fn add(&self, update: &[f64], which: Range<usize>, to: &mut [f64], rows: usize, first: usize) {
        let n = self.rows.len();
        for j in which {
            let column = (self.rows[j] as usize - first) * rows;
            let to = &mut to[column..column + rows];
            let values = &update[j * n + j..(j + 1) * n];
            for (&i, value) in self.rows[j..].iter().zip(values) {
                to[i as usize - first] += value;
            }
        }
    }
}
