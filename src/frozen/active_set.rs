//! The active set: which conditions are closed, found by steps that freeze it.
//!
//! λ ≥ 0 where closed, t ≤ g where open. A step that finds conditions that say otherwise exchanges
//! some of them.

use std::collections::BTreeMap;
use std::time::Instant;

use crate::bddc::solution::{Accuracy, ClusterLoads};
use crate::contact::laws::Statuses;
use crate::contact::limits::Limits;
use crate::context::Context;
use crate::error::Failure;
use crate::frozen::exchange::{Descent, Exchange};
use crate::frozen::fronts::FrozenFronts;
use crate::frozen::solution::FrozenSolution;
use crate::interface::s_con::ConTotals;
use crate::sweep::{SweepOutcome, SweepRecord, SweepStatus};

/// Most steps.
const MAX_STEPS: usize = 400;
/// What is none beside the largest force or displacement.
pub(super) const ROUND_OFF: f64 = 1e-12;

/// What the steps found, on this rank.
#[derive(Clone, Debug)]
pub struct FrozenContact {
    /// Forces and closed conditions of every contact group.
    pub conditions: BTreeMap<usize, Vec<(f64, bool)>>,
    /// The unknowns on the boundary of every cluster.
    pub boundaries: BTreeMap<usize, Vec<f64>>,
    /// The statuses of all limits of every contact group, from which the next load step begins; none where they aren't right.
    pub statuses: BTreeMap<usize, Statuses>,
    /// How they got there; the same on all ranks but for times.
    pub outcome: SweepOutcome,
}

/// What is wrong with the active set.
#[derive(Clone, Debug, Default)]
struct Faults {
    /// Normal jumps by group that should be open and are closed, or the other way round.
    wrong: BTreeMap<usize, Vec<usize>>,
    /// How many there are on all ranks.
    count: usize,
    /// Closed ones on all ranks.
    active: usize,
    /// The largest tension or penetration, relative to the largest force or jump.
    largest: f64,
}

/// What is open in an active set, and the solution with it.
pub(super) struct Settled {
    pub open: BTreeMap<usize, Vec<bool>>,
    pub solution: FrozenSolution,
    /// How many conditions are wrong; none where it is found.
    pub wrong: usize,
}

/// What an active set is found for: `loads` on the boundaries of the clusters, the jumps at which conditions are closed,
/// and which conditions stay closed whatever their forces, of every contact group of this rank.
#[derive(Clone, Copy)]
pub(super) struct Conditions<'a> {
    pub loads: &'a BTreeMap<usize, Vec<f64>>,
    pub bounds: &'a BTreeMap<usize, Vec<f64>>,
    pub stay: &'a BTreeMap<usize, Vec<bool>>,
}

/// Finds the active set under `loads` on the boundaries of the clusters, within the `limits` of every contact group
/// of this rank, from the statuses of the load step `before`, else from the bilateral problem. Collective.
///
/// # Errors
/// Some part of the scene moves freely, or a signal has asked the run to stop.
pub fn solve(
    context: &Context<'_>,
    fronts: &mut FrozenFronts,
    limits: &BTreeMap<usize, Limits>,
    (loads, before): (&BTreeMap<usize, Vec<f64>>, &BTreeMap<usize, Statuses>),
    max_steps: Option<usize>,
    observer: &mut dyn FnMut(&SweepRecord),
) -> Result<FrozenContact, Failure> {
    let bounds: BTreeMap<usize, Vec<f64>> = (limits.iter())
        .map(|(&g, limits)| (g, limits.bounds.clone()))
        .collect();
    let of_set = Conditions {
        loads,
        bounds: &bounds,
        stay: &BTreeMap::new(),
    };
    let mut outcome = SweepOutcome::before(Vec::new());
    let most = max_steps.unwrap_or(MAX_STEPS);
    let first = bounds.iter().map(|(&g, bounds)| {
        let known = before
            .get(&g)
            .filter(|known| known.closed.len() == bounds.len());
        let open = known.map(|known| known.closed.iter().map(|closed| !closed).collect());
        (g, open.unwrap_or_else(|| vec![false; bounds.len()]))
    });
    let first = first.collect();
    let mut settled = settle(
        context,
        fronts,
        of_set,
        (first, most),
        &mut outcome,
        observer,
    )?;
    let sweep = outcome.records.len() - 1;
    outcome.status = match settled.wrong {
        _ if !settled.solution.is_finite(context.comm) => not_finite(sweep),
        0 => SweepStatus::Converged,
        n => SweepStatus::NotConverged(format!(
            "newton stopped after {sweep} sweeps: {n} conditions aren't settled"
        )),
    };
    settled.solution.cut();
    end(&mut outcome);
    let Settled { open, solution, .. } = settled;
    let conditions = limits.iter().map(|(g, limits)| {
        let forces = solution.forces[g]
            .iter()
            .map(|f| f.max(0.0))
            .collect::<Vec<_>>();
        let both = limits
            .forces(&forces)
            .into_iter()
            .zip(limits.closed(open[g].iter().map(|open| !open)));
        (*g, both.collect())
    });
    let conditions = conditions.collect();
    let statuses = open
        .into_iter()
        .filter(|_| outcome.status == SweepStatus::Converged);
    let statuses = statuses.map(|(g, open)| {
        let closed = open.into_iter().map(|open| !open).collect();
        (
            g,
            Statuses {
                closed,
                ..Statuses::default()
            },
        )
    });
    Ok(FrozenContact {
        conditions,
        boundaries: solution.boundaries,
        statuses: statuses.collect(),
        outcome,
    })
}

