//! A contact pair: the common, nonlinear Schur complement S_kl of two subdomains, (12).

use faer::MatRef;

use super::active_set::{GapProblem, GapSolution};
use super::approach::ApproachOf;
use super::dependent::DependentRows;
use super::open_factor::OpenFactor;
use crate::schur::local::{CondensedLoad, LocalSchur, multiply_add};

/// A group of subdomains in contact, condensed onto its approaches t and its traces U on Γ.
#[derive(Debug)]
pub struct ContactPair {
    schur: LocalSchur,
    load: CondensedLoad,
    limits: Limits,
    open: Vec<bool>,
    contact: GapSolution,
}

/// The bounds t ≤ g and D t ≤ d, and the conditions that they come from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limits {
    /// g of every approach, the tightest of its conditions, then d of every dependent one (m).
    pub bounds: Vec<f64>,
    /// D.
    pub rows: DependentRows,
    /// Which condition each bound is, and its factor.
    tightest: Vec<(usize, f64)>,
    /// Number of conditions.
    conditions: usize,
    /// The largest displacement prescribed in the pair, initial gaps among them (m).
    pub scale: f64,
}

impl Limits {
    /// The bounds on `approaches` unknowns that conditions with these `gaps` make; `scale` bounds
    /// the displacements that are prescribed.
    pub fn new(approaches: usize, of: &[ApproachOf], gaps: &[f64], scale: f64) -> Self {
        let mut limits = Self {
            bounds: vec![f64::INFINITY; approaches],
            rows: DependentRows::default(),
            tightest: vec![(0, 1.0); approaches],
            conditions: of.len(),
            scale,
        };
        for (j, (of, gap)) in of.iter().zip(gaps).enumerate() {
            match of {
                &ApproachOf::Unknown {
                    number,
                    factor,
                    constant,
                } => {
                    let bound = (gap - constant) / factor;
                    if bound < limits.bounds[number] {
                        limits.bounds[number] = bound;
                        limits.tightest[number] = (j, factor);
                    }
                }
                ApproachOf::Combination { terms, constant } => {
                    limits.rows.push(terms.clone());
                    limits.bounds.push(gap - constant);
                    limits.tightest.push((j, 1.0));
                }
                ApproachOf::Prescribed(_) => {}
            }
        }
        limits
    }

    fn approaches(&self) -> usize {
        self.bounds.len() - self.rows.len()
    }

    /// g − t, then d − D t, 0 for the rows of D that aren't `open`.
    fn gaps(&self, t: &[f64], open: &[bool]) -> Vec<f64> {
        let m = t.len();
        let mut gaps: Vec<f64> = self.bounds.iter().zip(t).map(|(g, t)| g - t).collect();
        gaps.extend((0..self.rows.len()).map(|j| {
            let left = self.bounds[m + j] - self.rows.value(j, t);
            if open[m + j] { left.max(0.0) } else { 0.0 }
        }));
        gaps
    }
}

/// One evaluation of S_kl.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PairResponse {
    /// S_kl(U): the forces that hold the traces, less the pair's load (N/m).
    pub reaction: Vec<f64>,
    /// Scale of the terms that each reaction is a sum of.
    pub scale: Vec<f64>,
    /// g − t: what every approach has left, then d − D t (m); 0 where closed.
    pub gaps: Vec<f64>,
    /// c − H t: what contact forces hold where closed, round-off where open (N/m).
    pub drives: Vec<f64>,
    /// Scale of the terms that each drive is a sum of.
    pub drive_scale: Vec<f64>,
    /// Which approaches are open, then which dependent conditions.
    pub open: Vec<bool>,
    /// Conditions that opened or closed, against what was expected or the last evaluation.
    pub changed: usize,
    /// Linear systems solved.
    pub steps: usize,
    /// Whether the interior-point method was needed.
    pub fell_back: bool,
    /// Whether the small problem converged.
    pub converged: bool,
}

impl ContactPair {
    /// A pair whose first boundary unknowns are the approaches within `limits`, bilateral at first.
    pub fn new(schur: LocalSchur, load: CondensedLoad, limits: Limits) -> Self {
        Self {
            schur,
            load,
            open: vec![false; limits.bounds.len()],
            contact: GapSolution::bilateral(limits.approaches(), limits.bounds.len()),
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
        let mut closed = vec![false; self.limits.conditions];
        for (&(condition, _), open) in self.limits.tightest.iter().zip(&self.open) {
            closed[condition] = !open;
        }
        (self.forces(&self.contact.forces), closed)
    }

    fn traces(&self) -> usize {
        self.schur.boundary() - self.limits.approaches()
    }

    /// H, on the approaches.
    pub fn s_tt(&self) -> MatRef<'_, f64> {
        let m = self.limits.approaches();
        self.schur.s.as_ref().submatrix(0, 0, m, m)
    }

