//! The linear interface problem with every pair's active set frozen: J δ = r.
//!
//! J = S_0 + S_CON'(U) differs from the factorized bilateral operator by the contacts that opened, a
//! change of low rank, so that conjugate gradients preconditioned with that one factorization mostly
//! need few steps. Where they don't, J itself is factorized.

use super::{ROUND_OFF, axpy, dot, maximum};
use crate::contact::s_con::ConState;
use crate::interface::operator::Interface;

/// Conjugate gradient steps after which it pays to factorize.
const FEW_STEPS: usize = 60;
/// Most conjugate gradient steps where that can't be.
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

    /// δ = ((1 − blend) J + blend J_bilateral)⁻¹ r, to the round-off of terms of size `scale`;
    /// `None` where that operator is singular along the way.
    pub fn solve(&self, r: &[f64], scale: f64, blend: f64) -> Option<Vec<f64>> {
        let target = 0.1 * ROUND_OFF * scale;
        let bilateral = |z: &mut [f64]| self.interface.solve_bilateral(z);
        let first = self.conjugate_gradients(r, target, blend, FEW_STEPS, bilateral);
        if let Ending::Solved(x) = first {
            return Some(x);
        }
        // Many contacts opened, and the bilateral operator is far from J: factorize that one.
        if blend == 0.0
            && let Some(factor) = self.interface.factor_opened(|p| self.state.opening(p))
        {
            let opened = |z: &mut [f64]| {
                factor.forward(z);
                factor.backward(z);
            };
            match self.conjugate_gradients(r, target, blend, FEW_STEPS, opened) {
                Ending::Solved(x) | Ending::Unfinished(x) => return Some(x),
                Ending::Singular => {}
            }
        }
        match self.conjugate_gradients(r, target, blend, MAX_STEPS, bilateral) {
            Ending::Solved(x) | Ending::Unfinished(x) => Some(x),
            Ending::Singular => None,
        }
    }

    /// Conjugate gradients preconditioned with `precondition`, until the residual is `target`.
    fn conjugate_gradients(
        &self,
        r: &[f64],
        target: f64,
        blend: f64,
        most: usize,
        precondition: impl Fn(&mut [f64]),
    ) -> Ending {
        let mut x = vec![0.0; r.len()];
        let mut r = r.to_vec();
        let start = maximum(&r);
        let mut z = r.clone();
        precondition(&mut z);
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        let mut best = (f64::INFINITY, 0);
        for step in 0..=most {
            let size = maximum(&r);
            if size <= target || rz == 0.0 {
                return Ending::Solved(x);
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
                if best.0 <= 1e-10 * start {
                    return Ending::Unfinished(x);
                }
                return Ending::Singular;
            }
            let alpha = rz / curvature;
            axpy(alpha, &p, &mut x);
            axpy(-alpha, &q, &mut r);
            z.clone_from(&r);
            precondition(&mut z);
            let rz_next = dot(&r, &z);
            let beta = rz_next / rz;
            rz = rz_next;
            for (p, z) in p.iter_mut().zip(&z) {
                *p = z + beta * *p;
            }
        }
        if x.iter().all(|x| x.is_finite()) {
            Ending::Unfinished(x)
        } else {
            Ending::Singular
        }
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

/// How conjugate gradients end.
enum Ending {
    /// The residual is what was asked for.
    Solved(Vec<f64>),
    /// It isn't, but no better one was found in the steps that were allowed.
    Unfinished(Vec<f64>),
    /// The operator is singular.
    Singular,
}