/// What is said where a linear problem has no finite solution.
pub(super) fn not_finite(sweep: usize) -> SweepStatus {
    SweepStatus::NotConverged(format!(
        "newton stopped after {sweep} sweeps: with the contacts that are closed then, forces and displacements aren't \
         finite"
    ))
}

/// Finds the active set of these conditions, from one that is `open` at first, or the one after `most` steps. Collective.
///
/// # Errors
/// Some part of the scene moves freely, or a signal has asked the run to stop.
pub(super) fn settle(
    context: &Context<'_>,
    fronts: &mut FrozenFronts,
    of_set: Conditions<'_>,
    (mut open, most): (BTreeMap<usize, Vec<bool>>, usize),
    outcome: &mut SweepOutcome,
    observer: &mut dyn FnMut(&SweepRecord),
) -> Result<Settled, Failure> {
    let began = Instant::now();
    let bounds = of_set.bounds;
    let (mut exchange, mut descent) = (Exchange::default(), Descent::default());
    let (mut changed, mut is_released) = (None, false);
    let (mut last, mut wrong_by) = (None, 1.0_f64);
    let loads = ClusterLoads {
        clusters: of_set.loads,
        prescribed: bounds,
        forces: &BTreeMap::new(),
    };
    let first = outcome.records.len();
    loop {
        fronts.freeze(context, &open)?;
        let accurate = |fronts: &mut FrozenFronts, tolerance, start: Option<&FrozenSolution>| {
            let accuracy = Accuracy {
                tolerance,
                start: start.map(|start| &start.merge_roots),
            };
            let mut solution = fronts.solve(context, &open, loads, accuracy)?;
            solution.iterations += start.map_or(0, |start| start.iterations);
            let least = ROUND_OFF.max(tolerance);
            let faults = Faults::of(context, &solution, of_set, &open, least);
            Ok::<_, Failure>((solution, faults))
        };
        // No more accurate than the active set, until that seems to be right.
        let tolerance = match fronts.coarse_dofs() {
            Some(_) => (exchange.tolerance * wrong_by.min(1.0)).max(Accuracy::FULL.tolerance),
            None => 0.0,
        };
        let (mut solution, mut faults) = accurate(fronts, tolerance, last.as_ref())?;
        if faults.count == 0 && tolerance > Accuracy::FULL.tolerance {
            fronts.renew(context, &open)?;
            (solution, faults) = accurate(fronts, Accuracy::FULL.tolerance, Some(&solution))?;
        }
        if faults.count == 0 && !is_released && fronts.release(context, &open)? {
            is_released = true;
            (solution, faults) = accurate(fronts, Accuracy::FULL.tolerance, Some(&solution))?;
        }
        wrong_by = faults.largest;
        let sweep = outcome.records.len();
        let record = SweepRecord {
            sweep,
            residual: faults.largest,
            active: faults.active,
            changed,
            seconds: began.elapsed().as_secs_f64(),
        };
        outcome.records.push(record);
        if let Some(coarse_dofs) = fronts.coarse_dofs() {
            let solves = outcome.iterative.get_or_insert_default();
            solves.iterations.push(solution.iterations);
            solves.coarse_dofs = coarse_dofs;
        }
        observer(&record);
        let gave_up = sweep - first >= most || !solution.is_finite(context.comm);
        if faults.count == 0 || gave_up {
            return Ok(Settled {
                open,
                solution,
                wrong: faults.count,
            });
        }
        go_on(context, sweep)?;
        changed = Some(match exchange.is_of_all(faults.count) {
            true => {
                descent = Descent::default();
                for (g, wrong) in &faults.wrong {
                    if let Some(of_group) = open.get_mut(g) {
                        wrong.iter().for_each(|&j| of_group[j] = !of_group[j]);
                    }
                }
                faults.count
            }
            false => descent.exchange(context, &faults.wrong, bounds, &solution.jumps, &mut open),
        });
        last = Some(FrozenSolution {
            iterations: 0,
            ..solution
        });
    }
}

/// Counts what the steps took, at their end.
pub(super) fn end(outcome: &mut SweepOutcome) {
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

impl Faults {
    /// What is wrong, by more than `least`, where the conditions that are `open` led to this solution. Collective.
    fn of(
        context: &Context<'_>,
        solution: &FrozenSolution,
        of_set: Conditions<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
        least: f64,
    ) -> Self {
        let Context { comm, plan, .. } = *context;
        let Conditions { bounds, stay, .. } = of_set;
        let largest = |all: &BTreeMap<usize, Vec<f64>>| {
            let all = all.values().flatten().filter(|x| x.is_finite());
            all.fold(0.0, |m: f64, x| m.max(x.abs()))
        };
        let own = [
            largest(&solution.forces),
            largest(&solution.jumps).max(largest(bounds)),
        ];
        let mut scales = [0.0_f64; 2];
        for of_rank in comm.collect(&own) {
            scales = [0, 1].map(|k| f64::max(scales[k], of_rank[k]));
        }
        comm.broadcast(&mut scales);
        let mut faults = Self::default();
        let of_group = |g: usize| {
            let (mut wrong, mut largest, mut active) = (Vec::new(), 0.0_f64, 0);
            let stays = |j: usize| stay.get(&g).is_some_and(|stay| stay[j]);
            for (j, &is_open) in open[&g].iter().enumerate().filter(|&(j, _)| !stays(j)) {
                let excess = match is_open {
                    true => {
                        (solution.jumps[&g][j] - bounds[&g][j]) / scales[1].max(f64::MIN_POSITIVE)
                    }
                    false => -solution.forces[&g][j] / scales[0].max(f64::MIN_POSITIVE),
                };
                active += usize::from(!is_open);
                largest = largest.max(excess);
                if excess > least {
                    wrong.push(j);
                }
            }
            (wrong, largest, active)
        };
        let mut wrong = BTreeMap::new();
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
