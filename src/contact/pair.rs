//! A contact pair: the common, nonlinear Schur complement S_kl of two subdomains, (12).
//!
//! > S_kl(U) = S_ΓΓ U + S_Γt t(U) − f_Γ

use std::rc::Rc;

use serde::{Deserialize, Serialize};

use super::active_set::{ContactProblem, ContactSolution};
use super::friction::{FrictionProblem, Status};
use super::limits::Limits;
use super::open_factor::OpenFactor;
use super::patch::LastPatch;
use crate::schur::condensed::Condensed;
use crate::schur::local::multiply_add;

/// Subdomains in contact, with any others merged into them, condensed onto normal jumps t and traces U on Γ.
#[derive(Clone, Debug)]
pub struct ContactPair {
    /// S on [t | U], both triangles.
    condensed: Rc<Condensed>,
    /// The condensed load on [t | Γ] (N/m).
    load: Vec<f64>,
    limits: Limits,
    last_patch: LastPatch,
    /// The jumps at the beginning of the load step (m).
    begun: Vec<f64>,
    state: PairState,
}

/// The state of a pair after its last evaluation, from which the next one begins.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairState {
    /// The status of every jump, then of every linearly dependent constraint.
    status: Vec<Status>,
    contact: ContactSolution,
    /// The change of jumps in the load step (m).
    #[serde(default)]
    change: Vec<f64>,
}

/// One evaluation of S_kl.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PairResponse {
    /// S_kl(U): the forces that hold the interface dofs, less the pair's load (N/m).
    #[serde(with = "crate::bytes")]
    pub reaction: Vec<f64>,
    /// Scale of the terms that each reaction is a sum of.
    #[serde(with = "crate::bytes")]
    pub scale: Vec<f64>,
    /// g − t of every normal jump, then d − D t (m); 0 where closed.
    #[serde(with = "crate::bytes")]
    pub gaps: Vec<f64>,
    /// t (m).
    #[serde(with = "crate::bytes")]
    pub jumps: Vec<f64>,
    /// The change of jumps in the load step before where they slip along a direction in space, else 0; empty after an
    /// evaluation (m).
    #[serde(with = "crate::bytes")]
    pub change_before: Vec<f64>,
    /// c − H t: the contact force where closed, round-off where open (N/m).
    #[serde(with = "crate::bytes")]
    pub contact_residual: Vec<f64>,
    /// Scale of the terms that each contact residual is a sum of.
    #[serde(with = "crate::bytes")]
    pub contact_residual_scale: Vec<f64>,
    /// The status of every jump, then of every linearly dependent constraint.
    pub status: Vec<Status>,
    /// Number of closed contact points.
    pub active: usize,
    /// Limits whose status changed from the expected one, or else from that of the last evaluation.
    pub changed: usize,
    /// Linear systems solved.
    pub steps: usize,
    /// True if Newton's method alone didn't suffice.
    pub fell_back: bool,
    /// True if the small problem converged; false where it wasn't solved.
    pub converged: bool,
}

impl ContactPair {
    /// A pair under a condensed `load`, on normal jumps and traces, whose normal jumps lie within `limits`. It begins
    /// in its state after the load step `before`, else bilaterally; both triangles of S are filled.
    pub fn new(
        condensed: Rc<Condensed>,
        limits: Limits,
        load: Vec<f64>,
        before: Option<PairState>,
    ) -> Self {
        let bounds = limits.bounds.len();
        let state = before.unwrap_or_else(|| PairState {
            status: vec![Status::Closed; bounds],
            contact: ContactSolution::bilateral(condensed.jumps, bounds),
            change: Vec::new(),
        });
        Self {
            begun: state.contact.jumps.clone(),
            state,
            condensed,
            limits,
            last_patch: LastPatch::default(),
            load,
        }
    }

