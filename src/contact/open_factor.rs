//! H_NN⁻¹: H on the open conditions N, factorized even where it is singular.
//!
//! > S_kl'(U) = S_ΓΓ − S_ΓN H_NN⁻¹ S_NΓ

use faer::linalg::solvers::{Llt, SolveCore};
use faer::{Conj, Mat, MatMut, MatRef, Side};

use super::active_equalities::ActiveEqualities;
use super::dependent::DependentConstraints;
use crate::vector::axpy;

/// Pivot, relative to its diagonal entry, below which H is taken as singular.
const SINGULAR_PIVOT: f64 = 1e-13;
/// Diagonal entry, relative to the stiffness it is condensed from, below which it is round-off.
const SINGULAR_DIAGONAL: f64 = 1e-14;
/// Stiffness of the springs that make a singular H definite, relative to its diagonal, in the order of trial.
const SPRINGS: [f64; 4] = [1e-12, 1e-10, 1e-8, 1e-6];
/// Most refinements of a solution that springs have falsified.
const MAX_REFINEMENTS: usize = 40;

/// The Cholesky factor of H_NN on the open conditions N.
///
/// H is singular where a motion opens gaps without resistance. Springs make it definite then, and refinement removes
/// their forces again: the load along the motion decides how far it goes, and without a load it stays at rest. Closed
/// linearly dependent constraints leave fewer directions: H_NN is that of the open normal jumps that they leave
/// independent.
#[derive(Debug)]
pub struct OpenFactor {
    /// The open normal jumps, ascending.
    pub open: Vec<usize>,
    /// Equalities between the open normal jumps from the closed linearly dependent constraints.
    pub equalities: ActiveEqualities,
    /// The open normal jumps that no equality eliminates, ascending; empty where there is no equality.
    independent: Vec<usize>,
    h_nn: Mat<f64>,
    factor: Option<Llt<f64>>,
    /// True if springs were needed.
    pub singular: bool,
}

impl OpenFactor {
    /// Factorizes H_NN; `diagonal` is the diagonal of the matrix that H is condensed from, `open` has a flag for every
    /// normal jump and one for each of `rows`.
    pub fn new(
        h: MatRef<'_, f64>,
        diagonal: &[f64],
        rows: &DependentConstraints,
        open: &[bool],
    ) -> Self {
        let equalities = ActiveEqualities::new(rows, open);
        let open: Vec<usize> = (0..diagonal.len()).filter(|&j| open[j]).collect();
        let mut diagonal: Vec<f64> = open.iter().map(|&j| diagonal[j]).collect();
        let mut h_nn = Mat::zeros(open.len(), open.len());
        let mut independent = Vec::new();
        if equalities.equalities.is_empty() {
            gather(h, &open, &mut h_nn);
        } else {
            let is_pivot = |j: &usize| {
                equalities
                    .equalities
                    .iter()
                    .any(|equality| equality.pivot == *j)
            };
            independent = open.iter().copied().filter(|j| !is_pivot(j)).collect();
            (h_nn, diagonal) = eliminated(h, &diagonal, &open, &independent, &equalities);
        }
        let scale: Vec<f64> = (diagonal.iter().enumerate())
            .map(|(a, &diagonal)| scale_of(h_nn[(a, a)], diagonal))
            .collect();
        let round_off = (diagonal.iter().enumerate())
            .any(|(a, &diagonal)| h_nn[(a, a)] <= SINGULAR_DIAGONAL * diagonal);
        let regular = (!round_off).then(|| factorize(h_nn.as_ref(), &scale, 0.0));
        let singular = !scale.is_empty() && regular.as_ref().is_none_or(Option::is_none);
        let factor = regular.flatten().or_else(|| {
            SPRINGS
                .iter()
                .find_map(|&spring| factorize(h_nn.as_ref(), &scale, spring))
        });
        Self {
            open,
            equalities,
            independent,
            h_nn,
            factor,
            singular,
        }
    }

