//! The numerical factorization: front by front, each passing what it leaves to its parent's.

use faer::{MatMut, Par};

use super::factor::FactorError;
use super::front;
use super::pattern::SparseSymmetric;
use super::supernodes::{ROOT, Supernodes};

/// The fronts of a factorization under way.
pub(super) struct Fronts<'a> {
    matrix: &'a SparseSymmetric,
    supernodes: &'a Supernodes,
    count: usize,
    /// Children of each supernode, as lists.
    first_child: Vec<u32>,
    next_sibling: Vec<u32>,
    /// What the eliminated supernodes leave to the rows below, until their parents take it.
    updates: Vec<Vec<f64>>,
    /// Memory of updates that were taken.
    free: Vec<Vec<f64>>,
    /// Row of the current front for every unknown below it.
    place: Vec<u32>,
    targets: Vec<u32>,
}

impl<'a> Fronts<'a> {
    /// Fronts of the first `count` columns of `matrix`.
    pub fn new(matrix: &'a SparseSymmetric, supernodes: &'a Supernodes, count: usize) -> Self {
        let mut first_child = vec![ROOT; supernodes.len()];
        let mut next_sibling = vec![ROOT; supernodes.len()];
        for (s, &parent) in supernodes.parents.iter().enumerate().rev() {
            if parent != ROOT {
                next_sibling[s] = first_child[parent as usize];
                first_child[parent as usize] = s as u32;
            }
        }
        Self {
            matrix,
            supernodes,
            count,
            first_child,
            next_sibling,
            updates: vec![Vec::new(); supernodes.len()],
            free: Vec::new(),
            place: vec![0; matrix.pattern.n()],
            targets: Vec::new(),
        }
    }

    /// Appends the factor's panels to `values` and adds what the columns leave to the lower
    /// triangle of `rest`, whose rows are the unknowns that stay.
    ///
    /// # Errors
    /// A pivot isn't positive.
    pub fn run(
        mut self,
        values: &mut Vec<f64>,
        mut rest: MatMut<'_, f64>,
        par: Par,
    ) -> Result<(), FactorError> {
        let mut panel = Vec::new();
        for s in 0..self.supernodes.len() {
            let columns = self.supernodes.columns(s);
            let below = self.supernodes.below(s).len();
            let rows = columns.len() + below;
            self.gather(s, &mut panel);
            let mut update = self.zeros(below * below);
            let mut child = self.first_child[s];
            while child != ROOT {
                let taken = std::mem::take(&mut self.updates[child as usize]);
                self.target(child as usize);
                let split = self
                    .targets
                    .partition_point(|&t| (t as usize) < columns.len());
                let (own, passed) = (0..split, split..self.targets.len());
                add(&taken, &self.targets, own, &mut panel, rows, 0);
                add(
                    &taken,
                    &self.targets,
                    passed,
                    &mut update,
                    below,
                    columns.len(),
                );
                self.free.push(taken);
                child = self.next_sibling[child as usize];
            }
            front::factorize(&mut panel, rows, columns.len(), &mut update, par)
                .map_err(|column| FactorError::Pivot(columns.start + column))?;
            values.extend_from_slice(&panel);
            if self.supernodes.parents[s] == ROOT {
                self.leave(s, &update, rest.as_mut());
                self.free.push(update);
            } else {
                self.updates[s] = update;
            }
        }
        Ok(())
    }

    /// Copies the matrix's entries in the columns of supernode `s` and notes where its rows are.
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

    fn zeros(&mut self, len: usize) -> Vec<f64> {
        match self.free.pop() {
            Some(mut memory) if memory.capacity() >= len => {
                memory.clear();
                memory.resize(len, 0.0);
                memory
            }
            // To grow would copy what nobody needs.
            _ => vec![0.0; len],
        }
    }

    /// The rows of the current front that a child's rows below are.
    fn target(&mut self, child: usize) {
        let below = self.supernodes.below(child);
        self.targets.clear();
        self.targets
            .extend(below.iter().map(|&i| self.place[i as usize]));
    }

    /// Adds what a front without parent leaves to what stays.
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

/// Adds the columns `which` of a child's update to a square or panel with `rows` rows, whose first
/// row and column are row `first` of the front.
fn add(
    update: &[f64],
    targets: &[u32],
    which: std::ops::Range<usize>,
    to: &mut [f64],
    rows: usize,
    first: usize,
) {
    let n = targets.len();
    for j in which {
        let column = (targets[j] as usize - first) * rows;
        let to = &mut to[column..column + rows];
        for (&i, value) in targets[j..].iter().zip(&update[j * n + j..(j + 1) * n]) {
            to[i as usize - first] += value;
        }
    }
}
