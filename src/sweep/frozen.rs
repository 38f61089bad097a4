//! The linear interface problem with every pair's active set frozen: J δ = r.
//!
//! J = S_0 + S_CON'(U) differs from the factorized bilateral operator by the contacts that opened, a
//! change of low rank, so that conjugate gradients preconditioned with that one factorization
//! need few steps and nothing is ever factorized again at the root.

use super::{ROUND_OFF, axpy, dot, maximum};
use crate::contact::s_con::ConState;
use crate::interface::operator::Interface;

/// Most conjugate gradient steps of one sweep.
const MAX_STEPS: usize = 1000;
/// Conjugate gradient steps without progress that are taken for round-off.
const PATIENCE: usize = 20;
/// Curvature relative to the bilateral operator's below which the derivative is singular.
const SINGULAR_CURVATURE: f64 = 1e-13;

/// J at the active sets of the last evaluation of S_CON.
#[derive(Clone, Copy, Debug)]
pub struct Frozen<'a> {
    interface: &'a Interface,
    state: &'a ConState,
}

impl<'a> Frozen<'a> {
    /// J at the active sets that `state` has the openings of.
    pub fn new(interface: &'a Interface, state: &'a ConState) -> Self {
        Self { interface, state }
    }

    /// δ = ((1 − blend) J + blend J_bilateral)⁻¹ r by preconditioned conjugate gradients, to the
    /// round-off of terms of size `scale`; `None` where that operator is singular along the way.
    pub fn solve(&self, r: &[f64], scale: f64, blend: f64) -> Option<Vec<f64>> {
        let mut x = vec![0.0; r.len()];
        let mut r = r.to_vec();
        let target = 0.1 * ROUND_OFF * scale;
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
}
