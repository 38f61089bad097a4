//! Semismooth Newton on the contact laws: statuses of all limits make the problem linear, and its solution shows which
//! of them are wrong.
//!
//! All wrong statuses change at once. The residual of the laws in the energy norm is the merit function, and a step is
//! halved until it reduces that; if no fraction does, the best one is taken. All iterates fulfil λ = c − H t − Dᵀ μ, so
//! a fraction of a step needs no further solve.
//!
//! S. Hüeber, G. Stadler, B. Wohlmuth, *A primal-dual active set algorithm for three-dimensional contact problems with
//! Coulomb friction*, SIAM J. Sci. Comput. 30 (2008).

use contact_dd_partition::id::{GroupId, OnGroups};
use serde::{Deserialize, Serialize};

use super::law::PointStatus;
use super::laws::{ContactLaws, Iterate, LawResidual, Past, Statuses};
use crate::vector::larger;

/// Smallest fraction of a step.
const SMALLEST: f64 = 1e-3;
/// Relative reduction of the merit function that is required per fraction of a step.
const SUFFICIENT_DECREASE: f64 = 1e-4;

/// An operator that solves the linear problem of given statuses. Its methods are collective.
pub trait ContactOperator {
    /// Reason for a failure: some part of the scene moves freely, or a signal has asked the run to stop.
    type Error;

    /// Jumps and forces that solve the equations of these statuses, near an iterate; approximate ones where the solver
    /// is iterative and they suffice.
    ///
    /// # Errors
    /// The linear problem has no solution, or the run is to stop.
    fn step(
        &mut self,
        from: &OnGroups<Iterate>,
        statuses: &OnGroups<Statuses>,
        accuracy: StepAccuracy,
    ) -> Result<OnGroups<Iterate>, Self::Error>;

    /// The iterate at the fraction `part` of a step between two iterates.
    fn between(
        &self,
        from: &OnGroups<Iterate>,
        to: &OnGroups<Iterate>,
        part: f64,
    ) -> OnGroups<Iterate>;

    /// Makes limits that are closed `now`, at an iterate, independent of each other, those that were closed `before` first; an
    /// operator that shares forces among dependent limits leaves them.
    fn make_independent(
        &self,
        _at: &OnGroups<Iterate>,
        _before: &OnGroups<Statuses>,
        _now: &mut OnGroups<Statuses>,
    ) {
    }

    /// Scale of the terms whose sum is the force of every limit (N/m).
    fn force_scales(&self, at: &OnGroups<Iterate>) -> OnGroups<Vec<f64>>;

    /// Fraction of these scales within which a limit keeps its status.
    fn slack(&self) -> f64;

    /// The residual of all groups on all ranks.
    fn total(&self, residuals: &OnGroups<LawResidual>) -> TotalResidual;

    /// Energy norm of the forces that act before anything moves, or infinity where it isn't known.
    fn acting(&self) -> f64;

    /// Accuracy of the step after one with this residual.
    fn accuracy(&self, total: &TotalResidual) -> StepAccuracy;

    /// Records a step.
    ///
    /// # Errors
    /// A signal has asked the run to stop.
    fn record(&mut self, step: NewtonStep) -> Result<(), Self::Error>;
}

/// Accuracy of a step's solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepAccuracy {
    /// Accuracy adapted to this residual of the laws, relative to the largest force.
    Rough(f64),
    /// Accuracy of round-off.
    Full,
}

/// The residual of the laws of all groups on all ranks.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct TotalResidual {
    /// Σ x²/r over the residuals x of limits, then its square root.
    pub merit: f64,
    /// Σ λ²/r of the forces, then its square root.
    pub forces: f64,
    /// The largest residual relative to the scales of forces.
    pub largest: f64,
    /// Number of closed contact points; of closed normal jumps where each is one point's.
    pub active: usize,
    /// Number of wrong statuses.
    pub wrong: usize,
    /// True if a point parts, so that the merit function can't judge a fraction of a step.
    pub parts: bool,
}

impl TotalResidual {
    /// The residual before the first step.
    const UNKNOWN: Self = Self {
        merit: f64::INFINITY,
        forces: 0.0,
        largest: f64::INFINITY,
        active: 0,
        wrong: usize::MAX,
        parts: false,
    };

