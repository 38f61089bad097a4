//! The pattern of a symmetric sparse matrix assembled from small dense ones.

use faer::MatRef;

/// Lists of unknowns, one for every assembled dense matrix: the unknowns of an element, or the interface dofs of a
/// subdomain.
#[derive(Clone, Debug)]
pub struct Cliques {
    offsets: Vec<usize>,
    members: Vec<u32>,
}

impl Default for Cliques {
    fn default() -> Self {
        Self {
            offsets: vec![0],
            members: Vec::new(),
        }
    }
}

impl Cliques {
    /// Appends a list.
    pub fn push(&mut self, members: impl IntoIterator<Item = u32>) {
        self.members.extend(members);
        self.offsets.push(self.members.len());
    }

    /// Number of lists.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// List `c`.
    pub fn get(&self, c: usize) -> &[u32] {
        &self.members[self.offsets[c]..self.offsets[c + 1]]
    }

    /// The lists that contain each of `n` unknowns, as offsets and list numbers.
    pub(super) fn transposed(&self, n: usize) -> (Vec<usize>, Vec<u32>) {
        let mut offsets = vec![0; n + 1];
        for &i in &self.members {
            offsets[i as usize + 1] += 1;
        }
        for i in 0..n {
            offsets[i + 1] += offsets[i];
        }
        let mut next = offsets.clone();
        let mut lists = vec![0; self.members.len()];
        for c in 0..self.len() {
            for &i in self.get(c) {
                lists[next[i as usize]] = c as u32;
                next[i as usize] += 1;
            }
        }
        (offsets, lists)
    }
}

/// The pattern of the lower triangle by columns: rows ascending, the diagonal first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LowerPattern {
    pub(super) columns: Vec<u32>,
    pub(super) rows: Vec<u32>,
}

impl LowerPattern {
    /// The pattern of a sum of dense matrices over `cliques` of `n` unknowns.
    ///
    /// Returns `None` if it has more than 2³² entries.
    pub fn new(n: usize, cliques: &Cliques) -> Option<Self> {
        let (offsets, lists) = cliques.transposed(n);
        let mut columns = Vec::with_capacity(n + 1);
        let mut rows: Vec<u32> = Vec::new();
        let mut seen = vec![u32::MAX; n];
        columns.push(0);
        for j in 0..n as u32 {
            let start = rows.len();
            rows.push(j);
            seen[j as usize] = j;
            for &c in &lists[offsets[j as usize]..offsets[j as usize + 1]] {
                for &i in cliques.get(c as usize) {
                    if i > j && seen[i as usize] != j {
                        seen[i as usize] = j;
                        rows.push(i);
                    }
                }
            }
            rows[start + 1..].sort_unstable();
            columns.push(u32::try_from(rows.len()).ok()?);
        }
        Some(Self { columns, rows })
    }

    /// The pattern of a sum of dense matrices over `cliques` of sites; site s is the run of unknowns
    /// `starts[s]..starts[s + 1]`, at least one.
    ///
    /// Returns `None` if it has more than 2³² entries.
    pub fn of_sites(starts: &[u32], cliques: &Cliques) -> Option<Self> {
        let sites = Self::new(starts.len() - 1, cliques)?;
        let n = starts.last().map_or(0, |&n| n as usize);
        let mut columns = Vec::with_capacity(n + 1);
        let mut rows: Vec<u32> = Vec::with_capacity(5 * sites.len());
        columns.push(0);
        for s in 0..sites.n() {
            let first = rows.len();
            for &t in sites.rows_of(s) {
                rows.extend(starts[t as usize]..starts[t as usize + 1]);
            }
            let end = rows.len();
            columns.push(u32::try_from(end).ok()?);
            for skipped in 1..(starts[s + 1] - starts[s]) as usize {
                rows.extend_from_within(first + skipped..end);
                columns.push(u32::try_from(rows.len()).ok()?);
            }
        }
        Some(Self { columns, rows })
    }

    /// Number of unknowns.
    pub fn n(&self) -> usize {
        self.columns.len() - 1
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// The indices of the entries of column `j`.
    pub fn column(&self, j: usize) -> std::ops::Range<usize> {
        self.columns[j] as usize..self.columns[j + 1] as usize
    }

    /// The rows of column `j`, ascending from the diagonal.
    pub fn rows_of(&self, j: usize) -> &[u32] {
        &self.rows[self.column(j)]
    }
}

/// A symmetric sparse matrix, its lower triangle by columns.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseSymmetric {
    /// Pattern.
    pub pattern: LowerPattern,
    /// Values in the order of the pattern.
    pub values: Vec<f64>,
}