    /// The state after the last evaluation.
    pub fn into_state(self) -> PairState {
        let jumps = self.state.contact.jumps.iter().zip(&self.begun);
        PairState {
            change: jumps.map(|(t, begun)| t - begun).collect(),
            ..self.state
        }
    }

    /// The Schur complement.
    pub fn condensed(&self) -> &Condensed {
        &self.condensed
    }

    /// Normal jumps of the last evaluation (m).
    pub fn jumps(&self) -> &[f64] {
        &self.state.contact.jumps
    }

    /// Force of every condition in the last evaluation, and flags of the closed ones.
    pub fn conditions(&self) -> (Vec<f64>, Vec<bool>) {
        (
            self.limits.forces(&self.state.contact.forces),
            self.limits
                .closed(self.state.status.iter().map(|status| status.is_closed())),
        )
    }

    /// Load on the interface dofs with every normal jump zero.
    pub fn bilateral_load(&self) -> &[f64] {
        &self.load[self.condensed.jumps..]
    }

    /// The diagonal of the matrix that H is condensed from.
    pub fn diagonal(&self) -> &[f64] {
        &self.condensed.diagonal[..self.condensed.jumps]
    }

    /// The bounds t ≤ g and D t ≤ d.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Evaluates S_kl(U) = S_ΓΓ U + S_Γt t(U) − f_Γ, where t(U) within the limits minimizes the pair's energy. The
    /// search begins at the statuses `expected`, else at the last; with friction at the expected change of jumps.
    pub fn evaluate(
        &mut self,
        u: &[f64],
        expected: Option<(Vec<Status>, Vec<f64>)>,
    ) -> PairResponse {
        let expected = expected.unwrap_or_else(|| (self.state.status.clone(), Vec::new()));
        let (before, changes) = expected;
        let mut center = self.state.contact.jumps.clone();
        if !self.limits.tangents.is_empty() {
            (center.iter_mut().zip(changes)).for_each(|(t, change)| *t += change);
        }
        let (c, c_scale) = self.driving_force(u);
        let mut status = before.clone();
        let problem = ContactProblem {
            h: self.condensed.s_tt(),
            diagonal: self.diagonal(),
            c: &c,
            c_scale: &c_scale,
            rows: &self.limits.rows,
            bounds: &self.limits.bounds,
            center: &center,
            scale: u.iter().fold(self.limits.scale, |m, u| m.max(u.abs())),
        };
        let contact = FrictionProblem {
            contact: problem,
            tangents: &self.limits.tangents,
            last_patch: &self.last_patch,
        }
        .solve(&mut status);
        let mut response = PairResponse {
            gaps: (self.limits).gaps(&contact.jumps, |i| status[i].is_closed()),
            jumps: contact.jumps.clone(),
            contact_residual: c,
            contact_residual_scale: c_scale,
            active: (self.limits).closed_points(|i| status[i].is_closed()),
            changed: (before.iter().zip(&status)).filter(|(a, b)| a != b).count(),
            steps: contact.steps,
            fell_back: contact.fell_back,
            converged: contact.converged,
            ..PairResponse::default()
        };
        self.subtract_own(&mut response);
        self.state.contact = contact;
        self.state.status.clone_from(&status);
        response.status = status;
        (response.reaction, response.scale) = self.reaction(u);
        response
    }

    /// S_ΓΓ U + S_Γt t − f_Γ at the jumps t and statuses of the last evaluation, which another load or U leaves without
    /// their laws: the coupled problem of all pairs finds both.
    pub fn at_last_jumps(&self, u: &[f64]) -> PairResponse {
        let PairState {
            status,
            contact,
            change,
        } = &self.state;
        let change_before = |(i, status): (usize, &Status)| match status {
            Status::Slipping => change.get(i).copied().unwrap_or(0.0),
            _ => 0.0,
        };
        let of_jumps = &status[..contact.jumps.len()];
        let (c, c_scale) = self.driving_force(u);
        let (reaction, scale) = self.reaction(u);
        let mut response = PairResponse {
            reaction,
            scale,
            gaps: self.limits.gaps(&contact.jumps, |_| false),
            jumps: contact.jumps.clone(),
            change_before: of_jumps.iter().enumerate().map(change_before).collect(),
            contact_residual: c,
            contact_residual_scale: c_scale,
            active: (self.limits).closed_points(|i| status[i].is_closed()),
            status: status.clone(),
            ..PairResponse::default()
        };
        self.subtract_own(&mut response);
        response
    }

