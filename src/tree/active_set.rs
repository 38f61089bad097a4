//! The active set: the closed conditions, found by steps that each fix it.
//!
//! λ ≥ 0 where closed, t ≤ g where open. A step whose solution violates these conditions changes the status of some.

use std::collections::BTreeMap;

use contact_dd_partition::id::{GroupId, OnGroups};

use crate::bddc::loads::ClusterLoads;
use crate::bddc::solution::Accuracy;
use crate::comm::Comm;
use crate::contact::active_equalities::ActiveEqualities;
use crate::contact::laws::{ContactLaws, Iterate};
use crate::error::Failure;
use crate::tree::fronts::ActiveSetFronts;
use crate::tree::operator::ROUND_OFF;
use crate::tree::problem::{Steps, TreeProblem};
use crate::tree::solution::ActiveSetSolution;
use crate::tree::update::{ActiveSetUpdate, Descent};

/// The wrong statuses of the active set.
#[derive(Clone, Debug, Default)]
struct Faults {
    /// Normal jumps by group that are closed and should be open, or vice versa.
    wrong: OnGroups<Vec<usize>>,
    /// Number of wrong statuses on all ranks.
    count: usize,
    /// Number of closed contact points on all ranks.
    active: usize,
    /// The largest tension or penetration, relative to the largest force or jump.
    largest: f64,
}

/// Flags of open conditions, and the solution with them.
pub(super) struct FoundActiveSet {
    pub open: OnGroups<Vec<bool>>,
    pub solution: ActiveSetSolution,
    /// True if no status is wrong.
    pub is_right: bool,
}

/// Finds the active set of a `problem` with all tangential conditions sticking, from the conditions that are `open` at
/// first; after `most` steps the last one. Collective.
///
/// # Errors
/// Some part of the scene moves freely, or a signal has asked the run to stop.
pub(super) fn find_active_set(
    problem: &TreeProblem<'_>,
    fronts: &mut ActiveSetFronts,
    steps: &mut Steps<'_>,
    (mut open, most): (OnGroups<Vec<bool>>, usize),
) -> Result<FoundActiveSet, Failure> {
    let context = problem.context;
    let (mut update, mut descent) = (ActiveSetUpdate::default(), Descent::default());
    let mut changed = None;
    let mut search = Search {
        problem,
        fronts,
        last: None,
        wrong_by: 1.0,
        is_released: false,
    };
    let first = steps.count();
    loop {
        for (g, of_group) in &mut open {
            problem.laws[g].rows.open_redundant(of_group);
        }
        let (solution, faults) = search.step(&open, update.tolerance)?;
        let made = steps.count() - first;
        let residual = (faults.largest, faults.active, changed);
        steps.record(residual, search.fronts, solution.iterations);
        if faults.count == 0 || made >= most || !solution.is_finite(context.comm) {
            return Ok(FoundActiveSet {
                open,
                solution,
                is_right: faults.count == 0,
            });
        }
        steps.check_interrupt(context)?;
        changed = match update.is_of_all(faults.count) {
            true => {
                descent = Descent::default();
                for (g, wrong) in &faults.wrong {
                    if let Some(of_group) = open.get_mut(g) {
                        flip(&problem.laws[g], wrong, &solution.at[g], of_group);
                    }
                }
                Some(faults.count)
            }
            false => descent.update(problem, &faults.wrong, &solution.at, &mut open),
        };
        if changed.is_none() {
            return Ok(FoundActiveSet {
                open,
                solution,
                is_right: false,
            });
        }
        search.last = Some(ActiveSetSolution {
            iterations: 0,
            ..solution
        });
    }
}

/// Flips wrong statuses; a limit that depends on closed ones closes in exchange for one of them.
fn flip(laws: &ContactLaws<'_>, wrong: &[usize], at: &Iterate, open: &mut [bool]) {
    for &j in wrong {
        match open[j] {
            true => {
                let may_open = |i: usize| !laws.is_tangential[i];
                laws.rows.close(j, open, &at.forces, may_open);
            }
            false => open[j] = true,
        }
    }
}

/// The search for an active set.
struct Search<'a> {
    problem: &'a TreeProblem<'a>,
    fronts: &'a mut ActiveSetFronts,
    /// The solution of the last step.
    last: Option<ActiveSetSolution>,
    /// The largest tension or penetration in that solution.
    wrong_by: f64,
    /// True if springs of earlier active sets were taken away.
    is_released: bool,
}

