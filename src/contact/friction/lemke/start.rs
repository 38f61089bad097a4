//! Start of the path: the linear system from which pivots exchange zero quantities.
//!
//! Jumps and forces of all limits are linear in as many unknowns as there are limits: the independent jumps and the
//! forces of the dependent rows. Each limit has one quantity that is 0, an equation for them:
//!
//! ```text
//! x = A y + x₀,    aₖᵀ x + rₖ = 0
//! ```
//!
//! x holds jumps and forces, y the unknowns. Pivots exchange one equation after the other and gather round-off; here
//! the system is solved anew for all of them at once.

use faer::Mat;
use faer::linalg::solvers::Solve;

use super::responses::Terms;
use crate::contact::friction::FrictionProblem;
use crate::vector::axpy;

/// Compliance of closed rows that depend on each other.
const YIELD: f64 = 1e-8;
/// Stiffness of springs on all jumps, for motions without resistance.
const SPRING: f64 = 1e-10;

/// The system, in the scale of energies.
pub(super) struct Start {
    /// A: jumps of all limits, then their forces, for a unit of each independent jump and of the force of each dependent
    /// row.
    columns: Mat<f64>,
    /// x₀: both with all of these at 0.
    constants: Vec<f64>,
    /// Number of independent jumps.
    pub(super) independent: usize,
}

/// The equation of a limit.
pub(super) enum Equation {
    /// An independent jump is 0.
    Jump(usize),
    /// A combination of jumps and forces is 0; with its value at x₀ for θ = 0 and for a unit of θ.
    Combination(Terms, [f64; 2]),
}

impl Start {
    /// The system of a problem, from the factors `scale` of its jumps and the scaled `bounds`.
    pub(super) fn new(problem: &FrictionProblem<'_>, scale: &[f64], bounds: &[f64]) -> Self {
        let contact = &problem.contact;
        let (m, count) = (contact.c.len(), bounds.len());
        let mut columns = Mat::zeros(2 * count, count);
        let mut constants = vec![0.0; 2 * count];
        constants[..m].copy_from_slice(&bounds[..m]);
        for i in 0..m {
            let stiffness = |j: usize| contact.h[(i, j)] / (scale[i] * scale[j]);
            let held: f64 = (0..m).map(|j| stiffness(j) * bounds[j]).sum();
            constants[count + i] = contact.c[i] / scale[i] - held;
            (0..m).for_each(|j| columns[(count + i, j)] = stiffness(j));
            columns[(count + i, i)] += SPRING;
            columns[(i, i)] = -1.0;
        }
        for (k, row) in (m..).zip(contact.rows.iter()) {
            for &(i, c) in row {
                let c = c * scale[k] / scale[i];
                constants[k] += c * bounds[i];
                columns[(k, i)] -= c;
                columns[(count + i, k)] -= c;
            }
            columns[(k, k)] = -YIELD;
            columns[(count + k, k)] = 1.0;
        }
        Self {
            columns,
            constants,
            independent: m,
        }
    }

    /// Forces of all limits at x₀.
    pub(super) fn forces(&self) -> &[f64] {
        &self.constants[self.columns.ncols()..]
    }

    /// x₀ at θ = 0, and for every unit of θ.
    pub(super) fn values(&self) -> [Vec<f64>; 2] {
        [self.constants.clone(), vec![0.0; self.constants.len()]]
    }

    /// Jumps and forces for a unit of each limit's quantity, a column each; adds to `values` what they are with all of
    /// these quantities at 0.
    pub(super) fn solved(&self, equations: &[Equation], values: &mut [Vec<f64>; 2]) -> Mat<f64> {
        let count = equations.len();
        // Known jumps, and the limit of each.
        let known: Vec<(usize, usize)> = (equations.iter().enumerate())
            .filter_map(|(k, equation)| match *equation {
                Equation::Jump(i) => Some((k, i)),
                Equation::Combination(..) => None,
            })
            .collect();
        let mut is_unknown = vec![true; count];
        known.iter().for_each(|&(_, i)| is_unknown[i] = false);
        let unknown: Vec<usize> = (0..count).filter(|&i| is_unknown[i]).collect();
        // A column for every quantity, and two for the values.
        let mut change = Mat::zeros(unknown.len(), count + 2);
        let mut matrix = Mat::zeros(unknown.len(), unknown.len());
        let combinations =
            (equations.iter().enumerate()).filter_map(|(k, equation)| match equation {
                Equation::Jump(_) => None,
                Equation::Combination(terms, value) => Some((k, terms, value)),
            });
        for (row, (k, terms, value)) in combinations.enumerate() {
            let of = |j: usize| {
                let terms = terms.iter().map(|&(t, c)| c * self.columns[(t, j)]);
                terms.sum::<f64>()
            };
            for (l, &j) in unknown.iter().enumerate() {
                matrix[(row, l)] = of(j);
            }
            for &(column, i) in &known {
                change[(row, column)] = -of(i);
            }
            change[(row, k)] = 1.0;
            change[(row, count)] = -value[0];
            change[(row, count + 1)] = -value[1];
        }
        matrix.partial_piv_lu().solve_in_place(&mut change);
        let of_unknown = Mat::from_fn(2 * count, unknown.len(), |i, l| {
            self.columns[(i, unknown[l])]
        });
        let mut all = of_unknown * change;
        for (k, value) in values.iter_mut().enumerate() {
            axpy(1.0, all.col_as_slice(count + k), value);
        }
        for (column, i) in known {
            axpy(
                1.0,
                self.columns.col_as_slice(i),
                all.col_as_slice_mut(column),
            );
        }
        all.resize_with(2 * count, count, |_, _| 0.0);
        all
    }
}
