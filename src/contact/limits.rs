//! The limits of a pair: t ≤ g, D t ≤ d.

mod tangents;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use super::conditions::Conditions;
use super::dependent::DependentConstraints;
use super::jumps::{JumpOf, defining_conditions};
use super::prescribed_slip::PrescribedSlip;
use super::shared_jump::SharedJumps;
use super::status::{FixedStatus, LimitState};
pub use super::tangent::{OtherTangent, TangentialLimit};
use super::tangent::{TangentialCondition, with_other};

/// Slip, relative to the prescribed displacements, below which it counts as zero.
const ROUND_OFF: f64 = 1e-14;

/// The bounds t ≤ g and D t ≤ d, and the conditions that they come from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// g of every normal jump, the tightest of its conditions, then d of every dependent condition (m).
    #[serde(with = "crate::bytes")]
    pub bounds: Vec<f64>,
    /// D.
    pub rows: DependentConstraints,
    /// The condition that sets each bound, and its factor.
    tightest: Vec<(usize, f64)>,
    /// Conditions that set the same bounds and share the forces.
    shared: SharedJumps,
    /// The condition that defines each normal jump as an unknown.
    pub defining: Vec<usize>,
    /// Number of conditions.
    pub conditions: usize,
    /// The largest displacement prescribed in the pair, initial gaps among them (m).
    pub scale: f64,
    /// The limits of tangential jumps, ascending.
    pub tangents: Vec<TangentialLimit>,
    prescribed_slips: Vec<PrescribedSlip>,
    /// The conditions of ties and their jumps (m), in a single group only.
    pub tied: Vec<(usize, f64)>,
}

impl Limits {
    /// Bounds on `jumps` unknowns from `conditions`, the tangential ones last.
    pub fn new(jumps: usize, conditions: Conditions<'_>) -> Self {
        let Conditions {
            of,
            gaps,
            friction,
            scale,
            ..
        } = conditions;
        let defining = defining_conditions(of, jumps);
        let (shared, bearers) = conditions.shared(&defining);
        let mut limits = Self {
            bounds: vec![f64::INFINITY; jumps],
            rows: DependentConstraints::default(),
            tightest: vec![(0, 1.0); jumps],
            shared,
            defining,
            conditions: of.len(),
            scale,
            tangents: Vec::new(),
            prescribed_slips: Vec::new(),
            tied: tied(of, gaps),
        };
        limits.add_bounds(of, gaps, friction);
        for (jump, (condition, factor)) in bearers {
            limits.bounds[jump] = gaps[condition] / factor;
            limits.tightest[jump] = (condition, factor);
        }
        let prescribed = |j: usize| {
            let slip = -gaps[j];
            let slips = slip.abs() > ROUND_OFF * scale;
            (of[j] == JumpOf::Prescribed).then_some(if slips { slip } else { 0.0 })
        };
        limits.tangents = limits.tangents_of(friction, prescribed);
        for (tangential, other) in with_other(friction) {
            if let Some(slip) = prescribed(tangential.number) {
                limits.prescribed_slips.push(PrescribedSlip {
                    condition: tangential.number,
                    normal: tangential.normal,
                    bound: tangential.bound,
                    slip,
                    beside: other.and_then(prescribed).unwrap_or(0.0),
                    other: other.filter(|&other| prescribed(other).is_none()),
                });
            }
        }
        limits
    }

    /// Adds the bounds of conditions with these `gaps`: the tightest one for a normal jump, one each for dependent
    /// conditions.
    fn add_bounds(&mut self, of: &[JumpOf], gaps: &[f64], friction: &[TangentialCondition]) {
        let is_tangential = |j: usize| {
            let found = friction.binary_search_by_key(&j, |tangential| tangential.number);
            found.is_ok()
        };
        let mut alone = vec![true; of.len()];
        (self.shared.iter()).for_each(|sharer| alone[sharer.condition] = false);
        for (j, (of, gap)) in of.iter().zip(gaps).enumerate().filter(|(j, _)| alone[*j]) {
            match of {
                // A tangential jump doesn't bound other jumps, nor do these bound it.
                &JumpOf::Unknown { number, factor }
                    if (is_tangential(j) || is_tangential(self.defining[number]))
                        && self.defining[number] != j =>
                {
                    self.rows.push(vec![(number, factor)]);
                    self.bounds.push(*gap);
                    self.tightest.push((j, 1.0));
                }
                &JumpOf::Unknown { number, factor } => {
                    let bound = gap / factor;
                    if bound < self.bounds[number] {
                        self.bounds[number] = bound;
                        self.tightest[number] = (j, factor);
                    }
                }
                JumpOf::Combination(terms) => {
                    self.rows.push(terms.clone());
                    self.bounds.push(*gap);
                    self.tightest.push((j, 1.0));
                }
                JumpOf::Prescribed | JumpOf::Tied(_) => {}
            }
        }
    }