    /// Adds the residual of another group.
    pub fn include(&mut self, other: Self) {
        self.merit += other.merit;
        self.forces += other.forces;
        self.largest = larger(self.largest, other.largest);
        self.active += other.active;
        self.wrong += other.wrong;
        self.parts |= other.parts;
    }
}

/// A Newton step.
#[derive(Clone, Copy, Debug)]
pub struct NewtonStep {
    /// The residual at its end.
    pub total: TotalResidual,
    /// Number of statuses that changed before it; `None` for the first step.
    pub changed: Option<usize>,
}

/// Limits of Newton's method.
#[derive(Clone, Copy, Debug)]
pub struct NewtonSettings {
    /// Most steps.
    pub most: usize,
    /// Most steps in a row that don't reduce the merit function.
    pub patience: usize,
    /// Accepted residual of the laws, relative to the scales of forces.
    pub tolerance: f64,
    /// Accepted residual where steps no longer reduce it and no status is wrong.
    pub acceptable: f64,
    /// Round-off of the residual: no further step is made below it once the tolerance is met.
    pub round_off: f64,
    /// Merit relative to the acting forces above which force scales are no measure: a body that slides away has forces
    /// small against the terms of its displacement.
    pub law: f64,
    /// True if r is lowered where slips keep reversing; not in approximate steps.
    pub softens: bool,
}

/// The end of Newton's method.
#[derive(Clone, Debug)]
pub struct Found {
    /// Jumps and forces.
    pub at: OnGroups<Iterate>,
    /// The statuses whose equations they fulfil.
    pub statuses: OnGroups<Statuses>,
    /// Residual of the laws, relative to the scales of forces; infinite if the method doesn't converge.
    pub residual: f64,
    /// Linear systems solved.
    pub steps: usize,
}

/// Newton's method from an iterate, the first step with the equations of `statuses`. Collective.
///
/// # Errors
/// The operator's.
pub fn newton<O: ContactOperator>(
    operator: &mut O,
    laws: &OnGroups<ContactLaws<'_>>,
    start: &OnGroups<Iterate>,
    statuses: &OnGroups<Statuses>,
    settings: NewtonSettings,
) -> Result<Found, O::Error> {
    let (mut at, mut statuses, laws) = (start.clone(), statuses.clone(), &mut laws.clone());
    let (mut merit, mut changed) = (f64::INFINITY, None);
    let (mut least, mut patience) = (f64::INFINITY, settings.patience);
    let (mut accuracy, mut residual) = (operator.accuracy(&TotalResidual::UNKNOWN), f64::INFINITY);
    let mut best: Option<Found> = None;
    for steps in 1..=settings.most {
        let target = operator.step(&at, &statuses, accuracy)?;
        let (residuals, total) = evaluate_laws(operator, laws, &target, Some(&statuses), settings);
        operator.record(NewtonStep { total, changed })?;
        if total.merit.is_nan() {
            break;
        }
        if let Some(found) = &mut best
            && total.largest > 0.5 * found.residual
        {
            found.steps = steps;
            break;
        }
        if let Some(is_last) = accepted(&total, accuracy, residual, settings) {
            best = Some(Found {
                at: target.clone(),
                statuses: statuses.clone(),
                residual: total.largest,
                steps,
            });
            if is_last {
                break;
            }
        }
        patience = match total.merit < least {
            true => settings.patience,
            false => patience.saturating_sub(1),
        };
        if patience == 0 {
            break;
        }
        least = least.min(total.merit);
        accuracy = operator.accuracy(&total);
        (residual, changed) = (total.largest, Some(total.wrong));
        for (&g, of_group) in laws.iter_mut().filter(|_| settings.softens) {
            of_group.soften(&statuses[&g], &residuals[&g].statuses);
        }
        let from = (at, merit, statuses);
        (at, merit, statuses) = advance(operator, laws, from, target, (residuals, total), settings);
    }
    Ok(best.unwrap_or(Found {
        at,
        statuses,
        residual: f64::INFINITY,
        steps: settings.most,
    }))
}

/// Whether a step with this residual is accepted, where `previous` is the residual of the step before; true if it is the
/// last one: its accuracy is limited by round-off, or no better than that of the previous step.
fn accepted(
    total: &TotalResidual,
    accuracy: StepAccuracy,
    previous: f64,
    settings: NewtonSettings,
) -> Option<bool> {
    if accuracy != StepAccuracy::Full {
        return None;
    }
    let stalls = total.wrong == 0 && total.largest > 0.5 * previous;
    match total.largest <= settings.tolerance {
        true => Some(total.largest <= settings.round_off),
        false => (stalls && total.largest <= settings.acceptable).then_some(true),
    }
}

