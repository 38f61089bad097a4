//! The active set: which conditions are closed, found by steps that fix it.
//!
//! λ ≥ 0 where closed, t ≤ g where open. A step that finds conditions that say otherwise changes
//! some of them.

use std::collections::BTreeMap;
use std::time::Instant;

use crate::bddc::solution::{Accuracy, ClusterLoads};
use crate::context::Context;
use crate::error::Failure;
use crate::sweep::{SweepOutcome, SweepRecord};
use crate::tree::fronts::ActiveSetFronts;
use crate::tree::operator::{ROUND_OFF, go_on};
use crate::tree::solution::ActiveSetSolution;
use crate::tree::update::{ActiveSetUpdate, Descent};

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
    pub solution: ActiveSetSolution,
    /// Whether nothing is wrong.
    pub is_right: bool,
}

/// What an active set is found for: `loads` on the boundaries of the clusters, the jumps at which conditions are closed,
/// and which conditions stay closed whatever their forces, of every contact group of this rank.
#[derive(Clone, Copy)]
pub(super) struct Conditions<'a> {
    pub loads: &'a BTreeMap<usize, Vec<f64>>,
    pub bounds: &'a BTreeMap<usize, Vec<f64>>,
    pub stay: &'a BTreeMap<usize, Vec<bool>>,
}

/// Finds the active set of these conditions, from one that is `open` at first, or the one after `most` steps. Collective.
///
/// # Errors
/// Some part of the scene moves freely, or a signal has asked the run to stop.
pub(super) fn settle(
    context: &Context<'_>,
    fronts: &mut ActiveSetFronts,
    of_set: Conditions<'_>,
    (mut open, most): (BTreeMap<usize, Vec<bool>>, usize),
    outcome: &mut SweepOutcome,
    observer: &mut dyn FnMut(&SweepRecord),
) -> Result<Settled, Failure> {
    let began = Instant::now();
    let bounds = of_set.bounds;
    let (mut update, mut descent) = (ActiveSetUpdate::default(), Descent::default());
    let (mut changed, mut is_released) = (None, false);
    let (mut last, mut wrong_by) = (None, 1.0_f64);
    let loads = ClusterLoads {
        clusters: of_set.loads,
        prescribed: bounds,
        forces: &BTreeMap::new(),
    };
    let first = outcome.records.len();
    loop {
        fronts.fix(context, &open)?;
        let accurate =
            |fronts: &mut ActiveSetFronts, tolerance, start: Option<&ActiveSetSolution>| {
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
            Some(_) => (update.tolerance * wrong_by.min(1.0)).max(Accuracy::FULL.tolerance),
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
                is_right: faults.count == 0,
            });
        }
        go_on(context, sweep)?;
        changed = Some(match update.is_of_all(faults.count) {
            true => {
                descent = Descent::default();
                for (g, wrong) in &faults.wrong {
                    if let Some(of_group) = open.get_mut(g) {
                        wrong.iter().for_each(|&j| of_group[j] = !of_group[j]);
                    }
                }
                faults.count
            }
            false => descent.update(context, &faults.wrong, bounds, &solution.jumps, &mut open),
        });
        last = Some(ActiveSetSolution {
            iterations: 0,
            ..solution
        });
    }
}

impl Faults {
    /// What is wrong, by more than `least`, where the conditions that are `open` led to this solution. Collective.
    fn of(
        context: &Context<'_>,
        solution: &ActiveSetSolution,
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
