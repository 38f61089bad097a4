//! The contact problem of a load step, solved by Newton's method on the laws of contact
//! ([`newton`](crate::contact::newton)) with the tree as its operator, or the tree and BDDC.
//!
//! A jump is known where it is closed or sticks; where it slips its force follows its law. If Newton's method stalls,
//! it starts again from the solution of the convex problem without slip. That problem and the one without friction are
//! solved by updates of the active set, which take fewer steps than Newton's method with its line search.

use std::collections::BTreeMap;

use contact_dd_partition::id::{GroupId, OnGroups, OnTreeNodes};

use crate::contact::friction::Status;
use crate::contact::laws::{ContactLaws, Iterate, Statuses};
use crate::contact::limits::Limits;
use crate::contact::newton::{Found, NewtonSettings, newton};
use crate::context::Context;
use crate::error::Failure;
use crate::interface::s_con::ConTotals;
use crate::sweep::{SweepOutcome, SweepRecord, SweepStatus};
use crate::tree::active_set::find_active_set;
use crate::tree::fronts::ActiveSetFronts;
use crate::tree::operator::{ROUND_OFF, TreeOperator};
use crate::tree::problem::{Steps, TreeProblem};
use crate::tree::solution::ActiveSetSolution;

/// Most steps.
const MAX_STEPS: usize = 400;
/// Most steps in a row that don't reduce the merit.
const PATIENCE: usize = 20;
/// Accepted residual of the laws, relative to the largest force, where steps no longer reduce it: the rest is
/// round-off, which refinement removes.
const ACCEPTABLE: f64 = 1e-7;

/// The solution of the contact problem in the tree, on this rank.
#[derive(Clone, Debug)]
pub struct TreeContact {
    /// Forces and closed conditions of every contact group.
    pub conditions: OnGroups<Vec<(f64, bool)>>,
    /// The unknowns on the boundary of every cluster.
    pub boundaries: OnTreeNodes<Vec<f64>>,
    /// The statuses of all limits of every contact group, the start of the next load step; empty if they aren't right.
    pub statuses: OnGroups<Statuses>,
    /// Course of the sweeps; the same on all ranks but for times.
    pub outcome: SweepOutcome,
}

/// The start at rest, with these normal jumps open and all other limits closed and sticking.
fn begin(
    laws: &OnGroups<ContactLaws<'_>>,
    open: &OnGroups<Vec<bool>>,
) -> (OnGroups<Iterate>, OnGroups<Statuses>) {
    let (mut start, mut statuses) = (OnGroups::new(), OnGroups::new());
    for (&g, laws) in laws {
        let at = Iterate {
            jumps: laws.bounds.to_vec(),
            forces: vec![0.0; laws.bounds.len()],
        };
        let status: Vec<Status> = open[&g].iter().map(|&open| Status::new(open)).collect();
        statuses.insert(g, laws.begin(&status, &at));
        start.insert(g, at);
    }
    (start, statuses)
}

/// Solves for all contact points under `loads` on the boundaries of the clusters, within the `limits` of every contact
/// group of this rank, from the statuses of the load step `before`, else from all closed and sticking. Collective.
///
/// # Errors
/// Some part of the scene moves freely, or a signal has asked the run to stop.
pub fn solve(
    context: &Context<'_>,
    fronts: &mut ActiveSetFronts,
    limits: &OnGroups<Limits>,
    (loads, before): (&OnTreeNodes<Vec<f64>>, &OnGroups<Statuses>),
    max_steps: Option<usize>,
    observer: &mut dyn FnMut(&SweepRecord),
) -> Result<TreeContact, Failure> {
    let problem = TreeProblem::new(context, limits, loads);
    let mut steps = Steps::new(observer);
    let most = max_steps.unwrap_or(MAX_STEPS);
    let (found, solution) = match context.catalog.has_friction() {
        true => with_friction(&problem, fronts, &mut steps, before, most)?,
        false => without_friction(&problem, fronts, &mut steps, before, most)?,
    };
    conclude(&problem, found, solution, steps.outcome)
}

/// The solution without friction, by updates of the active set. Collective.
///
/// # Errors
/// Some part of the scene moves freely, or a signal has asked the run to stop.
fn without_friction(
    problem: &TreeProblem<'_>,
    fronts: &mut ActiveSetFronts,
    steps: &mut Steps<'_>,
    before: &OnGroups<Statuses>,
    most: usize,
) -> Result<(Found, ActiveSetSolution), Failure> {
    let mut open = problem.all_closed();
    for (g, open) in &mut open {
        if let Some(known) = before.get(g).filter(|b| b.closed.len() == open.len()) {
            *open = known.closed.iter().map(|closed| !closed).collect();
        }
    }
    let active_set = find_active_set(problem, fronts, steps, (open, most))?;
    let found = Found {
        at: active_set.solution.at.clone(),
        statuses: begin(&problem.laws, &active_set.open).1,
        residual: if active_set.is_right {
            0.0
        } else {
            f64::INFINITY
        },
        steps: steps.count(),
    };
    Ok((found, active_set.solution))
}

