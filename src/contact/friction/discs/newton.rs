//! Semismooth Newton on discs, and dashpots where it gets no further.

use super::{Act, Discs, Found, Look, Place, Rest, State};
use crate::contact::active_set::{ContactProblem, FORCE_TOLERANCE};
use crate::contact::friction::Status;
use crate::vector::{dot, largest};

/// Most steps of Newton's method.
const STEPS: usize = 40;
/// The same between two changes of dashpots.
const DAMPED_STEPS: usize = 15;
/// Part of a step that is too small.
const SMALLEST: f64 = 1e-3;
/// Part of the merit, for every part of a step, by which that has to lessen it.
const LESSENS: f64 = 1e-4;
/// What is missed that can't be less.
const ROUND_OFF: f64 = 1e-15;
/// Dashpots, relative to stiffness and time: the first, the weakest and the strongest ones.
const DASHPOTS: [f64; 3] = [0.1, 1e-4, 10.0];
/// Part of the way before that isn't less, and how often that may be.
const SLOWER: f64 = 0.9;
const PATIENCE: usize = 3;
/// What resists a motion relative to springs, that is round-off: nothing does.
const NO_RESISTANCE: f64 = 1e-10;
/// Work of loads along a motion that friction doesn't take, relative to the terms that it is a sum of, that is no round-off.
const SURPLUS: f64 = 1e-9;
/// Part of the fastest of jumps by which others change that stay as they are.
const STAYS_OPEN: f64 = 1e-6;
/// Most changes of dashpots.
const CHANGES: usize = 24;