    /// x ← H_NN⁻¹ x, `x` the entries of the open normal jumps; with equalities T (Tᵀ H_NN T)⁻¹ Tᵀ x, where T maps the
    /// independent jumps to all.
    pub fn solve(&self, x: &mut [f64]) {
        if self.equalities.equalities.is_empty() {
            self.solve_independent(x);
            return;
        }
        // The entries of `open` and `independent` are sorted, and every eliminated normal jump is open.
        let place = |j: usize| self.open.partition_point(|&i| i < j);
        for equality in &self.equalities.equalities {
            let held = x[place(equality.pivot)];
            for &(i, c) in &equality.others {
                x[place(i)] -= c * held;
            }
        }
        let mut of_independent: Vec<f64> = self.independent.iter().map(|&j| x[place(j)]).collect();
        self.solve_independent(&mut of_independent);
        for (&j, of_independent) in self.independent.iter().zip(of_independent) {
            x[place(j)] = of_independent;
        }
        for equality in &self.equalities.equalities {
            let others = equality.others.iter().map(|&(i, c)| c * x[place(i)]);
            x[place(equality.pivot)] = -others.sum::<f64>();
        }
    }

    fn solve_independent(&self, x: &mut [f64]) {
        let Some(factor) = &self.factor else { return };
        let apply = |x: &mut [f64]| {
            let n = x.len();
            let column = MatMut::from_column_major_slice_mut(x, n, 1);
            factor.solve_in_place_with_conj(Conj::No, column);
        };
        let load = x.to_vec();
        apply(x);
        let refinements = if self.singular { MAX_REFINEMENTS } else { 1 };
        let mut last = f64::INFINITY;
        for _ in 0..refinements {
            let mut left = load.clone();
            for (column, &x) in self.h_nn.col_iter().zip(x.iter()) {
                for (left, h) in left.iter_mut().zip(column.iter()) {
                    *left -= h * x;
                }
            }
            // Loads along motions without resistance stay with the springs, whatever refinement does.
            let size = left.iter().fold(0.0, |m: f64, r| m.max(r.abs()));
            if size == 0.0 || size > 0.9 * last || size.is_nan() {
                break;
            }
            last = size;
            apply(&mut left);
            axpy(1.0, &left, x);
        }
    }
}

/// The rows and columns of H of `open` normal jumps.
fn gather(h: MatRef<'_, f64>, open: &[usize], h_nn: &mut Mat<f64>) {
    for (b, &j) in open.iter().enumerate() {
        for (a, &i) in open.iter().enumerate() {
            h_nn[(a, b)] = h[(i, j)];
        }
    }
}

/// Tᵀ H_NN T on the `independent` normal jumps, and the `diagonal` of the open ones transformed likewise.
fn eliminated(
    h: MatRef<'_, f64>,
    diagonal: &[f64],
    open: &[usize],
    independent: &[usize],
    equalities: &ActiveEqualities,
) -> (Mat<f64>, Vec<f64>) {
    let mut whole = Mat::zeros(open.len(), open.len());
    gather(h, open, &mut whole);
    let mut diagonal = diagonal.to_vec();
    let place = |j: usize| open.partition_point(|&i| i < j);
    for equality in &equalities.equalities {
        let pivot = place(equality.pivot);
        for &(i, c) in &equality.others {
            let i = place(i);
            for a in 0..open.len() {
                let moved = c * whole[(a, pivot)];
                whole[(a, i)] -= moved;
            }
            diagonal[i] += c * c * diagonal[pivot];
        }
    }
    for equality in &equalities.equalities {
        let pivot = place(equality.pivot);
        for &(i, c) in &equality.others {
            let i = place(i);
            for b in 0..open.len() {
                let moved = c * whole[(pivot, b)];
                whole[(i, b)] -= moved;
            }
        }
    }
    let places: Vec<usize> = independent.iter().map(|&j| place(j)).collect();
    let mut h_nn = Mat::zeros(independent.len(), independent.len());
    gather(whole.as_ref(), &places, &mut h_nn);
    let diagonal = places.iter().map(|&a| diagonal[a]).collect();
    (h_nn, diagonal)
}

/// Scale of an entry on H's diagonal.
pub fn scale_of(entry: f64, diagonal: f64) -> f64 {
    if entry > SINGULAR_DIAGONAL * diagonal {
        entry
    } else {
        diagonal
    }
}

/// The factor of H + `spring` · diag(`scale`); `None` if that is singular.
pub fn factorize(h: MatRef<'_, f64>, scale: &[f64], spring: f64) -> Option<Llt<f64>> {
    let mut sum = h.to_owned();
    for (j, scale) in scale.iter().enumerate() {
        sum[(j, j)] += spring * scale;
    }
    let factor = sum.llt(Side::Lower).ok()?;
    let l = factor.L();
    let least = SINGULAR_PIVOT.max(0.1 * spring);
    let regular = (0..scale.len()).all(|j| l[(j, j)] * l[(j, j)] > least * scale[j]);
    regular.then_some(factor)
}
