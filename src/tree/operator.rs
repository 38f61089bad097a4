//! The tree of fronts as an operator of Newton's method on the contact laws: it solves for given statuses by
//! eliminating again all fronts above changed ones, and for slip forces by GMRES over such solves.

use contact_dd_partition::id::{GroupId, OnGroups};

use crate::bddc::solution::Accuracy;
use crate::contact::law::{PointLaw, PointStatus};
use crate::contact::laws::{ContactLaws, Iterate, LawResidual, Statuses};
use crate::contact::newton::{ContactOperator, NewtonStep, StepAccuracy, TotalResidual};
use crate::contact::slip_law::SlipLaw;
use crate::context::Context;
use crate::error::Failure;
use crate::tree::fronts::ActiveSetFronts;
use crate::tree::problem::{Steps, TreeProblem};
use crate::tree::slip_problem::{Laws, SlipProblem, fix};
use crate::tree::solution::ActiveSetSolution;
use crate::tree::update::FORCING_TERM;
use crate::vector::between;

/// Round-off, relative to the largest force or displacement.
pub(super) const ROUND_OFF: f64 = 1e-12;
/// Residual, relative to the scales of forces, below which the next step is exact although slip directions turn.
const NEARLY_CONVERGED: f64 = 1e-5;
/// Share of a point's stiffness times displacements in the scale of forces, whose round-off is relative to it.
const STIFFNESS_SHARE: f64 = 1e-3;

/// The tree of fronts as an operator.
pub(super) struct TreeOperator<'a, 's, 'o> {
    problem: &'a TreeProblem<'a>,
    fronts: &'a mut ActiveSetFronts,
    steps: &'s mut Steps<'o>,
    /// The last solution; all ranks have one or none does, although some have no clusters.
    pub solution: Option<ActiveSetSolution>,
    /// True if slips are prescribed because parts of the scene would otherwise move freely.
    is_held: bool,
    /// True if springs of earlier statuses were removed.
    is_released: bool,
    /// True if directions of slip turn with the slip.
    turns: bool,
    /// Round-off of the last solution, relative to the largest force.
    accuracy: f64,
}

/// The laws of the slipping points of a group with these statuses.
fn slip_laws(laws: &ContactLaws<'_>, statuses: &Statuses) -> Vec<SlipLaw> {
    let points = laws.points.iter().zip(&statuses.points);
    let law = |(point, status): (&PointLaw, &PointStatus)| {
        SlipLaw::new(point, status, point.is_closed(&statuses.closed))
    };
    points.filter_map(law).collect()
}

impl<'a, 's, 'o> TreeOperator<'a, 's, 'o> {
    /// The operator of a `problem`, which counts its `steps`.
    pub fn new(
        problem: &'a TreeProblem<'a>,
        fronts: &'a mut ActiveSetFronts,
        steps: &'s mut Steps<'o>,
    ) -> Self {
        Self {
            problem,
            fronts,
            steps,
            solution: None,
            is_held: false,
            is_released: false,
            turns: false,
            accuracy: ROUND_OFF,
        }
    }
}

