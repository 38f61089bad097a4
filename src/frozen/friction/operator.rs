//! The tree of fronts as an operator of Newton's method on the laws of contact: it answers for statuses by eliminating again
//! what is above those that changed, and for slip forces by GMRES over its answers.

use std::collections::BTreeMap;
use std::time::Instant;

use super::slip_law::SlipLaw;
use super::slip_problem::{Forces, Laws, SlipProblem};
use crate::bddc::solution::Accuracy;
use crate::contact::law::{PointLaw, PointStatus};
use crate::contact::laws::{ContactLaws, Iterate, LawResidual, Statuses};
use crate::contact::newton::{ContactOperator, NewtonStep, OnGroups, StepAccuracy, TotalResidual};
use crate::context::Context;
use crate::error::Failure;
use crate::frozen::active_set::{ROUND_OFF, go_on};
use crate::frozen::exchange::LOOSE;
use crate::frozen::fronts::FrozenFronts;
use crate::frozen::solution::FrozenSolution;
use crate::sweep::{SweepOutcome, SweepRecord};
use crate::vector::{axpy, between};

/// How far GMRES goes, relative to what is missed before, at least and at most.
const REDUCTION: [f64; 2] = [1e-1, 1e-3];

/// Share of the stiffness at a point, times the displacements, in the scale of forces: their round-off is relative to it.
const STIFFNESS_SHARE: f64 = 1e-3;

/// The operator.
pub(super) struct TreeOperator<'a, 'o> {
    pub context: &'a Context<'a>,
    pub fronts: &'a mut FrozenFronts,
    pub laws: &'a OnGroups<ContactLaws<'a>>,
    /// The stiffness that the round-off of the force of every limit is relative to (N/m).
    pub stiffest: &'a OnGroups<Vec<f64>>,
    /// Loads on the boundaries of clusters, by node.
    pub loads: &'a BTreeMap<usize, Vec<f64>>,
    /// Where closed jumps are, by contact group (m).
    pub bounds: &'a BTreeMap<usize, Vec<f64>>,
    /// The last answer.
    pub solution: FrozenSolution,
    /// Whether there was one.
    pub is_answered: bool,
    /// Whether springs of earlier statuses were taken away.
    pub is_released: bool,
    pub outcome: &'a mut SweepOutcome,
    pub began: Instant,
    pub observer: &'o mut dyn FnMut(&SweepRecord),
    /// Round-off of the last answer, relative to the largest force.
    pub accuracy: f64,
}

/// Which jumps are open, or slip, where a group has these statuses.
fn open(laws: &ContactLaws<'_>, statuses: &Statuses) -> Vec<bool> {
    let mut open: Vec<bool> = statuses.closed.iter().map(|closed| !closed).collect();
    for (point, status) in laws.points.iter().zip(&statuses.points) {
        for t in point.tangents.into_iter().flatten() {
            open[t] = *status != PointStatus::Sticks;
        }
    }
    open
}

/// The laws of the slipping points of a group with these statuses.
fn slip_laws(laws: &ContactLaws<'_>, statuses: &Statuses) -> Vec<SlipLaw> {
    let points = laws.points.iter().zip(&statuses.points);
    let law = |(point, status): (&PointLaw, &PointStatus)| {
        let is_closed = point.normal.is_some_and(|n| statuses.closed[n]);
        SlipLaw::new(point, status, is_closed)
    };
    points.filter_map(law).collect()
}

impl TreeOperator<'_, '_> {
    /// λ of a solution under slip forces. Collective.
    fn iterates(&self, solution: &FrozenSolution, slip_forces: &Forces) -> OnGroups<Iterate> {
        let of_group = |(&g, jumps): (&usize, &Vec<f64>)| {
            let mut forces = solution.forces[&g].clone();
            axpy(1.0, &slip_forces[&g], &mut forces);
            (
                g,
                Iterate {
                    jumps: jumps.clone(),
                    forces,
                },
            )
        };
        solution.jumps.iter().map(of_group).collect()
    }

    /// What slip forces miss of their laws. Collective.
    fn missed(&self, laws: &Laws, at: &OnGroups<Iterate>) -> Forces {
        let of_group = |(&g, at): (&usize, &Iterate)| {
            let mut missed = vec![0.0; at.jumps.len()];
            let slip = |i: usize| self.laws[&g].beyond(i, at);
            for law in &laws[&g] {
                law.add_missed(&at.forces, slip, false, &mut missed);
            }
            (g, missed)
        };
        at.iter().map(of_group).collect()
    }

    /// The largest of all numbers on all ranks. Collective.
    fn largest<'f>(&self, own: impl Iterator<Item = &'f f64>) -> f64 {
        let comm = self.context.comm;
        let own = own.fold(0.0, |m: f64, x| m.max(x.abs()));
        let mut largest = comm.collect(&own).into_iter().fold(0.0, f64::max);
        comm.broadcast(&mut largest);
        largest
    }
}

impl ContactOperator for TreeOperator<'_, '_> {
    type Error = Failure;