impl Discs<'_> {
    /// The solution, found from where these statuses are right, whether that took more than Newton's method, and whether
    /// things slide on and on.
    pub(super) fn solve(&self, status: &[Status]) -> (Found, bool, bool) {
        let start = self.start();
        let state = self.begin(status, &start);
        let at_once = self.newton(&start, &state, STEPS);
        if at_once.converged() {
            return (at_once, false, false);
        }
        if let Some(found) = self.along_path() {
            return (found, true, false);
        }
        let mut steps = at_once.steps;
        match self.with_dashpots(&start, &state, &mut steps) {
            Rest::Found(found) => (Found { steps, ..found }, true, false),
            Rest::Slides => (Found { steps, ..at_once }, true, true),
            Rest::Unknown => (Found { steps, ..at_once }, true, false),
        }
    }

    /// The place from which open jumps go where the load drives them.
    pub(super) fn start(&self) -> Place {
        let rows = self.contact.rows.len();
        self.place(self.contact.center.to_vec(), vec![0.0; rows])
    }

    /// Goes from one position to the next of a problem with dashpots, which weaken as long as that is found; to no end
    /// where things slide on and on.
    fn with_dashpots(&self, start: &Place, state: &State, steps: &mut usize) -> Rest {
        let [mut dashpots, weakest, strongest] = DASHPOTS;
        let (mut place, mut state) = (start.clone(), state.clone());
        let (mut last, mut sliding) = (f64::INFINITY, 0);
        for _ in 0..CHANGES {
            let found = self.damped(dashpots, &place, &state);
            *steps += found.steps;
            if !found.converged() {
                if dashpots >= strongest {
                    break;
                }
                dashpots = (4.0 * dashpots).min(strongest);
                continue;
            }
            let ways = found.place.jumps.iter().zip(&place.jumps);
            let ways: Vec<f64> = ways.map(|(to, from)| to - from).collect();
            let way = largest(&ways);
            if dashpots <= weakest && way > SLOWER * last {
                sliding += 1;
                if sliding >= PATIENCE && self.slides_on(&found, &ways) {
                    return Rest::Slides;
                }
            }
            let slows = way < last;
            last = way;
            dashpots = (0.25 * dashpots).max(weakest);
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

    /// Whether things slide on and on where jumps go these ways: the bodies don't resist, nothing that is open closes on
    /// the way, and loads do more work than all contacts take, that press as they do there and hold as much as they can.
    fn slides_on(&self, found: &Found, ways: &[f64]) -> bool {
        let Found { place, state, .. } = found;
        if self.resists(ways) > NO_RESISTANCE {
            return false;
        }
        let along = |row: &[(usize, f64)]| row.iter().map(|&(i, c)| c * ways[i]).sum::<f64>();
        let rows = self.contact.rows.iter().map(along);
        let all: Vec<f64> = ways.iter().copied().chain(rows).collect();
        let far = largest(ways);
        let [mut taken, mut closes] = [0.0; 2];
        for i in (0..all.len()).filter(|&i| !self.is_tangential[i]) {
            match state.closed[i] {
                true => taken += (place.forces[i] * all[i]).abs(),
                false => closes = f64::max(closes, all[i]),
            }
        }
        for point in &self.points {
            let [along, across] = point.tangents.map(|i| i.map_or(0.0, |i| all[i]));
            taken += self.bound(point, place, &state.closed) * along.hypot(across);
        }
        let work = dot(self.contact.c, ways);
        let terms = self.contact.c.iter().zip(ways);
        let terms: f64 = terms.map(|(c, way)| (c * way).abs()).sum();
        closes <= STAYS_OPEN * far && work - taken > SURPLUS * (terms + taken)
    }

    /// How much the bodies resist jumps that grow so, relative to springs as stiff as they are.
    fn resists(&self, ways: &[f64]) -> f64 {
        let mut forces = vec![0.0; ways.len()];
        self.contact.subtract(ways, &mut forces);
        let springs = ways
            .iter()
            .zip(&self.stiffness)
            .map(|(way, r)| r * way * way);
        -dot(ways, &forces) / springs.sum::<f64>()
    }

    /// The solution where every jump is held by a dashpot at where it is.
    fn damped(&self, dashpots: f64, place: &Place, state: &State) -> Found {
        let contact = &self.contact;
        let mut h = contact.h.to_owned();
        let (mut c, mut c_scale) = (contact.c.to_vec(), contact.c_scale.to_vec());
        for (i, t) in place.jumps.iter().enumerate() {
            let own = dashpots * self.stiffness[i];
            h[(i, i)] += own;
            c[i] += own * t;
            c_scale[i] += (own * t).abs();
        }
        let damped = Discs {
            contact: ContactProblem {
                h: h.as_ref(),
                c: &c,
                c_scale: &c_scale,
                ..*contact
            },
            points: self.points.clone(),
            is_tangential: self.is_tangential.clone(),
            stiffness: self.stiffness.clone(),
            acting: self.acting,
        };
        damped.newton(place, state, DAMPED_STEPS)
    }

    /// Newton's method from a place where limits do this.
    pub(super) fn newton(&self, start: &Place, state: &State, most: usize) -> Found {
        let mut place = start.clone();
        let mut state = state.clone();
        let mut merit = f64::INFINITY;
        let mut best: Option<Found> = None;
        for steps in 1..=most {
            let target = self.step(&place, &state);
            let look = self.look(&target, Some(&state));
            if look.merit.is_nan() {
                break;
            }
            if let Some(found) = &mut best
                && look.missed > 0.5 * found.missed
            {
                found.steps = steps;
                break;
            }
            if look.missed <= FORCE_TOLERANCE {
                let found = Found {
                    place: target.clone(),
                    state: state.clone(),
                    missed: look.missed,
                    steps,
                };
                let exact = found.missed <= ROUND_OFF;
                best = Some(found);
                if exact {
                    break;
                }
            }
            let opened = look.state.opened.clone();
            (place, merit, state) = self.part_of_way(place, merit, target, look);
            state.opened = opened;
        }
        best.unwrap_or(Found {
            place,
            state,
            missed: f64::INFINITY,
            steps: most,
        })
    }

    /// The part of the way from a place with this `merit` to a `target` that lessens it; the whole way if none does.
    fn part_of_way(
        &self,
        place: Place,
        merit: f64,
        target: Place,
        whole: Look,
    ) -> (Place, f64, State) {
        let lessens = |look: &Look, part: f64| look.merit <= (1.0 - LESSENS * part) * merit;
        // The law of what parts is no function of the place.
        let parts = |act: &Act| matches!(act, Act::Parts { .. });
        let parts = whole.state.points.iter().any(parts);
        if merit == f64::INFINITY || parts || lessens(&whole, 1.0) {
            return (target, whole.merit, whole.state);
        }
        let m = place.jumps.len();
        let mut part = 0.5;
        while part >= SMALLEST {
            let between = |a: &[f64], b: &[f64]| -> Vec<f64> {
                a.iter().zip(b).map(|(a, b)| a + part * (b - a)).collect()
            };
            let jumps = between(&place.jumps, &target.jumps);
            let there = self.place(jumps, between(&place.forces[m..], &target.forces[m..]));
            let look = self.look(&there, None);
            if lessens(&look, part) {
                return (there, look.merit, look.state);
            }
            part *= 0.5;
        }
        (target, whole.merit, whole.state)
    }
}
