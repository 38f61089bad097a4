//! The linear problem of slipping points with a fixed active set: forces and slips that follow their laws.
//!
//! GMRES solves it (Saad and Schultz, SIAM J. Sci. Stat. Comput. 7, 1986): a product is a solution of the fronts of the
//! active set under forces at the slipping points alone. Where only friction keeps bodies from moving on, these forces
//! would move them without limit: there slips are prescribed, as sticking is, and are the unknowns, which takes more
//! products. Slips determined by closed limits aren't prescribed; their forces are the unknowns.
//!
//! Where slips aren't prescribed, an iterative solver between clusters finds these forces with its own unknowns
//! (`bddc/slipping.rs`).

use std::collections::BTreeMap;

use contact_dd_partition::id::{GroupId, OnGroups, OnTreeNodes};
use faer::linalg::solvers::SolveLstsq;
use faer::{Col, Mat};

use crate::bddc::loads::ClusterLoads;
use crate::bddc::solution::Accuracy;
use crate::contact::laws::{ContactLaws, Iterate};
use crate::contact::slip_law::SlipLaw;
use crate::context::Context;
use crate::error::Failure;
use crate::tree::fronts::ActiveSetFronts;
use crate::tree::solution::ActiveSetSolution;
use crate::vector::{add_multiple, axpy, dot, multiple};

/// Most rounds.
const ROUNDS: usize = 2;
/// Ratio of a round's residual to the last one above which it stalls.
const STALLS: f64 = 0.5;
/// Least and largest reduction of the residual by GMRES, and the margin below the required accuracy.
const REDUCTION: [f64; 2] = [1e-1, 1e-6];
const MARGIN: f64 = 0.3;
/// Most products.
const PRODUCTS: usize = 40;
/// Tolerance of the first product relative to the goal of GMRES. The nearer that goal, the less a product matters:
/// later ones may be less exact in proportion (Bouras and Frayssé, SIAM J. Matrix Anal. Appl. 26, 2005).
const PRODUCT: f64 = 0.3;
/// Tolerance of an iterative solver that finds slip forces together with its own unknowns, relative to that without, and
/// the least one: the rest is left to the refinement of the whole problem.
const COUPLED: f64 = 0.01;
const FINEST: f64 = 1e-14;
/// Largest tolerance of a product.
const LEAST_EXACT: f64 = 1e-2;

/// A vector on the jumps of the contact groups of this rank.
pub type OnJumps = OnGroups<Vec<f64>>;
/// The laws of the slipping points of every contact group of this rank.
pub type Laws = OnGroups<Vec<SlipLaw>>;

/// Fixes the statuses with these `open`, holding points that slip by `laws` if they were or have to be, and returns
/// whether they are. Collective.
///
/// # Errors
/// Some part of the scene moves freely.
pub fn fix(
    context: &Context<'_>,
    fronts: &mut ActiveSetFronts,
    open: &mut OnGroups<Vec<bool>>,
    laws: &Laws,
    was_held: bool,
) -> Result<bool, Failure> {
    let hold = |fronts: &ActiveSetFronts, open: &mut OnGroups<Vec<bool>>| {
        for (g, laws) in laws {
            if let Some(open) = open.get_mut(g) {
                let limits = laws.iter().flat_map(SlipLaw::limits);
                fronts.hold(*g, limits, open);
            }
        }
    };
    if was_held {
        hold(fronts, open);
    }
    fronts.fix(context, open)?;
    if was_held || !fronts.must_hold_slipping(context) {
        return Ok(was_held);
    }
    hold(fronts, open);
    fronts.fix(context, open)?;
    fronts.release(context, open)?;
    Ok(true)
}

/// The loads and laws of a problem with a fixed active set.
#[derive(Clone, Copy)]
pub struct SlipProblem<'a> {
    /// The context of the run.
    pub context: &'a Context<'a>,
    /// Flags of open jumps, by contact group of this rank; slipping ones are open unless held.
    pub open: &'a OnGroups<Vec<bool>>,
    /// True if slips are prescribed, except those determined by closed limits.
    pub is_held: bool,
    /// Loads on the boundaries of clusters, by node.
    pub clusters: &'a OnTreeNodes<Vec<f64>>,
    /// The values of the closed jumps of every group, and the stick positions of slipping ones (m).
    pub prescribed: &'a OnJumps,
    /// The laws of the slipping points.
    pub laws: &'a Laws,
}

