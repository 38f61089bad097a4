//! Friction where active sets are frozen: a tangential jump sticks, and is known like a closed normal one, or slips
//! under a force that is given for a while, λ_t = b e with b = c + μ λ.
//!
//! The direction e is that of ξ = λ_t + r s, with the slip s and whatever stiffness r > 0 (Alart and Curnier, Comput.
//! Methods Appl. Mech. Engrg 92, 1991). A step that finds points that should do something else exchanges all of them;
//! the forces of those that slip follow by Newton's method.

pub mod points;
mod slip_forces;
pub mod slip_problem;

use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::Instant;

use self::points::{GroupFaults, GroupFriction};
use self::slip_forces::{STEPS, SlipForces, Solved};
use self::slip_problem::SlipProblem;
use crate::bddc::solution::Accuracy;
use crate::contact::limits::Limits;
use crate::context::Context;
use crate::error::Failure;
use crate::frozen::active_set::{
    Conditions, FrozenContact, ROUND_OFF, end, go_on, not_finite, settle,
};
use crate::frozen::exchange::LOOSE;
use crate::frozen::fronts::FrozenFronts;
use crate::frozen::solution::FrozenSolution;
use crate::sweep::{SweepOutcome, SweepRecord, SweepStatus};

/// Most steps.
const MAX_STEPS: usize = 400;
/// What slip forces may miss of their law, relative to the largest force, in the end.
const LAW: f64 = 1e-10;

/// What is wrong on all ranks.
#[derive(Clone, Debug, Default)]
struct Faults {
    of_groups: BTreeMap<usize, GroupFaults>,
    count: usize,
    last: usize,
    active: usize,
    largest: f64,
}

impl Faults {
    /// What is wrong, by more than `least`. Collective.
    fn of(
        context: &Context<'_>,
        groups: &BTreeMap<usize, GroupFriction>,
        solution: &Solved,
        least: f64,
    ) -> Self {
        let Context { comm, plan, .. } = *context;
        let mut faults = Self::default();
        let of_group = |g: usize| groups[&g].faults(&solution.groups[&g], solution.scales, least);
        let mut all = BTreeMap::new();
        comm.gather(
            &plan.group_owners(),
            |g| {
                let of_group = of_group(g);
                let count = of_group.normals.len() + of_group.points.len();
                let said = (count, of_group.active, of_group.largest);
                all.insert(g, of_group);
                said
            },
            |g, (count, active, largest): (usize, usize, f64)| {
                faults.count += count;
                faults.active += active;
                faults.largest = faults.largest.max(largest);
                if count > 0 {
                    faults.last = g;
                }
            },
        );
        let mut totals = (faults.count, faults.last, faults.active, faults.largest);
        comm.broadcast(&mut totals);
        (faults.count, faults.last, faults.active, faults.largest) = totals;
        faults.of_groups = all;
        faults
    }

    /// The points that are wrong, by contact and node; on the root. Collective.
    fn names(&self, context: &Context<'_>, groups: &BTreeMap<usize, GroupFriction>) -> Vec<String> {
        let Context {
            comm,
            plan,
            catalog,
            ..
        } = *context;
        let mut names = Vec::new();
        let name = |g: usize, point: usize| {
            let point = &context.groups[&g].points[point];
            let contact = &catalog.contacts[point.contact as usize].name;
            format!("node {} of contact '{contact}'", point.tag())
        };
        comm.gather(
            &plan.group_owners(),
            |g| {
                let (friction, faults) = (&groups[&g], &self.of_groups[&g]);
                let of_normals = faults.normals.iter().map(|&i| friction.of_jumps[i]);
                let of_points = (faults.points.iter())
                    .map(|&k| friction.of_jumps[friction.points[k].tangents[0]]);
                let points: BTreeSet<usize> = of_normals.chain(of_points).collect();
                points.into_iter().map(|point| name(g, point)).collect()
            },
            |_, of_group: Vec<String>| names.extend(of_group),
        );
        names
    }

    /// The last one alone.
    fn last(mut self) -> Self {
        for (g, of_group) in &mut self.of_groups {
            let is_last = *g == self.last;
            let normals = of_group.normals.len();
            let points = of_group.points.len();
            of_group.points.drain(
                ..if is_last {
                    points.saturating_sub(1)
                } else {
                    points
                },
            );
            let keeps = is_last && points == 0;
            of_group
                .normals
                .drain(..if keeps { normals - 1 } else { normals });
        }
        self
    }
}

/// A number that is another one where points do something else, but for chance; on all ranks. Collective.
fn fingerprint(context: &Context<'_>, groups: &BTreeMap<usize, GroupFriction>) -> u64 {
    let Context { comm, plan, .. } = *context;
    let mut all = DefaultHasher::new();
    comm.gather(
        &plan.group_owners(),
        |g| {
            let mut of_group = DefaultHasher::new();
            groups[&g].open.hash(&mut of_group);
            groups[&g].acts.hash(&mut of_group);
            of_group.finish()
        },
        |_, of_group: u64| of_group.hash(&mut all),
    );
    let mut number = all.finish();
    comm.broadcast(&mut number);
    number
}

