//! The contact problem of a load step, solved by Newton's method on the laws of contact
//! ([`newton`](crate::contact::newton)) with the tree as its operator, or the tree and BDDC.
//!
//! A jump is known where it is closed or sticks; where it slips its force follows its law. Where Newton's method gets no
//! further, it begins anew at the solution of the convex problem in which nothing slips. That and the problem without friction
//! are solved by updates of the active set, which take fewer steps than Newton's method with its
//! line search.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

use crate::contact::friction::Status;
use crate::contact::law::PointStatus;
use crate::contact::laws::{ContactLaws, Iterate, Statuses};
use crate::contact::limits::Limits;
use crate::contact::newton::{Found, NewtonSettings, OnGroups, newton};
use crate::context::Context;
use crate::error::Failure;
use crate::fem::contact_group::ContactGroup;
use crate::interface::s_con::ConTotals;
use crate::sweep::{SweepOutcome, SweepRecord, SweepStatus};
use crate::tree::active_set::{Conditions, settle};
use crate::tree::fronts::ActiveSetFronts;
use crate::tree::operator::{ROUND_OFF, TreeOperator};
use crate::tree::solution::ActiveSetSolution;

/// Most steps.
const MAX_STEPS: usize = 400;
/// Most steps in a row without a smaller merit.
const PATIENCE: usize = 20;
/// What may be missed of the laws, relative to the largest force, where steps make it no smaller: the rest is round-off,
/// which refinement takes off.
const ACCEPTABLE: f64 = 1e-7;

/// What the steps found, on this rank.
#[derive(Clone, Debug)]
pub struct TreeContact {
    /// Forces and closed conditions of every contact group.
    pub conditions: BTreeMap<usize, Vec<(f64, bool)>>,
    /// The unknowns on the boundary of every cluster.
    pub boundaries: BTreeMap<usize, Vec<f64>>,
    /// The statuses of all limits of every contact group, from which the next load step begins; none where they aren't right.
    pub statuses: BTreeMap<usize, Statuses>,
    /// How they got there; the same on all ranks but for times.
    pub outcome: SweepOutcome,
}

/// The number of the point of every limit of a group.
fn points_of_limits(group: &ContactGroup, limits: &Limits) -> Vec<usize> {
    let conditions: Vec<usize> = group.conditions().map(|one| one.point).collect();
    let of_limits = limits.conditions_of_limits().into_iter();
    of_limits.map(|j| conditions[j]).collect()
}

/// The laws of the limits of a group.
fn laws<'a>(group: &ContactGroup, limits: &'a Limits) -> ContactLaws<'a> {
    let points = points_of_limits(group, limits).into_iter();
    let stiffness = points.map(|point| group.stiffness_at(point)).collect();
    ContactLaws::new(&limits.bounds, &limits.rows, &limits.tangents, stiffness)
}

/// Where all is at rest, with these normal jumps open and all else closed and sticking.
fn begin(
    laws: &OnGroups<ContactLaws<'_>>,
    open: impl Fn(usize) -> Vec<bool>,
) -> (OnGroups<Iterate>, OnGroups<Statuses>) {
    let of_group = |(&g, laws): (&usize, &ContactLaws<'_>)| {
        let at = Iterate {
            jumps: laws.bounds.to_vec(),
            forces: vec![0.0; laws.bounds.len()],
        };
        let status: Vec<Status> = open(g).into_iter().map(Status::new).collect();
        (g, (laws.begin(&status, &at), at))
    };
    let both = laws.iter().map(of_group);
    let (mut start, mut statuses) = (OnGroups::new(), OnGroups::new());
    for (g, (of_group, at)) in both {
        statuses.insert(g, of_group);
        start.insert(g, at);
    }
    (start, statuses)
}