impl ContactOperator for TreeOperator<'_, '_, '_> {
    type Error = Failure;

    fn step(
        &mut self,
        from: &OnGroups<Iterate>,
        statuses: &OnGroups<Statuses>,
        accuracy: StepAccuracy,
    ) -> Result<OnGroups<Iterate>, Failure> {
        let (context, all_laws) = (self.problem.context, &self.problem.laws);
        self.steps.check_interrupt(context)?;
        let laws: Laws = (statuses.iter())
            .map(|(&g, statuses)| (g, slip_laws(&all_laws[&g], statuses)))
            .collect();
        let open = |(&g, statuses): (&GroupId, &Statuses)| {
            let known = all_laws[&g].known(statuses);
            (g, known.iter().map(|known| !known).collect())
        };
        let mut open = statuses.iter().map(open).collect();
        // Slips remain prescribed from then on, as their directions turn with springs.
        self.is_held = fix(context, self.fronts, &mut open, &laws, self.is_held)?;
        let finest = match self.fronts.coarse_dofs() {
            Some(_) => Accuracy::FULL.tolerance,
            None => 0.0,
        };
        let tolerance = match accuracy {
            StepAccuracy::Rough(residual) => {
                self.accuracy = (FORCING_TERM * residual.min(1.0)).max(ROUND_OFF);
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
        let turn: Vec<f64> = laws.values().flatten().map(SlipLaw::turning).collect();
        self.turns = context.comm.largest(&turn) > 0.0;
        let problem = SlipProblem {
            context,
            open: &open,
            clusters: self.problem.loads,
            prescribed: &self.problem.bounds,
            laws: &laws,
            is_held: self.is_held,
        };
        let first = problem.first(all_laws, from);
        let start = self.solution.take().map(|start| ActiveSetSolution {
            iterations: 0,
            ..start
        });
        let from = (tolerance, start.as_ref());
        let solution = problem.solve(self.fronts, first, from, self.accuracy)?;
        Ok(self.solution.insert(solution).at.clone())
    }

    fn between(
        &self,
        from: &OnGroups<Iterate>,
        to: &OnGroups<Iterate>,
        part: f64,
    ) -> OnGroups<Iterate> {
        let of_group = |(&g, from): (&GroupId, &Iterate)| {
            let jumps = between(&from.jumps, &to[&g].jumps, part);
            let forces = between(&from.forces, &to[&g].forces, part);
            (g, Iterate { jumps, forces })
        };
        from.iter().map(of_group).collect()
    }

    fn make_independent(
        &self,
        at: &OnGroups<Iterate>,
        before: &OnGroups<Statuses>,
        now: &mut OnGroups<Statuses>,
    ) {
        for (g, now) in now {
            self.problem.laws[g].make_independent(&at[g], &before[g], now);
        }
    }

    fn force_scales(&self, at: &OnGroups<Iterate>) -> OnGroups<Vec<f64>> {
        let comm = self.problem.context.comm;
        let largest = comm.largest(at.values().flat_map(|at| &at.forces));
        let scale = largest.max(f64::MIN_POSITIVE);
        let boundaries = self
            .solution
            .iter()
            .flat_map(|last| last.boundaries.values());
        let displaced = comm.largest(boundaries.flatten());
        // An approximate solution gets no larger share than an exact one.
        let share = STIFFNESS_SHARE * (ROUND_OFF / self.accuracy) * displaced;
        let of_group = |&g: &GroupId| {
            let own = self.problem.stiffest[&g].iter();
            (g, own.map(|k| scale + share * k).collect())
        };
        self.problem.laws.keys().map(of_group).collect()
    }

    fn total(&self, residuals: &OnGroups<LawResidual>) -> TotalResidual {
        let Context { comm, plan, .. } = *self.problem.context;
        let mut total = TotalResidual::default();
        comm.gather(
            &plan.group_owners(),
            |g| {
                let closed = &residuals[&g].statuses.closed;
                let active = self.problem.limits[&g].closed_points(|i| closed[i]);
                let of_group = residuals[&g].of_group();
                TotalResidual { active, ..of_group }
            },
            |_, of_group| total.include(of_group),
        );
        comm.broadcast(&mut total);
        total.merit = total.merit.sqrt();
        total.forces = total.forces.sqrt();
        total
    }

    fn acting(&self) -> f64 {
        f64::INFINITY
    }

    fn slack(&self) -> f64 {
        self.accuracy
    }

    fn accuracy(&self, total: &TotalResidual) -> StepAccuracy {
        let residual = total.largest;
        match total.wrong {
            0 if self.turns && residual > NEARLY_CONVERGED => {
                StepAccuracy::Rough(residual.min(residual * residual / FORCING_TERM))
            }
            0 => StepAccuracy::Full,
            _ => StepAccuracy::Rough(residual),
        }
    }

    fn record(&mut self, step: NewtonStep) -> Result<(), Failure> {
        let TotalResidual {
            largest, active, ..
        } = step.total;
        let iterations = self.solution.as_ref().map_or(0, |last| last.iterations);
        (self.steps).record((largest, active, step.changed), self.fronts, iterations);
        Ok(())
    }
}
