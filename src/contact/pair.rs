//! A contact pair: the common, nonlinear Schur complement S_kl of two subdomains, (12).

use faer::{Mat, MatRef};

use super::active_set::{GapProblem, GapSolution, OpenFactor};
use crate::schur::local::{CondensedLoad, LocalSchur};

/// A group of subdomains in contact, condensed onto its gaps s and its traces U on Γ.
#[derive(Debug)]
pub struct ContactPair {
    schur: LocalSchur,
    gaps: usize,
    load: CondensedLoad,
    load_scale: Vec<f64>,
    gap_scale: f64,
    open: Vec<bool>,
}

/// One evaluation of S_kl.
#[derive(Clone, Debug, PartialEq)]
pub struct PairResponse {
    /// S_kl(U): the forces that hold the traces, less the pair's load [N/m].
    pub reaction: Vec<f64>,
    /// Scale of the terms that each reaction is a difference of.
    pub scale: Vec<f64>,
    /// Gaps and contact forces.
    pub contact: GapSolution,
    /// Closed conditions.
    pub active: usize,
    /// Conditions that opened or closed since the last evaluation.
    pub changed: usize,
}

impl ContactPair {
    /// A pair with its first `gaps` boundary unknowns in contact, bilateral at first.
    ///
    /// `load_scale` bounds the terms of its load on B, `gap_scale` the displacements that are
    /// prescribed in it, initial gaps among them.
    pub fn new(
        schur: LocalSchur,
        gaps: usize,
        load: CondensedLoad,
        load_scale: Vec<f64>,
        gap_scale: f64,
    ) -> Self {
        Self {
            schur,
            gaps,
            load,
            load_scale,
            gap_scale,
            open: vec![false; gaps],
        }
    }

    /// Its Schur complement.
    pub fn schur(&self) -> &LocalSchur {
        &self.schur
    }

    /// Its condensed load.
    pub fn load(&self) -> &CondensedLoad {
        &self.load
    }

    /// Which conditions were open in the last evaluation.
    pub fn open(&self) -> &[bool] {
        &self.open
    }

    fn traces(&self) -> usize {
        self.schur.boundary() - self.gaps
    }

    fn s_gap_trace(&self) -> MatRef<'_, f64> {
        self.schur
            .s
            .as_ref()
            .submatrix(0, self.gaps, self.gaps, self.traces())
    }

    /// S_ΓΓ, the derivative with every contact closed (16).
    pub fn bilateral(&self) -> MatRef<'_, f64> {
        self.schur
            .s
            .as_ref()
            .submatrix(self.gaps, self.gaps, self.traces(), self.traces())
    }

    /// Load on the traces with every contact closed.
    pub fn bilateral_load(&self) -> &[f64] {
        &self.load.boundary()[self.gaps..]
    }

    /// Evaluates S_kl(U) = S_ΓΓ U + S_Γs s(U) − f_Γ, where s(U) ≥ 0 minimizes the pair's energy.
    pub fn evaluate(&mut self, u: &[f64]) -> PairResponse {
        let f = self.load.boundary();
        let s_st = self.s_gap_trace();
        let mut c = f[..self.gaps].to_vec();
        let mut c_scale = self.load_scale[..self.gaps].to_vec();
        for (j, &u_j) in u.iter().enumerate() {
            for i in 0..self.gaps {
                let term = s_st[(i, j)] * u_j;
                c[i] -= term;
                c_scale[i] += term.abs();
            }
        }
        let gap_scale = u.iter().fold(self.gap_scale, |m, u| m.max(u.abs()));
        let problem = GapProblem {
            h: self.schur.s.as_ref().submatrix(0, 0, self.gaps, self.gaps),
            c: &c,
            c_scale: &c_scale,
            gap_scale,
        };
        let before = self.open.clone();
        let contact = problem.solve(&mut self.open);

        let n = self.traces();
        let s_tt = self.bilateral();
        let s_st = self.s_gap_trace();
        let mut reaction: Vec<f64> = f[self.gaps..].iter().map(|f| -f).collect();
        let mut scale = self.load_scale[self.gaps..].to_vec();
        for (j, &u_j) in u.iter().enumerate() {
            for i in 0..n {
                let term = s_tt[(i, j)] * u_j;
                reaction[i] += term;
                scale[i] += term.abs();
            }
        }
        for i in 0..n {
            for (j, &s) in contact.gaps.iter().enumerate() {
                let term = s_st[(j, i)] * s;
                reaction[i] += term;
                scale[i] += term.abs();
            }
        }
        PairResponse {
            reaction,
            scale,
            active: self.open.iter().filter(|&&open| !open).count(),
            changed: before
                .iter()
                .zip(&self.open)
                .filter(|(a, b)| a != b)
                .count(),
            contact,
        }
    }

    /// W with S_kl'(U) = S_ΓΓ − Wᵀ W for the active set of the last evaluation, |open| × |Γ|.
    pub fn opening(&self) -> Option<Mat<f64>> {
        let h = self.schur.s.as_ref().submatrix(0, 0, self.gaps, self.gaps);
        OpenFactor::regular(h, &self.open).map(|factor| factor.half_solve(self.s_gap_trace()))
    }
}
