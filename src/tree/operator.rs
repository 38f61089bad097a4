//! The tree of fronts as an operator of Newton's method on the laws of contact: it answers for statuses by eliminating again
//! what is above those that changed, and for slip forces by GMRES over its answers.

use std::collections::BTreeMap;
use std::time::Instant;

use crate::bddc::solution::Accuracy;
use crate::contact::law::{PointLaw, PointStatus};
use crate::contact::laws::{ContactLaws, Iterate, LawResidual, Statuses};
use crate::contact::newton::{ContactOperator, NewtonStep, OnGroups, StepAccuracy, TotalResidual};
use crate::context::Context;
use crate::error::Failure;
use crate::sweep::{SweepOutcome, SweepRecord};
use crate::tree::fronts::ActiveSetFronts;
use crate::tree::slip_law::SlipLaw;
use crate::tree::slip_problem::{Laws, SlipProblem};
use crate::tree::solution::ActiveSetSolution;
use crate::tree::update::LOOSE;
use crate::vector::between;

/// What is none beside the largest force or displacement.
pub(super) const ROUND_OFF: f64 = 1e-12;
/// What may be missed where directions of slip turn, relative to the scales of forces, for the next step to be exact.
const NEARLY: f64 = 1e-5;
/// Share of the stiffness at a point, times the displacements, in the scale of forces: their round-off is relative to it.
const STIFFNESS_SHARE: f64 = 1e-3;

/// The operator.
pub(super) struct TreeOperator<'a, 'o> {
    pub context: &'a Context<'a>,
    pub fronts: &'a mut ActiveSetFronts,
    pub laws: &'a OnGroups<ContactLaws<'a>>,
    /// The stiffness that the round-off of the force of every limit is relative to (N/m).
    pub stiffest: &'a OnGroups<Vec<f64>>,
    /// Loads on the boundaries of clusters, by node.
    pub loads: &'a BTreeMap<usize, Vec<f64>>,
    /// Where closed jumps are, by contact group (m).
    pub bounds: &'a BTreeMap<usize, Vec<f64>>,
    /// The last answer.
    pub solution: ActiveSetSolution,
    /// Whether there was one.
    pub is_answered: bool,
    /// Whether what slips is held at its slip, without which something moves.
    pub is_held: bool,
    /// Whether springs of earlier statuses were taken away.
    pub is_released: bool,
    pub outcome: &'a mut SweepOutcome,
    pub began: Instant,
    pub observer: &'o mut dyn FnMut(&SweepRecord),
    /// Whether directions of slip turn with it.
    pub turns: bool,
    /// Round-off of the last answer, relative to the largest force.
    pub accuracy: f64,
}

/// Which jumps are open, or slip unless that is held, where a group has these statuses.
fn open(laws: &ContactLaws<'_>, statuses: &Statuses, is_held: bool) -> Vec<bool> {
    let mut open: Vec<bool> = statuses.closed.iter().map(|closed| !closed).collect();
    for (point, status) in laws.points.iter().zip(&statuses.points) {
        for t in point.limits() {
            open[t] = match is_held {
                true => *status == PointStatus::Open,
                false => *status != PointStatus::Sticks,
            };
        }
    }
    open
}

/// The laws of the slipping points of a group with these statuses.
fn slip_laws(laws: &ContactLaws<'_>, statuses: &Statuses) -> Vec<SlipLaw> {
    let points = laws.points.iter().zip(&statuses.points);
    let law = |(point, status): (&PointLaw, &PointStatus)| {
        SlipLaw::new(point, status, point.is_closed(&statuses.closed))
    };
    points.filter_map(law).collect()
}

/// Goes on unless a signal has asked the run to stop. Collective.
///
/// # Errors
/// A signal did.
pub(super) fn go_on(context: &Context<'_>, sweeps: usize) -> Result<(), Failure> {
    match context.comm.is_any_asked_to_stop() {
        false => Ok(()),
        true => Err(Failure::interrupted(format!(
            "interrupted after {sweeps} sweeps"
        ))),
    }
}

impl TreeOperator<'_, '_> {
    /// Fixes what these statuses leave open, which it returns; where that needs springs and directions of slip turn with
    /// it, what slips is held from then on.
    /// Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely.
    fn fix(
        &mut self,
        statuses: &OnGroups<Statuses>,
    ) -> Result<BTreeMap<usize, Vec<bool>>, Failure> {
        let (context, laws) = (self.context, self.laws);
        let open = |is_held: bool| {
            let all = statuses.iter();
            all.map(|(&g, statuses)| (g, open(&laws[&g], statuses, is_held)))
                .collect()
        };
        let free: BTreeMap<usize, Vec<bool>> = open(self.is_held);
        self.fronts.fix(context, &free)?;
        if self.is_held || !self.fronts.has_to_hold(context) {
            return Ok(free);
        }
        self.is_held = true;
        let held = open(true);
        self.fronts.fix(context, &held)?;
        self.fronts.release(context, &held)?;
        Ok(held)
    }

    /// The iterate that a solution is.
    pub fn iterate(solution: &ActiveSetSolution) -> OnGroups<Iterate> {
        let of_group = |(&g, jumps): (&usize, &Vec<f64>)| {
            let (jumps, forces) = (jumps.clone(), solution.forces[&g].clone());
            (g, Iterate { jumps, forces })
        };
        solution.jumps.iter().map(of_group).collect()
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
        let open = self.fix(statuses)?;
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
        let turn: Vec<f64> = laws.values().flatten().map(SlipLaw::turning).collect();
        self.turns = context.comm.largest(&turn) > 0.0;
        let problem = SlipProblem {
            context,
            open: &open,
            clusters: self.loads,
            prescribed: self.bounds,
            laws: &laws,
            is_held: self.is_held,
        };
        let first = problem.first(self.laws, from);
        // The same on all ranks, of which some have no clusters.
        let start = self.is_answered.then(|| ActiveSetSolution {
            iterations: 0,
            ..std::mem::take(&mut self.solution)
        });
        let from = (tolerance, start.as_ref());
        let solution = problem.solve(self.fronts, first, from, self.accuracy)?;
        let at = Self::iterate(&solution);
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
        let comm = self.context.comm;
        let largest = comm.largest(at.values().flat_map(|at| &at.forces));
        let scale = largest.max(f64::MIN_POSITIVE);
        let displaced = comm.largest(self.solution.boundaries.values().flatten());
        // Of a rough answer no more than of an exact one.
        let share = STIFFNESS_SHARE * (ROUND_OFF / self.accuracy) * displaced;
        let of_group = |&g: &usize| {
            let own = self.stiffest[&g].iter();
            (g, own.map(|k| scale + share * k).collect())
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

    fn accuracy(&self, total: &TotalResidual) -> StepAccuracy {
        let missed = total.missed;
        match total.wrong {
            0 if self.turns && missed > NEARLY => {
                StepAccuracy::Rough(missed.min(missed * missed / LOOSE))
            }
            0 => StepAccuracy::Full,
            _ => StepAccuracy::Rough(missed),
        }
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
