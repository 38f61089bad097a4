//! H on the open conditions, factorized even where it is singular.

use faer::linalg::solvers::{Llt, SolveCore};
use faer::{Conj, Mat, MatMut, MatRef, Side};

/// Pivot relative to its diagonal entry below which H is taken as singular.
const SINGULAR_PIVOT: f64 = 1e-13;
/// Diagonal entry relative to the stiffness it is condensed from below which it is round-off.
const SINGULAR_DIAGONAL: f64 = 1e-14;
/// Stiffness of the springs that make H definite where it isn't, relative to its diagonal, from
/// the softest on.
const SPRINGS: [f64; 4] = [1e-12, 1e-10, 1e-8, 1e-6];
/// Most refinements of a solution that springs have bent.
const MAX_REFINEMENTS: usize = 40;

/// The Cholesky factor of H_NN on the open conditions N.
///
/// H is singular where a motion opens gaps without resistance. Springs make it definite then, and
/// refinement takes their forces off again: what drives the motion decides how far it goes, and
/// where nothing drives it, it stays where it is.
#[derive(Debug)]
pub struct OpenFactor {
    /// The open conditions, ascending.
    pub open: Vec<usize>,
    h_nn: Mat<f64>,
    factor: Option<Llt<f64>>,
    singular: bool,
}

impl OpenFactor {
    /// Factorizes H_NN; `stiffness` is the diagonal of the matrix that H is condensed from.
    pub fn new(h: MatRef<'_, f64>, stiffness: &[f64], open: &[bool]) -> Self {
        let open: Vec<usize> = (0..open.len()).filter(|&j| open[j]).collect();
        let mut h_nn = Mat::zeros(open.len(), open.len());
        for (b, &j) in open.iter().enumerate() {
            for (a, &i) in open.iter().enumerate() {
                h_nn[(a, b)] = h[(i, j)];
            }
        }
        let scale: Vec<f64> = (open.iter().map(|&j| scale_of(h[(j, j)], stiffness[j]))).collect();
        let round_off = (open.iter()).any(|&j| h[(j, j)] <= SINGULAR_DIAGONAL * stiffness[j]);
        let regular = (!round_off).then(|| factorize(h_nn.as_ref(), &scale, 0.0));
        let singular = !open.is_empty() && regular.as_ref().is_none_or(Option::is_none);
        let factor = regular.flatten().or_else(|| {
            SPRINGS
                .iter()
                .find_map(|&spring| factorize(h_nn.as_ref(), &scale, spring))
        });
        Self {
            open,
            h_nn,
            factor,
            singular,
        }
    }

    /// x ← H_NN⁻¹ x, `x` the entries of the open conditions.
    pub fn solve(&self, x: &mut [f64]) {
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
            // What resists nowhere leaves the springs' force as it is.
            let size = left.iter().fold(0.0, |m: f64, r| m.max(r.abs()));
            if size == 0.0 || size > 0.9 * last || size.is_nan() {
                break;
            }
            last = size;
            apply(&mut left);
            for (x, dx) in x.iter_mut().zip(left) {
                *x += dx;
            }
        }
    }
}

/// What an entry of H's diagonal is measured by.
pub fn scale_of(diagonal: f64, stiffness: f64) -> f64 {
    if diagonal > SINGULAR_DIAGONAL * stiffness {
        diagonal
    } else {
        stiffness
    }
}

/// The factor of H + `spring` · diag(`scale`); `None` where that is singular.
fn factorize(h: MatRef<'_, f64>, scale: &[f64], spring: f64) -> Option<Llt<f64>> {
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
