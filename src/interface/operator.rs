//! S_0, the bilateral operator S_0 + S_CON', and the solve at the root.

use faer::linalg::solvers::{Llt, SolveCore};
use faer::{Conj, Mat, MatMut, MatRef, Par, Side};

use super::numbering::Numbering;
use crate::error::Failure;
use crate::schur::factor::BoundaryLastCholesky;
use crate::schur::pattern::{LowerPattern, SparseSymmetric};

/// Most traces of pairs that a dense matrix is made for.
const DENSE_LIMIT: usize = 4000;
/// Pivot relative to its diagonal entry below which an operator is singular.
const SINGULAR_PIVOT: f64 = 1e-13;

/// The factor of S_0 + S_CON' with some contacts open.
#[derive(Debug)]
pub enum Opened<'a> {
    /// Only what contact can change is factorized anew, the traces of pairs, dense.
    Dense {
        /// The interface problem, whose factor serves for all else.
        interface: &'a Interface,
        /// The factor on the traces of pairs.
        factor: Llt<f64>,
    },
    /// All of it.
    Sparse(BoundaryLastCholesky),
}

impl Opened<'_> {
    /// x ← (S_0 + S_CON')⁻¹ x.
    pub fn solve(&self, x: &mut [f64]) {
        match self {
            Self::Dense { interface, factor } => {
                interface.factor.forward(x);
                let pairs = MatMut::from_column_major_slice_mut(
                    &mut x[interface.linear..],
                    interface.len - interface.linear,
                    1,
                );
                factor.solve_in_place_with_conj(Conj::No, pairs);
                interface.factor.backward(x);
            }
            Self::Sparse(factor) => factor.solve(x),
        }
    }
}

/// What a block contributes to the interface problem.
#[derive(Clone, Debug)]
pub struct Contribution {
    /// Its Schur complement on its traces, with every contact closed.
    pub s: Mat<f64>,
    /// Its condensed load.
    pub load: Vec<f64>,
    /// The smallest pivot of its interior relative to its diagonal entry.
    pub smallest_pivot: f64,
}

/// The interface problem S_0 U + S_CON(U) = F, (14), as the root holds it.
#[derive(Debug)]
pub struct Interface {
    /// Number of unknowns on Γ.
    pub len: usize,
    /// Number of those that no pair has; they come first.
    linear: usize,
    /// The traces of every pair.
    pub pair_traces: Vec<Vec<u32>>,
    /// S_0 = Σ R_iᵀ S_i R_i over the linear subdomains, (15).
    s_0: SparseSymmetric,
    /// Pattern of S_0 + S_CON'.
    pattern: LowerPattern,
    /// The bilateral operator condensed onto the traces of pairs, where they aren't too many.
    s_pairs: Option<Mat<f64>>,
    /// F of the linear subdomains.
    f: Vec<f64>,
    f_scale: Vec<f64>,
    /// S_ΓΓ of every pair.
    bilateral: Vec<Mat<f64>>,
    /// F of the pairs with every contact closed.
    f_bilateral: Vec<f64>,
    factor: BoundaryLastCholesky,
    smallest_pivot: f64,
    par: Par,
}

