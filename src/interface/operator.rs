//! S_0 of (15), and the bilateral operator S_0 + S_CON' of (16)-(17) with its solver, at the root.
//!
//! > S_0 = Σ_T R̄_iᵀ S_i R̄_i,   S_CON' = Σ_ϑ R̄_klᵀ S_ΓΓ R̄_kl

use std::cell::{OnceCell, RefCell};

use faer::{Mat, MatRef, Par};
use serde::{Deserialize, Serialize};

use super::numbering::Numbering;
use super::rigid_modes::RigidBasis;
use super::solver::DirectSolver;
use crate::contact::condensed_contact::CondensedContact;
use crate::contact::patch::LastPatch;
use crate::error::Failure;
use crate::schur::factor::BoundaryLastCholesky;
use crate::schur::pattern::{LowerPattern, SparseSymmetric};

/// Fraction of S_CON' of the bilateral problem that picard adds to S_0 if S_0 is singular: small enough that (18) still
/// diverges for equally stiff sides.
const SHARE: f64 = 0.05;
/// Pivot, relative to its diagonal entry, below which an operator is singular.
const SINGULAR_PIVOT: f64 = 1e-13;

/// The contribution of a cluster to the interface problem.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Contribution {
    /// Schur complement on the interface dofs, with every contact closed.
    #[serde(with = "crate::bytes::symmetric")]
    pub s: Mat<f64>,
    /// The smallest pivot of its interior, relative to its diagonal entry.
    pub smallest_pivot: f64,
    /// The contact law of a pair; `None` for a linear subdomain, and if all pairs have too many normal jumps for the
    /// coupled problem.
    pub law: Option<CondensedContact>,
}

/// The operators of the interface problem S_0 U + S_CON(U) = F, (14), on the root; F of each load step is in
/// [`InterfaceProblem`](super::problem::InterfaceProblem).
#[derive(Debug)]
pub struct Interface {
    /// Number of unknowns on Γ shared by clusters.
    pub len: usize,
    /// Number of unknowns that belong to no pair; they come first.
    pub linear: usize,
    /// The traces of every pair.
    pub pair_interface_dofs: Vec<Vec<u32>>,
    /// The contact law of every pair, without H; empty if they have too many normal jumps for the coupled problem.
    pub laws: Vec<CondensedContact>,
    /// H of every law until they are condensed; then it is dropped to save memory.
    h_of_laws: RefCell<Vec<Mat<f64>>>,
    /// S_0 = Σ R_iᵀ S_i R_i over the linear subdomains, (15).
    s_0: SparseSymmetric,
    /// S_0 + S_CON' of the bilateral problem.
    bilateral: SparseSymmetric,
    /// Flags of the clusters in contact.
    pub in_contact: Vec<bool>,
    /// Solver of the bilateral problem.
    pub solver: DirectSolver,
    condensed_laws: OnceCell<Mat<f64>>,
    /// The patch of these laws that was in contact last.
    pub last_patch: LastPatch,
    smallest_pivot: f64,
    par: Par,
}

impl Interface {
    /// Assembles S_0 and the bilateral operator from all clusters, in their order, and factorizes the latter.
    /// `in_contact[c]` is true if cluster c is in contact.
    ///
    /// # Errors
    /// The bilateral problem is singular.
    pub fn new(
        numbering: &Numbering,
        contributions: Vec<Contribution>,
        in_contact: &[bool],
        par: Par,
    ) -> Result<Self, Failure> {
        let n = numbering.len;
        let clusters = 0..in_contact.len();
        let linear = numbering.cliques(clusters.clone().filter(|&c| !in_contact[c]));
        let all = numbering.cliques(clusters);
        let too_large = || {
            Failure::internal(format!(
                "the interface problem of {n} unknowns has more than 2^32 entries: \
                 use fewer subdomains"
            ))
        };
        let mut s_0 = SparseSymmetric::zeros(LowerPattern::new(n, &linear).ok_or_else(too_large)?);
        let mut sum = SparseSymmetric::zeros(LowerPattern::new(n, &all).ok_or_else(too_large)?);
        let mut pair_interface_dofs = Vec::new();
        let mut laws: Vec<CondensedContact> = Vec::new();
        let mut smallest_pivot = f64::INFINITY;
        let parts = contributions.into_iter().zip(&numbering.interface_dofs);
        for ((part, interface_dofs), &in_contact) in parts.zip(in_contact) {
            smallest_pivot = smallest_pivot.min(part.smallest_pivot);
            if in_contact {
                sum.add_large(interface_dofs, part.s.as_ref());
                pair_interface_dofs.push(interface_dofs.clone());
                laws.extend(part.law);
            } else {
                s_0.add_large(interface_dofs, part.s.as_ref());
            }
        }
        sum.add_sparse(&s_0);
        let factor = BoundaryLastCholesky::new(&sum, numbering.linear, par).map_err(|error| {
            Failure::ill_posed(format!(
                "the interface problem can't be solved even with every contact closed \
                     ({error}): some part of the scene is held neither by supports nor by contact"
            ))
        })?;
        let of_laws = laws
            .iter_mut()
            .map(|law| std::mem::replace(&mut law.h, Mat::new()));
        Ok(Self {
            h_of_laws: RefCell::new(of_laws.collect()),
            len: n,
            linear: numbering.linear,
            pair_interface_dofs,
            laws,
            s_0,
            bilateral: sum,
            in_contact: in_contact.to_vec(),
            smallest_pivot: smallest_pivot.min(factor.smallest_pivot()),
            solver: DirectSolver::new(factor, par),
            condensed_laws: OnceCell::new(),
            last_patch: LastPatch::default(),
            par,
        })
    }

