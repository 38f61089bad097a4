//! Rigid motions of many bodies, where each condition touches a few of them: sparse matrices and an interior-point
//! method say what dense ones would take the cube of the number of bodies for.
//!
//! > min ½ ε‖y‖² − f·y   subject to   B y ≤ g
//!
//! is how the bodies come to rest: the forces λ ≥ 0 on its conditions balance the load up to ε y, Bᵀ λ = f − ε y.

use std::collections::{BTreeSet, VecDeque};

use crate::vector::{dot, largest};

/// Motions from which on there are many.
pub(super) const MANY: usize = 100;
/// ε, where load and gaps are about 1.
const SPRING: f64 = 1e-9;
/// What may be left of load and gaps, and the products of gaps and forces: round-off of the load grows as
/// these vanish.
const ENOUGH: [f64; 3] = [1e-10, 1e-12, 1e-13];
/// Most steps; 6 to 20 are usual.
const MOST_STEPS: usize = 60;
/// How near to the end of its positive part a variable may go in a step.
const TO_THE_BOUNDARY: f64 = 0.995;
/// Smallest eigenvalue of BᵀB, relative to the largest, where conditions certainly hold all motions.
const HELD: f64 = 1e-12;
/// Steps of inverse iteration that find it within a factor of some few.
const ITERATIONS: usize = 12;

/// A row of B, by ascending unknowns.
pub(super) type SparseRow = Vec<(usize, f64)>;

/// Conditions against the motions of many bodies.
#[derive(Debug)]
pub(super) struct ManyBodies {
    /// B, its unknowns in an order that leaves the envelope of BᵀB small.
    rows: Vec<SparseRow>,
    /// Where that order has every unknown.
    place: Vec<usize>,
    /// First unknown that shares a condition with each one, in that order.
    first: Vec<usize>,
}

/// How bodies come to rest.
#[derive(Debug)]
pub(super) struct Rest {
    /// y.
    pub motion: Vec<f64>,
    /// ‖f − Bᵀ λ‖.
    pub unbalanced: f64,
}

impl ManyBodies {
    /// The conditions `rows` against `n` unknown motions.
    pub fn new(n: usize, mut rows: Vec<SparseRow>) -> Self {
        let place = order(n, &rows);
        let mut first: Vec<usize> = (0..n).collect();
        for row in &mut rows {
            row.iter_mut().for_each(|(i, _)| *i = place[*i]);
            row.sort_unstable_by_key(|&(i, _)| i);
            if let Some(&(lowest, _)) = row.first() {
                row.iter()
                    .for_each(|&(i, _)| first[i] = first[i].min(lowest));
            }
        }
        Self { rows, place, first }
    }

    /// Number of conditions.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether the conditions certainly hold every motion, were they all closed; if not, some may be free.
    pub fn hold_all(&self) -> bool {
        let mut gram = Envelope::zeros(&self.first);
        gram.add_products(&self.rows, |_| 1.0);
        let size = gram.norm();
        if !gram.factorize(HELD) {
            return false;
        }
        // No motion is orthogonal to this one for a reason.
        let mut x: Vec<f64> = (0..self.first.len())
            .map(|i| 1.0 + (12.9898 * i as f64).sin())
            .collect();
        let mut smallest = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let before = dot(&x, &x).sqrt();
            x.iter_mut().for_each(|x| *x /= before);
            gram.solve(&mut x);
            smallest = 1.0 / dot(&x, &x).sqrt();
        }
        smallest > HELD * size
    }

    /// How the bodies come to rest under `load` where the conditions have these `gaps`; nothing if that wasn't found.
    /// By Mehrotra's predictor and corrector.
    pub fn rest(&self, load: &[f64], gaps: &[f64]) -> Option<Rest> {
        let n = load.len();
        let force = dot(load, load).sqrt() / (n as f64).sqrt();
        let length = match largest(gaps) {
            0.0 => 1.0,
            length => length,
        };
        let mut motion = vec![0.0; n];
        if force == 0.0 {
            return Some(Rest {
                motion,
                unbalanced: 0.0,
            });
        }
        let mut f = vec![0.0; n];
        for (&to, load) in self.place.iter().zip(load) {
            f[to] = load / force;
        }
        let g: Vec<f64> = gaps.iter().map(|gap| gap / length).collect();
        let mut point = Point {
            y: vec![0.0; n],
            left: g.iter().map(|g| g.max(1.0)).collect(),
            lambda: vec![1.0; g.len()],
        };
        for _ in 0..MOST_STEPS {
            let residual = point.residual(self, &f, &g);
            let complementarity = point.complementarity();
            let size = [
                largest(&residual.load),
                largest(&residual.gaps),
                complementarity,
            ];
            if size
                .iter()
                .zip(ENOUGH)
                .all(|(&size, enough)| size <= enough)
            {
                let of_forces = self.actions(&point.lambda);
                let missing = f.iter().zip(&of_forces).map(|(f, forces)| f - forces);
                for (motion, &from) in motion.iter_mut().zip(&self.place) {
                    *motion = length * point.y[from];
                }
                return Some(Rest {
                    motion,
                    unbalanced: force * missing.map(|r| r * r).sum::<f64>().sqrt(),
                });
            }
            let mut matrix = Envelope::zeros(&self.first);
            matrix.add_products(&self.rows, |j| point.lambda[j] / point.left[j]);
            matrix.add_to_diagonal(SPRING);
            if !matrix.factorize(0.0) {
                return None;
            }
            let products = point.left.iter().zip(&point.lambda).map(|(s, l)| -s * l);
            let aim: Vec<f64> = products.collect();
            let predicted = point.change(self, &matrix, &residual, &aim);
            let mut ahead = point.clone();
            ahead.go(&predicted, point.longest(&predicted));
            let centring = (ahead.complementarity() / complementarity).powi(3) * complementarity;
            let of_second_order = predicted.left.iter().zip(&predicted.lambda);
            let aim: Vec<f64> = (aim.iter().zip(of_second_order))
                .map(|(aim, (s, l))| aim + centring - s * l)
                .collect();
            let change = point.change(self, &matrix, &residual, &aim);
            point.go(&change, TO_THE_BOUNDARY * point.longest(&change));
        }
        None
    }

    /// Bᵀ λ.
    fn actions(&self, lambda: &[f64]) -> Vec<f64> {
        let mut actions = vec![0.0; self.first.len()];
        for (row, lambda) in self.rows.iter().zip(lambda) {
            row.iter().for_each(|&(i, b)| actions[i] += b * lambda);
        }
        actions
    }

    /// B y.
    fn jumps<'a>(&'a self, y: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let of_row = |row: &SparseRow| row.iter().map(|&(i, b)| b * y[i]).sum();
        self.rows.iter().map(of_row)
    }
}

