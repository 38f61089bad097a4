//! Semismooth Newton on friction cones, and where it goes on from where it stalls.

use std::convert::Infallible;

use contact_dd_partition::id::{GroupId, OnGroups};

use super::{ACCEPTABLE, Found, FrictionCones, Rest};
use crate::contact::active_set::FORCE_TOLERANCE;
use crate::contact::friction::{FrictionProblem, Status};
use crate::contact::interior_point::{ConvexProblem, GivenFriction, NearSolution};
use crate::contact::law::{PointLaw, PointStatus};
use crate::contact::laws::{Iterate, LawResidual, Past, Statuses};
use crate::contact::newton::{
    ContactOperator, NewtonSettings, NewtonStep, StepAccuracy, TotalResidual, newton,
};
use crate::vector::between;

/// Maximum number of steps of Newton's method.
const STEPS: usize = 40;
/// Accepted residual of the law, relative to the acting forces.
const LAW: f64 = 1e-9;
/// Round-off of the residual.
const ROUND_OFF: f64 = 1e-15;
/// Part of its bound that the force of a slipping point may lack, and the part of a force's terms that is round-off: a
/// whole bound is small against the terms of an unresisted slip.
const RESIDUAL_OF_BOUND: f64 = 1e-3;
const RESIDUAL_OF_TERMS: f64 = 1e-14;
/// Force, relative to its terms, up to which a limit keeps its status.
const STATUS_TOLERANCE: f64 = 1e-15;

impl FrictionCones<'_> {
    /// The solution from the iterate of these statuses, with two flags: more than Newton's method was needed; a body
    /// slides without end.
    pub(super) fn solve(
        &self,
        problem: &FrictionProblem<'_>,
        status: &[Status],
    ) -> (Found, bool, bool) {
        let start = self.start();
        let state = self.laws.begin(status, &start);
        let at_once = self.newton(&start, &state, STEPS);
        let holds = at_once.converged();
        if holds && !self.misses_a_bound(&at_once) {
            return (at_once, false, false);
        }
        let mut steps = at_once.steps;
        let near = self.after_interior_point(&mut steps);
        let keeps_bounds = |found: &Found| !self.misses_a_bound(found);
        if !holds && near.is_none() {
            match self.as_viscosity_vanishes(&start, &state, &mut steps) {
                Rest::Found(found) if keeps_bounds(&found) => {
                    return (Found { steps, ..found }, true, false);
                }
                // A path may lead to an equilibrium that a motion from the start passes by.
                Rest::Slides => {
                    return match self.along_paths(problem, &mut steps, 1) {
                        Some(found) => (Found { steps, ..found }, true, false),
                        None => (Found { steps, ..at_once }, true, true),
                    };
                }
                Rest::Found(_) | Rest::Unknown => {}
            }
        }
        let found = match near.as_ref().is_some_and(keeps_bounds) {
            true => near,
            false => self.along_lemke_s_path(problem, &mut steps).or(near),
        };
        match (found, holds) {
            (Some(found), _) => return (Found { steps, ..found }, true, false),
            (None, true) => return (Found { steps, ..at_once }, false, false),
            (None, false) => {}
        }
        match self.regularized(&start, &state, &mut steps) {
            Rest::Found(found) => (Found { steps, ..found }, true, false),
            Rest::Slides => (Found { steps, ..at_once }, true, true),
            Rest::Unknown => (Found { steps, ..at_once }, true, false),
        }
    }

    /// True if the force of a slipping point isn't at its bound, beyond round-off: an unresisted slip is of any size,
    /// and so are the terms to which the law's residual is relative.
    fn misses_a_bound(&self, found: &Found) -> bool {
        let Found { place, state, .. } = found;
        let residuals = self.laws.residuals(place, state);
        let mut points = self.laws.points.iter().zip(&state.points);
        points.any(|(point, status)| {
            let bound = self.laws.point(point, place, &state.closed).bound;
            let miss = point
                .limits()
                .map(|i| residuals[i].abs())
                .fold(0.0, f64::max);
            matches!(status, PointStatus::Slips { .. })
                && miss > RESIDUAL_OF_BOUND * bound
                && miss > RESIDUAL_OF_TERMS * self.force_scale(point.first, place)
        })
    }

    /// The solution of a convex problem, from that of the interior-point method.
    pub(super) fn after_interior_point(&self, steps: &mut usize) -> Option<Found> {
        let points = self.given_friction()?;
        let near = self.near(&points);
        *steps += near.steps;
        let start = self.place(near.jumps, near.of_rows);
        let mut state = self.laws.residual(&start, None, 0.0).statuses;
        state.past = vec![Past::Closed; state.points.len()];
        let found = self.newton(&start, &state, STEPS);
        *steps += found.steps;
        found.converged().then_some(found)
    }

    /// The points, if the bounds of all are given.
    fn given_friction(&self) -> Option<Vec<GivenFriction>> {
        let given = |point: &PointLaw| {
            let bound = point.bound;
            let is_given =
                bound.coefficient == 0.0 && (!bound.only_closed || bound.cohesion == 0.0);
            is_given.then_some(GivenFriction {
                limits: point.tangents,
                prescribed: point.prescribed,
                bound: bound.cohesion,
            })
        };
        self.laws.points.iter().map(given).collect()
    }

    /// The interior-point method's solution where the bounds of all points are given.
    fn near(&self, points: &[GivenFriction]) -> NearSolution {
        let contact = &self.contact;
        let scale: Vec<f64> = self.sizes.iter().map(|size| size * size).collect();
        ConvexProblem {
            h: contact.h,
            c: contact.c,
            scale: &scale[..contact.c.len()],
            rows: contact.rows,
            bounds: contact.bounds,
            points,
        }
        .solve()
    }

    /// The solution at the end of Lemke's path.
    pub(super) fn along_lemke_s_path(
        &self,
        problem: &FrictionProblem<'_>,
        steps: &mut usize,
    ) -> Option<Found> {
        self.along_paths(problem, steps, usize::MAX)
    }

    /// The solution at the end of one of at most so many of Lemke's paths.
    fn along_paths(
        &self,
        problem: &FrictionProblem<'_>,
        steps: &mut usize,
        most: usize,
    ) -> Option<Found> {
        problem.try_paths(most, |end, pivots| {
            *steps += pivots;
            let end = end?;
            // Without resistance, slips in both directions end between both bounds there.
            let start = self.place(end.jumps.clone(), end.of_rows.clone());
            let mut state = self.laws.begin(&end.status, &start);
            state.past.fill(Past::Opened);
            let found = self.newton(&start, &state, STEPS);
            *steps += found.steps;
            found.converged().then_some(found)
        })
    }

    /// Iterate from which the load moves open jumps.
    pub(super) fn start(&self) -> Iterate {
        let rows = self.contact.rows.len();
        self.place(self.contact.center.to_vec(), vec![0.0; rows])
    }

    /// Newton's method from an iterate, with the equations of these statuses first.
    pub(super) fn newton(&self, start: &Iterate, state: &Statuses, most: usize) -> Found {
        let settings = NewtonSettings {
            most,
            patience: most,
            tolerance: FORCE_TOLERANCE,
            acceptable: ACCEPTABLE,
            round_off: ROUND_OFF,
            law: LAW,
            softens: true,
        };
        let Ok(found) = newton(
            &mut Dense(self),
            &only(self.laws.clone()),
            &only(start.clone()),
            &only(state.clone()),
            settings,
        );
        let (at, statuses) = (found.at.into_values(), found.statuses.into_values());
        let (place, state) = at
            .zip(statuses)
            .next()
            .unwrap_or_else(|| (start.clone(), state.clone()));
        Found {
            place,
            state,
            residual: found.residual,
            steps: found.steps,
        }
    }
}