impl Interface {
    /// Assembles S_0, F and the bilateral operator from all blocks, in their order, and factorizes
    /// the latter. `pair[b]` tells whether block b is a pair.
    ///
    /// # Errors
    /// The bilateral problem is singular.
    pub fn new(
        numbering: &Numbering,
        contributions: Vec<Contribution>,
        pair: &[bool],
        par: Par,
    ) -> Result<Self, Failure> {
        let n = numbering.len;
        let blocks = 0..pair.len();
        let linear = numbering.cliques(blocks.clone().filter(|&b| !pair[b]));
        let all = numbering.cliques(blocks);
        let too_large = || {
            Failure::internal(format!(
                "the interface problem of {n} unknowns has more than 2^32 entries: \
                 use fewer subdomains"
            ))
        };
        let mut s_0 = SparseSymmetric::zeros(LowerPattern::new(n, &linear).ok_or_else(too_large)?);
        let pattern = LowerPattern::new(n, &all).ok_or_else(too_large)?;
        let mut pair_traces = Vec::new();
        let mut bilateral = Vec::new();
        let mut f = vec![0.0; n];
        let mut f_bilateral = vec![0.0; n];
        let mut f_scale = vec![0.0; n];
        let mut smallest_pivot = f64::INFINITY;
        for ((part, traces), &is_pair) in contributions.into_iter().zip(&numbering.traces).zip(pair)
        {
            smallest_pivot = smallest_pivot.min(part.smallest_pivot);
            let load_of_kind = if is_pair { &mut f_bilateral } else { &mut f };
            for (&dof, load) in traces.iter().zip(&part.load) {
                load_of_kind[dof as usize] += load;
                f_scale[dof as usize] += load.abs();
            }
            if is_pair {
                pair_traces.push(traces.clone());
                bilateral.push(part.s);
            } else {
                s_0.add(traces, |a, b| part.s[(a, b)]);
            }
        }
        let pairs = pair_traces.iter().zip(bilateral.iter().map(Mat::as_ref));
        let sum = with_pairs(&s_0, &pattern, pairs);
        let free = vec![0.0; n - numbering.linear];
        let factor = BoundaryLastCholesky::new(sum, numbering.linear, &free, par).map_err(|error| {
            Failure::ill_posed(format!(
                "the interface problem can't be solved even with every contact closed ({error}): \
                 some part of the scene is held neither by supports nor by contact"
            ))
        })?;
        let s_pairs = (free.len() <= DENSE_LIMIT).then(|| factor.schur_complement(&free, par));
        Ok(Self {
            len: n,
            linear: numbering.linear,
            pair_traces,
            s_0,
            pattern,
            s_pairs,
            f,
            f_scale,
            bilateral,
            f_bilateral,
            smallest_pivot: smallest_pivot.min(factor.smallest_pivot()),
            factor,
            par,
        })
    }

    /// The smallest pivot of all blocks and of the bilateral operator, each relative to its
    /// diagonal entry.
    pub fn smallest_pivot(&self) -> f64 {
        self.smallest_pivot
    }

    /// U^0: the solution of the bilateral problem (16)-(17).
    pub fn bilateral_start(&self) -> Vec<f64> {
        let mut u: Vec<f64> = self
            .f
            .iter()
            .zip(&self.f_bilateral)
            .map(|(a, b)| a + b)
            .collect();
        self.solve_bilateral(&mut u);
        u
    }

    /// x ← (S_0 + S_CON' of the bilateral problem)⁻¹ x.
    pub fn solve_bilateral(&self, x: &mut [f64]) {
        self.factor.solve(x);
    }

    /// y ← y + S_0 x.
    pub fn add_s_0(&self, x: &[f64], y: &mut [f64]) {
        self.s_0.multiply_add(x, y);
    }

    /// y ← y + (S_0 + S_CON' of the bilateral problem) x.
    pub fn add_bilateral(&self, x: &[f64], y: &mut [f64]) {
        self.add_s_0(x, y);
        self.add_pairs_bilateral(x, y);
    }

    /// y ← y + S_CON' x of the bilateral problem.
    pub fn add_pairs_bilateral(&self, x: &[f64], y: &mut [f64]) {
        for (p, bilateral) in self.bilateral.iter().enumerate() {
            let x_p = self.restrict(p, x);
            let mut y_p = vec![0.0; x_p.len()];
            multiply_add(bilateral.as_ref(), &x_p, &mut y_p);
            self.extend(p, &y_p, y);
        }
    }

