//! The dense system of equations of fixed statuses, in the scale of energies, with springs where it is singular.

use faer::linalg::solvers::{PartialPivLu, SolveCore};
use faer::{Conj, Mat, MatMut};

use crate::vector::largest;

/// Pivot of the scaled matrix, or reciprocal size of its inverse, below which it counts as singular.
const SINGULAR: f64 = 1e-13;
/// Stiffness of the springs that regularize it, in that scale.
pub(super) const SPRING: f64 = 1e-12;
/// Compliance of closed rows that depend on each other, in that scale: they share the force that one could carry.
pub(super) const YIELD: f64 = 1e-6;
/// Reduction of the springs when refinement leaves more than this part of the right-hand side: soft bodies between
/// stiff ones carry a small part of what their rows could.
const REDUCTION: f64 = 1e-3;
const REFINED: f64 = 1e-12;
/// Maximum number of refinements that remove the forces of the springs.
const MAX_REFINEMENTS: usize = 40;

/// A x = b in the scale of energies.
pub(super) struct System {
    pub a: Mat<f64>,
    /// Limits of the unknowns: open or slipping jumps, then closed or slipping rows.
    pub unknowns: Vec<usize>,
    /// Factors of unknowns, jumps and forces, in that scale.
    pub scale: Vec<f64>,
    /// Spring of every jump and compliance of every closed row, where A is singular.
    pub springs: Vec<f64>,
}

impl System {
    /// Solution A⁻¹ b; 0 where A is singular and b `is_balanced`.
    pub fn solve(&self, b: Vec<f64>, is_balanced: impl Fn() -> bool) -> Vec<f64> {
        let n = b.len();
        let lu = self.a.partial_piv_lu();
        if !is_singular(&lu, n) {
            return self.refine(&lu, &b, 1);
        }
        if is_balanced() {
            return vec![0.0; n];
        }
        let x = self.refine(&self.held(1.0), &b, MAX_REFINEMENTS);
        let residual = |x: &[f64]| largest(&self.remainder(&b, x));
        if residual(&x) <= REFINED * largest(&b) {
            return x;
        }
        let stiffer = self.refine(&self.held(REDUCTION), &b, MAX_REFINEMENTS);
        match residual(&stiffer) < residual(&x) {
            true => stiffer,
            false => x,
        }
    }

    /// Factors of A with its springs, those of rows times `part`.
    fn held(&self, part: f64) -> PartialPivLu<f64> {
        let mut held = self.a.clone();
        for (k, &spring) in self.springs.iter().enumerate() {
            let of_row = spring.abs() == YIELD;
            held[(k, k)] += if of_row { part * spring } else { spring };
        }
        held.partial_piv_lu()
    }

    /// b − A x.
    fn remainder(&self, b: &[f64], x: &[f64]) -> Vec<f64> {
        let mut remainder = b.to_vec();
        for (column, &x) in self.a.col_iter().zip(x) {
            for (remainder, a) in remainder.iter_mut().zip(column.iter()) {
                *remainder -= a * x;
            }
        }
        remainder
    }

    /// Solution A⁻¹ b by iterative refinement with approximate factors.
    fn refine(&self, lu: &PartialPivLu<f64>, b: &[f64], most: usize) -> Vec<f64> {
        let mut x = b.to_vec();
        apply(lu, &mut x);
        let mut last = f64::INFINITY;
        for _ in 0..most {
            let mut remainder = self.remainder(b, &x);
            let size = remainder.iter().fold(0.0, |m: f64, r| m.max(r.abs()));
            if size == 0.0 || size > 0.9 * last || size.is_nan() {
                break;
            }
            last = size;
            apply(lu, &mut remainder);
            for (x, dx) in x.iter_mut().zip(remainder) {
                *x += dx;
            }
        }
        x
    }
}

/// True if A is singular to round-off. A motion without resistance may have little of the last unknowns, so that no
/// pivot is small, but it dominates A⁻¹ times any vector.
fn is_singular(lu: &PartialPivLu<f64>, n: usize) -> bool {
    if (0..n).any(|k| lu.U()[(k, k)].abs() <= SINGULAR) {
        return true;
    }
    let mut x: Vec<f64> = (0..n).map(|i| (1.0 + 12.9898 * i as f64).sin()).collect();
    let size = largest(&x);
    apply(lu, &mut x);
    size <= SINGULAR * largest(&x)
}

fn apply(lu: &PartialPivLu<f64>, x: &mut [f64]) {
    let n = x.len();
    lu.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(x, n, 1));
}
