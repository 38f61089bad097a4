//! Shared unknowns together with the forces of slipping points, which follow their laws.
//!
//! GMRES (Saad and Schultz, SIAM J. Sci. Stat. Comput. 7, 1986) solves for both at once, with x on the unknowns that
//! clusters share and φ at the slipping points:
//!
//! ```text
//! A x − L φ = b          balance of the clusters under the loads L φ
//! φ − C(x, φ) = c        the laws, linear in pressures and slips
//! ```
//!
//! The preconditioner cancels the residual of the laws by each point's own compliance, and the balance of what remains
//! by BDDC. Residuals have its energy as their size.

use contact_dd_partition::id::{GroupId, OnGroups, OnTreeNodes};
use faer::linalg::solvers::SolveLstsq;
use faer::{Col, Mat};

use crate::bddc::Bddc;
use crate::bddc::conjugate_gradients::ConjugateGradients;
use crate::bddc::loads::{ClusterAnswer, ClusterLoads, Constants, SlipLaws};
use crate::bddc::local::{Local, Vectors};
use crate::contact::slip_law::SlipLaw;
use crate::context::Context;
use crate::schur::cluster_schur::ClusterSchur;
use crate::vector::{add_multiple, axpy, multiple};

/// Most iterations.
const CYCLE: usize = 150;
/// Least reduction of the residual by a cycle, and by as many iterations as are a trial.
const STALLS: f64 = 0.5;
/// Most iterations with a preconditioner of earlier matrices.
const MAX_WITH_STALE: usize = 40;
/// Tolerance above which a cycle's own residual is taken for the true one.
const EXACT: f64 = 1e-10;
/// Residual relative to the energy norm of the unknowns below which it may be round-off.
const ROUND_OFF: f64 = 1e-12;
/// Iterations after which a preconditioner that can be improved is judged, and the reduction to be reached by then.
const TRIAL: usize = 15;
const GOOD: f64 = 0.02;

/// Values on the shared unknowns of this rank's clusters and on the jumps of its contact groups.
#[derive(Clone, Debug, Default)]
struct Pair {
    x: Vectors,
    forces: OnGroups<Vec<f64>>,
}

impl Pair {
    /// Adds `factor` times another.
    fn add(&mut self, factor: f64, other: &Self) {
        add_multiple(factor, &other.x, &mut self.x);
        add_multiple(factor, &other.forces, &mut self.forces);
    }

    fn scaled(&self, factor: f64) -> Self {
        Self {
            x: multiple(factor, &self.x),
            forces: multiple(factor, &self.forces),
        }
    }
}

/// A solution on this rank, with the forces of slipping points.
#[derive(Debug)]
pub(super) struct SlippingSolution {
    /// The unknowns of clusters, and the answer of contact groups without forces of slipping points.
    pub answer: ClusterAnswer,
    /// The forces of slipping points, on all jumps.
    pub forces: OnGroups<Vec<f64>>,
    /// Number of iterations.
    pub iterations: usize,
    /// True if the iteration converged.
    pub is_solved: bool,
}

/// A cycle of GMRES.
struct Cycle {
    change: Pair,
    iterations: usize,
    /// The size of the residual that it leaves.
    left: f64,
    /// True if that is small enough.
    reached: bool,
}

/// The residual at a pair.
struct Evaluation {
    answer: ClusterAnswer,
    residual: Pair,
    /// The energy norm of the unknowns, √(x·A x).
    energy: f64,
}

/// The problem of slipping points between clusters.
pub(super) struct Slipping<'a> {
    pub bddc: &'a Bddc,
    pub context: &'a Context<'a>,
    pub clusters: &'a OnTreeNodes<ClusterSchur>,
    pub gradients: ConjugateGradients<'a>,
    pub loads: ClusterLoads<'a>,
    pub constants: &'a Constants,
    pub laws: &'a SlipLaws,
}