/// Finds what every contact point does under `loads` on the boundaries of the clusters, within the `limits` of every
/// contact group of this rank, from where all are closed and stick. Where that comes back to where it was, or nowhere, it
/// begins anew where those are closed that press while everything sticks along tangents, open or closed: a convex problem,
/// in which no body is without a hold because contacts open that are far from each other. Collective.
///
/// # Errors
/// Some part of the scene moves freely, or a signal has asked the run to stop.
pub fn solve(
    context: &Context<'_>,
    fronts: &mut FrozenFronts,
    limits: &BTreeMap<usize, Limits>,
    loads: &BTreeMap<usize, Vec<f64>>,
    max_steps: Option<usize>,
    observer: &mut dyn FnMut(&SweepRecord),
) -> Result<FrozenContact, Failure> {
    let began = Instant::now();
    let mut groups: BTreeMap<usize, GroupFriction> = (limits.iter())
        .map(|(&g, limits)| (g, GroupFriction::new(&context.groups[&g], limits)))
        .collect();
    let bounds: BTreeMap<usize, Vec<f64>> = (limits.iter())
        .map(|(&g, limits)| (g, limits.bounds.clone()))
        .collect();
    let mut outcome = SweepOutcome {
        ..SweepOutcome::before(Vec::new())
    };
    let stay = groups
        .iter()
        .map(|(&g, friction)| (g, friction.is_tangential.clone()))
        .collect();
    let sticking = Conditions {
        loads,
        bounds: &bounds,
        stay: &stay,
    };
    let (mut known, mut is_anew) = (BTreeSet::new(), false);
    let (mut changed, mut wrong_by, mut is_released) = (None, 1.0_f64, false);
    let mut start: Option<FrozenSolution> = None;
    loop {
        let open: BTreeMap<usize, Vec<bool>> = groups
            .iter()
            .map(|(&g, friction)| (g, friction.open.clone()))
            .collect();
        fronts.freeze(context, &open)?;
        let mut slipping = SlipForces {
            problem: SlipProblem {
                context,
                open: &open,
                clusters: loads,
                prescribed: &bounds,
            },
            groups: &mut groups,
        };
        let finest = match fronts.coarse_dofs() {
            Some(_) => Accuracy::FULL.tolerance,
            None => 0.0,
        };
        // What an iterative solver leaves is no smaller.
        let enough = ROUND_OFF.max(10.0 * finest);
        let loose = (LOOSE * wrong_by.min(1.0)).max(ROUND_OFF);
        let (mut solved, mut missed) =
            slipping.solve(fronts, loose.max(finest), (loose, 1), start.as_ref())?;
        let mut faults = Faults::of(context, slipping.groups, &solved, loose);
        if faults.count == 0 {
            fronts.renew(context, &open)?;
            (solved, missed) =
                slipping.solve(fronts, finest, (enough, STEPS), Some(&solved.solution))?;
            faults = Faults::of(context, slipping.groups, &solved, ROUND_OFF);
        }
        if faults.count == 0 && !is_released && fronts.release(context, &open)? {
            is_released = true;
            (solved, missed) =
                slipping.solve(fronts, finest, (enough, STEPS), Some(&solved.solution))?;
            faults = Faults::of(context, slipping.groups, &solved, ROUND_OFF);
        }
        wrong_by = faults.largest.max(missed);
        let sweep = outcome.records.len();
        let record = SweepRecord {
            sweep,
            residual: wrong_by,
            active: faults.active,
            changed,
            seconds: began.elapsed().as_secs_f64(),
        };
        outcome.records.push(record);
        if let Some(coarse_dofs) = fronts.coarse_dofs() {
            let solves = outcome.iterative.get_or_insert_default();
            solves.iterations.push(solved.solution.iterations);
            solves.coarse_dofs = coarse_dofs;
        }
        observer(&record);
        let is_finite = solved.solution.is_finite(context.comm) && missed.is_finite();
        let most = max_steps.unwrap_or(MAX_STEPS);
        let all = known.insert(fingerprint(context, &groups));
        if !is_anew && sweep < most && (!is_finite || faults.count > 0 && !all) {
            go_on(context, sweep)?;
            let left = most - sweep;
            let settled = settle(context, fronts, sticking, left, &mut outcome, observer)?;
            for (g, friction) in &mut groups {
                friction.begin(&settled.open[g]);
            }
            known.clear();
            (is_anew, is_released, changed, start) = (true, false, None, None);
            wrong_by = 1.0;
            continue;
        }
        if faults.count == 0 || sweep >= most || !is_finite {
            outcome.status = match faults.count {
                _ if !is_finite => not_finite(sweep),
                0 if missed <= LAW => SweepStatus::Converged,
                0 => SweepStatus::NotConverged(format!(
                    "forces of slipping points miss their law by {missed:.1e} of the largest"
                )),
                n => SweepStatus::NotConverged(format!(
                    "newton stopped after {sweep} sweeps: {n} conditions aren't settled"
                )),
            };
            end(&mut outcome);
            solved.cut();
            outcome.name_unsettled(&faults.names(context, &groups));
            let conditions = limits.iter().map(|(g, limits)| {
                let friction = &groups[g];
                let [_, forces] = &solved.groups[g];
                let forces = forces.iter().zip(&friction.is_tangential);
                let forces: Vec<f64> = (forces)
                    .map(|(f, is_tangential)| if *is_tangential { *f } else { f.max(0.0) })
                    .collect();
                let closed = limits.closed(friction.open.iter().map(|open| !open));
                (*g, limits.forces(&forces).into_iter().zip(closed).collect())
            });
            return Ok(FrozenContact {
                conditions: conditions.collect(),
                boundaries: solved.solution.boundaries,
                outcome,
            });
        }
        go_on(context, sweep)?;
        changed = Some(if all { faults.count } else { 1 });
        let faults = if all { faults } else { faults.last() };
        for (g, of_group) in &faults.of_groups {
            if let Some(friction) = groups.get_mut(g) {
                friction.exchange(of_group, &solved.groups[g]);
            }
        }
        start = Some(FrozenSolution {
            iterations: 0,
            ..solved.solution
        });
    }
}
