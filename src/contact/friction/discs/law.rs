//! The laws of points with discs at a place: what every limit should do there, and what it misses.

use super::{Act, Discs, LAW, Look, Place, Point, STAYS, State};
use crate::contact::friction::Status;

impl Discs<'_> {
    /// How far limit i is beyond its bound, or has slipped (m).
    pub(super) fn beyond(&self, i: usize, place: &Place) -> f64 {
        let m = place.jumps.len();
        let value = match place.jumps.get(i) {
            Some(t) => *t,
            None => self.contact.rows.value(i - m, &place.jumps),
        };
        value - self.contact.bounds[i]
    }

    /// Slip and force of a point.
    pub(super) fn tangential(&self, point: &Point, place: &Place) -> [[f64; 2]; 2] {
        let slip = |i: usize| self.beyond(i, place);
        [
            [
                point.tangents[0].map_or(0.0, slip),
                point.tangents[1].map_or(point.prescribed, slip),
            ],
            point
                .tangents
                .map(|tangent| tangent.map_or(0.0, |i| place.forces[i])),
        ]
    }

    /// The bound of a point's force.
    pub(super) fn bound(&self, point: &Point, place: &Place, closed: &[bool]) -> f64 {
        let is_closed = point.normal.is_some_and(|n| closed[n]);
        let pressed = point.normal.filter(|_| is_closed);
        point
            .own
            .bound
            .at(pressed.map_or(0.0, |n| place.forces[n]), is_closed)
    }

    /// ξ_t of a point with this bound. Along what is prescribed the force is what the bound leaves.
    pub(super) fn reach(&self, point: &Point, place: &Place, bound: f64) -> [f64; 2] {
        let [slip, mut force] = self.tangential(point, place);
        if point.prescribed != 0.0 {
            let along = force[0].abs().min(bound);
            force[1] = ((bound - along) * (bound + along))
                .sqrt()
                .copysign(point.prescribed);
        }
        let r = self.stiffness[point.own.limit];
        [0, 1].map(|k| force[k] + r * slip[k])
    }

    /// What a point with this ξ_t and this bound does.
    pub(super) fn act(&self, point: &Point, xi: [f64; 2], bound: f64, slack: f64) -> Act {
        let size = xi[0].hypot(xi[1]);
        if size <= bound + slack && point.prescribed == 0.0 {
            return Act::Sticks;
        }
        let r = self.stiffness[point.own.limit];
        let rest = (size - bound).max(f64::EPSILON * size);
        Act::Slips {
            e: xi.map(|x| x / size),
            across: point.across(r * bound / rest),
        }
    }

    /// What point k does whose cohesion vanishes as it opens, where it parted `before` or would open once more; `None` where
    /// the state `now` is right.
    fn parting(&self, k: usize, place: &Place, before: &State, now: &State) -> Option<Act> {
        let point = &self.points[k];
        let bound = point.own.bound;
        let n = point.normal?;
        if !bound.only_closed || bound.cohesion == 0.0 || point.prescribed != 0.0 {
            return None;
        }
        let [slip, force] = self.tangential(point, place);
        let [way, size] = [slip, force].map(|v| v[0].hypot(v[1]));
        let parts = || match way > 0.0 {
            true => Act::Parts {
                e: slip.map(|s| s / way),
                across: point.across(size / way),
            },
            false => Act::Parts {
                e: force.map(|f| f / size),
                across: 0.0,
            },
        };
        let along = |v: [f64; 2], e: [f64; 2]| v[0] * e[0] + v[1] * e[1];
        match before.points[k] {
            Act::Slips { .. } | Act::Sticks if now.points[k] == Act::Rests => {
                (before.opened[k] && way + size > 0.0).then(parts)
            }
            Act::Parts { e, .. } if along(force, e) < 0.0 || way == 0.0 => Some(Act::Rests),
            Act::Parts { e, .. } if along(slip, e) < 0.0 => Some(Act::Sticks),
            Act::Parts { .. } if size > bound.cohesion => {
                let whole = bound.at(place.forces[n], true);
                Some(self.act(point, self.reach(point, place, whole), whole, 0.0))
            }
            Act::Parts { .. } => Some(parts()),
            _ => None,
        }
        .filter(|_| before.closed[n])
    }

    /// What limits with these statuses do at a place.
    pub(super) fn begin(&self, status: &[Status], place: &Place) -> State {
        let closed: Vec<bool> = status.iter().map(|status| status.is_closed()).collect();
        let act = |point: &Point| {
            let own = status[point.own.limit];
            let is_closed = point.normal.is_some_and(|n| closed[n]);
            if !is_closed && point.own.bound.only_closed {
                return Act::Rests;
            }
            let [slip, _] = self.tangential(point, place);
            let size = slip[0].hypot(slip[1]);
            if size == 0.0 || own.is_closed() && point.prescribed == 0.0 {
                return Act::Sticks;
            }
            let bound = self.bound(point, place, &closed);
            Act::Slips {
                e: slip.map(|s| s / size),
                across: point.across(bound / size),
            }
        };
        State {
            points: self.points.iter().map(act).collect(),
            closed,
            opened: vec![false; self.points.len()],
        }
    }

    /// How right a place is, which within round-off stays what it was `before`; only its merit counts where that isn't
    /// known.
    pub(super) fn look(&self, place: &Place, before: Option<&State>) -> Look {
        let scales: Option<Vec<f64>> = before.map(|_| {
            let all = 0..place.forces.len();
            all.map(|i| self.force_scale(i, place)).collect()
        });
        let slack = |i: usize, was: Option<bool>| match (was, &scales) {
            (Some(true), Some(scales)) => STAYS * scales[i],
            (Some(false), Some(scales)) => -STAYS * scales[i],
            _ => 0.0,
        };
        let closed: Vec<bool> = (0..place.forces.len())
            .map(|i| {
                let xi = place.forces[i] + self.stiffness[i] * self.beyond(i, place);
                !self.is_tangential[i] && xi > -slack(i, before.map(|before| before.closed[i]))
            })
            .collect();
        let act = |(k, point): (usize, &Point)| {
            let is_closed = point.normal.is_some_and(|n| closed[n]);
            if !is_closed && point.own.bound.only_closed {
                return Act::Rests;
            }
            let stuck = before.map(|before| before.points[k] == Act::Sticks);
            let bound = self.bound(point, place, &closed);
            let xi = self.reach(point, place, bound);
            self.act(point, xi, bound, slack(point.own.limit, stuck))
        };
        let mut state = State {
            points: self.points.iter().enumerate().map(act).collect(),
            closed,
            opened: Vec::new(),
        };
        if let Some(before) = before {
            for (k, point) in self.points.iter().enumerate() {
                if let (Some(n), Some(act)) = (point.normal, self.parting(k, place, before, &state))
                {
                    state.closed[n] = act != Act::Rests;
                    state.points[k] = act;
                }
            }
            let rests = state.points.iter().map(|act| *act == Act::Rests);
            state.opened = rests.zip(&before.opened).map(|(a, b)| a || *b).collect();
        }
        let missed = self.missed(place, &state);
        let squares = missed.iter().zip(&self.stiffness);
        let merit = squares.map(|(x, r)| x * x / r).sum::<f64>().sqrt();
        // What slides away has forces that are small beside the terms of its way.
        let scales = scales.filter(|_| merit <= LAW * self.acting);
        let relative = scales.map(|scales| {
            let all = missed.iter().zip(scales).filter(|(x, _)| **x != 0.0);
            all.map(|(x, scale)| x.abs() / scale).fold(0.0, f64::max)
        });
        Look {
            merit,
            missed: relative.unwrap_or(f64::INFINITY),
            state,
        }
    }

    /// What every limit misses of its law, as a force.
    pub(super) fn missed(&self, place: &Place, state: &State) -> Vec<f64> {
        let normal = |i: usize| match state.closed[i] {
            true => -self.stiffness[i] * self.beyond(i, place),
            false => place.forces[i],
        };
        let mut missed: Vec<f64> = (0..place.forces.len()).map(normal).collect();
        for (point, act) in self.points.iter().zip(&state.points) {
            let bound = self.bound(point, place, &state.closed);
            let xi = self.reach(point, place, bound);
            let [_, force] = self.tangential(point, place);
            for (k, i) in point.tangents.into_iter().enumerate() {
                let Some(i) = i else { continue };
                let right = match act {
                    Act::Rests => 0.0,
                    Act::Sticks => xi[k],
                    Act::Slips { e, .. } => bound * e[k],
                    Act::Parts { e, .. } => e[k] * (e[0] * force[0] + e[1] * force[1]),
                };
                missed[i] = place.forces[i] - right;
            }
            if let (Act::Parts { .. }, Some(n)) = (act, point.normal) {
                missed[n] = place.forces[n];
            }
        }
        missed
    }

    /// The terms that the force of limit i is a sum of.
    pub(super) fn force_scale(&self, i: usize, place: &Place) -> f64 {
        let m = place.jumps.len();
        let of_jump = |j: usize| {
            let by_rows = self.contact.rows.iter().zip(&place.forces[m..]);
            let by_rows = by_rows.map(|(row, force)| {
                let share = row.iter().find(|&&(jump, _)| jump == j);
                share.map_or(0.0, |(_, share)| (share * force).abs())
            });
            self.contact.scale_of(j, &place.jumps) + by_rows.sum::<f64>()
        };
        match i < m {
            true => of_jump(i),
            false => {
                let row = self.contact.rows.row(i - m).iter();
                row.map(|&(j, c)| c.abs() * of_jump(j)).sum()
            }
        }
    }
}
