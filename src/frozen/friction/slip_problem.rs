//! The linear problem of points that slip while the active set is frozen: forces that change as their laws say with what
//! they make of jumps and pressures.
//!
//! GMRES solves it (Saad and Schultz, SIAM J. Sci. Stat. Comput. 7, 1986): a product is a solution of the frozen fronts
//! for forces at the slipping points and nothing else.

use std::collections::BTreeMap;

use faer::linalg::solvers::SolveLstsq;
use faer::{Col, Mat};

use super::slip_law::SlipLaw;
use crate::bddc::solution::{Accuracy, ClusterLoads};
use crate::context::Context;
use crate::error::Failure;
use crate::frozen::fronts::FrozenFronts;
use crate::frozen::solution::FrozenSolution;
use crate::vector::{axpy, dot};

/// Most products.
const PRODUCTS: usize = 40;
/// Tolerance of the first product beside what GMRES is to reach. The nearer that is, the less a product matters: later
/// ones may be as much less exact (Bouras and Frayssé, SIAM J. Matrix Anal. Appl. 26, 2005).
const PRODUCT: f64 = 0.3;
/// Tolerance of a product at most.
const LEAST_EXACT: f64 = 0.1;

/// Forces on the jumps of every contact group of this rank.
pub type Forces = BTreeMap<usize, Vec<f64>>;
/// The laws of the slipping points of every contact group of this rank.
pub type Laws = BTreeMap<usize, Vec<SlipLaw>>;

/// What a frozen active set is solved for with.
#[derive(Clone, Copy)]
pub struct SlipProblem<'a> {
    /// What the run works on.
    pub context: &'a Context<'a>,
    /// Which jumps are open, by contact group of this rank.
    pub open: &'a BTreeMap<usize, Vec<bool>>,
    /// Loads on the boundaries of clusters, by node.
    pub clusters: &'a BTreeMap<usize, Vec<f64>>,
    /// The values of the closed jumps of every group (m).
    pub prescribed: &'a BTreeMap<usize, Vec<f64>>,
}

