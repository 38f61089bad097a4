//! The linear interface problem with every pair's active set frozen: J δ = r.
//!
//! J = S_0 + S_CON'(U) differs from the factorized bilateral operator by the contacts that opened,
//! and on the traces of pairs alone. Those are eliminated last, so that nothing else is ever
//! factorized again. Where J is singular, because too little is closed to hold a body, conjugate
//! gradients preconditioned with the bilateral operator solve for it all the same or blended with it.

use super::{ROUND_OFF, axpy, dot, maximum};
use crate::contact::s_con::ConState;
use crate::interface::operator::Interface;

/// Most refinements of a direct solution.
const MAX_REFINEMENTS: usize = 2;
/// Most conjugate gradient steps.
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

    /// δ = J⁻¹ r, to the round-off of terms of size `scale`; `None` where J is singular.
    pub fn solve(&self, r: &[f64], scale: f64) -> Option<Vec<f64>> {
        let factor = self.interface.factor_opened(|p| self.state.opening(p))?;
        let mut x = r.to_vec();
        factor.solve(&mut x);
        for _ in 0..MAX_REFINEMENTS {
            let mut left = r.to_vec();
            axpy(-1.0, &self.derivative(&x, 0.0).0, &mut left);
            if maximum(&left) <= ROUND_OFF * scale {
                break;
            }
            factor.solve(&mut left);
            axpy(1.0, &left, &mut x);
        }
        x.iter().all(|x| x.is_finite()).then_some(x)
    }

    /// δ = ((1 − blend) J + blend J_bilateral)⁻¹ r by conjugate gradients preconditioned with the
    /// bilateral operator, which need no regular J; `None` where r drives what nothing resists.
    pub fn solve_blended(&self, r: &[f64], scale: f64, blend: f64) -> Option<Vec<f64>> {
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
                return Some(x);
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
        let mut bilateral = vec![0.0; p.len()];
        self.interface.add_bilateral(p, &mut bilateral);
        let mut q = bilateral.clone();
        self.state
            .add_openings(self.interface, 1.0 - blend, p, &mut q);
        (q, bilateral)
    }
}