/// An order of `n` unknowns in which those that share a row are near each other, by Cuthill and McKee: where each is.
fn order(n: usize, rows: &[SparseRow]) -> Vec<usize> {
    let mut neighbours: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); n];
    for row in rows {
        for &(i, _) in row {
            neighbours[i].extend(row.iter().map(|&(j, _)| j));
        }
    }
    const NOWHERE: usize = usize::MAX;
    let mut place = vec![NOWHERE; n];
    let mut placed = 0;
    for seed in 0..n {
        if place[seed] != NOWHERE {
            continue;
        }
        // What is farthest from anything is at an end.
        let end = *walk(&neighbours, seed).last().unwrap_or(&seed);
        for i in walk(&neighbours, end) {
            place[i] = placed;
            placed += 1;
        }
    }
    place
}

/// All that is connected with `start`, the nearest first.
fn walk(neighbours: &[BTreeSet<usize>], start: usize) -> Vec<usize> {
    let mut is_known = vec![false; neighbours.len()];
    is_known[start] = true;
    let (mut queue, mut all) = (VecDeque::from([start]), Vec::new());
    while let Some(i) = queue.pop_front() {
        all.push(i);
        for &j in &neighbours[i] {
            if !std::mem::replace(&mut is_known[j], true) {
                queue.push_back(j);
            }
        }
    }
    all
}

/// An interior point, or a change of one.
#[derive(Clone, Debug)]
struct Point {
    y: Vec<f64>,
    /// What is left of every gap.
    left: Vec<f64>,
    lambda: Vec<f64>,
}

/// What a point leaves of f − ε y − Bᵀ λ = 0 and g − B y − s = 0.
struct Residual {
    load: Vec<f64>,
    gaps: Vec<f64>,
}

impl Point {
    fn residual(&self, bodies: &ManyBodies, f: &[f64], g: &[f64]) -> Residual {
        let forces = bodies.actions(&self.lambda);
        let terms = f.iter().zip(&self.y).zip(&forces);
        let gaps = g.iter().zip(bodies.jumps(&self.y)).zip(&self.left);
        Residual {
            load: terms.map(|((f, y), r)| f - SPRING * y - r).collect(),
            gaps: gaps.map(|((g, jump), s)| g - jump - s).collect(),
        }
    }

    /// The mean of s λ.
    fn complementarity(&self) -> f64 {
        dot(&self.left, &self.lambda) / self.left.len().max(1) as f64
    }

