//! A contact pair: the common, nonlinear Schur complement S_kl of two subdomains, (12).

use faer::{Mat, MatRef};

use super::active_set::{GapProblem, GapSolution, OpenFactor};
use super::approach::ApproachOf;
use crate::schur::local::{CondensedLoad, LocalSchur};

/// A group of subdomains in contact, condensed onto its approaches t and its traces U on Γ.
#[derive(Debug)]
pub struct ContactPair {
    schur: LocalSchur,
    load: CondensedLoad,
    limits: Limits,
    open: Vec<bool>,
    contact: GapSolution,
}

/// The bounds t ≤ g, and the conditions that they come from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limits {
    /// g of every approach: the tightest of its conditions (m).
    bounds: Vec<f64>,
    /// Which condition that is, and its factor.
    tightest: Vec<(usize, f64)>,
    /// Number of conditions.
    conditions: usize,
    /// The largest displacement prescribed in the pair, initial gaps among them (m).
    scale: f64,
}

impl Limits {
    /// The bounds on `approaches` unknowns that conditions with these `gaps` make; `scale` bounds
    /// the displacements that are prescribed.
    pub fn new(approaches: usize, of: &[ApproachOf], gaps: &[f64], scale: f64) -> Self {
        let mut limits = Self {
            bounds: vec![f64::INFINITY; approaches],
            tightest: vec![(0, 1.0); approaches],
            conditions: of.len(),
            scale,
        };
        for (j, (of, gap)) in of.iter().zip(gaps).enumerate() {
            if let ApproachOf::Unknown {
                number,
                factor,
                constant,
            } = *of
            {
                let bound = (gap - constant) / factor;
                if bound < limits.bounds[number] {
                    limits.bounds[number] = bound;
                    limits.tightest[number] = (j, factor);
                }
            }
        }
        limits
    }

    fn len(&self) -> usize {
        self.bounds.len()
    }
}

/// One evaluation of S_kl.
#[derive(Clone, Debug, PartialEq)]
pub struct PairResponse {
    /// S_kl(U): the forces that hold the traces, less the pair's load (N/m).
    pub reaction: Vec<f64>,
    /// Scale of the terms that each reaction is a sum of.
    pub scale: Vec<f64>,
    /// Closed conditions.
    pub active: usize,
    /// Conditions that opened or closed since the last evaluation.
    pub changed: usize,
    /// Linear systems solved.
    pub steps: usize,
    /// Whether the small problem converged.
    pub converged: bool,
}

/// A load condensed onto the traces with the active set frozen.
#[derive(Debug)]
pub struct FrozenLoad {
    /// The load condensed onto approaches and traces.
    pub load: CondensedLoad,
    factor: OpenFactor,
    t: Vec<f64>,
    /// What is left of it on the traces.
    pub traces: Vec<f64>,
}

impl ContactPair {
    /// A pair whose first boundary unknowns are the approaches within `limits`, bilateral at first.
    pub fn new(schur: LocalSchur, load: CondensedLoad, limits: Limits) -> Self {
        Self {
            schur,
            load,
            open: vec![false; limits.len()],
            contact: GapSolution::bilateral(limits.len()),
            limits,
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

    /// Approaches of the last evaluation (m).
    pub fn approaches(&self) -> &[f64] {
        &self.contact.approaches
    }

    /// Force of every condition in the last evaluation, and whether it was closed.
    pub fn conditions(&self) -> (Vec<f64>, Vec<bool>) {
        let mut forces = vec![0.0; self.limits.conditions];
        let mut closed = vec![false; self.limits.conditions];
        for (t, &(condition, factor)) in self.limits.tightest.iter().enumerate() {
            forces[condition] = self.contact.forces[t] / factor;
            closed[condition] = !self.open[t];
        }
        (forces, closed)
    }

    fn traces(&self) -> usize {
        self.schur.boundary() - self.limits.len()
    }

    /// H, on the approaches.
    fn s_tt(&self) -> MatRef<'_, f64> {
        let m = self.limits.len();
        self.schur.s.as_ref().submatrix(0, 0, m, m)
    }

    /// Approaches against traces.
    fn s_t_gamma(&self) -> MatRef<'_, f64> {
        let m = self.limits.len();
        self.schur.s.as_ref().submatrix(0, m, m, self.traces())
    }