impl Search<'_> {
    /// The solution with these conditions `open`, and its wrong statuses; an iterative solver's tolerance is this
    /// `share` of the active set's error until that set seems right. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely.
    fn step(
        &mut self,
        open: &OnGroups<Vec<bool>>,
        share: f64,
    ) -> Result<(ActiveSetSolution, Faults), Failure> {
        let context = self.problem.context;
        let finest = Accuracy::FULL.tolerance;
        self.fronts.fix(context, open)?;
        let tolerance = match self.fronts.coarse_dofs() {
            // No active set is to be found first.
            Some(_) if context.plan.groups.len() == 0 => finest,
            Some(_) => (share * self.wrong_by.min(1.0)).max(finest),
            None => 0.0,
        };
        let last = self.last.take();
        let (mut solution, mut faults) = self.solve(open, tolerance, last.as_ref())?;
        if faults.count == 0 && tolerance > finest {
            self.fronts.renew(context, open)?;
            (solution, faults) = self.solve(open, finest, Some(&solution))?;
        }
        if faults.count == 0 && !self.is_released && self.fronts.release(context, open)? {
            self.is_released = true;
            (solution, faults) = self.solve(open, finest, Some(&solution))?;
        }
        self.wrong_by = faults.largest;
        Ok((solution, faults))
    }

    /// The solution of a step with this `tolerance` of an iterative solver, from an earlier one. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely.
    fn solve(
        &mut self,
        open: &OnGroups<Vec<bool>>,
        tolerance: f64,
        start: Option<&ActiveSetSolution>,
    ) -> Result<(ActiveSetSolution, Faults), Failure> {
        let loads = ClusterLoads {
            clusters: self.problem.loads,
            prescribed: &self.problem.bounds,
            forces: &BTreeMap::new(),
            laws: None,
        };
        let accuracy = Accuracy {
            tolerance,
            start: start.map(|start| &start.merge_roots),
        };
        let context = self.problem.context;
        let mut solution = self.fronts.solve(context, open, loads, accuracy)?;
        solution.iterations += start.map_or(0, |start| start.iterations);
        let faults = Faults::of(self.problem, &solution, open, ROUND_OFF.max(tolerance));
        Ok((solution, faults))
    }
}

/// The largest force of a solution, and the largest jump or bound, on all ranks. Collective.
fn scales(comm: &Comm, solution: &ActiveSetSolution, bounds: &OnGroups<Vec<f64>>) -> [f64; 2] {
    let is_finite = |x: &&f64| x.is_finite();
    let forces = solution.at.values().flat_map(|at| &at.forces);
    let jumps = solution.at.values().flat_map(|at| &at.jumps);
    let distances = jumps.chain(bounds.values().flatten());
    [
        comm.largest(forces.filter(is_finite)),
        comm.largest(distances.filter(is_finite)),
    ]
}

impl Faults {
    /// Statuses wrong by more than `least` in the solution with these conditions `open`. Collective.
    fn of(
        problem: &TreeProblem<'_>,
        solution: &ActiveSetSolution,
        open: &OnGroups<Vec<bool>>,
        least: f64,
    ) -> Self {
        let (comm, plan) = (problem.context.comm, problem.context.plan);
        let scales = scales(comm, solution, &problem.bounds).map(|x| x.max(f64::MIN_POSITIVE));
        let of_group = |g: GroupId| {
            let (mut wrong, mut largest) = (Vec::new(), 0.0_f64);
            let sticks = &problem.laws[&g].is_tangential;
            let rows = problem.laws[&g].rows;
            let equalities = ActiveEqualities::new(rows, &open[&g]);
            for (j, &is_open) in open[&g].iter().enumerate().filter(|&(j, _)| !sticks[j]) {
                let Iterate { jumps, forces } = &solution.at[&g];
                let mut excess = match is_open {
                    true => (jumps[j] - problem.bounds[&g][j]) / scales[1],
                    false => -forces[j] / scales[0],
                };
                if is_open && excess > least {
                    excess /= rows.amplified(j, &open[&g], &equalities).max(1.0);
                }
                largest = largest.max(excess);
                if excess > least {
                    wrong.push(j);
                }
            }
            let active = problem.limits[&g].closed_points(|j| !open[&g][j]);
            (wrong, largest, active)
        };
        let (mut faults, mut wrong) = (Self::default(), BTreeMap::new());
        comm.gather(
            &plan.group_owners(),
            |g| {
                let (of_group, largest, active) = of_group(g);
                let count = of_group.len();
                wrong.insert(g, of_group);
                (count, largest, active)
            },
            |_, (count, largest, active)| {
                faults.count += count;
                faults.active += active;
                faults.largest = faults.largest.max(largest);
            },
        );
        let mut totals = (faults.count, faults.active, faults.largest);
        comm.broadcast(&mut totals);
        (faults.count, faults.active, faults.largest) = totals;
        wrong.retain(|_, of_group| !of_group.is_empty());
        faults.wrong = wrong;
        faults
    }
}