    /// Subtracts H t from the contact residual of a response, c.
    fn subtract_own(&self, response: &mut PairResponse) {
        for (column, &t) in self.condensed.s_tt().col_iter().zip(&response.jumps) {
            for (i, h) in column.iter().enumerate() {
                response.contact_residual[i] -= h * t;
                response.contact_residual_scale[i] += (h * t).abs();
            }
        }
    }

    /// c = f_t − S_tΓ U, the force on every normal jump at t = 0, and the scale of its terms.
    fn driving_force(&self, u: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let m = self.condensed.jumps;
        let mut c = self.load[..m].to_vec();
        let mut c_scale: Vec<f64> = c.iter().map(|f| f.abs()).collect();
        for (j, &u_j) in u.iter().enumerate() {
            let column = self.condensed.s.col_as_slice(m + j);
            for ((c, scale), s) in c.iter_mut().zip(&mut c_scale).zip(column) {
                let term = s * u_j;
                *c -= term;
                *scale += term.abs();
            }
        }
        (c, c_scale)
    }

    /// S_ΓΓ U + S_Γt t − f_Γ and the scale of its terms.
    fn reaction(&self, u: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut reaction: Vec<f64> = self.bilateral_load().iter().map(|f| -f).collect();
        let mut scale: Vec<f64> = reaction.iter().map(|f| f.abs()).collect();
        let m = self.condensed.jumps;
        let unknowns = self.state.contact.jumps.iter().chain(u);
        for (j, &x) in unknowns.enumerate() {
            let column = &self.condensed.s.col_as_slice(j)[m..];
            for ((reaction, scale), s) in reaction.iter_mut().zip(&mut scale).zip(column) {
                let term = s * x;
                *reaction += term;
                *scale += term.abs();
            }
        }
        (reaction, scale)
    }

    /// S_kl'(U) x = S_ΓΓ x − S_ΓN H_NN⁻¹ S_NΓ x with the normal jumps N open in the last evaluation and the slipping
    /// jumps, whose friction is held constant.
    pub fn derivative(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        multiply_add(self.condensed.bilateral(), x, &mut y);
        let open = self.state.status.iter().map(|status| !status.is_closed());
        let open: Vec<bool> = open.collect();
        let factor = OpenFactor::new(
            self.condensed.s_tt(),
            self.diagonal(),
            &self.limits.rows,
            &open,
        );
        let mut driven = vec![0.0; self.condensed.jumps];
        multiply_add(self.condensed.s_t_gamma(), x, &mut driven);
        let mut opened: Vec<f64> = factor.open.iter().map(|&j| -driven[j]).collect();
        factor.solve(&mut opened);
        let mut t = vec![0.0; self.condensed.jumps];
        for (&j, opened) in factor.open.iter().zip(opened) {
            t[j] = opened;
        }
        multiply_add(self.condensed.s_t_gamma().transpose(), &t, &mut y);
        y
    }
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;
    use crate::contact::jumps::JumpOf;
    use crate::contact::limits::Conditions;
    use crate::schur::condensed::InterfaceDof;

    const GAPS: [f64; 3] = [0.1, -0.2, 0.05];

    fn number(i: usize) -> f64 {
        (1.0 + 12.9898 * i as f64).sin()
    }