    /// S_ΓΓ, the derivative with every contact closed (16).
    pub fn bilateral(&self) -> MatRef<'_, f64> {
        let (m, n) = (self.limits.len(), self.traces());
        self.schur.s.as_ref().submatrix(m, m, n, n)
    }

    /// Load on the traces with every approach zero.
    pub fn bilateral_load(&self) -> &[f64] {
        &self.load.boundary()[self.limits.len()..]
    }

    /// Evaluates S_kl(U) = S_ΓΓ U + S_Γt t(U) − f_Γ, where t(U) ≤ g minimizes the pair's energy.
    pub fn evaluate(&mut self, u: &[f64]) -> PairResponse {
        let m = self.limits.len();
        let mut c = self.load.boundary()[..m].to_vec();
        let mut c_scale: Vec<f64> = c.iter().map(|f| f.abs()).collect();
        let s_t_gamma = self.s_t_gamma();
        for (j, &u_j) in u.iter().enumerate() {
            for i in 0..m {
                let term = s_t_gamma[(i, j)] * u_j;
                c[i] -= term;
                c_scale[i] += term.abs();
            }
        }
        let mut open = self.open.clone();
        let contact = GapProblem {
            h: self.s_tt(),
            c: &c,
            c_scale: &c_scale,
            bounds: &self.limits.bounds,
            scale: u.iter().fold(self.limits.scale, |m, u| m.max(u.abs())),
        }
        .solve(&mut open);
        let changed = self.open.iter().zip(&open).filter(|(a, b)| a != b).count();
        let (steps, converged) = (contact.steps, contact.converged);
        self.open = open;
        self.contact = contact;
        let (reaction, scale) = self.reaction(u);
        PairResponse {
            reaction,
            scale,
            active: self.open.iter().filter(|&&open| !open).count(),
            changed,
            steps,
            converged,
        }
    }

    /// S_ΓΓ U + S_Γt t − f_Γ and the scale of its terms.
    fn reaction(&self, u: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut reaction: Vec<f64> = self.bilateral_load().iter().map(|f| -f).collect();
        let mut scale: Vec<f64> = reaction.iter().map(|f| f.abs()).collect();
        let m = self.limits.len();
        let unknowns = self.contact.approaches.iter().chain(u);
        for (j, &x) in unknowns.enumerate() {
            for i in 0..reaction.len() {
                let term = self.schur.s[(m + i, j)] * x;
                reaction[i] += term;
                scale[i] += term.abs();
            }
        }
        (reaction, scale)
    }

    /// Condenses a load onto the traces with the active set frozen, where the closed conditions
    /// still have to approach by `missing`, one entry a condition.
    pub fn condense_frozen(&self, load: CondensedLoad, missing: &[f64]) -> Option<FrozenLoad> {
        let (m, h) = (self.limits.len(), self.s_tt());
        let factor = OpenFactor::regular(h, &self.open)?;
        let mut t: Vec<f64> = (0..m)
            .map(|j| {
                let (condition, factor) = self.limits.tightest[j];
                if self.open[j] {
                    0.0
                } else {
                    missing[condition] / factor
                }
            })
            .collect();
        let mut left = load.boundary()[..m].to_vec();
        for (column, t) in h.col_iter().zip(&t) {
            for (left, h) in left.iter_mut().zip(column.iter()) {
                *left -= h * t;
            }
        }
        let opened = factor.solve(|j| left[j]);
        for (&j, opened) in factor.open.iter().zip(opened) {
            t[j] = opened;
        }
        let mut traces = load.boundary()[m..].to_vec();
        for (column, traces) in self.s_t_gamma().col_iter().zip(&mut traces) {
            *traces -= column.iter().zip(&t).map(|(s, t)| s * t).sum::<f64>();
        }
        Some(FrozenLoad {
            load,
            factor,
            t,
            traces,
        })
    }

    /// What such a load adds to the approaches and to the force of every condition once the change
    /// `u` of the traces is known.
    pub fn recover_frozen(&self, frozen: &FrozenLoad, u: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let m = self.limits.len();
        let mut driven = vec![0.0; m];
        for (column, u) in self.s_t_gamma().col_iter().zip(u) {
            for (driven, s) in driven.iter_mut().zip(column.iter()) {
                *driven -= s * u;
            }
        }
        let mut t = frozen.t.clone();
        let opened = frozen.factor.solve(|j| driven[j]);
        for (&j, opened) in frozen.factor.open.iter().zip(opened) {
            t[j] += opened;
        }
        let mut forces = vec![0.0; self.limits.conditions];
        for (j, &(condition, factor)) in self.limits.tightest.iter().enumerate() {
            if !self.open[j] {
                let held: f64 = (0..m).map(|k| self.schur.s[(j, k)] * t[k]).sum();
                forces[condition] = (frozen.load.boundary()[j] + driven[j] - held) / factor;
            }
        }
        (t, forces)
    }

    /// W with S_kl'(U) = S_ΓΓ − Wᵀ W for the active set of the last evaluation, |open| × |Γ|.
    pub fn opening(&self) -> Option<Mat<f64>> {
        OpenFactor::regular(self.s_tt(), &self.open)
            .map(|factor| factor.half_solve(self.s_t_gamma()))
    }
}