impl SlipProblem<'_> {
    /// The response to a load with these forces at slipping points, or with the slips that these cause against the
    /// points' own stiffness; `accuracy` is that of an iterative solver. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely.
    fn respond(
        &self,
        fronts: &mut ActiveSetFronts,
        (clusters, prescribed): (&OnTreeNodes<Vec<f64>>, &OnJumps),
        (forces, laws): (&OnJumps, Option<&Laws>),
        accuracy: Accuracy<'_>,
    ) -> Result<ActiveSetSolution, Failure> {
        let mut loads = ClusterLoads {
            clusters,
            prescribed,
            forces,
            laws,
        };
        let (mut held, of_open) = (prescribed.clone(), self.on_open(forces));
        loads.forces = &of_open;
        if self.is_held {
            add_multiple(1.0, &self.slips(forces), &mut held);
            loads.prescribed = &held;
        }
        let mut solution = fronts.solve(self.context, self.open, loads, accuracy)?;
        for (g, at) in &mut solution.at {
            if let Some(forces) = solution.open_forces.get(g) {
                axpy(1.0, forces, &mut at.forces);
            }
        }
        Ok(solution)
    }

    /// The part of these forces on open friction conditions.
    fn on_open(&self, forces: &OnJumps) -> OnJumps {
        let of_group = |(&g, forces): (&GroupId, &Vec<f64>)| {
            let both = forces.iter().zip(&self.open[&g]);
            let on_open = both.map(|(force, open)| if *open { *force } else { 0.0 });
            (g, on_open.collect())
        };
        forces.iter().map(of_group).collect()
    }

    /// Start values of the forces near these iterates.
    pub fn first(&self, laws: &OnGroups<ContactLaws<'_>>, from: &OnGroups<Iterate>) -> OnJumps {
        let of_group = |(&g, from): (&GroupId, &Iterate)| {
            let mut forces = vec![0.0; from.jumps.len()];
            let mut holding = forces.clone();
            for law in &self.laws[&g] {
                law.set_force(&from.forces, &mut forces);
                law.set_holding(|t| laws[&g].violation(t, from), &mut holding);
            }
            for ((force, holding), open) in forces.iter_mut().zip(holding).zip(&self.open[&g]) {
                *force = if *open { *force } else { holding };
            }
            (g, forces)
        };
        from.iter().map(of_group).collect()
    }

    /// True if any point slips by a law. Collective.
    pub fn has_laws(&self) -> bool {
        let any = self.laws.values().any(|laws| !laws.is_empty());
        self.context.comm.is_any(any)
    }

    /// True if an iterative solver finds the forces of slipping points together with its own unknowns. Collective.
    pub fn is_coupled(&self, fronts: &ActiveSetFronts) -> bool {
        self.has_laws() && !self.is_held && fronts.coarse_dofs().is_some()
    }

    /// The solution that follows the laws to an `accuracy` relative to the largest force, as far as rounds of GMRES
    /// reduce the residual; from `forces` and an earlier solution, if all ranks have one. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely.
    pub fn solve(
        &self,
        fronts: &mut ActiveSetFronts,
        mut forces: OnJumps,
        (tolerance, start): (f64, Option<&ActiveSetSolution>),
        accuracy: f64,
    ) -> Result<ActiveSetSolution, Failure> {
        let respond = |fronts: &mut ActiveSetFronts,
                       of: (&OnJumps, Option<&Laws>),
                       tolerance: f64,
                       start: Option<&ActiveSetSolution>| {
            let known = start.map(|start| &start.merge_roots);
            let accuracy = Accuracy {
                tolerance,
                start: known,
            };
            let load = (self.clusters, self.prescribed);
            let mut solution = self.respond(fronts, load, of, accuracy)?;
            solution.iterations += start.map_or(0, |start| start.iterations);
            Ok::<_, Failure>(solution)
        };
        // The solver between clusters follows the laws itself, as far as it can.
        let is_coupled = self.is_coupled(fronts);
        let laws = Some(self.laws).filter(|_| is_coupled);
        let first = match is_coupled {
            true => (COUPLED * tolerance).max(FINEST),
            false => tolerance,
        };
        let mut solution = respond(fronts, (&forces, laws), first, start)?;
        let mut last = f64::INFINITY;
        for round in 0..ROUNDS + usize::from(is_coupled) {
            let slip = |g: GroupId, i: usize| solution.at[&g].jumps[i] - self.prescribed[&g][i];
            let residual = self.residual(&solution, slip, false);
            let size = self.context.comm.largest(residual.values().flatten());
            let all = solution.at.values().flat_map(|at| &at.forces);
            let enough = accuracy * self.context.comm.largest(all);
            if size <= enough || size.is_nan() || size > STALLS * last {
                break;
            }
            let reduction = (MARGIN * enough / size).clamp(REDUCTION[1], REDUCTION[0]);
            if is_coupled {
                forces.clone_from(&solution.open_forces);
            }
            if is_coupled && round == 0 {
                let finer = (reduction * first).max(FINEST);
                solution = respond(fronts, (&forces, laws), finer, Some(&solution))?;
                continue;
            }
            last = size;
            let (change, iterations) = self.gmres(fronts, &residual, reduction)?;
            add_multiple(1.0, &change, &mut forces);
            solution.iterations += iterations;
            solution = respond(fronts, (&forces, None), tolerance, Some(&solution))?;
        }
        Ok(solution)
    }

    /// The residual of the laws at the forces of a solution with the slips `slip` of each group's jumps.
    fn residual(
        &self,
        solution: &ActiveSetSolution,
        slip: impl Fn(GroupId, usize) -> f64,
        is_change: bool,
    ) -> OnJumps {
        let of_group = |(&g, at): (&GroupId, &Iterate)| {
            let mut residual = vec![0.0; at.forces.len()];
            for law in self.laws.get(&g).into_iter().flatten() {
                law.add_residual(&at.forces, |i| slip(g, i), is_change, &mut residual);
            }
            (g, residual)
        };
        solution.at.iter().map(of_group).collect()
    }

    /// The change of forces that cancels the `residual` of the laws to a relative accuracy `reduction`, and the
    /// number of iterations. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely.
    fn gmres(
        &self,
        fronts: &mut ActiveSetFronts,
        residual: &OnJumps,
        reduction: f64,
    ) -> Result<(OnJumps, usize), Failure> {
        let mut sum: OnJumps = residual
            .iter()
            .map(|(&g, m)| (g, vec![0.0; m.len()]))
            .collect();
        let size = self.dot(residual, residual).sqrt();
        let mut iterations = 0;
        if size == 0.0 {
            return Ok((sum, iterations));
        }
        let mut basis = vec![multiple(-1.0 / size, residual)];
        let mut h = Mat::<f64>::zeros(PRODUCTS + 1, PRODUCTS);
        let mut weights = Vec::new();
        let mut tolerance = PRODUCT * reduction;
        for k in 0..PRODUCTS {
            let (mut next, taken) = self.product(fronts, &basis[k], tolerance)?;
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
            basis.push(multiple(1.0 / rest, &next));
        }
        for (known, weight) in basis.iter().zip(weights) {
            for (g, sum) in &mut sum {
                axpy(weight, &known[g], sum);
            }
        }
        Ok((sum, iterations))
    }

    /// The slips that forces would cause against the points' own stiffness (m).
    fn slips(&self, forces: &OnJumps) -> OnJumps {
        let of_group = |(&g, forces): (&GroupId, &Vec<f64>)| {
            let mut slips = vec![0.0; forces.len()];
            for law in self.laws.get(&g).into_iter().flatten() {
                law.add_slips(forces, &mut slips);
            }
            (g, slips)
        };
        forces.iter().map(of_group).collect()
    }

    /// Change of the residual of slipping points' laws due to these forces. Collective.
    fn product(
        &self,
        fronts: &mut ActiveSetFronts,
        forces: &OnJumps,
        tolerance: f64,
    ) -> Result<(OnJumps, usize), Failure> {
        let accuracy = Accuracy {
            tolerance,
            start: None,
        };
        let response = self.respond(
            fronts,
            (&zeros(self.clusters), &zeros(self.prescribed)),
            (forces, None),
            accuracy,
        )?;
        let product = self.residual(&response, |g, i| response.at[&g].jumps[i], true);
        Ok((product, response.iterations))
    }

    /// a·b over all groups, added up in their order. Collective.
    fn dot(&self, a: &OnJumps, b: &OnJumps) -> f64 {
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

/// Vectors of the same lengths, all 0.
fn zeros<K: Copy + Ord>(of: &BTreeMap<K, Vec<f64>>) -> BTreeMap<K, Vec<f64>> {
    let all = of.iter();
    all.map(|(&k, values)| (k, vec![0.0; values.len()]))
        .collect()
}
