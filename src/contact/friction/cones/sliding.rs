//! Viscous regularization of all jumps: its solutions, as the viscosity falls, lead to a solution or show that a body
//! slides without end.
//!
//! A load that friction can't hold moves its body the farther the less viscous the jumps are: the part of its work that
//! contacts leave to the viscosity stays the same, however small that is. At the limit of friction this part vanishes
//! with the viscosity, and beyond it the motion ends.

use super::{Found, FrictionCones, Rest};
use crate::contact::active_set::ContactProblem;
use crate::contact::laws::{Iterate, Statuses};
use crate::vector::{dot, largest};

/// Maximum number of Newton's steps between two changes of the viscosity.
const STEPS: usize = 15;
/// Viscosity of all jumps relative to stiffness and time: first, least and largest.
const VISCOSITIES: [f64; 3] = [0.1, 1e-4, 10.0];
/// Least viscosity of a motion without end: round-off of its distance is far below the bodies' deformation.
const FAINTEST: f64 = 1e-10;
/// Factor by which it falls, and the largest one after motions that weren't found.
const FALLS: [f64; 2] = [0.1, 0.6];
/// Ratio to the last motion that counts as no decrease, and how often this may occur.
const SLOWER: f64 = 0.9;
const PATIENCE: usize = 3;
/// Ratio of the work left to the viscosity to that of the last motion from which on it is constant.
const LASTING: f64 = 0.9;
/// Resistance to a motion, relative to that of springs, that counts as zero.
const NO_RESISTANCE: f64 = 1e-10;
/// Work of loads beyond that of friction, relative to its terms, that exceeds round-off.
const SURPLUS: f64 = 1e-9;
/// Round-off of the work of loads, relative to the terms that they are sums of.
const ROUND_OFF: f64 = 1e-12;
/// Change of a jump, relative to the fastest one, that counts as zero.
const STAYS_OPEN: f64 = 1e-6;
/// Maximum number of changes of the viscosity.
const CHANGES: usize = 24;

impl FrictionCones<'_> {
    /// Steps through solutions of a regularized problem whose viscosity falls as long as they are found; sliding
    /// without end is detected.
    pub(super) fn regularized(&self, start: &Iterate, state: &Statuses, steps: &mut usize) -> Rest {
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
            let change = largest(&changes(&place, &found));
            if viscosity <= weakest && change > SLOWER * last {
                sliding += 1;
                if sliding >= PATIENCE
                    && let end @ (Rest::Found(_) | Rest::Slides) =
                        self.as_viscosity_vanishes(&place, &state, steps)
                {
                    return end;
                }
            }
            let slows = change < last;
            last = change;
            viscosity = (0.25 * viscosity).max(weakest);
            (place, state) = self.reached(found);
            if !slows {
                continue;
            }
            let free = self.newton(&place, &state, STEPS);
            *steps += free.steps;
            if free.converged() {
                return Rest::Found(free);
            }
        }
        Rest::Unknown
    }

    /// The end of motions as the viscosity vanishes. A body slides without end if they become longer and longer, bodies
    /// resist less and less, and a constant part of the loads' work is left to the viscosity; where they become shorter,
    /// the bodies come to rest nearby.
    pub(super) fn as_viscosity_vanishes(
        &self,
        start: &Iterate,
        state: &Statuses,
        steps: &mut usize,
    ) -> Rest {
        let [mut falls, slowest] = FALLS;
        let [first, _, strongest] = VISCOSITIES;
        let (mut place, mut state) = (start.clone(), state.clone());
        let (mut before, mut viscosity) = (f64::INFINITY, first);
        let (mut last, mut left, mut slows) = (0.0, f64::INFINITY, 0);
        while viscosity >= FAINTEST {
            let found = self.damped(viscosity, &place, &state);
            *steps += found.steps;
            if !found.converged() {
                let is_first = before == f64::INFINITY;
                falls = if is_first { falls } else { falls.sqrt() };
                if falls > slowest || is_first && viscosity >= strongest {
                    return Rest::Unknown;
                }
                viscosity = match is_first {
                    true => viscosity / falls,
                    false => before * falls,
                };
                continue;
            }
            let changes = changes(&place, &found);
            let change = largest(&changes);
            let surplus = self.surplus(&found, &changes);
            let lasts = change > last && surplus > SURPLUS.max(LASTING * left);
            if lasts && self.goes_on(&found, &changes) {
                return Rest::Slides;
            }
            (place, state) = self.reached(found);
            if change <= last {
                let free = self.newton(&place, &state, STEPS);
                *steps += free.steps;
                slows += 1;
                if free.converged() {
                    return Rest::Found(free);
                }
                if slows == PATIENCE {
                    return Rest::Unknown;
                }
            }
            (last, left, before) = (change, surplus, viscosity);
            viscosity *= falls;
        }
        Rest::Unknown
    }

    /// The iterate and the statuses of a motion's end.
    fn reached(&self, found: Found) -> (Iterate, Statuses) {
        let Found { place, state, .. } = found;
        let of_rows = place.forces[self.contact.c.len()..].to_vec();
        (self.place(place.jumps, of_rows), state)
    }

    /// True if nothing ends this motion of jumps: the bodies don't resist, and no open limit closes.
    fn goes_on(&self, found: &Found, changes: &[f64]) -> bool {
        let all = self.of_limits(changes);
        let open = (0..all.len())
            .filter(|&i| !self.laws.is_tangential[i] && !found.state.closed[i])
            .map(|i| all[i]);
        let closes = open.fold(0.0, f64::max);
        self.resists(changes) <= NO_RESISTANCE && closes <= STAYS_OPEN * largest(changes)
    }

    /// The work of loads along a motion of jumps beyond their round-off and what all contacts dissipate, under their present
    /// pressure and with friction at its bound, relative to the terms of both.
    fn surplus(&self, found: &Found, changes: &[f64]) -> f64 {
        let Found { place, state, .. } = found;
        let all = self.of_limits(changes);
        let closed = (0..all.len()).filter(|&i| !self.laws.is_tangential[i] && state.closed[i]);
        let mut taken: f64 = closed.map(|i| (place.forces[i] * all[i]).abs()).sum();
        for point in &self.laws.points {
            let [along, across] = point.tangents.map(|i| i.map_or(0.0, |i| all[i]));
            taken += self.laws.point(point, place, &state.closed).bound * along.hypot(across);
        }
        let work = dot(self.contact.c, changes);
        let terms = |loads: &[f64]| -> f64 {
            let terms = loads.iter().zip(changes);
            terms.map(|(load, change)| (load * change).abs()).sum()
        };
        let round_off = ROUND_OFF * terms(self.contact.c_scale);
        (work - taken - round_off) / (terms(self.contact.c) + taken)
    }

    /// Changes of all limits along changes of jumps.
    fn of_limits(&self, changes: &[f64]) -> Vec<f64> {
        let along = |row: &[(usize, f64)]| row.iter().map(|&(i, c)| c * changes[i]).sum::<f64>();
        let rows = self.contact.rows.iter().map(along);
        changes.iter().copied().chain(rows).collect()
    }

    /// Resistance of the bodies to a motion of jumps, relative to springs as stiff as they are.
    fn resists(&self, changes: &[f64]) -> f64 {
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
        damped.newton(place, state, STEPS)
    }
}

/// Changes of jumps from an iterate to the end of a motion.
fn changes(from: &Iterate, found: &Found) -> Vec<f64> {
    let jumps = found.place.jumps.iter().zip(&from.jumps);
    jumps.map(|(to, from)| to - from).collect()
}