    /// Newton's change that takes the residual away and adds `aim` to s λ, where `matrix` is the factor of
    /// ε + Bᵀ diag(λ/s) B.
    fn change(
        &self,
        bodies: &ManyBodies,
        matrix: &Envelope<'_>,
        residual: &Residual,
        aim: &[f64],
    ) -> Self {
        let both = || self.left.iter().zip(&self.lambda);
        let push: Vec<f64> = (aim.iter().zip(&residual.gaps).zip(both()))
            .map(|((aim, gap), (s, l))| (aim - l * gap) / s)
            .collect();
        let mut y = bodies.actions(&push);
        for (y, load) in y.iter_mut().zip(&residual.load) {
            *y = load - *y;
        }
        matrix.solve(&mut y);
        let left: Vec<f64> = (residual.gaps.iter().zip(bodies.jumps(&y)))
            .map(|(gap, jump)| gap - jump)
            .collect();
        let lambda = aim.iter().zip(&left).zip(both());
        let lambda = lambda.map(|((aim, ds), (s, l))| (aim - l * ds) / s);
        Self {
            lambda: lambda.collect(),
            y,
            left,
        }
    }

    /// The part of a change, 1 at most, at which something ceases to be positive.
    fn longest(&self, change: &Self) -> f64 {
        let variables = self.left.iter().chain(&self.lambda);
        let changes = change.left.iter().chain(&change.lambda);
        let shrinking = variables.zip(changes).filter(|(_, dx)| **dx < 0.0);
        shrinking.map(|(x, dx)| -x / dx).fold(1.0, f64::min)
    }

    fn go(&mut self, change: &Self, part: f64) {
        let lists = [
            (&mut self.y, &change.y),
            (&mut self.left, &change.left),
            (&mut self.lambda, &change.lambda),
        ];
        for (x, dx) in lists {
            x.iter_mut().zip(dx).for_each(|(x, dx)| *x += part * dx);
        }
    }
}

/// A symmetric matrix, each row from its first entry that isn't 0 to the diagonal; or its Cholesky factor.
struct Envelope<'a> {
    first: &'a [usize],
    rows: Vec<Vec<f64>>,
}

impl<'a> Envelope<'a> {
    fn zeros(first: &'a [usize]) -> Self {
        let row = |(i, &first): (usize, &usize)| vec![0.0; i - first + 1];
        let rows = first.iter().enumerate().map(row).collect();
        Self { first, rows }
    }

    /// Adds Bᵀ diag(`weight`) B.
    fn add_products(&mut self, rows: &[SparseRow], weight: impl Fn(usize) -> f64) {
        for (number, row) in rows.iter().enumerate() {
            let weight = weight(number);
            for (k, &(i, b_i)) in row.iter().enumerate() {
                for &(j, b_j) in &row[..=k] {
                    self.rows[i][j - self.first[i]] += weight * b_i * b_j;
                }
            }
        }
    }

    fn add_to_diagonal(&mut self, value: f64) {
        for row in &mut self.rows {
            row.iter_mut()
                .next_back()
                .into_iter()
                .for_each(|d| *d += value);
        }
    }

    /// A bound of the largest eigenvalue.
    fn norm(&self) -> f64 {
        let mut sums = vec![0.0; self.rows.len()];
        for (i, row) in self.rows.iter().enumerate() {
            for (j, a) in (self.first[i]..).zip(row) {
                sums[i] += a.abs();
                if j < i {
                    sums[j] += a.abs();
                }
            }
        }
        largest(&sums)
    }

    /// A = L Lᵀ; whether all pivots are more than `least` of the diagonal.
    fn factorize(&mut self, least: f64) -> bool {
        for i in 0..self.rows.len() {
            let (before, rest) = self.rows.split_at_mut(i);
            let (first, row) = (self.first[i], &mut rest[0]);
            for j in first..i {
                let common = first.max(self.first[j]);
                let of_column = &before[j][common - self.first[j]..];
                let known = dot(&row[common - first..j - first], &of_column[..j - common]);
                row[j - first] = (row[j - first] - known) / of_column[j - common];
            }
            let diagonal = row[i - first];
            let pivot = diagonal - dot(&row[..i - first], &row[..i - first]);
            if pivot.is_nan() || pivot <= least * diagonal {
                return false;
            }
            row[i - first] = pivot.sqrt();
        }
        true
    }

    /// x ← A⁻¹ x.
    fn solve(&self, x: &mut [f64]) {
        for (i, row) in self.rows.iter().enumerate() {
            let (off, first) = (row.len() - 1, self.first[i]);
            x[i] = (x[i] - dot(&row[..off], &x[first..i])) / row[off];
        }
        for (i, row) in self.rows.iter().enumerate().rev() {
            let (off, first) = (row.len() - 1, self.first[i]);
            x[i] /= row[off];
            let x_i = x[i];
            for (x, l) in x[first..i].iter_mut().zip(row) {
                *x -= l * x_i;
            }
        }
    }
}

#[cfg(test)]
mod tests;