    /// Approaches against traces.
    pub fn s_t_gamma(&self) -> MatRef<'_, f64> {
        let m = self.limits.approaches();
        self.schur.s.as_ref().submatrix(0, m, m, self.traces())
    }

    /// S_ΓΓ, the derivative with every contact closed (16).
    pub fn bilateral(&self) -> MatRef<'_, f64> {
        let (m, n) = (self.limits.approaches(), self.traces());
        self.schur.s.as_ref().submatrix(m, m, n, n)
    }

    /// Load on the traces with every approach zero.
    pub fn bilateral_load(&self) -> &[f64] {
        &self.load.boundary()[self.limits.approaches()..]
    }

    /// The diagonal of the matrix that H is condensed from.
    pub fn stiffness(&self) -> &[f64] {
        &self.schur.stiffness[..self.limits.approaches()]
    }

    /// The bounds t ≤ g and D t ≤ d.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Evaluates S_kl(U) = S_ΓΓ U + S_Γt t(U) − f_Γ, where t(U) within the limits minimizes the pair's energy.
    /// The search begins at the conditions `expected` to be open, else at those of last time.
    pub fn evaluate(&mut self, u: &[f64], expected: Option<Vec<bool>>) -> PairResponse {
        let m = self.limits.approaches();
        let before = expected.unwrap_or_else(|| self.open.clone());
        let mut c = self.load.boundary()[..m].to_vec();
        let mut c_scale: Vec<f64> = c.iter().map(|f| f.abs()).collect();
        for (column, &u_j) in self.s_t_gamma().col_iter().zip(u) {
            for (i, s) in column.iter().enumerate() {
                let term = s * u_j;
                c[i] -= term;
                c_scale[i] += term.abs();
            }
        }
        let mut open = before.clone();
        let contact = GapProblem {
            h: self.s_tt(),
            stiffness: self.stiffness(),
            c: &c,
            c_scale: &c_scale,
            rows: &self.limits.rows,
            bounds: &self.limits.bounds,
            center: &self.contact.approaches,
            scale: u.iter().fold(self.limits.scale, |m, u| m.max(u.abs())),
        }
        .solve(&mut open);
        let (mut drives, mut drive_scale) = (c, c_scale);
        for (column, &t) in self.s_tt().col_iter().zip(&contact.approaches) {
            for (i, h) in column.iter().enumerate() {
                drives[i] -= h * t;
                drive_scale[i] += (h * t).abs();
            }
        }
        let mut response = PairResponse {
            gaps: self.limits.gaps(&contact.approaches, &open),
            drives,
            drive_scale,
            changed: before.iter().zip(&open).filter(|(a, b)| a != b).count(),
            steps: contact.steps,
            fell_back: contact.fell_back,
            converged: contact.converged,
            ..PairResponse::default()
        };
        self.contact = contact;
        self.open.clone_from(&open);
        response.open = open;
        (response.reaction, response.scale) = self.reaction(u);
        response
    }

    /// S_ΓΓ U + S_Γt t − f_Γ and the scale of its terms.
    fn reaction(&self, u: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut reaction: Vec<f64> = self.bilateral_load().iter().map(|f| -f).collect();
        let mut scale: Vec<f64> = reaction.iter().map(|f| f.abs()).collect();
        let m = self.limits.approaches();
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

    /// S_kl'(U) x = S_ΓΓ x − S_ΓN H_NN⁻¹ S_NΓ x with the open approaches N of the last evaluation.
    pub fn derivative(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        multiply_add(self.bilateral(), x, &mut y);
        let factor = OpenFactor::new(self.s_tt(), self.stiffness(), &self.limits.rows, &self.open);
        let mut driven = vec![0.0; self.limits.approaches()];
        multiply_add(self.s_t_gamma(), x, &mut driven);
        let mut opened: Vec<f64> = factor.open.iter().map(|&j| -driven[j]).collect();
        factor.solve(&mut opened);
        let mut t = vec![0.0; self.limits.approaches()];
        for (&j, opened) in factor.open.iter().zip(opened) {
            t[j] = opened;
        }
        multiply_add(self.s_t_gamma().transpose(), &t, &mut y);
        y
    }

    /// Forces of all conditions for those of the limits.
    pub fn forces(&self, of_limits: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.limits.conditions];
        for (force, &(condition, factor)) in of_limits.iter().zip(&self.limits.tightest) {
            forces[condition] = force / factor;
        }
        forces
    }

    /// Which limits are open where these conditions are `closed`, and what every closed one lacks of
    /// its bound when the conditions lack `missing`; 0 for the open ones.
    pub fn frozen_limits(&self, closed: &[bool], missing: &[f64]) -> (Vec<bool>, Vec<f64>) {
        let of_condition = |&(condition, factor): &(usize, f64)| match closed[condition] {
            true => (false, missing[condition] / factor),
            false => (true, 0.0),
        };
        self.limits.tightest.iter().map(of_condition).unzip()
    }
}
