//! Choice of the conditions that change where the solution contradicts the active set.
//!
//! All wrong ones change, as in semismooth Newton. Where their number doesn't fall, the energy descends: from jumps
//! without penetration a step towards those of the solution is shortened to where the first condition closes, and if
//! none does, the tensile ones open (Nocedal and Wright, Numerical Optimization, 2006, algorithm 16.3), until fewer are
//! wrong than ever. Descent doesn't cycle, so it ends.

use std::collections::BTreeMap;

use contact_dd_partition::id::{GroupId, OnGroups};

use crate::contact::laws::{ContactLaws, Iterate};
use crate::contact::projection::project;
use crate::context::Context;
use crate::tree::problem::TreeProblem;

/// Tolerance of an iterative solver relative to the previous error of the active set.
pub(super) const FORCING_TERM: f64 = 0.01;
/// Steps without fewer wrong conditions after which the energy descends.
const PATIENCE: usize = 8;

/// Rule by which all wrong conditions change, or some.
#[derive(Debug)]
pub(super) struct ActiveSetUpdate {
    /// Fewest wrong conditions so far.
    fewest: usize,
    /// Remaining steps without fewer.
    patience: usize,
    /// Tolerance of an iterative solver relative to the previous error of the active set: conditions changed because of
    /// solver errors don't become fewer.
    pub tolerance: f64,
}

impl Default for ActiveSetUpdate {
    fn default() -> Self {
        Self {
            fewest: usize::MAX,
            patience: PATIENCE,
            tolerance: FORCING_TERM,
        }
    }
}

impl ActiveSetUpdate {
    /// True if all of `count` wrong conditions change; if not, the energy is to descend.
    pub fn is_of_all(&mut self, count: usize) -> bool {
        let all = count < self.fewest || self.patience > 0;
        if count < self.fewest {
            (self.fewest, self.patience) = (count, PATIENCE);
        } else {
            self.patience = self.patience.saturating_sub(1);
            self.tolerance *= FORCING_TERM;
        }
        all
    }
}

/// Normal jumps without penetration, by group of this rank, from which the energy descends.
#[derive(Debug, Default)]
pub(super) struct Descent(Option<OnGroups<Vec<f64>>>);

impl Descent {
    /// Moves towards the jumps `found` by a step of a `problem` with those limits `open`, some of them `wrong`, and
    /// changes some statuses; returns how many. `None` if rows depend on sticking tangential jumps: no nearby position
    /// without penetration is known. Collective.
    pub fn update(
        &mut self,
        problem: &TreeProblem<'_>,
        wrong: &OnGroups<Vec<usize>>,
        found: &OnGroups<Iterate>,
        open: &mut OnGroups<Vec<bool>>,
    ) -> Option<usize> {
        let Context { comm, plan, .. } = *problem.context;
        let bounds = &problem.bounds;
        let sticks =
            |laws: &ContactLaws<'_>| !laws.rows.is_empty() && laws.is_tangential.contains(&true);
        let any_sticks = problem.laws.values().any(sticks);
        if comm.decide(comm.collect(&any_sticks).contains(&true)) {
            return None;
        }
        let begun = self.0.is_some();
        let all = || found.iter().map(|(&g, at)| (g, at.jumps.clone())).collect();
        let jumps = self.0.get_or_insert_with(all);
        let part_of = |g: GroupId| match (begun, wrong.get(&g)) {
            (true, Some(wrong)) => {
                part(&jumps[&g], &found[&g].jumps, &bounds[&g], &open[&g], wrong)
            }
            _ => f64::INFINITY,
        };
        let mut least = f64::INFINITY;
        comm.gather(&plan.group_owners(), part_of, |_, part| {
            least = least.min(part)
        });
        comm.broadcast(&mut least);
        let mut changed = BTreeMap::new();
        for (g, of_group) in jumps {
            let wrong = wrong.get(g).map_or(&[][..], Vec::as_slice);
            if let Some(open) = open.get_mut(g) {
                let count = match begun {
                    true => go(of_group, &found[g].jumps, &bounds[g], open, wrong, least),
                    false => {
                        let rows = problem.laws[g].rows;
                        let projected = project(rows, &bounds[g], of_group, open);
                        // None penetrates once all others that do are closed.
                        projected + close(of_group, &bounds[g], open, wrong)
                    }
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
        Some(sum)
    }
}

/// The fraction of the step from `jumps` to those `found` at which the first wrong open condition closes; infinite
/// without such a condition.
fn part(jumps: &[f64], found: &[f64], bounds: &[f64], open: &[bool], wrong: &[usize]) -> f64 {
    let part = |&j: &usize| ((bounds[j] - jumps[j]) / (found[j] - jumps[j])).max(0.0);
    let penetrating = wrong.iter().filter(|&&j| open[j]);
    penetrating.map(part).fold(f64::INFINITY, f64::min)
}

/// Makes the fraction `way` of the step from `jumps` to those `found`, and closes the conditions that close there, or
/// makes the full step if nothing blocks it, and opens the tensile ones; returns how many.
fn go(
    jumps: &mut [f64],
    found: &[f64],
    bounds: &[f64],
    open: &mut [bool],
    wrong: &[usize],
    allowed: f64,
) -> usize {
    let is_blocked = allowed.is_finite();
    let closes = |j: usize, jumps: &[f64]| part(jumps, found, bounds, open, &[j]) <= allowed;
    let changed: Vec<usize> = (wrong.iter().copied())
        .filter(|&j| match is_blocked {
            true => open[j] && closes(j, jumps),
            false => !open[j],
        })
        .collect();
    for j in 0..jumps.len() {
        jumps[j] += allowed.min(1.0) * (found[j] - jumps[j]);
    }
    for &j in &changed {
        open[j] = !open[j];
        jumps[j] = bounds[j];
    }
    changed.len()
}

/// Closes wrong open conditions at their bounds; returns how many.
fn close(jumps: &mut [f64], bounds: &[f64], open: &mut [bool], wrong: &[usize]) -> usize {
    let mut count = 0;
    for &j in wrong.iter().filter(|&&j| open[j]) {
        if jumps[j] > bounds[j] {
            jumps[j] = bounds[j];
            count += 1;
        }
    }
    wrong.iter().for_each(|&j| open[j] &= jumps[j] != bounds[j]);
    count
}

#[cfg(test)]
mod tests {
    use faer::linalg::solvers::Solve;
    use faer::{Mat, Side};

    use super::*;

    /// Finds which t are 0 in min ½ tᵀ H t − cᵀ t over t ≤ 0; returns the number of descent steps.
    fn open_jumps(h: &Mat<f64>, c: &[f64]) -> usize {
        let n = c.len();
        let (mut open, mut update, mut singles) = (vec![false; n], ActiveSetUpdate::default(), 0);
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
            if update.is_of_all(wrong.len()) {
                descent = None;
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
                    let allowed = part(jumps, &found, &bounds, &open, &wrong);
                    go(jumps, &found, &bounds, &mut open, &wrong, allowed);
                }
            }
        }
        panic!("it goes on for ever");
    }

    /// Changes of all wrong conditions cycle for 7 of these matrices.
    #[test]
    fn sets_that_come_back_are_left_by_descent() {
        let noise = |s: usize| ((s as f64 * 78.233).sin() * 43758.5453).fract();
        let mut singles = 0;
        for seed in 0..200 {
            let n = 6 + seed % 9;
            // Matrices of almost low rank.
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