impl SlipProblem<'_> {
    /// The solution where the jumps that slip carry these `forces`, with an iterative solver as far as the `tolerance`
    /// from where an earlier solution was. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely.
    pub fn respond(
        &self,
        fronts: &mut FrozenFronts,
        forces: &Forces,
        tolerance: f64,
        start: Option<&FrozenSolution>,
    ) -> Result<FrozenSolution, Failure> {
        let loads = ClusterLoads {
            clusters: self.clusters,
            prescribed: self.prescribed,
            forces,
        };
        let accuracy = Accuracy {
            tolerance,
            start: start.map(|start| &start.merge_roots),
        };
        let mut solution = fronts.solve(self.context, self.open, loads, accuracy)?;
        solution.iterations += start.map_or(0, |start| start.iterations);
        Ok(solution)
    }

    /// The forces that follow `laws` with the pressures and slips of a solution without them;
    /// GMRES makes what is missed smaller by `reduction`. `None` where none are missed. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely.
    pub fn follow(
        &self,
        fronts: &mut FrozenFronts,
        laws: &Laws,
        solution: &FrozenSolution,
        reduction: f64,
    ) -> Result<Option<Forces>, Failure> {
        let of_group = |(&g, jumps): (&usize, &Vec<f64>)| {
            let mut missed = vec![0.0; jumps.len()];
            for law in laws.get(&g).into_iter().flatten() {
                law.add_missed(&solution.forces[&g], |i| jumps[i], false, &mut missed);
            }
            (g, missed)
        };
        let missed: Forces = solution.jumps.iter().map(of_group).collect();
        if self.dot(&missed, &missed) == 0.0 {
            return Ok(None);
        }
        let (forces, _) = self.gmres(fronts, laws, missed, reduction)?;
        Ok(Some(forces))
    }

    /// The change of forces that takes back what is `missed` of `laws`, but for a part `reduction`, and the iterations
    /// that it took. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely.
    pub fn gmres(
        &self,
        fronts: &mut FrozenFronts,
        laws: &Laws,
        missed: Forces,
        reduction: f64,
    ) -> Result<(Forces, usize), Failure> {
        let mut sum: Forces = missed
            .iter()
            .map(|(&g, m)| (g, vec![0.0; m.len()]))
            .collect();
        let size = self.dot(&missed, &missed).sqrt();
        let mut iterations = 0;
        if size == 0.0 {
            return Ok((sum, iterations));
        }
        let mut basis = vec![scaled(&missed, -1.0 / size)];
        let mut h = Mat::<f64>::zeros(PRODUCTS + 1, PRODUCTS);
        let mut weights = Vec::new();
        let mut tolerance = PRODUCT * reduction;
        for k in 0..PRODUCTS {
            let (mut next, taken) = self.product(fronts, laws, &basis[k], tolerance)?;
            iterations += taken;
            for (i, known) in basis.iter().enumerate() {
                let share = self.dot(&next, known);
                h[(i, k)] = share;
                for (g, next) in &mut next {
                    axpy(-share, &known[g], next);
                }
            }
            let rest = self.dot(&next, &next).sqrt();
            h[(k + 1, k)] = rest;
            let small = h.submatrix(0, 0, k + 2, k + 1);
            let right = Col::from_fn(k + 2, |i| if i == 0 { size } else { 0.0 });
            let y = small.qr().solve_lstsq(&right);
            let left = (small * &y - &right).norm_l2();
            tolerance = (PRODUCT * reduction * size / left).min(LEAST_EXACT);
            weights = y.subrows(0, k + 1).iter().copied().collect();
            if left <= reduction * size || rest <= f64::EPSILON * size {
                break;
            }
            basis.push(scaled(&next, 1.0 / rest));
        }
        for (known, weight) in basis.iter().zip(weights) {
            for (g, sum) in &mut sum {
                axpy(weight, &known[g], sum);
            }
        }
        Ok((sum, iterations))
    }

    /// How what slipping points miss of their law changes with their forces. Collective.
    fn product(
        &self,
        fronts: &mut FrozenFronts,
        laws: &Laws,
        change: &Forces,
        tolerance: f64,
    ) -> Result<(Forces, usize), Failure> {
        let clusters = self.clusters.iter();
        let loads = ClusterLoads {
            clusters: &clusters
                .map(|(&v, load)| (v, vec![0.0; load.len()]))
                .collect(),
            prescribed: &(self.prescribed.iter())
                .map(|(&g, values)| (g, vec![0.0; values.len()]))
                .collect(),
            forces: change,
        };
        let accuracy = Accuracy {
            tolerance,
            start: None,
        };
        let response = fronts.solve(self.context, self.open, loads, accuracy)?;
        let of_group = |(&g, change): (&usize, &Vec<f64>)| {
            let (mut product, mut forces) = (vec![0.0; change.len()], response.forces[&g].clone());
            axpy(1.0, change, &mut forces);
            for law in laws.get(&g).into_iter().flatten() {
                law.add_missed(&forces, |i| response.jumps[&g][i], true, &mut product);
            }
            (g, product)
        };
        Ok((change.iter().map(of_group).collect(), response.iterations))
    }

    /// a·b over all groups, added up in their order. Collective.
    fn dot(&self, a: &Forces, b: &Forces) -> f64 {
        let Context { comm, plan, .. } = *self.context;
        let mut sum = 0.0;
        comm.gather(
            &plan.group_owners(),
            |g| dot(&a[&g], &b[&g]),
            |_, of_group: f64| sum += of_group,
        );
        comm.broadcast(&mut sum);
        sum
    }
}

fn scaled(forces: &Forces, factor: f64) -> Forces {
    let all = forces.iter();
    all.map(|(&g, forces)| (g, forces.iter().map(|f| factor * f).collect()))
        .collect()
}