    /// A pair of three conditions and four traces, with arbitrary stiffness.
    fn pair() -> ContactPair {
        let (jumps, n) = (GAPS.len(), 7);
        let root = Mat::from_fn(n, n, |i, j| number(n * i + j));
        let s = &root * root.transpose() + Mat::<f64>::identity(n, n);
        let of = |number| JumpOf::Unknown {
            number,
            factor: 1.0,
        };
        let of: Vec<JumpOf> = (0..jumps).map(of).collect();
        let condensed = Condensed {
            jumps,
            interface_dofs: (0..4).map(|node| InterfaceDof { node, axis: 0 }).collect(),
            diagonal: (0..n).map(|i| s[(i, i)]).collect(),
            s,
            smallest_pivot: 1.0,
        };
        let load = (0..n).map(|i| 3.0 * number(100 + i)).collect();
        let limits = Limits::new(
            jumps,
            Conditions {
                of: &of,
                gaps: &GAPS,
                areas: &[1.0; GAPS.len()],
                friction: &[],
                scale: 0.0,
                round_off: &[0.0; GAPS.len()],
            },
        );
        ContactPair::new(Rc::new(condensed), limits, load, None)
    }

    /// Traces that open and close contacts in many combinations.
    fn traces() -> impl Iterator<Item = Vec<f64>> {
        (0..100).map(|k| (0..4).map(|i| 2.0 * number(1000 + 4 * k + i)).collect())
    }

    #[test]
    fn forces_keep_the_law_and_balance_the_pair() {
        let (mut pair, mut closed) = (pair(), 0);
        for u in traces() {
            let response = pair.evaluate(&u, None);
            let (forces, _) = pair.conditions();
            let x = [&response.jumps[..], &u].concat();
            let load = [&forces[..], &response.reaction].concat();
            for (i, acting) in load.iter().enumerate() {
                let held: f64 = (0..7).map(|j| pair.condensed.s[(i, j)] * x[j]).sum();
                let sign = if i < GAPS.len() { 1.0 } else { -1.0 };
                assert!((held + sign * acting - pair.load[i]).abs() < 1e-11);
            }
            for (i, force) in forces.iter().enumerate() {
                let gap = GAPS[i] - response.jumps[i];
                assert!(*force >= 0.0 && gap >= 0.0 && force * gap == 0.0);
                closed += usize::from(*force > 0.0);
            }
        }
        assert!((50..250).contains(&closed), "{closed}");
    }

    #[test]
    fn at_its_last_jumps_a_pair_responds_as_after_its_evaluation() {
        let mut pair = pair();
        for u in traces() {
            let evaluated = pair.evaluate(&u, None);
            let kept = pair.at_last_jumps(&u);
            let differences = [
                (&evaluated.reaction, &kept.reaction),
                (&evaluated.contact_residual, &kept.contact_residual),
                (&evaluated.gaps, &kept.gaps),
            ];
            for (a, b) in differences {
                assert_eq!(a.len(), b.len());
                assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14));
            }
            assert_eq!(evaluated.status, kept.status);
            // It isn't solved, so that no method ends with it.
            assert!(evaluated.converged && !kept.converged && kept.steps == 0);
        }
    }

    #[test]
    fn the_derivative_is_that_of_the_answers() {
        let (mut pair, mut compared, step) = (pair(), 0, 1e-3);
        for (u, direction) in traces().zip(traces().skip(1)) {
            let before = pair.evaluate(&u, None);
            let slope = pair.derivative(&direction);
            let there: Vec<f64> = (u.iter().zip(&direction))
                .map(|(u, d)| u + step * d)
                .collect();
            let after = pair.evaluate(&there, None);
            // Responses are linear between two kinks only.
            if before.status != after.status {
                continue;
            }
            compared += 1;
            let change = after.reaction.iter().zip(&before.reaction);
            for ((after, before), slope) in change.zip(slope) {
                assert!(((after - before) / step - slope).abs() < 1e-9);
            }
        }
        assert!(compared > 50, "{compared}");
    }
}