    fn step(
        &mut self,
        from: &OnGroups<Iterate>,
        statuses: &OnGroups<Statuses>,
        accuracy: StepAccuracy,
    ) -> Result<OnGroups<Iterate>, Failure> {
        let context = self.context;
        go_on(context, self.outcome.records.len())?;
        let of_group = |(&g, statuses): (&usize, &Statuses)| (g, open(&self.laws[&g], statuses));
        let open: BTreeMap<usize, Vec<bool>> = statuses.iter().map(of_group).collect();
        self.fronts.freeze(context, &open)?;
        let finest = match self.fronts.coarse_dofs() {
            Some(_) => Accuracy::FULL.tolerance,
            None => 0.0,
        };
        let tolerance = match accuracy {
            StepAccuracy::Rough(missed) => {
                self.accuracy = (LOOSE * missed.min(1.0)).max(ROUND_OFF);
                self.accuracy.max(finest)
            }
            StepAccuracy::Full => {
                self.accuracy = ROUND_OFF;
                self.fronts.renew(context, &open)?;
                if !self.is_released {
                    self.is_released = self.fronts.release(context, &open)?;
                }
                finest
            }
        };
        let laws: Laws = (statuses.iter())
            .map(|(&g, statuses)| (g, slip_laws(&self.laws[&g], statuses)))
            .collect();
        let mut slip_forces: Forces = (from.iter())
            .map(|(&g, from)| {
                let mut first = vec![0.0; from.jumps.len()];
                laws[&g]
                    .iter()
                    .for_each(|law| law.set_first(&from.forces, &mut first));
                (g, first)
            })
            .collect();
        let problem = SlipProblem {
            context,
            open: &open,
            clusters: self.loads,
            prescribed: self.bounds,
        };
        // The same on all ranks, of which some have no clusters.
        let start = self.is_answered.then(|| FrozenSolution {
            iterations: 0,
            ..std::mem::take(&mut self.solution)
        });
        let mut solution = problem.respond(self.fronts, &slip_forces, tolerance, start.as_ref())?;
        let mut at = self.iterates(&solution, &slip_forces);
        let missed = self.missed(&laws, &at);
        let size = self.largest(missed.values().flatten());
        let scale = self.largest(at.values().flat_map(|at| &at.forces));
        if size > self.accuracy * scale {
            let aim = 0.3 * self.accuracy * scale / size;
            let reduction = aim.clamp(REDUCTION[1], REDUCTION[0]);
            let (change, iterations) = problem.gmres(self.fronts, &laws, missed, reduction)?;
            for (g, forces) in &mut slip_forces {
                axpy(1.0, &change[g], forces);
            }
            solution.iterations += iterations;
            solution = problem.respond(self.fronts, &slip_forces, tolerance, Some(&solution))?;
            at = self.iterates(&solution, &slip_forces);
        }
        (self.solution, self.is_answered) = (solution, true);
        Ok(at)
    }

    fn between(
        &self,
        from: &OnGroups<Iterate>,
        to: &OnGroups<Iterate>,
        part: f64,
    ) -> OnGroups<Iterate> {
        let of_group = |(&g, from): (&usize, &Iterate)| {
            let jumps = between(&from.jumps, &to[&g].jumps, part);
            let forces = between(&from.forces, &to[&g].forces, part);
            (g, Iterate { jumps, forces })
        };
        from.iter().map(of_group).collect()
    }

    fn force_scales(&self, at: &OnGroups<Iterate>) -> OnGroups<Vec<f64>> {
        let largest = self.largest(at.values().flat_map(|at| &at.forces));
        let scale = largest.max(f64::MIN_POSITIVE);
        let displaced = self.largest(self.solution.boundaries.values().flatten());
        let of_group = |&g: &usize| {
            let own = self.stiffest[&g].iter();
            (
                g,
                own.map(|k| scale + STIFFNESS_SHARE * k * displaced)
                    .collect(),
            )
        };
        self.laws.keys().map(of_group).collect()
    }

    fn total(&self, residuals: &OnGroups<LawResidual>) -> TotalResidual {
        let Context { comm, plan, .. } = *self.context;
        let mut total = TotalResidual::default();
        comm.gather(
            &plan.group_owners(),
            |g| residuals[&g].of_group(),
            |_, of_group| total.include(of_group),
        );
        comm.broadcast(&mut total);
        total.merit = total.merit.sqrt();
        total
    }

    fn acting(&self) -> f64 {
        f64::INFINITY
    }

    fn slack(&self) -> f64 {
        self.accuracy
    }

    fn accuracy(&self, missed: f64) -> StepAccuracy {
        StepAccuracy::Rough(missed)
    }

    fn record(&mut self, step: NewtonStep) -> Result<(), Failure> {
        let sweep = self.outcome.records.len();
        let record = SweepRecord {
            sweep,
            residual: step.total.missed,
            active: step.total.active,
            changed: step.changed,
            seconds: self.began.elapsed().as_secs_f64(),
        };
        self.outcome.records.push(record);
        if let Some(coarse_dofs) = self.fronts.coarse_dofs() {
            let solves = self.outcome.iterative.get_or_insert_default();
            solves.iterations.push(self.solution.iterations);
            solves.coarse_dofs = coarse_dofs;
        }
        (self.observer)(&record);
        Ok(())
    }
}
