//! The active set: which conditions are closed, found by steps that freeze it.
//!
//! λ ≥ 0 where closed, t ≤ g where open. A step that finds conditions that say otherwise exchanges all of them, as
//! semismooth Newton does. Where these don't become fewer the energy descends: from jumps that penetrate nowhere the way
//! towards those of a step is gone up to where the first condition closes, and where none does those under tension open
//! (Nocedal and Wright, Numerical Optimization, 2006, algorithm 16.3). That comes back nowhere, so it ends.

use std::collections::BTreeMap;
use std::time::Instant;

use crate::bddc::solution::Accuracy;
use crate::contact::limits::Limits;
use crate::context::Context;
use crate::error::Failure;
use crate::frozen::fronts::FrozenFronts;
use crate::frozen::solution::FrozenSolution;
use crate::interface::s_con::ConTotals;
use crate::sweep::{SweepOutcome, SweepRecord, SweepStatus};

/// Steps without fewer conditions that say otherwise until the energy descends.
const PATIENCE: usize = 8;
/// Most steps.
const MAX_STEPS: usize = 400;
/// Tolerance of an iterative solver beside what is wrong with the active set before.
const LOOSE: f64 = 0.01;
/// What is none beside the largest force or displacement.
const ROUND_OFF: f64 = 1e-12;