/// The iterate, its merit and its statuses after the step from an iterate with this merit, by the equations of these statuses,
/// to a `target`. Collective.
fn advance<O: ContactOperator>(
    operator: &O,
    laws: &OnGroups<ContactLaws<'_>>,
    (from, merit, before): (OnGroups<Iterate>, f64, OnGroups<Statuses>),
    target: OnGroups<Iterate>,
    whole: (OnGroups<LawResidual>, TotalResidual),
    settings: NewtonSettings,
) -> (OnGroups<Iterate>, f64, OnGroups<Statuses>) {
    let past: OnGroups<Vec<Past>> = (whole.0.iter())
        .map(|(&g, of_group)| (g, of_group.statuses.past.clone()))
        .collect();
    let (at, merit, mut statuses) =
        line_search(operator, laws, (from, merit), target, whole, settings);
    operator.make_independent(&at, &before, &mut statuses);
    for (g, past) in past {
        if let Some(of_group) = statuses.get_mut(&g) {
            of_group.past = past;
        }
    }
    (at, merit, statuses)
}

/// The residual of the laws at an iterate, which within round-off keeps the statuses `before`; only the merit counts where these
/// aren't known. Collective.
pub fn evaluate_laws<O: ContactOperator>(
    operator: &O,
    laws: &OnGroups<ContactLaws<'_>>,
    at: &OnGroups<Iterate>,
    before: Option<&OnGroups<Statuses>>,
    settings: NewtonSettings,
) -> (OnGroups<LawResidual>, TotalResidual) {
    let scales = before.map(|_| operator.force_scales(at));
    let of_group = |(&g, laws): (&GroupId, &ContactLaws<'_>)| {
        let known = before.zip(scales.as_ref());
        (
            g,
            laws.residual(
                &at[&g],
                known.map(|(before, scales)| (&before[&g], &scales[&g][..])),
                operator.slack(),
            ),
        )
    };
    let residuals = laws.iter().map(of_group).collect();
    let mut total = operator.total(&residuals);
    if total.merit > settings.law * (total.forces + operator.acting()) {
        total.largest = f64::INFINITY;
    }
    (residuals, total)
}

/// The fraction of a step to `target` that reduces the merit, or else the one with the least merit. Collective.
fn line_search<O: ContactOperator>(
    operator: &O,
    laws: &OnGroups<ContactLaws<'_>>,
    (from, merit): (OnGroups<Iterate>, f64),
    target: OnGroups<Iterate>,
    (whole, of_whole): (OnGroups<LawResidual>, TotalResidual),
    settings: NewtonSettings,
) -> (OnGroups<Iterate>, f64, OnGroups<Statuses>) {
    let lessens =
        |total: TotalResidual, part: f64| total.merit <= (1.0 - SUFFICIENT_DECREASE * part) * merit;
    let statuses = |residuals: OnGroups<LawResidual>| {
        let all = residuals.into_iter();
        all.map(|(g, residual)| (g, residual.statuses)).collect()
    };
    if merit == f64::INFINITY || of_whole.parts || lessens(of_whole, 1.0) {
        return (target, of_whole.merit, statuses(whole));
    }
    let mut best = (target.clone(), of_whole.merit, whole);
    let mut part = 0.5;
    while part >= SMALLEST {
        let there = operator.between(&from, &target, part);
        let (residuals, total) = evaluate_laws(operator, laws, &there, None, settings);
        if lessens(total, part) {
            return (there, total.merit, statuses(residuals));
        }
        if total.merit < best.1 {
            best = (there, total.merit, residuals);
        }
        part *= 0.5;
    }
    let (there, merit, residuals) = best;
    (there, merit, statuses(residuals))
}

impl LawResidual {
    /// The residual of a single group.
    pub fn of_group(&self) -> TotalResidual {
        let Statuses { closed, points, .. } = &self.statuses;
        let parts = |status: &PointStatus| matches!(status, PointStatus::Parts { .. });
        TotalResidual {
            merit: self.squares,
            forces: self.forces,
            largest: self.largest,
            active: closed.iter().filter(|closed| **closed).count(),
            wrong: self.wrong.len(),
            parts: points.iter().any(parts),
        }
    }
}
