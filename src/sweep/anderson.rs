//! The chord method with Anderson acceleration: (S_0 + S_CON' of the bilateral problem) δ = r.

use std::collections::VecDeque;

use nalgebra::{DMatrix, DVector};

use super::{Residual, SweepStatus, Sweeps, axpy};

/// Steps that are remembered.
const DEPTH: usize = 5;
/// Sweeps before it gives up.
const MAX_SWEEPS: usize = 500;

impl Sweeps<'_, '_> {
    pub(super) fn anderson(&mut self, u: &mut [f64], mut residual: Residual) -> SweepStatus {
        let limit = self.settings.max_sweeps.unwrap_or(MAX_SWEEPS);
        let first = self.sweeps_done();
        let mut history: VecDeque<(Vec<f64>, Vec<f64>)> = VecDeque::new();
        let mut last: Option<(Vec<f64>, Vec<f64>)> = None;
        while !self.is_converged(&residual) {
            let hopeless = !residual.relative.is_finite() || self.interface.len == 0;
            if hopeless || self.sweeps_done() - first >= limit {
                return self.gave_up(&residual, "anderson stopped");
            }
            let mut chord = residual.r.clone();
            self.interface.solve_bilateral(&mut chord);
            if let Some((u_last, chord_last)) = last.replace((u.to_vec(), chord.clone())) {
                history.push_back((difference(u, &u_last), difference(&chord, &chord_last)));
                if history.len() > DEPTH {
                    history.pop_front();
                }
            }
            let weights = mixing_weights(&history, &chord);
            axpy(1.0, &chord, u);
            for ((du, dc), weight) in history.iter().zip(&weights) {
                axpy(-weight, du, u);
                axpy(-weight, dc, u);
            }
            residual = self.residual(u, None);
            self.record(&residual);
        }
        SweepStatus::Converged
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
    // Nearly dependent directions say nothing: the cut-off drops them.
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