    /// The condition of each limit.
    pub fn conditions_of_limits(&self) -> Vec<usize> {
        self.tightest
            .iter()
            .map(|&(condition, _)| condition)
            .collect()
    }

    /// Number of normal jumps.
    pub fn jumps(&self) -> usize {
        self.bounds.len() - self.rows.len()
    }

    /// g − t, then d − D t, 0 for the rows of D that are `closed`.
    pub(super) fn gaps(&self, t: &[f64], closed: impl Fn(usize) -> bool) -> Vec<f64> {
        let m = t.len();
        let mut gaps: Vec<f64> = self.bounds.iter().zip(t).map(|(g, t)| g - t).collect();
        gaps.extend((0..self.rows.len()).map(|j| {
            let left = self.bounds[m + j] - self.rows.value(j, t);
            match (closed(m + j), self.is_tangential(m + j)) {
                (true, _) => 0.0,
                (false, true) => left,
                (false, false) => left.max(0.0),
            }
        }));
        gaps
    }

    /// True if limit i bounds a tangential jump.
    pub fn is_tangential(&self, i: usize) -> bool {
        let found = (self.tangents).binary_search_by_key(&i, |tangent| tangent.limit);
        found.is_ok()
    }

    /// The limits of several groups joined into one pair; normal jumps, linearly dependent constraints and conditions
    /// are numbered consecutively in the order of groups.
    pub fn join(groups: &[Self]) -> Self {
        let mut all = Self::default();
        let mut dependent = (Vec::new(), Vec::new());
        let jumps: usize = groups.iter().map(Self::jumps).sum();
        for group in groups {
            let m = group.jumps();
            let (first, first_row) = (all.bounds.len(), all.rows.len());
            let place = |limit: usize| match limit < m {
                true => first + limit,
                false => jumps + first_row + limit - m,
            };
            let tangents = group.tangents.iter();
            (all.tangents).extend(tangents.map(|tangent| tangent.renamed(place)));
            let shifted =
                |&(condition, factor): &(usize, f64)| (all.conditions + condition, factor);
            (all.shared).append(&group.shared, first, all.conditions);
            let (own, rows) = group.tightest.split_at(m);
            all.rows.append(&group.rows, all.bounds.len());
            dependent.0.extend(&group.bounds[m..]);
            dependent.1.extend(rows.iter().map(shifted));
            all.bounds.extend(&group.bounds[..m]);
            all.tightest.extend(own.iter().map(shifted));
            all.defining
                .extend(group.defining.iter().map(|j| all.conditions + j));
            let prescribed = group.prescribed_slips.iter();
            (all.prescribed_slips).extend(prescribed.map(|prescribed| PrescribedSlip {
                condition: all.conditions + prescribed.condition,
                normal: all.conditions + prescribed.normal,
                other: prescribed.other.map(|other| all.conditions + other),
                ..*prescribed
            }));
            all.conditions += group.conditions;
            all.scale = all.scale.max(group.scale);
        }
        all.bounds.append(&mut dependent.0);
        all.tightest.append(&mut dependent.1);
        all.tangents.sort_by_key(|tangent| tangent.limit);
        all
    }

    /// Forces of the limits from those of all conditions.
    pub fn of_limits(&self, forces: &[f64]) -> Vec<f64> {
        let tightest = self.tightest.iter();
        let of_limit = tightest.map(|&(condition, factor)| factor * forces[condition]);
        let mut of_limits: Vec<f64> = of_limit.collect();
        for sharer in self.shared.iter() {
            of_limits[sharer.jump] += sharer.factor * forces[sharer.condition];
        }
        of_limits
    }