/// Dense problem as an operator of one group.
struct Dense<'d, 'a>(&'d FrictionCones<'a>);

/// Number of its group.
const ONLY: GroupId = GroupId::new(0);

fn only<T>(of_group: T) -> OnGroups<T> {
    OnGroups::from([(ONLY, of_group)])
}

impl ContactOperator for Dense<'_, '_> {
    type Error = Infallible;

    fn step(
        &mut self,
        from: &OnGroups<Iterate>,
        statuses: &OnGroups<Statuses>,
        _: StepAccuracy,
    ) -> Result<OnGroups<Iterate>, Infallible> {
        Ok(only(self.0.step(&from[&ONLY], &statuses[&ONLY])))
    }

    fn between(
        &self,
        from: &OnGroups<Iterate>,
        to: &OnGroups<Iterate>,
        part: f64,
    ) -> OnGroups<Iterate> {
        let (from, to) = (&from[&ONLY], &to[&ONLY]);
        let m = from.jumps.len();
        let jumps = between(&from.jumps, &to.jumps, part);
        only(
            self.0
                .place(jumps, between(&from.forces[m..], &to.forces[m..], part)),
        )
    }

    fn force_scales(&self, at: &OnGroups<Iterate>) -> OnGroups<Vec<f64>> {
        let at = &at[&ONLY];
        let all = 0..at.forces.len();
        only(all.map(|i| self.0.force_scale(i, at)).collect())
    }

    fn total(&self, residuals: &OnGroups<LawResidual>) -> TotalResidual {
        let total = residuals[&ONLY].of_group();
        TotalResidual {
            merit: total.merit.sqrt(),
            forces: total.forces.sqrt(),
            ..total
        }
    }

    fn acting(&self) -> f64 {
        self.0.acting
    }

    fn slack(&self) -> f64 {
        STATUS_TOLERANCE
    }

    fn accuracy(&self, _: &TotalResidual) -> StepAccuracy {
        StepAccuracy::Full
    }

    fn record(&mut self, _: NewtonStep) -> Result<(), Infallible> {
        Ok(())
    }
}
