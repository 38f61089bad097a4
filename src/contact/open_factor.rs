//! H_NN⁻¹: H on the open conditions N, factorized even where it is singular.
//!
//! > S_kl'(U) = S_ΓΓ − S_ΓN H_NN⁻¹ S_NΓ

use faer::linalg::solvers::{Llt, SolveCore};
use faer::{Conj, Mat, MatMut, MatRef, Side};

use super::dependent::DependentRows;
use super::ties::Ties;

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
/// where nothing drives it, it stays where it is. Closed dependent conditions leave fewer directions:
/// H_NN is that of the open approaches that they don't tie.
#[derive(Debug)]
pub struct OpenFactor {
    /// The open approaches, ascending.
    pub open: Vec<usize>,
    /// What the closed dependent conditions make of them.
    pub ties: Ties,
    /// The open approaches that aren't tied, ascending; empty where none is tied.
    untied: Vec<usize>,
    h_nn: Mat<f64>,
    factor: Option<Llt<f64>>,
    /// Whether springs were needed.
    pub singular: bool,
}

impl OpenFactor {
    /// Factorizes H_NN; `diagonal` is the diagonal of the matrix that H is condensed from, `open`
    /// has a flag for every approach and one for each of `rows`.
    pub fn new(h: MatRef<'_, f64>, diagonal: &[f64], rows: &DependentRows, open: &[bool]) -> Self {
        let ties = Ties::new(rows, open);
        let open: Vec<usize> = (0..diagonal.len()).filter(|&j| open[j]).collect();
        let mut diagonal: Vec<f64> = open.iter().map(|&j| diagonal[j]).collect();
        let mut h_nn = Mat::zeros(open.len(), open.len());
        let mut untied = Vec::new();
        if ties.ties.is_empty() {
            gather(h, &open, &mut h_nn);
        } else {
            let is_pivot = |j: &usize| ties.ties.iter().any(|tie| tie.pivot == *j);
            untied = open.iter().copied().filter(|j| !is_pivot(j)).collect();
            (h_nn, diagonal) = tied(h, &diagonal, &open, &untied, &ties);
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
            ties,
            untied,
            h_nn,
            factor,
            singular,
        }
    }

    /// x ← H_NN⁻¹ x, `x` the entries of the open approaches; with ties it is T (Tᵀ H_NN T)⁻¹ Tᵀ x
    /// for the T that the untied ones move all by.
    pub fn solve(&self, x: &mut [f64]) {
        if self.ties.ties.is_empty() {
            self.solve_untied(x);
            return;
        }
        // The entries of `open` and `untied` are sorted, and every tied approach is open.
        let place = |j: usize| self.open.partition_point(|&i| i < j);
        for tie in &self.ties.ties {
            let held = x[place(tie.pivot)];
            for &(i, c) in &tie.others {
                x[place(i)] -= c * held;
            }
        }
        let mut of_untied: Vec<f64> = self.untied.iter().map(|&j| x[place(j)]).collect();
        self.solve_untied(&mut of_untied);
        for (&j, of_untied) in self.untied.iter().zip(of_untied) {
            x[place(j)] = of_untied;
        }
        for tie in &self.ties.ties {
            let others = tie.others.iter().map(|&(i, c)| c * x[place(i)]);
            x[place(tie.pivot)] = -others.sum::<f64>();
        }
    }

    fn solve_untied(&self, x: &mut [f64]) {
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

/// The rows and columns of H of `open` approaches.
fn gather(h: MatRef<'_, f64>, open: &[usize], h_nn: &mut Mat<f64>) {
    for (b, &j) in open.iter().enumerate() {
        for (a, &i) in open.iter().enumerate() {
            h_nn[(a, b)] = h[(i, j)];
        }
    }
}

/// Tᵀ H_NN T on the `untied` approaches, and the `diagonal` of the open ones seen from there.
fn tied(
    h: MatRef<'_, f64>,
    diagonal: &[f64],
    open: &[usize],
    untied: &[usize],
    ties: &Ties,
) -> (Mat<f64>, Vec<f64>) {
    let mut whole = Mat::zeros(open.len(), open.len());
    gather(h, open, &mut whole);
    let mut diagonal = diagonal.to_vec();
    let place = |j: usize| open.partition_point(|&i| i < j);
    for tie in &ties.ties {
        let pivot = place(tie.pivot);
        for &(i, c) in &tie.others {
            let i = place(i);
            for a in 0..open.len() {
                let moved = c * whole[(a, pivot)];
                whole[(a, i)] -= moved;
            }
            diagonal[i] += c * c * diagonal[pivot];
        }
    }
    for tie in &ties.ties {
        let pivot = place(tie.pivot);
        for &(i, c) in &tie.others {
            let i = place(i);
            for b in 0..open.len() {
                let moved = c * whole[(pivot, b)];
                whole[(i, b)] -= moved;
            }
        }
    }
    let places: Vec<usize> = untied.iter().map(|&j| place(j)).collect();
    let mut h_nn = Mat::zeros(untied.len(), untied.len());
    gather(whole.as_ref(), &places, &mut h_nn);
    let diagonal = places.iter().map(|&a| diagonal[a]).collect();
    (h_nn, diagonal)
}

/// What an entry of H's diagonal is measured by.
pub fn scale_of(entry: f64, diagonal: f64) -> f64 {
    if entry > SINGULAR_DIAGONAL * diagonal {
        entry
    } else {
        diagonal
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
