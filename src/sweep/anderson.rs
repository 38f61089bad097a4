//! The chord method with Anderson acceleration: (S_0 + S_CON' of the bilateral problem) δ = r.

use std::collections::VecDeque;

use nalgebra::{DMatrix, DVector};

use super::{ROUND_OFF, Residual, SweepStatus, Sweeps};
use crate::error::Failure;
use crate::interface::coupled::CoupledContact;
use crate::vector::axpy;

/// Number of stored steps.
const DEPTH: usize = 5;
/// Most sweeps, including those of a method that it took over from.
const MAX_SWEEPS: usize = 500;
/// Most sweeps if points slip in two directions: problems not solved by a hundred aren't solved by ten times as many.
const MAX_SWEEPS_OF_DISCS: usize = 100;
/// Most sweeps in which only the contact problem of a pair keeps the residual from convergence.
const MAX_FAILURES: usize = 10;

/// The stored steps.
#[derive(Default)]
struct Chords {
    /// The previous U and chord step.
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Changes of both.
    history: VecDeque<(Vec<f64>, Vec<f64>)>,
}

impl Chords {
    fn remember(&mut self, u: &[f64], chord: &[f64]) {
        let now = (u.to_vec(), chord.to_vec());
        if let Some((u_last, chord_last)) = self.last.replace(now) {
            let change = (difference(u, &u_last), difference(chord, &chord_last));
            self.history.push_back(change);
            if self.history.len() > DEPTH {
                self.history.pop_front();
            }
        }
    }
}

impl Sweeps<'_, '_> {
    pub(super) fn anderson(&mut self, mut residual: Residual) -> Result<SweepStatus, Failure> {
        let coupled = CoupledContact::new(self.problem);
        let most = match coupled.is_some_and(|coupled| coupled.has_cones()) {
            true => MAX_SWEEPS_OF_DISCS,
            false => MAX_SWEEPS,
        };
        let limit = self.settings.max_sweeps.unwrap_or(most);
        let mut chords = Chords::default();
        let mut failures = 0;
        while self.needs_sweep(&residual)? {
            failures += usize::from(residual.relative <= ROUND_OFF);
            let hopeless = !residual.relative.is_finite()
                || self.problem.interface.len == 0
                || failures > MAX_FAILURES;
            if hopeless || self.sweeps_done() >= limit {
                self.outcome.is_settled = residual.totals.changed == 0;
                return Ok(self.gave_up(&residual, "anderson stopped"));
            }
            let mut chord = residual.r;
            self.problem.interface.solver.solve(&mut chord);
            let u = &mut self.outcome.u;
            chords.remember(u, &chord);
            let weights = mixing_weights(&chords.history, &chord);
            axpy(1.0, &chord, u);
            for ((du, dc), weight) in chords.history.iter().zip(&weights) {
                axpy(-weight, du, u);
                axpy(-weight, dc, u);
            }
            residual = self.evaluate(None);
        }
        Ok(SweepStatus::Converged)
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// γ that minimizes ‖chord − Σ γ_i Δchord_i‖₂.
fn mixing_weights(history: &VecDeque<(Vec<f64>, Vec<f64>)>, chord: &[f64]) -> Vec<f64> {
    if history.is_empty() {
        return Vec::new();
    }
    let norms: Vec<f64> = history
        .iter()
        .map(|(_, dc)| {
            dc.iter()
                .map(|x| x * x)
                .sum::<f64>()
                .sqrt()
                .max(f64::MIN_POSITIVE)
        })
        .collect();
    let columns = DMatrix::from_fn(chord.len(), history.len(), |i, j| {
        history[j].1[i] / norms[j]
    });
    let rhs = DVector::from_column_slice(chord);
    // Nearly dependent directions carry no information: the cut-off drops them.
    columns
        .svd(true, true)
        .solve(&rhs, 1e-10)
        .map(|gamma| gamma.iter().zip(&norms).map(|(g, n)| g / n).collect())
        .unwrap_or_else(|_| vec![0.0; history.len()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_find_a_combination_that_is_there() {
        let a = vec![1.0, 2.0, -1.0, 0.5];
        let b = vec![1e6, -3e6, 2e6, 1e6];
        let chord: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 0.25 * a - 2e-6 * b).collect();
        let history = VecDeque::from([(vec![], a), (vec![], b)]);
        let weights = mixing_weights(&history, &chord);
        assert!((weights[0] - 0.25).abs() < 1e-12);
        assert!((weights[1] + 2e-6).abs() < 1e-17);
    }
}
