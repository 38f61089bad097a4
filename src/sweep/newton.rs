//! Semismooth Newton: (S_0 + S_CON'(U)) δ = r.
//!
//! A sweep freezes every pair's active set at U^(k−1) and solves the linear interface problem. r is
//! minus the gradient of a convex energy, along which a line search gets down.
//!
//! The derivative differs from the factorized bilateral operator by the contacts that opened, a
//! change of low rank, so that conjugate gradients preconditioned with that one factorization
//! need few steps and nothing is ever factorized again at the root.

use super::{ROUND_OFF, Residual, SweepStatus, Sweeps, axpy, dot, maximum};
use crate::contact::s_con::Openings;

/// Sweeps before another method takes over.
const MAX_SWEEPS: usize = 80;
/// Most conjugate gradient steps of one sweep.
const MAX_STEPS: usize = 1000;
/// Conjugate gradient steps without progress that are taken for round-off.
const PATIENCE: usize = 20;
/// Share of the bilateral operator that is blended in where the derivative is singular.
const BLEND: f64 = 1e-3;
/// Curvature relative to the bilateral operator's below which the derivative is singular.
const SINGULAR_CURVATURE: f64 = 1e-13;

impl Sweeps<'_, '_> {
    pub(super) fn newton(&mut self, u: &mut [f64], mut residual: Residual) -> SweepStatus {
        let limit = self.settings.max_sweeps.unwrap_or(MAX_SWEEPS);
        while !self.is_converged(&residual) {
            if self.sweeps_done() >= limit {
                if self.settings.max_sweeps.is_some() {
                    return self.gave_up(&residual, "newton stopped");
                }
                self.notes.push(format!(
                    "newton didn't converge in {limit} sweeps; anderson took over"
                ));
                return self.anderson(u, residual);
            }
            let step = self
                .newton_step(&residual, 0.0)
                .or_else(|| self.newton_step(&residual, BLEND));
            let Some(step) = step else {
                return self.gave_up(&residual, "newton found no direction");
            };
            residual = self.line_search(u, &step, &residual);
            self.record(&residual);
        }
        SweepStatus::Converged
    }

    /// δ = ((1 − blend) J + blend J_bilateral)⁻¹ r by preconditioned conjugate gradients; `None`
    /// where that operator is singular along the way.
    pub(super) fn newton_step(&self, residual: &Residual, blend: f64) -> Option<Vec<f64>> {
        let mut x = vec![0.0; residual.r.len()];
        let mut r = residual.r.clone();
        let target = 0.1 * ROUND_OFF * residual.scale;
        let start = maximum(&r);
        let mut z = r.clone();
        self.interface.solve_bilateral(&mut z);
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        let mut best = (f64::INFINITY, 0);
        for step in 0..MAX_STEPS {
            let size = maximum(&r);
            if size <= target || rz == 0.0 {
                break;
            }
            // No progress for long means that round-off is reached.
            if size < 0.5 * best.0 {
                best = (size, step);
            } else if step > best.1 + PATIENCE {
                break;
            }
            let (q, reference) = self.derivative(&p, blend);
            let curvature = dot(&p, &q);
            if curvature <= SINGULAR_CURVATURE * dot(&p, &reference) || curvature.is_nan() {
                // Along p nothing resists; what is solved so far serves if it is nearly all.
                return (best.0 <= 1e-10 * start).then_some(x);
            }
            let alpha = rz / curvature;
            axpy(alpha, &p, &mut x);
            axpy(-alpha, &q, &mut r);
            z.clone_from(&r);
            self.interface.solve_bilateral(&mut z);
            let rz_next = dot(&r, &z);
            let beta = rz_next / rz;
            rz = rz_next;
            for (p, z) in p.iter_mut().zip(&z) {
                *p = z + beta * *p;
            }
        }
        x.iter().all(|x| x.is_finite()).then_some(x)
    }

    /// (1 − blend) J p + blend J_bilateral p, and J_bilateral p.
    fn derivative(&self, p: &[f64], blend: f64) -> (Vec<f64>, Vec<f64>) {
        let mut s_0 = vec![0.0; p.len()];
        self.interface.add_s_0(p, &mut s_0);
        let mut bilateral = s_0.clone();
        for pair in 0..self.interface.pair_traces.len() {
            let x = self.interface.restrict(pair, p);
            let mut y = vec![0.0; x.len()];
            self.interface.add_pair_bilateral(pair, &x, &mut y);
            self.interface.extend(pair, &y, &mut bilateral);
        }
        let mut q = s_0;
        self.state.add_derivative(self.interface, p, &mut q);
        if blend > 0.0 {
            for (q, b) in q.iter_mut().zip(&bilateral) {
                *q = (1.0 - blend) * *q + blend * b;
            }
        }
        (q, bilateral)
    }

    /// Moves U along `step` and returns the residual there.
    ///
    /// r is minus the gradient of a convex energy: a step too far shows in a slope stepᵀr that has
    /// turned and is as steep as before; then a shorter one is taken. The residual's size may rise.
    fn line_search(&mut self, u: &mut [f64], step: &[f64], before: &Residual) -> Residual {
        let slope = dot(step, &before.r);
        let mut alpha = 1.0;
        loop {
            let mut trial = u.to_vec();
            axpy(alpha, step, &mut trial);
            let residual = self.residual(&trial, Openings::Changed);
            let there = dot(step, &residual.r);
            let accepted = there >= -0.9 * slope || self.is_converged(&residual);
            if accepted || alpha < 1e-4 {
                u.copy_from_slice(&trial);
                return residual;
            }
            alpha *= (slope / (slope - there)).clamp(0.1, 0.6);
        }
    }
}