    /// The smallest pivot of all clusters and of the bilateral operator, each relative to its diagonal entry.
    pub fn smallest_pivot(&self) -> f64 {
        self.smallest_pivot
    }

    /// The pairs' laws condensed onto their normal jumps, computed on first use; the energy of the bodies' rigid
    /// `motions` is set to zero.
    pub fn condensed_laws(&self, motions: &RigidBasis) -> MatRef<'_, f64> {
        self.condensed_laws
            .get_or_init(|| condense_laws(self, motions))
            .as_ref()
    }

    /// S_0, (15).
    pub fn s_0(&self) -> &SparseSymmetric {
        &self.s_0
    }

    /// The factor of S_0, or of S_0 + `SHARE` S_CON' of the bilateral problem if S_0 is singular, and the factor of
    /// S_CON', 0 or `SHARE`; `None` if both are singular.
    pub fn factor_s_0(&self) -> Option<(BoundaryLastCholesky, f64)> {
        let regular = |matrix: &SparseSymmetric| {
            let factor = BoundaryLastCholesky::new(matrix, self.len, self.par).ok()?;
            (factor.smallest_pivot() > SINGULAR_PIVOT).then_some(factor)
        };
        if let Some(factor) = regular(&self.s_0) {
            return Some((factor, 0.0));
        }
        let mut shared = self.bilateral.clone();
        shared.values.iter_mut().for_each(|value| *value *= SHARE);
        let mut linear = self.s_0.clone();
        (linear.values.iter_mut()).for_each(|value| *value *= 1.0 - SHARE);
        shared.add_sparse(&linear);
        Some((regular(&shared)?, SHARE))
    }

    /// y ← y + a S_CON' x, with S_CON' of the bilateral problem.
    pub fn add_bilateral_con(&self, a: f64, x: &[f64], y: &mut [f64]) {
        let scaled: Vec<f64> = x.iter().map(|x| a * x).collect();
        self.bilateral.multiply_add(&scaled, y);
        let opposite: Vec<f64> = scaled.iter().map(|x| -x).collect();
        self.s_0.multiply_add(&opposite, y);
    }

    /// The entries of `u` on the interface dofs of pair p.
    pub fn restrict(&self, p: usize, u: &[f64]) -> Vec<f64> {
        self.pair_interface_dofs[p]
            .iter()
            .map(|&i| u[i as usize])
            .collect()
    }

    /// y ← y + R_pᵀ x.
    pub fn extend(&self, p: usize, x: &[f64], y: &mut [f64]) {
        for (&i, x) in self.pair_interface_dofs[p].iter().zip(x) {
            y[i as usize] += x;
        }
    }
}

/// H − Cᵀ A⁻¹ C for the laws of all pairs.
fn condense_laws(interface: &Interface, motions: &RigidBasis) -> Mat<f64> {
    let laws = &interface.laws;
    let mut h = side_by_side(interface.h_of_laws.take());
    let mut w = Mat::zeros(interface.len - interface.linear, h.nrows());
    let mut first = 0;
    for (law, interface_dofs) in laws.iter().zip(&interface.pair_interface_dofs) {
        for (column, &trace) in law.s_t_gamma.col_iter().zip(interface_dofs) {
            for (i, s) in column.iter().enumerate() {
                w[(trace as usize - interface.linear, first + i)] = *s;
            }
        }
        first += law.len();
    }
    interface.solver.condense(w, h.as_mut());
    for j in 0..h.nrows() {
        for i in j + 1..h.nrows() {
            h[(j, i)] = h[(i, j)];
        }
    }
    motions.remove_energy(&mut h);
    h
}

/// The block-diagonal matrix with these blocks.
fn side_by_side(mut parts: Vec<Mat<f64>>) -> Mat<f64> {
    if let [_] = parts[..] {
        return parts.swap_remove(0);
    }
    let m = parts.iter().map(Mat::nrows).sum();
    let mut whole = Mat::zeros(m, m);
    let mut first = 0;
    for part in parts {
        let n = part.nrows();
        let mut target = whole.as_mut().submatrix_mut(first, first, n, n);
        target.copy_from(&part);
        first += n;
    }
    whole
}

/// Concatenated diagonals of the matrices from which the laws are condensed.
pub(super) fn diagonal_of(laws: &[CondensedContact]) -> Vec<f64> {
    laws.iter().flat_map(|law| law.diagonal.clone()).collect()
}
