//! Conjugate gradients on the clusters' shared unknowns, preconditioned by separate clusters and the coarse problem.
//!
//! Every rank holds the vectors of its own clusters.

use std::collections::BTreeMap;

use contact_dd_partition::id::{MergeRootId, OnMergeRoots};
use contact_dd_partition::numbered::Numbered;

use crate::bddc::class_sums::ClassSums;
use crate::bddc::classes::Classes;
use crate::bddc::coarse::Coarse;
use crate::bddc::local::{Local, Vectors};
use crate::context::Context;
use crate::schur::symmetric::PackedSymmetric;

/// Most iterations.
const MAX_ITERATIONS: usize = 500;
/// Most iterations with a preconditioner of earlier matrices.
const MAX_WITH_STALE: usize = 30;
/// Iterations after which a preconditioner that can be improved is judged.
const TRIAL: usize = 6;
/// Relative error to be reached by then: a better preconditioner costs about as much as 30 iterations.
const GOOD: f64 = 0.1;

/// The conjugate gradient method: operator and preconditioner.
#[derive(Clone, Copy)]
pub struct ConjugateGradients<'a> {
    /// The context of the run.
    pub context: &'a Context<'a>,
    /// The classes of Γ.
    pub classes: &'a Classes,
    /// Their sums over clusters.
    pub sums: &'a ClassSums,
    /// The clusters of this rank.
    pub locals: &'a OnMergeRoots<Local>,
    /// S of every cluster; `None` for those of other ranks.
    pub matrices: &'a Numbered<MergeRootId, Option<&'a PackedSymmetric>>,
    /// The coarse problem.
    pub coarse: &'a Coarse,
    /// True if the preconditioner is that of earlier matrices.
    pub is_stale: bool,
    /// True if the preconditioner can be improved.
    pub is_provisional: bool,
}

impl ConjugateGradients<'_> {
    /// Solves S x = b, where b is a sum over clusters, from a `start`, or from 0; returns x, the number of iterations
    /// and whether they converged. Collective.
    ///
    /// Iteration ends where √(rᵀ M r), with the preconditioner M about the error in the energy norm, is less than
    /// `tolerance` times the solution's: bᵀ M b, or with a start x₀ the energy of its best multiple, (bᵀ x₀)² / x₀ᵀ S x₀.
    pub fn solve(
        &self,
        mut b: Vectors,
        start: Option<Vectors>,
        tolerance: f64,
    ) -> (Vectors, usize, bool) {
        self.add_up(&mut b);
        let mut r = b;
        let (mut x, energy) = match start.and_then(|start| self.begun(&mut r, start)) {
            Some((start, energy)) => (start, Some(energy)),
            None => (
                r.iter().map(|(&c, r)| (c, vec![0.0; r.len()])).collect(),
                None,
            ),
        };
        let mut z = self.precondition(&r);
        let mut rho = self.dot(&r, &z);
        let enough = tolerance * tolerance * energy.unwrap_or(rho);
        let mut p = z.clone();
        let most = match self.is_stale {
            true => MAX_WITH_STALE,
            false => MAX_ITERATIONS,
        };
        let mut iterations = 0;
        let begin = rho;
        let is_slow = |iterations: usize, rho: f64| {
            let is_provisional = !self.is_stale && self.is_provisional && iterations == TRIAL;
            is_provisional && rho > GOOD * GOOD * begin
        };
        let mut done = 0.0_f64;
        self.context.listener.done(done);
        while rho > enough && iterations < most && !is_slow(iterations, rho) {
            let q = self.multiply(&p);
            let curvature = self.dot(&p, &q);
            if curvature <= 0.0 || curvature.is_nan() {
                break;
            }
            let step = rho / curvature;
            subtract(&mut x, &p, -step);
            subtract(&mut r, &q, step);
            z = self.precondition(&r);
            let before = std::mem::replace(&mut rho, self.dot(&r, &z));
            for (p, z) in p.values_mut().zip(z.values()) {
                p.iter_mut()
                    .zip(z)
                    .for_each(|(p, z)| *p = z + rho / before * *p);
            }
            iterations += 1;
            done = done.max((begin / rho).ln() / (begin / enough).ln());
            self.context
                .listener
                .done(done.clamp(f64::MIN_POSITIVE, 1.0));
        }
        (x, iterations, rho <= enough)
    }

    /// Takes S x₀ off the residual b of 0 and returns x₀ with the energy of its best multiple, if x₀ is a better start than
    /// 0: in the energy norm its error is less where x₀ᵀ S x₀ < 2 bᵀ x₀. The solution for another load may be a worse one.
    /// Collective.
    fn begun(&self, b: &mut Vectors, start: Vectors) -> Option<(Vectors, f64)> {
        let of_start = self.multiply(&start);
        let products = self.products(&start, &[b, &of_start]);
        let (work, energy) = (products[0], products[1]);
        (energy < 2.0 * work).then(|| {
            subtract(b, &of_start, 1.0);
            (start, work * (work / energy))
        })
    }

    /// S x. Collective.
    fn multiply(&self, x: &Vectors) -> Vectors {
        let of = |(&c, local): (&MergeRootId, &Local)| {
            Some((c, local.multiply(self.matrices[c]?, &x[&c])))
        };
        let mut y = self.locals.iter().filter_map(of).collect();
        self.add_up(&mut y);
        y
    }

    /// M r. Collective.
    pub fn precondition(&self, r: &Vectors) -> Vectors {
        let (mut others, mut coarse) = (BTreeMap::new(), Vectors::new());
        for (&c, local) in self.locals {
            let (of_others, of_coarse) = local.share(&r[&c]);
            others.insert(c, of_others);
            coarse.insert(c, of_coarse);
        }
        let mut answers = self.coarse.solve(self.context, coarse);
        let mut z = Vectors::new();
        for (c, others) in others {
            let x = answers.remove(&c).unwrap_or_default();
            z.insert(c, self.locals[&c].correct(others, &x));
        }
        self.add_up(&mut z);
        z
    }

    /// Replaces each cluster's values by the sum over all that share an unknown. Collective.
    pub fn add_up(&self, v: &mut Vectors) {
        (self.sums).add_up(self.context.comm, self.classes, self.locals, v);
    }

    /// x·y, with each unknown counted once, on all ranks. Collective.
    fn dot(&self, x: &Vectors, y: &Vectors) -> f64 {
        self.products(x, &[y])[0]
    }

    /// x·y for several y, with each unknown counted once, on all ranks. Collective.
    pub fn products(&self, x: &Vectors, all: &[&Vectors]) -> Vec<f64> {
        (self.sums).products(self.context.comm, self.classes, self.locals, (x, all))
    }
}

/// x ← x − a y.
fn subtract(x: &mut Vectors, y: &Vectors, a: f64) {
    for (x, y) in x.values_mut().zip(y.values()) {
        x.iter_mut().zip(y).for_each(|(x, y)| *x -= a * y);
    }
}