    /// Forces of all conditions from those of the limits.
    pub fn forces(&self, of_limits: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.conditions];
        let mut left = of_limits.to_vec();
        for sharer in self.shared.iter() {
            let force = sharer.part * of_limits[sharer.jump];
            forces[sharer.condition] = force;
            left[sharer.jump] -= sharer.factor * force;
        }
        for (force, &(condition, factor)) in left.iter().zip(&self.tightest) {
            forces[condition] = force / factor;
        }
        for prescribed in self.prescribed_slips.iter().filter(|p| p.slip != 0.0) {
            forces[prescribed.condition] = prescribed.force(&forces);
        }
        forces
    }

    /// Copies the forces at the jumps of ties to their conditions.
    pub fn put_tied(&self, of_jumps: &[f64], forces: &mut [f64]) {
        for (&(condition, _), force) in self.tied.iter().zip(of_jumps) {
            forces[condition] = *force;
        }
    }

    /// Flags of the conditions whose limits are closed, or stick if tangential.
    pub fn closed(&self, limits: impl IntoIterator<Item = bool>) -> Vec<bool> {
        let mut closed = vec![false; self.conditions];
        for (&(condition, _), is_closed) in self.tightest.iter().zip(limits) {
            closed[condition] = is_closed;
        }
        for sharer in self.shared.iter() {
            closed[sharer.condition] = closed[self.tightest[sharer.jump].0];
        }
        for prescribed in &self.prescribed_slips {
            closed[prescribed.condition] = closed[prescribed.normal] && prescribed.slip == 0.0;
        }
        closed
    }

    /// Number of contact points whose limits are closed, each of those that share a jump counted.
    pub fn closed_points(&self, is_closed: impl Fn(usize) -> bool) -> usize {
        let of_limits = (0..self.bounds.len()).filter(|&i| !self.is_tangential(i) && is_closed(i));
        let jumps = self.shared.iter().map(|sharer| sharer.jump);
        let of_sharers = jumps.filter(|&i| !self.is_tangential(i) && is_closed(i));
        of_limits.count() + of_sharers.count()
    }

    /// The states of the limits from those of all conditions.
    pub fn states(&self, conditions: &[LimitState]) -> Vec<LimitState> {
        let of_condition = |&(condition, factor): &(usize, f64)| {
            let LimitState { force, gap, status } = conditions[condition];
            LimitState {
                force: factor * force,
                gap: gap / factor,
                status,
            }
        };
        let mut states: Vec<LimitState> = self.tightest.iter().map(of_condition).collect();
        for sharer in self.shared.iter() {
            states[sharer.jump].force += sharer.factor * conditions[sharer.condition].force;
        }
        states
    }

    /// The statuses of limits in the linear problem from those of its `conditions`.
    pub fn fixed(&self, conditions: &[FixedStatus]) -> Vec<FixedStatus> {
        let mut jumps: Vec<f64> = conditions
            .iter()
            .map(FixedStatus::distance_to_bound)
            .collect();
        self.share_jumps(&mut jumps);
        let of_condition = |&(condition, factor): &(usize, f64)| match conditions[condition] {
            FixedStatus::Closed { .. } => FixedStatus::Closed {
                distance: jumps[condition] / factor,
            },
            other => other,
        };
        let mut fixed: Vec<FixedStatus> = self.tightest.iter().map(of_condition).collect();
        for sharer in self.shared.iter() {
            if let Some([_, turning]) = conditions[sharer.condition].slip() {
                fixed[sharer.jump].add_turning(turning);
            }
        }
        fixed
    }

    /// Makes the `gaps` of conditions that share a jump equal, which round-off keeps apart.
    pub fn equalize(&self, gaps: &mut [f64]) {
        self.shared.equalize(gaps);
    }

    /// Replaces the `jumps` of conditions that share a jump's force by their mean, weighted by the parts of the force: as
    /// force and jump are conjugate, the work of the forces stays.
    pub fn share_jumps(&self, jumps: &mut [f64]) {
        let mut means: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
        for sharer in self.shared.iter() {
            let (rest, mean) = means.entry(sharer.jump).or_insert((1.0, 0.0));
            *rest -= sharer.factor * sharer.part;
            *mean += sharer.part * jumps[sharer.condition];
        }
        for (jump, (rest, mean)) in &mut means {
            let (condition, factor) = self.tightest[*jump];
            *mean += *rest / factor * jumps[condition];
            jumps[condition] = factor * *mean;
        }
        for sharer in self.shared.iter() {
            let (_, mean) = means[&sharer.jump];
            jumps[sharer.condition] = sharer.factor * mean;
        }
    }
}

/// The conditions of ties with their jumps, in the order of the jumps' numbers.
fn tied(of: &[JumpOf], gaps: &[f64]) -> Vec<(usize, f64)> {
    let mut tied: Vec<(usize, (usize, f64))> = Vec::new();
    for (j, (of, gap)) in of.iter().zip(gaps).enumerate() {
        if let JumpOf::Tied(number) = *of {
            tied.push((number, (j, *gap)));
        }
    }
    tied.sort_by_key(|&(number, _)| number);
    tied.into_iter().map(|(_, of_jump)| of_jump).collect()
}

#[cfg(test)]
mod tests;
