//! Rigid-body motions of many bodies, each constraint touching few of them: sparse matrices and an interior-point
//! method avoid the cubic cost of dense matrices.
//!
//! > min ½ ε‖y‖² − f·y   subject to   B y ≤ g
//!
//! is the rest position of the bodies: the forces λ ≥ 0 of its constraints balance the load up to ε y, Bᵀ λ = f − ε y.

use faer::Par;

use super::null_space::RANK_TOLERANCE;
use crate::comm::is_asked_to_stop;
use crate::schur::factor::BoundaryLastCholesky;
use crate::schur::ordering::nested_dissection;
use crate::schur::pattern::{Cliques, LowerPattern, SparseSymmetric};
use crate::vector::{axpy, dot, largest};

/// Number of motions from which on the sparse method is used.
pub(super) const MANY: usize = 100;
/// ε of the rest position, for loads and gaps scaled to about 1.
const SPRING: f64 = 1e-9;
/// Largest residuals of load and of gaps, and largest product of gap and force; as these products vanish, the round-off
/// in the load residual grows.
const TOLERANCES: [f64; 3] = [1e-10, 1e-12, 1e-13];
/// Most iterations; 6 to 20 are usual.
const MOST_STEPS: usize = 60;
/// Steps of iterative refinement of a Newton step: the matrices of high towers are ill-conditioned.
const REFINEMENTS: usize = 2;
/// Fraction of the longest step that keeps all variables positive.
const TO_THE_BOUNDARY: f64 = 0.995;
/// Shift of BᵀB, relative to its largest entry, that makes it definite for inverse iteration on its null space.
const SHIFT: f64 = 1e-14;
/// Inverse iterations, after which components restrained as weakly as by the shift have vanished.
const ITERATIONS: usize = 12;

/// A row of B.
pub(super) type SparseRow = Vec<(usize, f64)>;

/// Contact constraints on the motions of many bodies.
#[derive(Debug)]
pub(super) struct ManyBodies {
    /// B, its unknowns in elimination order.
    rows: Vec<SparseRow>,
    /// The place of every unknown in that order.
    place: Vec<usize>,
    /// The pattern of BᵀB.
    pattern: LowerPattern,
}

/// A rest position of bodies.
#[derive(Debug)]
pub(super) struct Rest {
    /// y.
    pub motion: Vec<f64>,
    /// f − Bᵀ λ.
    pub left: Vec<f64>,
    /// λ.
    pub forces: Vec<f64>,
}

impl Rest {
    /// ‖f − Bᵀ λ‖.
    pub fn unbalanced(&self) -> f64 {
        dot(&self.left, &self.left).sqrt()
    }
}

impl ManyBodies {
    /// The constraints `rows` on unknown motions of bodies at these `points`; `None` if they are too many for a sparse
    /// matrix.
    pub fn new(points: &[[f64; 3]], mut rows: Vec<SparseRow>) -> Option<Self> {
        let order = nested_dissection(points, &cliques(&rows));
        let mut place = vec![0; points.len()];
        for (at, &i) in order.iter().enumerate() {
            place[i as usize] = at;
        }
        for (i, _) in rows.iter_mut().flatten() {
            *i = place[*i];
        }
        Some(Self {
            pattern: LowerPattern::new(points.len(), &cliques(&rows))?,
            rows,
            place,
        })
    }