/// Finds what every contact point does under `loads` on the boundaries of the clusters, within the `limits` of every
/// contact group of this rank, from the statuses of the load step `before`, else from where all are closed and stick. Where
/// Newton's method gets no further, it begins anew where those are closed that press while everything sticks along tangents,
/// open or closed: a convex problem, in which no body is without a hold because contacts open that are far from each other.
/// Collective.
///
/// # Errors
/// Some part of the scene moves freely, or a signal has asked the run to stop.
pub fn solve(
    context: &Context<'_>,
    fronts: &mut ActiveSetFronts,
    limits: &BTreeMap<usize, Limits>,
    (loads, before): (&BTreeMap<usize, Vec<f64>>, &BTreeMap<usize, Statuses>),
    max_steps: Option<usize>,
    observer: &mut dyn FnMut(&SweepRecord),
) -> Result<TreeContact, Failure> {
    let laws: OnGroups<ContactLaws<'_>> = (limits.iter())
        .map(|(&g, limits)| (g, laws(&context.groups[&g], limits)))
        .collect();
    let stiffest = limits.iter().map(|(&g, limits)| {
        let group = &context.groups[&g];
        let points = points_of_limits(group, limits).into_iter();
        (
            g,
            points
                .map(|point| group.largest_stiffness_at(point))
                .collect(),
        )
    });
    let stiffest: OnGroups<Vec<f64>> = stiffest.collect();
    let bounds: BTreeMap<usize, Vec<f64>> = (limits.iter())
        .map(|(&g, limits)| (g, limits.bounds.clone()))
        .collect();
    let mut outcome = SweepOutcome::before(Vec::new());
    let all_closed: BTreeMap<usize, Vec<bool>> = (bounds.iter())
        .map(|(&g, bounds)| (g, vec![false; bounds.len()]))
        .collect();
    let sticking = Conditions {
        loads,
        bounds: &bounds,
        stay: &(laws.iter())
            .map(|(&g, laws)| (g, laws.is_tangential.clone()))
            .collect(),
    };
    if !context.catalog.has_friction() {
        let mut open = all_closed;
        for (g, own) in &mut open {
            let known = before.get(g).filter(|b| b.closed.len() == own.len());
            let closed = known.into_iter().flat_map(|known| &known.closed);
            own.iter_mut()
                .zip(closed)
                .for_each(|(open, closed)| *open = !closed);
        }
        let first = (open, max_steps.unwrap_or(MAX_STEPS));
        let settled = settle(context, fronts, sticking, first, &mut outcome, observer)?;
        let found = Found {
            at: TreeOperator::iterate(&settled.solution),
            statuses: begin(&laws, |g| settled.open[&g].clone()).1,
            wrong: OnGroups::new(),
            missed: if settled.is_right { 0.0 } else { f64::INFINITY },
            steps: outcome.records.len(),
        };
        return conclude(context, limits, &laws, found, settled.solution, outcome);
    }
    let began = Instant::now();
    let mut settings = NewtonSettings {
        most: max_steps.unwrap_or(MAX_STEPS) + 1,
        patience: PATIENCE,
        tolerance: ROUND_OFF,
        acceptable: ACCEPTABLE,
        round_off: ROUND_OFF,
        law: 1.0,
    };
    let (mut start, mut statuses) = begin(&laws, |g| all_closed[&g].clone());
    for (g, own) in &mut statuses {
        if let Some(known) = before.get(g) {
            laws[g].take_over(known, own);
        }
    }
    let mut is_anew = false;
    loop {
        let mut operator = TreeOperator {
            context,
            fronts,
            laws: &laws,
            stiffest: &stiffest,
            loads,
            bounds: &bounds,
            solution: ActiveSetSolution::default(),
            is_answered: false,
            is_held: false,
            is_released: false,
            outcome: &mut outcome,
            began,
            observer,
            accuracy: ROUND_OFF,
            turns: false,
        };
        let found = newton(&mut operator, &laws, &start, &statuses, settings)?;
        let solution = std::mem::take(&mut operator.solution);
        let sweep = outcome.records.len() - 1;
        settings.most = settings.most.saturating_sub(sweep);
        if found.missed.is_finite() || is_anew || settings.most == 0 {
            return conclude(context, limits, &laws, found, solution, outcome);
        }
        is_anew = true;
        let first = (all_closed.clone(), settings.most);
        let settled = settle(context, fronts, sticking, first, &mut outcome, observer)?;
        (start, statuses) = begin(&laws, |g| settled.open[&g].clone());
    }
}

/// What was found: forces at the conditions, unknowns at the clusters, and how that went. Collective.
fn conclude(
    context: &Context<'_>,
    limits: &BTreeMap<usize, Limits>,
    laws: &OnGroups<ContactLaws<'_>>,
    found: Found,
    mut solution: ActiveSetSolution,
    mut outcome: SweepOutcome,
) -> Result<TreeContact, Failure> {
    let sweep = outcome.records.len() - 1;
    let is_finite = solution.is_finite(context.comm);
    outcome.status = match found.missed.is_finite() {
        _ if !is_finite => not_finite(sweep),
        true => SweepStatus::Converged,
        false => SweepStatus::NotConverged(format!(
            "newton stopped after {sweep} sweeps: {} conditions aren't settled",
            outcome.records[sweep].changed.unwrap_or_default()
        )),
    };
    end(&mut outcome);
    solution.cut();
    if outcome.status != SweepStatus::Converged {
        outcome.name_unsettled(&names(context, limits, &found.wrong));
    }
    let conditions = limits.iter().map(|(&g, limits)| {
        let (laws, at, statuses) = (&laws[&g], &found.at[&g], &found.statuses[&g]);
        let forces = at.forces.iter().zip(&laws.is_tangential);
        let forces: Vec<f64> = (forces)
            .map(
                |(force, is_tangential)| match (force.is_finite(), is_tangential) {
                    (false, _) => 0.0,
                    (true, true) => *force,
                    (true, false) => force.max(0.0),
                },
            )
            .collect();
        let mut closed = statuses.closed.clone();
        for (point, status) in laws.points.iter().zip(&statuses.points) {
            for t in point.limits() {
                closed[t] = *status == PointStatus::Sticks;
            }
        }
        let both = limits
            .forces(&forces)
            .into_iter()
            .zip(limits.closed(closed));
        (g, both.collect())
    });
    let conditions = conditions.collect();
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

/// What is said where a linear problem has no finite solution.
fn not_finite(sweep: usize) -> SweepStatus {
    SweepStatus::NotConverged(format!(
        "newton stopped after {sweep} sweeps: with the contacts that are closed then, forces and displacements aren't \
         finite"
    ))
}

/// Counts what the steps took, at their end.
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

/// The points of wrong limits, by contact and node; on the root. Collective.
fn names(
    context: &Context<'_>,
    limits: &BTreeMap<usize, Limits>,
    wrong: &OnGroups<Vec<usize>>,
) -> Vec<String> {
    let Context {
        comm,
        plan,
        catalog,
        groups,
        ..
    } = *context;
    let name = |g: usize, point: usize| {
        let point = &groups[&g].points[point];
        let contact = &catalog.contacts[point.contact as usize].name;
        format!("node {} of contact '{contact}'", point.tag())
    };
    let mut names = Vec::new();
    comm.gather(
        &plan.group_owners(),
        |g| {
            let points = points_of_limits(&groups[&g], &limits[&g]);
            let wrong: BTreeSet<usize> = wrong[&g].iter().map(|&i| points[i]).collect();
            wrong.into_iter().map(|point| name(g, point)).collect()
        },
        |_, of_group: Vec<String>| names.extend(of_group),
    );
    names
}