/// What the steps found, on this rank.
#[derive(Clone, Debug)]
pub struct FrozenContact {
    /// Forces and closed conditions of every contact group.
    pub conditions: BTreeMap<usize, Vec<(f64, bool)>>,
    /// The unknowns on the boundary of every cluster.
    pub boundaries: BTreeMap<usize, Vec<f64>>,
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

/// Whether all wrong conditions are exchanged.
#[derive(Debug)]
struct Exchange {
    /// Fewest conditions that were wrong.
    fewest: usize,
    /// Steps that may go by without fewer.
    patience: usize,
    /// Tolerance of an iterative solver beside what is wrong with the active set before: where conditions are exchanged
    /// because of errors they don't become fewer.
    tolerance: f64,
}

impl Default for Exchange {
    fn default() -> Self {
        Self {
            fewest: usize::MAX,
            patience: PATIENCE,
            tolerance: LOOSE,
        }
    }
}

impl Exchange {
    /// Whether all are exchanged where `count` are wrong; once they aren't, they never are again.
    fn is_of_all(&mut self, count: usize) -> bool {
        if self.patience == 0 {
            return false;
        }
        match count < self.fewest {
            true => (self.fewest, self.patience) = (count, PATIENCE),
            false => {
                self.patience -= 1;
                self.tolerance *= LOOSE;
            }
        }
        true
    }
}

/// Normal jumps that penetrate nowhere, by group of this rank, from which the energy descends.
#[derive(Debug, Default)]
struct Descent(Option<BTreeMap<usize, Vec<f64>>>);

impl Descent {
    /// Goes towards the jumps that a step `found` where the conditions that are `open` led to these `faults`, and
    /// exchanges conditions; how many. Collective.
    fn exchange(
        &mut self,
        context: &Context<'_>,
        faults: &Faults,
        bounds: &BTreeMap<usize, Vec<f64>>,
        found: &BTreeMap<usize, Vec<f64>>,
        open: &mut BTreeMap<usize, Vec<bool>>,
    ) -> usize {
        let Context { comm, plan, .. } = *context;
        let begun = self.0.is_some();
        let jumps = self.0.get_or_insert_with(|| found.clone());
        let part_of = |g: usize| match (begun, faults.wrong.get(&g)) {
            (true, Some(wrong)) => part(&jumps[&g], &found[&g], &bounds[&g], &open[&g], wrong),
            _ => f64::INFINITY,
        };
        let mut least = f64::INFINITY;
        comm.gather(&plan.group_owners(), part_of, |_, part| {
            least = least.min(part)
        });
        comm.broadcast(&mut least);
        let mut changed = BTreeMap::new();
        for (g, of_group) in jumps {
            let wrong = faults.wrong.get(g).map_or(&[][..], Vec::as_slice);
            for open in open.get_mut(g) {
                let count = match begun {
                    true => go(of_group, &found[g], &bounds[g], open, wrong, least),
                    // Where all that penetrates is closed none does.
                    false => close(of_group, &bounds[g], open, wrong),
                };
                changed.insert(*g, count);
            }
        }
        let mut sum = 0;
        comm.gather(
            &plan.group_owners(),
            |g| changed.get(&g).copied().unwrap_or(0),
            |_, count| sum += count,
        );
        comm.broadcast(&mut sum);
        sum
    }
}

/// The part of the way from `jumps` to those that were `found` after which the first open condition that is wrong
/// closes; infinite where none is.
fn part(jumps: &[f64], found: &[f64], bounds: &[f64], open: &[bool], wrong: &[usize]) -> f64 {
    let part = |&j: &usize| ((bounds[j] - jumps[j]) / (found[j] - jumps[j])).max(0.0);
    let penetrating = wrong.iter().filter(|&&j| open[j]);
    penetrating.map(part).fold(f64::INFINITY, f64::min)
}

/// Goes a `way` of this length from `jumps` towards those that were `found`, and closes what closes there, or goes there
/// where nothing is in the way, and opens what is under tension; how many.
fn go(
    jumps: &mut [f64],
    found: &[f64],
    bounds: &[f64],
    open: &mut [bool],
    wrong: &[usize],
    way: f64,
) -> usize {
    let is_blocked = way.is_finite();
    let closes = |j: usize, jumps: &[f64]| part(jumps, found, bounds, open, &[j]) <= way;
    let exchanged: Vec<usize> = (wrong.iter().copied())
        .filter(|&j| match is_blocked {
            true => open[j] && closes(j, jumps),
            false => !open[j],
        })
        .collect();
    for j in 0..jumps.len() {
        jumps[j] += way.min(1.0) * (found[j] - jumps[j]);
    }
    for &j in &exchanged {
        open[j] = !open[j];
        jumps[j] = bounds[j];
    }
    exchanged.len()
}

/// Closes what is open and wrong, at its bound; how many.
fn close(jumps: &mut [f64], bounds: &[f64], open: &mut [bool], wrong: &[usize]) -> usize {
    let mut count = 0;
    for &j in wrong.iter().filter(|&&j| open[j]) {
        jumps[j] = bounds[j];
        count += 1;
    }
    wrong.iter().for_each(|&j| open[j] &= jumps[j] != bounds[j]);
    count
}

/// Finds the active set under `loads` on the boundaries of the clusters, within the `limits` of every contact group
/// of this rank, from the bilateral problem. Collective.
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
    let mut open: BTreeMap<usize, Vec<bool>> = (limits.iter())
        .map(|(&g, limits)| (g, vec![false; limits.bounds.len()]))
        .collect();
    let bounds: BTreeMap<usize, Vec<f64>> = (limits.iter())
        .map(|(&g, limits)| (g, limits.bounds.clone()))
        .collect();
    let mut outcome = SweepOutcome {
        frozen: true,
        ..SweepOutcome::before(Vec::new())
    };
    let (mut exchange, mut descent) = (Exchange::default(), Descent::default());
    let (mut changed, mut is_released) = (None, false);
    let (mut last, mut wrong_by) = (None, 1.0_f64);
    loop {
        fronts.freeze(context, &open)?;
        let accurate = |fronts: &mut FrozenFronts, tolerance, start: Option<&FrozenSolution>| {
            let accuracy = Accuracy {
                tolerance,
                start: start.map(|start| &start.tops),
            };
            let mut solution = fronts.solve(context, &open, loads, &bounds, accuracy)?;
            solution.iterations += start.map_or(0, |start| start.iterations);
            let least = ROUND_OFF.max(tolerance);
            let faults = Faults::of(context, &solution, &bounds, &open, least);
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
        let gave_up = sweep >= max_steps.unwrap_or(MAX_STEPS);
        if faults.count == 0 || gave_up {
            outcome.status = match faults.count {
                0 => SweepStatus::Converged,
                n => SweepStatus::NotConverged(format!(
                    "newton stopped after {sweep} sweeps: {n} conditions aren't settled"
                )),
            };
            outcome.residual = faults.largest;
            outcome.active_set_iterations = sweep + 1;
            outcome.totals = ConTotals {
                active: faults.active,
                changed: changed.unwrap_or(0),
                steps: sweep + 1,
                ..ConTotals::default()
            };
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
            return Ok(FrozenContact {
                conditions: conditions.collect(),
                boundaries: solution.boundaries,
                outcome,
            });
        }
        if context.comm.is_any_asked_to_stop() {
            return Err(Failure::interrupted(format!(
                "interrupted after {sweep} sweeps, before a result was written"
            )));
        }
        changed = Some(match exchange.is_of_all(faults.count) {
            true => {
                for (g, wrong) in &faults.wrong {
                    for of_group in open.get_mut(g) {
                        wrong.iter().for_each(|&j| of_group[j] = !of_group[j]);
                    }
                }
                faults.count
            }
            false => descent.exchange(context, &faults, &bounds, &solution.jumps, &mut open),
        });
        last = Some(FrozenSolution {
            iterations: 0,
            ..solution
        });
    }
}

impl Faults {
    /// What is wrong, by more than `least`, where the conditions that are `open` led to this solution. Collective.
    fn of(
        context: &Context<'_>,
        solution: &FrozenSolution,
        bounds: &BTreeMap<usize, Vec<f64>>,
        open: &BTreeMap<usize, Vec<bool>>,
        least: f64,
    ) -> Self {
        let Context { comm, plan, .. } = *context;
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
            for (j, &is_open) in open[&g].iter().enumerate() {
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

#[cfg(test)]
mod tests {
    use faer::linalg::solvers::Solve;
    use faer::{Mat, Side};

    use super::*;

    /// Finds which t are 0 in min ½ tᵀ H t − cᵀ t over t ≤ 0; how many steps of descent that took.
    fn open_jumps(h: &Mat<f64>, c: &[f64]) -> usize {
        let n = c.len();
        let (mut open, mut exchange, mut singles) = (vec![false; n], Exchange::default(), 0);
        let mut descent: Option<Vec<f64>> = None;
        let bounds = vec![0.0; n];
        for _ in 0..1000 {
            let free: Vec<usize> = (0..n).filter(|&j| open[j]).collect();
            let of_free = Mat::from_fn(free.len(), free.len(), |i, j| h[(free[i], free[j])]);
            let load = Mat::from_fn(free.len(), 1, |i, _| c[free[i]]);
            let jumps = match free.len() {
                0 => load,
                _ => of_free.llt(Side::Lower).unwrap().solve(&load),
            };
            let force = |j: usize| {
                let terms = free.iter().enumerate();
                c[j] - terms.map(|(i, &k)| h[(j, k)] * jumps[(i, 0)]).sum::<f64>()
            };
            let jump = |j: usize| free.binary_search(&j).map_or(0.0, |i| jumps[(i, 0)]);
            let is_wrong = |j: &usize| match open[*j] {
                true => jump(*j) > 0.0,
                false => force(*j) < 0.0,
            };
            let wrong: Vec<usize> = (0..n).filter(is_wrong).collect();
            if wrong.is_empty() {
                return singles;
            }
            if exchange.is_of_all(wrong.len()) {
                wrong.iter().for_each(|&j| open[j] = !open[j]);
                continue;
            }
            singles += 1;
            let found: Vec<f64> = (0..n).map(jump).collect();
            match &mut descent {
                None => {
                    let mut jumps = found;
                    close(&mut jumps, &bounds, &mut open, &wrong);
                    descent = Some(jumps);
                }
                Some(jumps) => {
                    let way = part(jumps, &found, &bounds, &open, &wrong);
                    go(jumps, &found, &bounds, &mut open, &wrong, way);
                }
            }
        }
        panic!("it goes on for ever");
    }

    /// Exchanges of all that are wrong come back to where they were with 7 of these matrices.
    #[test]
    fn sets_that_come_back_are_left_by_descent() {
        let noise = |s: usize| ((s as f64 * 78.233).sin() * 43758.5453).fract();
        let mut singles = 0;
        for seed in 0..200 {
            let n = 6 + seed % 9;
            // Of low rank, but for a little.
            let root = Mat::from_fn(n, (3 * n / 10).max(2), |i, j| {
                noise(1000 * seed + 31 * i + j)
            });
            let mut h = &root * root.transpose();
            (0..n).for_each(|i| h[(i, i)] += 1e-4);
            let c: Vec<f64> = (0..n).map(|i| noise(77 * seed + i)).collect();
            singles += open_jumps(&h, &c);
        }
        assert!(singles > 0);
    }
}