impl Slipping<'_> {
    /// Solves from the forces of the loads and from a `start` of shared unknowns, or from 0, until the residual is less
    /// than `tolerance` times the energy norm of the unknowns. Collective.
    pub fn solve(&self, start: Option<Vectors>, tolerance: f64) -> SlippingSolution {
        let shared = |(&c, local): (&_, &Local)| (c, vec![0.0; local.shared()]);
        let starts_at_zero = start.is_none();
        let mut at = Pair {
            x: start.unwrap_or_else(|| self.bddc.locals.iter().map(shared).collect()),
            forces: self.loads.forces.clone(),
        };
        let (mut iterations, mut last) = (0, f64::INFINITY);
        let (mut reached, mut left) = (true, f64::INFINITY);
        let (answer, is_solved) = loop {
            let Evaluation {
                answer,
                residual,
                mut energy,
            } = self.evaluate(&at);
            if tolerance > EXACT && left <= tolerance * energy {
                break (answer, true);
            }
            let residual = self.preconditioned(residual);
            let size = self.size(&residual);
            if starts_at_zero && iterations == 0 {
                energy = size;
            }
            // Where cycles reach the goal, and the residual doesn't, the rest is round-off.
            let ends = !reached || size.is_nan() || size > STALLS * last;
            if ends || size <= tolerance * energy {
                break (answer, reached || size <= ROUND_OFF * energy);
            }
            last = size;
            let cycle = self.cycle(residual, size, tolerance * energy, iterations);
            at.add(1.0, &cycle.change);
            iterations += cycle.iterations;
            (reached, left) = (cycle.reached, cycle.left);
        };
        SlippingSolution {
            answer,
            forces: at.forces,
            iterations,
            is_solved,
        }
    }

    /// A cycle of GMRES from a residual of this size to one of `enough`, after `before` iterations. Collective.
    fn cycle(&self, residual: [Pair; 2], size: f64, enough: f64, before: usize) -> Cycle {
        let most = match self.gradients.is_stale {
            true => MAX_WITH_STALE.saturating_sub(before).clamp(1, CYCLE),
            false => CYCLE,
        };
        let is_provisional = !self.gradients.is_stale && self.gradients.is_provisional;
        let mut basis = vec![residual.each_ref().map(|part| part.scaled(1.0 / size))];
        let mut h = Mat::<f64>::zeros(most + 1, most);
        let (mut weights, mut sizes) = (Vec::new(), vec![size]);
        for k in 0..most {
            let mut next = self.preconditioned(self.product(&basis[k][1]));
            // Orthogonalized twice, which is as good as one by one.
            for _ in 0..2 {
                let shares = self.products(&basis, &next);
                for (i, share) in shares.iter().enumerate() {
                    h[(i, k)] += share;
                    for (next, known) in next.iter_mut().zip(&basis[i]) {
                        next.add(-share, known);
                    }
                }
            }
            let rest = self.size(&next);
            h[(k + 1, k)] = rest;
            let small = h.submatrix(0, 0, k + 2, k + 1);
            let right = Col::from_fn(k + 2, |i| if i == 0 { size } else { 0.0 });
            let y = small.qr().solve_lstsq(&right);
            let left = (small * &y - &right).norm_l2();
            weights = y.subrows(0, k + 1).iter().copied().collect();
            let done = (size / left).ln() / (size / enough).ln();
            self.context
                .listener
                .done(done.clamp(f64::MIN_POSITIVE, 1.0));
            sizes.push(left);
            let ends = left <= enough || rest <= f64::EPSILON * size || left.is_nan();
            let is_slow = is_provisional && before + k + 1 == TRIAL && left > GOOD * size;
            let stalls = k >= TRIAL && left > STALLS * sizes[k + 1 - TRIAL];
            if ends || is_slow || stalls {
                break;
            }
            basis.push(next.each_ref().map(|part| part.scaled(1.0 / rest)));
        }
        let iterations = weights.len();
        let none = basis[0][1].scaled(0.0);
        let change = basis.iter().zip(weights).fold(none, |mut sum, (known, w)| {
            sum.add(w, &known[1]);
            sum
        });
        Cycle {
            change,
            iterations,
            left: sizes[iterations],
            reached: sizes[iterations] <= enough,
        }
    }

    /// The residual of the loads and laws at a pair. Collective.
    fn evaluate(&self, at: &Pair) -> Evaluation {
        let loads = Some((self.loads.clusters, self.constants));
        let (answer, residual, mut b) = self.residual(at, loads);
        self.gradients.add_up(&mut b);
        add_multiple(-1.0, &residual.x, &mut b);
        let energy = self.gradients.products(&at.x, &[&b])[0].max(0.0).sqrt();
        Evaluation {
            answer,
            residual,
            energy,
        }
    }

    /// The negative residual at a pair without loads and constants of the laws. Collective.
    fn product(&self, at: &Pair) -> Pair {
        self.residual(at, None).1.scaled(-1.0)
    }

    /// The answer of clusters and contact groups to a pair, the residual, with the balance after the correction of slip
    /// forces, and the part of the loads on shared unknowns in every cluster. Collective.
    fn residual(
        &self,
        at: &Pair,
        loads: Option<(&OnTreeNodes<Vec<f64>>, &Constants)>,
    ) -> (ClusterAnswer, Pair, Vectors) {
        let (bddc, comm) = (self.bddc, self.context.comm);
        let none = Constants::new();
        let constants = loads.map_or(&none, |(_, constants)| constants);
        let acting = bddc.acting(self.context, loads.map(|(loads, _)| loads), &at.forces);
        let (own, b) = bddc.condense(self.context, self.clusters, &acting, constants);
        let solved = bddc.recovered(&own, &at.x, constants);
        let unbalanced = bddc.unbalanced(self.context, self.clusters, acting, &solved);
        let shared = |(&c, r): (&_, &Vec<f64>)| (c, bddc.locals[&c].on_shared(r));
        let mut balance: Vectors = unbalanced.iter().map(shared).collect();
        let answer = bddc.answer(comm, solved, &unbalanced);
        let of_laws = at.forces.iter();
        let of_laws =
            of_laws.map(|(&g, forces)| (g, self.of_laws(g, &answer, forces, loads.is_some())));
        let forces: OnGroups<Vec<f64>> = of_laws.collect();
        // The balance under forces that cancel this residual against each point's own compliance: it is such that they
        // are the residual itself.
        let acting = bddc.acting(self.context, None, &forces);
        let (_, of_correction) = bddc.condense(self.context, self.clusters, &acting, &none);
        add_multiple(1.0, &of_correction, &mut balance);
        self.gradients.add_up(&mut balance);
        (answer, Pair { x: balance, forces }, b)
    }

    /// A residual r with what the preconditioner makes of it: [r, M r]. Collective.
    fn preconditioned(&self, r: Pair) -> [Pair; 2] {
        let z = Pair {
            x: self.gradients.precondition(&r.x),
            forces: r.forces.clone(),
        };
        [r, z]
    }

    /// The negative residual of the laws of group g under these forces of its slipping points.
    fn of_laws(
        &self,
        g: GroupId,
        answer: &ClusterAnswer,
        forces: &[f64],
        has_loads: bool,
    ) -> Vec<f64> {
        let mut residual = vec![0.0; forces.len()];
        // Groups below clusters keep their forces.
        let (Some(at), Some(laws)) = (answer.groups.get(&g), self.laws.get(&g)) else {
            return residual;
        };
        let both = at.forces.iter().zip(forces);
        let all: Vec<f64> = both.map(|(closed, slipping)| closed + slipping).collect();
        let prescribed = &self.loads.prescribed[&g];
        let start = |i: usize| if has_loads { prescribed[i] } else { 0.0 };
        for law in laws {
            law.add_residual(&all, |i| at.jumps[i] - start(i), !has_loads, &mut residual);
        }
        residual.iter_mut().for_each(|r| *r = -*r);
        residual
    }

    /// √(r·M r). Collective.
    fn size(&self, both: &[Pair; 2]) -> f64 {
        let product = self.products(std::slice::from_ref(both), both)[0];
        product.max(0.0).sqrt()
    }

    /// r·M v for every v of a basis. Collective.
    fn products(&self, basis: &[[Pair; 2]], [r, _]: &[Pair; 2]) -> Vec<f64> {
        let Context { comm, plan, .. } = *self.context;
        let corrections: Vec<&Vectors> = basis.iter().map(|[_, z]| &z.x).collect();
        let mut sums = self.gradients.products(&r.x, &corrections);
        let of_group = |g: GroupId| -> Vec<f64> {
            let (Some(own), Some(r)) = (self.laws.get(&g), r.forces.get(&g)) else {
                return Vec::new();
            };
            let product = |[_, z]: &[Pair; 2]| {
                let of_law = |law: &SlipLaw| law.product(r, &z.forces[&g]);
                own.iter().map(of_law).sum()
            };
            basis.iter().map(product).collect()
        };
        comm.gather(&plan.group_owners(), of_group, |_, of_group: Vec<f64>| {
            axpy(1.0, &of_group, &mut sums);
        });
        comm.broadcast(&mut sums);
        sums
    }
}
