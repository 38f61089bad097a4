//! S_0 and F of (15), and the bilateral operator S_0 + S_CON' of (16)-(17) with its factor at the root.
//!
//! > S_0 = Σ_T R̄_iᵀ S_i R̄_i,   F = Σ_T R̄_iᵀ f_i,   S_CON' = Σ_ϑ R̄_klᵀ S_ΓΓ R̄_kl

use std::cell::OnceCell;

use faer::{Mat, MatMut, MatRef, Par};

use super::coupled::condense_laws;
use super::numbering::Numbering;
use crate::contact::law::PairLaw;
use crate::error::Failure;
use crate::rigid::energy::{RigidBasis, RigidDrive};
use crate::schur::factor::BoundaryLastCholesky;
use crate::schur::pattern::{LowerPattern, SparseSymmetric};

/// Pivot relative to its diagonal entry below which an operator is singular.
const SINGULAR_PIVOT: f64 = 1e-13;

/// What a cluster contributes to the interface problem.
#[derive(Clone, Debug)]
pub struct Contribution {
    /// Its Schur complement on its traces, with every contact closed.
    pub s: Mat<f64>,
    /// The smallest pivot of its interior relative to its diagonal entry.
    pub smallest_pivot: f64,
    /// The law of a pair; `None` for a linear subdomain, and where all pairs have too many
    /// approaches to be solved for at once.
    pub law: Option<PairLaw>,
}

/// What loads a cluster.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClusterLoad {
    /// Its condensed load on its traces, with every contact closed.
    pub load: Vec<f64>,
    /// The largest displacement that is prescribed in a cluster in contact (m).
    pub scale: f64,
}

/// The interface problem S_0 U + S_CON(U) = F, (14), as the root holds it.
#[derive(Debug)]
pub struct Interface {
    /// Number of unknowns on Γ that clusters share.
    pub len: usize,
    /// Number of those that no pair has; they come first.
    pub linear: usize,
    /// The traces of every pair.
    pub pair_traces: Vec<Vec<u32>>,
    /// The law of every pair; empty where they have too many approaches to be solved for at once.
    pub laws: Vec<PairLaw>,
    /// The rigid motions of the bodies as their approaches see them.
    pub motions: RigidBasis,
    /// S_0 = Σ R_iᵀ S_i R_i over the linear subdomains, (15).
    s_0: SparseSymmetric,
    /// F of the linear subdomains.
    f: Vec<f64>,
    f_scale: Vec<f64>,
    /// F of the pairs with every contact closed.
    f_bilateral: Vec<f64>,
    /// Which clusters are in contact.
    in_contact: Vec<bool>,
    factor: BoundaryLastCholesky,
    condensed_laws: OnceCell<Mat<f64>>,
    smallest_pivot: f64,
    par: Par,
}

impl Interface {
    /// Assembles S_0 and the bilateral operator from all clusters, in their order, and factorizes
    /// the latter. `in_contact[c]` tells whether cluster c is in contact. Nothing loads it before
    /// [`prescribe`](Self::prescribe).
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
        let mut pair_traces = Vec::new();
        let mut laws = Vec::new();
        let mut smallest_pivot = f64::INFINITY;
        let parts = contributions.into_iter().zip(&numbering.traces);
        for ((part, traces), &in_contact) in parts.zip(in_contact) {
            smallest_pivot = smallest_pivot.min(part.smallest_pivot);
            if in_contact {
                sum.add_large(traces, part.s.as_ref());
                pair_traces.push(traces.clone());
                laws.extend(part.law);
            } else {
                s_0.add_large(traces, part.s.as_ref());
            }
        }
        sum.add_sparse(&s_0);
        let factor = BoundaryLastCholesky::new(&sum, numbering.linear, par).map_err(|error| {
            Failure::ill_posed(format!(
                "the interface problem can't be solved even with every contact closed \
                     ({error}): some part of the scene is held neither by supports nor by contact"
            ))
        })?;
        Ok(Self {
            len: n,
            linear: numbering.linear,
            pair_traces,
            motions: RigidBasis::default(),
            laws,
            s_0,
            f: vec![0.0; n],
            f_scale: vec![0.0; n],
            f_bilateral: vec![0.0; n],
            in_contact: in_contact.to_vec(),
            smallest_pivot: smallest_pivot.min(factor.smallest_pivot()),
            factor,
            condensed_laws: OnceCell::new(),
            par,
        })
    }

    /// Assembles F of the `loads` of all clusters, in their order; `drive` has the pairs' approaches
    /// against the rigid motions of the bodies, and the load along these.
    pub fn prescribe(&mut self, numbering: &Numbering, loads: &[ClusterLoad], drive: &RigidDrive) {
        for f in [&mut self.f, &mut self.f_bilateral, &mut self.f_scale] {
            f.fill(0.0);
        }
        let mut laws = self.laws.iter_mut();
        let loads = loads.iter().zip(&numbering.traces);
        for ((of_cluster, traces), &in_contact) in loads.zip(&self.in_contact) {
            let f = match in_contact {
                true => &mut self.f_bilateral,
                false => &mut self.f,
            };
            for (&dof, load) in traces.iter().zip(&of_cluster.load) {
                f[dof as usize] += load;
                self.f_scale[dof as usize] += load.abs();
            }
            if in_contact && let Some(law) = laws.next() {
                law.scale = of_cluster.scale;
            }
        }
        self.motions = RigidBasis::new(drive, &diagonal_of(&self.laws));
    }

    /// The smallest pivot of all clusters and of the bilateral operator, each relative to its
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

    /// The pairs' laws condensed onto their approaches, made when first asked for.
    pub fn condensed_laws(&self) -> MatRef<'_, f64> {
        self.condensed_laws
            .get_or_init(|| condense_laws(self, self.par))
            .as_ref()
    }

    /// X ← L⁻¹ X on the traces of pairs, which come last in the factor L of the bilateral operator.
    pub fn half_solve_pairs(&self, x: MatMut<'_, f64>) {
        self.factor.forward_boundary(x, self.par);
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

    /// The factor of S_0 alone; `None` where S_0 is singular.
    pub fn factor_s_0(&self) -> Option<BoundaryLastCholesky> {
        let factor = BoundaryLastCholesky::new(&self.s_0, self.len, self.par).ok()?;
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

/// The diagonal of what all laws are condensed from, side by side.
pub(super) fn diagonal_of(laws: &[PairLaw]) -> Vec<f64> {
    laws.iter().flat_map(|law| law.diagonal.clone()).collect()
}