    /// F − S_0 U and the scale of its terms.
    pub fn linear_residual(&self, u: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut su = vec![0.0; self.len];
        self.s_0.multiply_add(u, &mut su);
        let mut scale = self.f_scale.clone();
        self.s_0.multiply_add_absolute(u, &mut scale);
        let r = self.f.iter().zip(&su).map(|(f, su)| f - su).collect();
        (r, scale)
    }

    /// The factor of S_0 + S_CON' for other derivatives of the pairs than the bilateral ones: S_ΓΓ
    /// less `opening(p)` for pair p. `None` where it is singular.
    pub fn factor_opened(&self, opening: impl Fn(usize) -> Option<Mat<f64>>) -> Option<Opened<'_>> {
        let openings = (0..self.pair_traces.len()).filter_map(|p| Some((p, opening(p)?)));
        let Some(s_pairs) = &self.s_pairs else {
            let mut sum = with_pairs(&self.s_0, &self.pattern, self.pairs());
            for (p, opening) in openings {
                sum.add(&self.pair_traces[p], |a, b| -opening[(a, b)]);
            }
            let factor = BoundaryLastCholesky::new(sum, self.len, &[], self.par).ok()?;
            return (factor.smallest_pivot() > SINGULAR_PIVOT).then_some(Opened::Sparse(factor));
        };
        let mut s = s_pairs.clone();
        for (p, opening) in openings {
            let traces = &self.pair_traces[p];
            for (b, &j) in traces.iter().enumerate() {
                for (a, &i) in traces.iter().enumerate() {
                    s[(i as usize - self.linear, j as usize - self.linear)] -= opening[(a, b)];
                }
            }
        }
        let factor = s.llt(Side::Lower).ok()?;
        let l = factor.L();
        let regular =
            (0..s.nrows()).all(|i| l[(i, i)] * l[(i, i)] > SINGULAR_PIVOT * s_pairs[(i, i)]);
        regular.then_some(Opened::Dense {
            interface: self,
            factor,
        })
    }

    fn pairs(&self) -> impl Iterator<Item = (&Vec<u32>, MatRef<'_, f64>)> {
        self.pair_traces
            .iter()
            .zip(self.bilateral.iter().map(Mat::as_ref))
    }

    /// The factor of S_0 alone; `None` where S_0 is singular.
    pub fn factor_s_0(&self) -> Option<BoundaryLastCholesky> {
        let factor = BoundaryLastCholesky::new(self.s_0.clone(), self.len, &[], self.par).ok()?;
        (factor.smallest_pivot() > SINGULAR_PIVOT).then_some(factor)
    }

    /// The entries of `u` on the traces of pair p.
    pub fn restrict(&self, p: usize, u: &[f64]) -> Vec<f64> {
        self.pair_traces[p].iter().map(|&i| u[i as usize]).collect()
    }

    /// y ← y + R_pᵀ x.
    pub fn extend(&self, p: usize, x: &[f64], y: &mut [f64]) {
        for (&i, x) in self.pair_traces[p].iter().zip(x) {
            y[i as usize] += x;
        }
    }
}

/// S_0 and the pairs' matrices on their traces, summed in one pattern.
fn with_pairs<'a>(
    s_0: &SparseSymmetric,
    pattern: &LowerPattern,
    pairs: impl Iterator<Item = (&'a Vec<u32>, MatRef<'a, f64>)>,
) -> SparseSymmetric {
    let mut sum = SparseSymmetric::zeros(pattern.clone());
    sum.add_sparse(s_0);
    for (traces, matrix) in pairs {
        sum.add(traces, |a, b| matrix[(a, b)]);
    }
    sum
}

/// y ← y + A x.
pub fn multiply_add(a: MatRef<'_, f64>, x: &[f64], y: &mut [f64]) {
    for (column, x_j) in a.col_iter().zip(x) {
        for (y_i, a_ij) in y.iter_mut().zip(column.iter()) {
            *y_i += a_ij * x_j;
        }
    }
}