    /// Number of constraints.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// An orthonormal basis of the motions that no constraint would restrain if all were closed, by inverse iteration;
    /// each is fixed before the next is computed. `None` if a signal stopped the computation.
    ///
    /// The resistance to a motion is evaluated with B: BᵀB has half as many accurate digits.
    pub fn unheld(&self) -> Option<Vec<Vec<f64>>> {
        let n = self.place.len();
        let gram = self.products(|_| 1.0, 0.0);
        let mut row_sums = vec![0.0; n];
        gram.multiply_add_absolute(&vec![1.0; n], &mut row_sums);
        let most = largest(&row_sums);
        let (mut pins, mut motions): (Vec<usize>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
        while motions.len() < n {
            if is_asked_to_stop() {
                return None;
            }
            let spring = if most > 0.0 { SHIFT * most } else { 1.0 };
            let mut matrix = self.products(|_| 1.0, spring);
            for &pin in &pins {
                matrix.add(&[pin as u32], |_, _| most);
            }
            let factor = factorized(&matrix)?;
            // An arbitrary vector, so that no motion is orthogonal to it by symmetry.
            let mut x: Vec<f64> = (0..n).map(|i| 1.0 + (12.9898 * i as f64).sin()).collect();
            for _ in 0..ITERATIONS {
                factor.solve(&mut x);
                normalize(&mut x);
            }
            let held: f64 = self.jumps(&x).map(|jump| jump * jump).sum();
            let pinned: f64 = pins.iter().map(|&pin| most * x[pin] * x[pin]).sum();
            if held + pinned > RANK_TOLERANCE.powi(2) * most {
                break;
            }
            let farthest = (0..n).max_by(|&a, &b| x[a].abs().total_cmp(&x[b].abs()));
            pins.extend(farthest);
            for _ in 0..2 {
                for z in &motions {
                    axpy(-dot(z, &x), z, &mut x);
                }
            }
            normalize(&mut x);
            motions.push(x);
        }
        let given = |x: Vec<f64>| self.place.iter().map(|&at| x[at]).collect();
        Some(motions.into_iter().map(given).collect())
    }

    /// The rest position under `load` with these `gaps` at the constraints; `None` if it isn't found.
    pub fn rest(&self, load: &[f64], gaps: &[f64]) -> Option<Rest> {
        self.rest_on(SPRING, load, gaps)
    }

    /// The part of a `load` that the nearest forces λ ≥ 0 leave unbalanced; `None` if it isn't found.
    ///
    /// It is the projection of the load onto the motions that the constraints allow, which is y for ε = 1 (Moreau).
    pub fn residual(&self, load: &[f64]) -> Option<Rest> {
        self.rest_on(1.0, load, &vec![0.0; self.len()])
    }

    /// The rest position with ε = `spring`, by Mehrotra's predictor-corrector method.
    fn rest_on(&self, spring: f64, load: &[f64], gaps: &[f64]) -> Option<Rest> {
        let n = load.len();
        let force = dot(load, load).sqrt() / (n as f64).sqrt();
        let length = match largest(gaps) {
            0.0 => 1.0,
            length => length,
        };
        if force == 0.0 {
            return Some(Rest {
                motion: vec![0.0; n],
                left: vec![0.0; n],
                forces: vec![0.0; self.len()],
            });
        }
        let mut f = vec![0.0; n];
        for (&to, load) in self.place.iter().zip(load) {
            f[to] = load / force;
        }
        let g: Vec<f64> = gaps.iter().map(|gap| gap / length).collect();
        let mut point = Iterate {
            y: vec![0.0; n],
            left: g.iter().map(|g| g.max(1.0)).collect(),
            lambda: vec![1.0; g.len()],
        };
        for _ in 0..MOST_STEPS {
            if is_asked_to_stop() {
                return None;
            }
            let residual = point.residual(self, spring, &f, &g);
            let complementarity = point.complementarity();
            let size = [
                largest(&residual.load),
                largest(&residual.gaps),
                complementarity,
            ];
            if size
                .iter()
                .zip(TOLERANCES)
                .all(|(size, enough)| *size <= enough)
            {
                return Some(self.at_rest(&point, &f, force, length));
            }
            let matrix = self.products(|j| point.lambda[j] / point.left[j], spring);
            let matrix = factorized(&matrix)?;
            let products = point.left.iter().zip(&point.lambda).map(|(s, l)| -s * l);
            let aim: Vec<f64> = products.collect();
            let predicted = point.change(self, spring, &matrix, &residual, &aim);
            let mut ahead = point.clone();
            ahead.go(&predicted, point.longest(&predicted));
            let centring = (ahead.complementarity() / complementarity).powi(3) * complementarity;
            let of_second_order = predicted.left.iter().zip(&predicted.lambda);
            let aim: Vec<f64> = (aim.iter().zip(of_second_order))
                .map(|(aim, (s, l))| aim + centring - s * l)
                .collect();
            let change = point.change(self, spring, &matrix, &residual, &aim);
            point.go(&change, TO_THE_BOUNDARY * point.longest(&change));
        }
        None
    }

    /// The rest position at an iterate whose load f has the unit `force` and whose gaps have the unit `length`.
    fn at_rest(&self, point: &Iterate, f: &[f64], force: f64, length: f64) -> Rest {
        let of_forces = self.actions(&point.lambda);
        let missing = |&at: &usize| force * (f[at] - of_forces[at]);
        Rest {
            motion: self.place.iter().map(|&at| length * point.y[at]).collect(),
            left: self.place.iter().map(missing).collect(),
            forces: point.lambda.iter().map(|lambda| force * lambda).collect(),
        }
    }

    /// Bᵀ diag(`weight`) B + `spring` I.
    fn products(&self, weight: impl Fn(usize) -> f64, spring: f64) -> SparseSymmetric {
        let mut matrix = SparseSymmetric::zeros(self.pattern.clone());
        for (j, row) in self.rows.iter().enumerate() {
            let unknowns: Vec<u32> = row.iter().map(|&(i, _)| i as u32).collect();
            let weight = weight(j);
            matrix.add(&unknowns, |a, b| weight * row[a].1 * row[b].1);
        }
        for i in 0..self.place.len() as u32 {
            matrix.add(&[i], |_, _| spring);
        }
        matrix
    }

    /// Bᵀ λ.
    fn actions(&self, lambda: &[f64]) -> Vec<f64> {
        let mut actions = vec![0.0; self.place.len()];
        for (row, lambda) in self.rows.iter().zip(lambda) {
            row.iter().for_each(|&(i, b)| actions[i] += b * lambda);
        }
        actions
    }

    /// B y.
    fn jumps<'a>(&'a self, y: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.rows.iter().map(|row| jump(row, y))
    }
}