/// The solution with friction, by Newton's method. If that stalls, it starts again with the conditions closed that are
/// compressed while everything sticks along tangents, open or closed: a convex problem, in which no body loses its
/// restraint because contacts far from each other open. Collective.
///
/// # Errors
/// Some part of the scene moves freely, or a signal has asked the run to stop.
fn with_friction(
    problem: &TreeProblem<'_>,
    fronts: &mut ActiveSetFronts,
    steps: &mut Steps<'_>,
    before: &OnGroups<Statuses>,
    most: usize,
) -> Result<(Found, ActiveSetSolution), Failure> {
    let mut settings = NewtonSettings {
        most: most + 1,
        patience: PATIENCE,
        tolerance: ROUND_OFF,
        acceptable: ACCEPTABLE,
        round_off: ROUND_OFF,
        law: 1.0,
        softens: false,
    };
    let laws = &problem.laws;
    let (mut start, mut statuses) = begin(laws, &problem.all_closed());
    for (g, own) in &mut statuses {
        if let Some(known) = before.get(g) {
            laws[g].take_over(known, own);
        }
    }
    let mut is_anew = false;
    loop {
        let mut operator = TreeOperator::new(problem, fronts, steps);
        let found = newton(&mut operator, laws, &start, &statuses, settings)?;
        let solution = operator.solution.unwrap_or_default();
        settings.most = settings.most.saturating_sub(steps.count() - 1);
        if found.residual.is_finite() || is_anew || settings.most == 0 {
            return Ok((found, solution));
        }
        is_anew = true;
        let first = (problem.all_closed(), settings.most);
        let active_set = find_active_set(problem, fronts, steps, first)?;
        (start, statuses) = begin(laws, &active_set.open);
    }
}

/// The solution: forces at the conditions, unknowns at the clusters, and the outcome. Collective.
fn conclude(
    problem: &TreeProblem<'_>,
    found: Found,
    mut solution: ActiveSetSolution,
    mut outcome: SweepOutcome,
) -> Result<TreeContact, Failure> {
    let sweep = outcome.records.len() - 1;
    let is_finite = solution.is_finite(problem.context.comm);
    outcome.status = match found.residual.is_finite() {
        _ if !is_finite => not_finite(sweep),
        true => SweepStatus::Converged,
        false => SweepStatus::NotConverged(format!(
            "newton stopped after {sweep} sweeps: {} conditions aren't settled",
            outcome.records[sweep].changed.unwrap_or_default()
        )),
    };
    outcome.is_settled = is_finite && outcome.records[sweep].changed == Some(0);
    end(&mut outcome);
    solution.cut();
    let mut conditions: OnGroups<Vec<(f64, bool)>> = (problem.limits.iter())
        .map(|(&g, limits)| (g, conditions(limits, &problem.laws[&g], &found, g)))
        .collect();
    for (g, of_group) in &mut conditions {
        let tied = solution.tied.get(g).into_iter().flatten();
        for (force, (condition, _)) in tied.zip(&problem.limits[g].tied) {
            of_group[*condition].0 = *force;
        }
    }
    let statuses = match outcome.status {
        SweepStatus::Converged => found.statuses,
        SweepStatus::NotConverged(_) => BTreeMap::new(),
    };
    Ok(TreeContact {
        conditions,
        boundaries: solution.boundaries,
        statuses,
        outcome,
    })
}

/// The force of every condition of group g, and flags of those that are closed or stick.
fn conditions(
    limits: &Limits,
    laws: &ContactLaws<'_>,
    found: &Found,
    g: GroupId,
) -> Vec<(f64, bool)> {
    let of_limit = |(force, is_tangential): (&f64, &bool)| match (force.is_finite(), is_tangential)
    {
        (false, _) => 0.0,
        (true, true) => *force,
        (true, false) => force.max(0.0),
    };
    let forces = found.at[&g].forces.iter().zip(&laws.is_tangential);
    let forces: Vec<f64> = forces.map(of_limit).collect();
    let closed = limits.closed(laws.known(&found.statuses[&g]));
    limits.forces(&forces).into_iter().zip(closed).collect()
}

/// The message where a linear problem has no finite solution.
fn not_finite(sweep: usize) -> SweepStatus {
    SweepStatus::NotConverged(format!(
        "newton stopped after {sweep} sweeps: with the contacts that are closed then, forces and displacements aren't \
         finite"
    ))
}

/// Adds the work of the steps to the outcome, at their end.
fn end(outcome: &mut SweepOutcome) {
    let steps = outcome.records.len();
    outcome.active_set_iterations = steps;
    if let Some(last) = outcome.records.last() {
        outcome.residual = last.residual;
        outcome.totals = ConTotals {
            active: last.active,
            changed: last.changed.unwrap_or(0),
            steps,
            ..ConTotals::default()
        };
    }
}
