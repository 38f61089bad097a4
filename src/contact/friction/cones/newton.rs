//! Semismooth Newton on friction cones, with viscous regularization where it stalls.

use std::convert::Infallible;

use contact_dd_partition::id::{GroupId, OnGroups};

use super::{ACCEPTABLE, Found, FrictionCones, Rest};
use crate::contact::active_set::{ContactProblem, FORCE_TOLERANCE};
use crate::contact::friction::{FrictionProblem, Status};
use crate::contact::interior_point::{ConvexProblem, GivenFriction, NearSolution};
use crate::contact::law::{PointLaw, PointStatus};
use crate::contact::laws::{Iterate, LawResidual, Past, Statuses};
use crate::contact::newton::{
    ContactOperator, NewtonSettings, NewtonStep, StepAccuracy, TotalResidual, newton,
};
use crate::vector::{between, dot, largest};

/// Maximum number of steps of Newton's method.
const STEPS: usize = 40;
/// Maximum number of steps between two changes of the viscosity.
const DAMPED_STEPS: usize = 15;
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
/// Viscosity of all jumps relative to stiffness and time: first, least and largest.
const VISCOSITIES: [f64; 3] = [0.1, 1e-4, 10.0];
/// Ratio to the last motion that counts as no decrease, and how often this may occur.
const NO_DECREASE: f64 = 0.9;
const PATIENCE: usize = 3;
/// Resistance to a motion, relative to that of springs, that counts as zero.
const NO_RESISTANCE: f64 = 1e-10;
/// Work of loads beyond that of friction, relative to its terms, that exceeds round-off.
const WORK_TOLERANCE: f64 = 1e-9;
/// Change of a jump, relative to the fastest one, that counts as zero.
const NO_CHANGE: f64 = 1e-6;
/// Maximum number of changes of the viscosity.
const CHANGES: usize = 24;

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
        problem.try_paths(|end, pivots| {
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

    /// Steps through solutions of a regularized problem whose viscosity falls as long as they are found; sliding
    /// without end is detected.
    fn regularized(&self, start: &Iterate, state: &Statuses, steps: &mut usize) -> Rest {
        let [mut viscosity, weakest, strongest] = VISCOSITIES;
        let (mut place, mut state) = (start.clone(), state.clone());
        let (mut last, mut sliding) = (f64::INFINITY, 0);
        for _ in 0..CHANGES {
            let found = self.damped(viscosity, &place, &state);
            *steps += found.steps;
            if !found.converged() {
                if viscosity >= strongest {
                    break;
                }
                viscosity = (4.0 * viscosity).min(strongest);
                continue;
            }
            let changes = found.place.jumps.iter().zip(&place.jumps);
            let changes: Vec<f64> = changes.map(|(to, from)| to - from).collect();
            let change = largest(&changes);
            if viscosity <= weakest && change > NO_DECREASE * last {
                sliding += 1;
                if sliding >= PATIENCE && self.slides_on(&found, &changes) {
                    return Rest::Slides;
                }
            }
            let slows = change < last;
            last = change;
            viscosity = (0.25 * viscosity).max(weakest);
            let of_rows = found.place.forces[self.contact.c.len()..].to_vec();
            place = self.place(found.place.jumps, of_rows);
            state = found.state;
            if !slows {
                continue;
            }
            let free = self.newton(&place, &state, DAMPED_STEPS);
            *steps += free.steps;
            if free.converged() {
                return Rest::Found(free);
            }
        }
        Rest::Unknown
    }

    /// True if bodies slide without end along this motion of jumps: the bodies don't resist, no open limit closes, and
    /// loads do more work than all contacts dissipate, under their present pressure and with friction at its bound.
    fn slides_on(&self, found: &Found, changes: &[f64]) -> bool {
        let Found { place, state, .. } = found;
        if self.resistance(changes) > NO_RESISTANCE {
            return false;
        }
        let along = |row: &[(usize, f64)]| row.iter().map(|&(i, c)| c * changes[i]).sum::<f64>();
        let rows = self.contact.rows.iter().map(along);
        let all: Vec<f64> = changes.iter().copied().chain(rows).collect();
        let far = largest(changes);
        let [mut taken, mut closes] = [0.0; 2];
        for i in (0..all.len()).filter(|&i| !self.laws.is_tangential[i]) {
            match state.closed[i] {
                true => taken += (place.forces[i] * all[i]).abs(),
                false => closes = f64::max(closes, all[i]),
            }
        }
        for point in &self.laws.points {
            let [along, across] = point.tangents.map(|i| i.map_or(0.0, |i| all[i]));
            taken += self.laws.point(point, place, &state.closed).bound * along.hypot(across);
        }
        let work = dot(self.contact.c, changes);
        let terms = self.contact.c.iter().zip(changes);
        let terms: f64 = terms.map(|(c, change)| (c * change).abs()).sum();
        closes <= NO_CHANGE * far && work - taken > WORK_TOLERANCE * (terms + taken)
    }

    /// Resistance of the bodies to a motion of jumps, relative to springs as stiff as they are.
    fn resistance(&self, changes: &[f64]) -> f64 {
        let mut forces = vec![0.0; changes.len()];
        self.contact.subtract(changes, &mut forces);
        let springs = changes
            .iter()
            .zip(&self.laws.stiffness)
            .map(|(change, r)| r * change * change);
        -dot(changes, &forces) / springs.sum::<f64>()
    }

    /// Solution with a viscous resistance of every jump to leaving its present value.
    fn damped(&self, viscosity: f64, place: &Iterate, state: &Statuses) -> Found {
        let contact = &self.contact;
        let mut h = contact.h.to_owned();
        let (mut c, mut c_scale) = (contact.c.to_vec(), contact.c_scale.to_vec());
        for (i, t) in place.jumps.iter().enumerate() {
            let own = viscosity * self.laws.stiffness[i];
            h[(i, i)] += own;
            c[i] += own * t;
            c_scale[i] += (own * t).abs();
        }
        let damped = FrictionCones {
            contact: ContactProblem {
                h: h.as_ref(),
                c: &c,
                c_scale: &c_scale,
                ..*contact
            },
            laws: self.laws.clone(),
            sizes: self.sizes.clone(),
            acting: self.acting,
        };
        damped.newton(place, state, DAMPED_STEPS)
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