/// A row of B times y.
pub(super) fn jump(row: &SparseRow, y: &[f64]) -> f64 {
    row.iter().map(|&(i, b)| b * y[i]).sum()
}

fn normalize(x: &mut [f64]) {
    let size = dot(x, x).sqrt();
    x.iter_mut().for_each(|x| *x /= size);
}

/// The unknowns of each row, which are mutually coupled.
fn cliques(rows: &[SparseRow]) -> Cliques {
    let mut cliques = Cliques::default();
    (rows.iter()).for_each(|row| cliques.push(row.iter().map(|&(i, _)| i as u32)));
    cliques
}

fn factorized(matrix: &SparseSymmetric) -> Option<BoundaryLastCholesky> {
    BoundaryLastCholesky::new(matrix, matrix.pattern.n(), Par::Seq).ok()
}

/// An iterate of the interior-point method, or a step between two.
#[derive(Clone, Debug)]
struct Iterate {
    y: Vec<f64>,
    /// The slack of every gap.
    left: Vec<f64>,
    lambda: Vec<f64>,
}

/// Residuals of a point in f − ε y − Bᵀ λ = 0 and g − B y − s = 0.
struct Residual {
    load: Vec<f64>,
    gaps: Vec<f64>,
}

impl Iterate {
    fn residual(&self, bodies: &ManyBodies, spring: f64, f: &[f64], g: &[f64]) -> Residual {
        let forces = bodies.actions(&self.lambda);
        let terms = f.iter().zip(&self.y).zip(&forces);
        let gaps = g.iter().zip(bodies.jumps(&self.y)).zip(&self.left);
        Residual {
            load: terms.map(|((f, y), r)| f - spring * y - r).collect(),
            gaps: gaps.map(|((g, jump), s)| g - jump - s).collect(),
        }
    }

    /// The mean of s λ.
    fn complementarity(&self) -> f64 {
        dot(&self.left, &self.lambda) / self.left.len().max(1) as f64
    }

    /// Newton's step that removes the residual and adds `aim` to s λ; `matrix` is the factor of ε + Bᵀ diag(λ/s) B.
    fn change(
        &self,
        bodies: &ManyBodies,
        spring: f64,
        matrix: &BoundaryLastCholesky,
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
        let mut change = Self {
            lambda: lambda.collect(),
            y,
            left,
        };
        for _ in 0..REFINEMENTS {
            let forces = bodies.actions(&change.lambda);
            let terms = residual.load.iter().zip(&change.y).zip(&forces);
            let missing = terms.map(|((load, y), force)| load - spring * y - force);
            let mut missing: Vec<f64> = missing.collect();
            matrix.solve(&mut missing);
            for (j, jump) in bodies.jumps(&missing).enumerate() {
                change.left[j] -= jump;
                change.lambda[j] += self.lambda[j] / self.left[j] * jump;
            }
            axpy(1.0, &missing, &mut change.y);
        }
        change
    }

    /// The largest step length, at most 1, that keeps all variables non-negative.
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

#[cfg(test)]
mod tests;