impl SparseSymmetric {
    /// A zero matrix.
    pub fn zeros(pattern: LowerPattern) -> Self {
        let values = vec![0.0; pattern.len()];
        Self { pattern, values }
    }

    /// Adds a dense symmetric matrix over the unknowns `dofs`; `entry(a, b)` is called once for every pair with
    /// `dofs[a] ≥ dofs[b]`. The pattern must contain all pairs.
    pub fn add(&mut self, dofs: &[u32], entry: impl Fn(usize, usize) -> f64) {
        for (b, &j) in dofs.iter().enumerate() {
            let range = self.pattern.column(j as usize);
            let rows = &self.pattern.rows[range.clone()];
            for (a, &i) in dofs.iter().enumerate() {
                if i < j {
                    continue;
                }
                if let Ok(place) = rows.binary_search(&i) {
                    self.values[range.start + place] += entry(a, b);
                }
            }
        }
    }

    /// Adds a dense symmetric `matrix` over many unknowns `dofs`; both triangles are filled.
    pub fn add_large(&mut self, dofs: &[u32], matrix: MatRef<'_, f64>) {
        let mut place = vec![0; self.pattern.n()];
        for (&j, column) in dofs.iter().zip(matrix.col_iter()) {
            for (at, &i) in (self.pattern.column(j as usize)).zip(self.pattern.rows_of(j as usize))
            {
                place[i as usize] = at;
            }
            for (&i, entry) in dofs.iter().zip(column.iter()) {
                if i >= j {
                    self.values[place[i as usize]] += entry;
                }
            }
        }
    }

    /// Adds a dense symmetric matrix over runs of `width` unknowns that begin at `firsts`, each a site of the pattern;
    /// `entry` is called as in [`add`](Self::add).
    pub fn add_runs(&mut self, firsts: &[u32], width: usize, entry: impl Fn(usize, usize) -> f64) {
        for (q, &j) in firsts.iter().enumerate() {
            let range = self.pattern.column(j as usize);
            for (p, &i) in firsts.iter().enumerate() {
                if i < j {
                    continue;
                }
                let rows = &self.pattern.rows[range.clone()];
                let Some(offset) = rows.iter().position(|&row| row == i) else {
                    continue;
                };
                for b in 0..width {
                    // Each column of a run begins one row below the previous one.
                    let column = self.pattern.columns[j as usize + b] as usize + offset;
                    for a in if i == j { b } else { 0 }..width {
                        self.values[column + a - b] += entry(p * width + a, q * width + b);
                    }
                }
            }
        }
    }

    /// Adds a sparse matrix whose pattern is contained in this one's.
    pub fn add_sparse(&mut self, other: &Self) {
        for j in 0..other.pattern.n() {
            let range = self.pattern.column(j);
            let mut place = range.start;
            for (from, &i) in other.pattern.column(j).zip(other.pattern.rows_of(j)) {
                while place < range.end && self.pattern.rows[place] < i {
                    place += 1;
                }
                self.values[place] += other.values[from];
            }
        }
    }

    /// y ← y + A x.
    pub fn multiply_add(&self, x: &[f64], y: &mut [f64]) {
        for j in 0..self.pattern.n() {
            let range = self.pattern.column(j);
            let mut sum = self.values[range.start] * x[j];
            for place in range.start + 1..range.end {
                let i = self.pattern.rows[place] as usize;
                let a = self.values[place];
                y[i] += a * x[j];
                sum += a * x[i];
            }
            y[j] += sum;
        }
    }

    /// y ← y + |A| |x|.
    pub fn multiply_add_absolute(&self, x: &[f64], y: &mut [f64]) {
        for j in 0..self.pattern.n() {
            let range = self.pattern.column(j);
            let mut sum = (self.values[range.start] * x[j]).abs();
            for place in range.start + 1..range.end {
                let i = self.pattern.rows[place] as usize;
                let a = self.values[place].abs();
                y[i] += a * x[j].abs();
                sum += a * x[i].abs();
            }
            y[j] += sum;
        }
    }

    /// The diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        (0..self.pattern.n())
            .map(|j| self.values[self.pattern.column(j).start])
            .collect()
    }
}
