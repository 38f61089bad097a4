//! The contact laws of a contact problem, or of a contact group: the status every limit should have at an iterate, and
//! its residual.

use std::mem::discriminant;

use serde::{Deserialize, Serialize};

use super::dependent::DependentConstraints;
use super::friction::Status;
use super::law::{PointLaw, PointState, PointStatus};
use super::limits::TangentialLimit;

/// Slip reversals from which on a point's r is lowered, and the factor it is lowered by.
const TURNS: usize = 3;
const SOFTER: f64 = 0.1;

/// The contact laws of all limits.
#[derive(Clone, Debug)]
pub struct ContactLaws<'a> {
    /// g, then d (m): the jumps of limits that are closed or stick.
    pub bounds: &'a [f64],
    /// D.
    pub rows: &'a DependentConstraints,
    /// The points with friction.
    pub points: Vec<PointLaw>,
    /// Limits of tangential jumps.
    pub is_tangential: Vec<bool>,
    /// r of every limit (N/m).
    pub stiffness: Vec<f64>,
    /// Full steps so far in which the slip of each point reversed.
    turns: Vec<usize>,
}

/// The statuses of all limits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statuses {
    /// Flags of the closed limits, tangential ones excepted.
    pub closed: Vec<bool>,
    /// The tangential statuses of points with friction.
    pub points: Vec<PointStatus>,
    /// The history of every point in the search.
    pub past: Vec<Past>,
}

/// The history in the search of a point whose cohesion vanishes as it opens.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Past {
    /// Never open since the search began.
    Closed,
    /// Opened once: it parts first if it is to open again.
    Opened,
    /// Force above the cohesion as it parted, and not open since: if it parts and exceeds the cohesion again, neither
    /// sticking nor slipping is right, and it opens.
    Exceeded,
}

impl Past {
    /// The history after a step in which a point had the first status and should have the second.
    fn after(self, was: PointStatus, right: PointStatus) -> Self {
        match (was, right) {
            (_, PointStatus::Open) => Self::Opened,
            (PointStatus::Parts { .. }, PointStatus::Slips { .. }) => Self::Exceeded,
            _ => self,
        }
    }
}

/// Jumps and forces of an iterate.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Iterate {
    /// t (m).
    pub jumps: Vec<f64>,
    /// λ = c − H t − Dᵀ μ, then μ (N/m).
    pub forces: Vec<f64>,
}

/// Residual of the contact laws at an iterate.
#[derive(Clone, Debug)]
pub struct LawResidual {
    /// The statuses that all limits should have there.
    pub statuses: Statuses,
    /// Limits with a wrong status, where the previous statuses are known.
    pub wrong: Vec<usize>,
    /// Σ x²/r over the residuals x of all limits, as forces.
    pub squares: f64,
    /// Σ λ²/r of the forces.
    pub forces: f64,
    /// The largest residual relative to the scales of forces, where these are known.
    pub largest: f64,
}

impl<'a> ContactLaws<'a> {
    /// The laws of limits with these `bounds`, `rows` and `tangents`, with r of every limit (N/m).
    pub fn new(
        bounds: &'a [f64],
        rows: &'a DependentConstraints,
        tangents: &[TangentialLimit],
        mut stiffness: Vec<f64>,
    ) -> Self {
        let mut is_tangential = vec![false; stiffness.len()];
        let mut points = Vec::new();
        for tangent in tangents {
            is_tangential[tangent.limit] = true;
            let Some(([_, second], _)) = tangent.of_point() else {
                continue;
            };
            // The friction law must not depend on how the tangents are turned, so r is equal along both.
            let mean = second.map_or(stiffness[tangent.limit], |other| {
                0.5 * (stiffness[tangent.limit] + stiffness[other])
            });
            for i in [Some(tangent.limit), second].into_iter().flatten() {
                stiffness[i] = mean;
            }
            points.extend(PointLaw::new(tangent, mean));
        }
        Self {
            turns: vec![0; points.len()],
            bounds,
            rows,
            points,
            is_tangential,
            stiffness,
        }
    }

    /// Violation of the bound of limit i, or its slip (m).
    pub fn violation(&self, i: usize, at: &Iterate) -> f64 {
        let m = at.jumps.len();
        let value = match at.jumps.get(i) {
            Some(t) => *t,
            None => self.rows.value(i - m, &at.jumps),
        };
        value - self.bounds[i]
    }

    /// The state of a point at an iterate with these limits `closed`.
    pub fn point(&self, point: &PointLaw, at: &Iterate, closed: &[bool]) -> PointState {
        point.at(|i| self.violation(i, at), &at.forces, closed)
    }

    /// The status of point k with a cohesion that vanishes on opening, if it parted `before` or would open once more;
    /// `None` where the statuses `now` are right.
    fn parting(
        &self,
        k: usize,
        at: &Iterate,
        before: &Statuses,
        now: &Statuses,
    ) -> Option<PointStatus> {
        let point = &self.points[k];
        let bound = point.bound;
        let n = point.normal?;
        if !bound.only_closed || bound.cohesion == 0.0 || point.prescribed != 0.0 {
            return None;
        }
        let here = self.point(point, at, &before.closed);
        let (slip, force) = (here.slip, here.force);
        let (distance, size) = (here.distance(), here.size());
        let parts = || match distance > 0.0 {
            true => PointStatus::Parts {
                direction: slip.map(|s| s / distance),
                turning: point.turning(size / distance),
            },
            false => PointStatus::Parts {
                direction: force.map(|f| f / size),
                turning: 0.0,
            },
        };
        let along = |v: [f64; 2], e: [f64; 2]| v[0] * e[0] + v[1] * e[1];
        match before.points[k] {
            PointStatus::Slips { .. } | PointStatus::Sticks
                if now.points[k] == PointStatus::Open =>
            {
                (before.past[k] != Past::Closed && distance + size > 0.0).then(parts)
            }
            PointStatus::Parts { direction, .. }
                if along(force, direction) < 0.0 || distance == 0.0 =>
            {
                Some(PointStatus::Open)
            }
            PointStatus::Parts { direction, .. } if along(slip, direction) < 0.0 => {
                Some(PointStatus::Sticks)
            }
            PointStatus::Parts { .. } if size > bound.cohesion => match before.past[k] {
                Past::Exceeded => Some(PointStatus::Open),
                Past::Closed | Past::Opened => Some(point.status(&here, 0.0)),
            },
            PointStatus::Parts { .. } => Some(parts()),
            _ => None,
        }
        .filter(|_| before.closed[n])
    }

    /// Flags of the limits whose jump is known under these statuses: closed or sticking ones.
    pub fn known(&self, statuses: &Statuses) -> Vec<bool> {
        let mut known = statuses.closed.clone();
        for (point, status) in self.points.iter().zip(&statuses.points) {
            point
                .limits()
                .for_each(|t| known[t] = *status == PointStatus::Sticks);
        }
        known
    }

    /// Statuses at an iterate that correspond to the `status` of every limit.
    pub fn begin(&self, status: &[Status], at: &Iterate) -> Statuses {
        let closed: Vec<bool> = status.iter().map(|status| status.is_closed()).collect();
        let of_point = |point: &PointLaw| {
            let own = status[point.first];
            if point.has_opened(&closed) {
                return PointStatus::Open;
            }
            let here = self.point(point, at, &closed);
            let distance = here.distance();
            let force = match own {
                Status::Parting => here.size().min(point.bound.cohesion),
                _ => here.bound,
            };
            let (direction, turning) = match distance > 0.0 {
                true => (
                    here.slip.map(|s| s / distance),
                    point.turning(force / distance),
                ),
                false => ([own.sign(), 0.0], 0.0),
            };
            if own == Status::Parting && distance > 0.0 {
                return PointStatus::Parts { direction, turning };
            }
            match own.is_closed() && point.prescribed == 0.0 || direction == [0.0; 2] {
                true => PointStatus::Sticks,
                false => PointStatus::Slips { direction, turning },
            }
        };
        Statuses {
            points: self.points.iter().map(of_point).collect(),
            closed,
            past: vec![Past::Closed; self.points.len()],
        }
    }

    /// Replaces the statuses `own` by those of another load step, except at slips that supports prescribe.
    pub fn take_over(&self, known: &Statuses, own: &mut Statuses) {
        if known.closed.len() != own.closed.len() || known.points.len() != own.points.len() {
            return;
        }
        own.closed.clone_from(&known.closed);
        let points = self
            .points
            .iter()
            .zip(own.points.iter_mut().zip(&known.points));
        for (point, (own, known)) in points {
            if point.prescribed == 0.0 {
                *own = *known;
            }
        }
    }

    /// Residual of the contact laws at an iterate; a limit keeps its status `before` within `stays` times its scale of
    /// forces.
    pub fn residual(
        &self,
        at: &Iterate,
        before: Option<(&Statuses, &[f64])>,
        stays: f64,
    ) -> LawResidual {
        let slack = |i: usize, was: Option<bool>| match (was, before) {
            (Some(true), Some((_, scales))) => stays * scales[i],
            (Some(false), Some((_, scales))) => -stays * scales[i],
            _ => 0.0,
        };
        let closed: Vec<bool> = (0..at.forces.len())
            .map(|i| {
                let xi = at.forces[i] + self.stiffness[i] * self.violation(i, at);
                let was = before.map(|(before, _)| before.closed[i]);
                !self.is_tangential[i] && xi > -slack(i, was)
            })
            .collect();
        let of_point = |(k, point): (usize, &PointLaw)| {
            if point.has_opened(&closed) {
                return PointStatus::Open;
            }
            let stuck = before.map(|(before, _)| before.points[k] == PointStatus::Sticks);
            let here = self.point(point, at, &closed);
            point.status(&here, slack(point.first, stuck))
        };
        let mut statuses = Statuses {
            points: self.points.iter().enumerate().map(of_point).collect(),
            closed,
            past: Vec::new(),
        };
        if let Some((before, _)) = before {
            for (k, point) in self.points.iter().enumerate() {
                if let (Some(n), Some(right)) =
                    (point.normal, self.parting(k, at, before, &statuses))
                {
                    statuses.closed[n] = right != PointStatus::Open;
                    statuses.points[k] = right;
                }
            }
            let points = before.points.iter().zip(&statuses.points);
            let past = before.past.iter().zip(points);
            statuses.past = past
                .map(|(past, (&was, &right))| past.after(was, right))
                .collect();
        }
        let residuals = self.residuals(at, &statuses);
        let relative = before.map(|(_, scales)| {
            let all = residuals.iter().zip(scales).filter(|(x, _)| **x != 0.0);
            all.map(|(x, scale)| x.abs() / scale).fold(0.0, f64::max)
        });
        LawResidual {
            wrong: before.map_or_else(Vec::new, |(before, _)| self.wrong(before, &statuses)),
            squares: self.squares(&residuals),
            forces: self.squares(&at.forces),
            largest: relative.unwrap_or(f64::INFINITY),
            statuses,
        }
    }

    /// Lowers r of points whose slip reverses from step to step: |λ_t + r s| ≤ b, the set in which they would stick, is
    /// too narrow for points much stiffer than the bodies that move them.
    pub fn soften(&mut self, before: &Statuses, now: &Statuses) {
        let statuses = before.points.iter().zip(&now.points);
        let points = self.points.iter_mut().zip(&mut self.turns);
        for ((point, turns), statuses) in points.zip(statuses) {
            if let (
                PointStatus::Slips {
                    direction: from, ..
                },
                PointStatus::Slips { direction: to, .. },
            ) = statuses
                && from[0] * to[0] + from[1] * to[1] < 0.0
            {
                *turns += 1;
                if *turns >= TURNS {
                    point.stiffness *= SOFTER;
                }
            }
        }
    }

    /// Σ x²/r of these forces x.
    pub fn squares(&self, forces: &[f64]) -> f64 {
        let all = forces.iter().zip(&self.stiffness);
        all.map(|(x, r)| x * x / r).sum()
    }

    /// Limits whose statuses differ, a point with friction by its first tangential one.
    fn wrong(&self, before: &Statuses, now: &Statuses) -> Vec<usize> {
        let closed = before.closed.iter().zip(&now.closed).enumerate();
        let normals = closed.filter(|(_, (a, b))| a != b).map(|(i, _)| i);
        let points = self
            .points
            .iter()
            .zip(before.points.iter().zip(&now.points));
        let points = points.filter(|(_, (a, b))| discriminant(*a) != discriminant(*b));
        normals
            .chain(points.map(|(point, _)| point.first))
            .collect()
    }

    /// Residual of every limit's law, as a force (N/m).
    pub fn residuals(&self, at: &Iterate, statuses: &Statuses) -> Vec<f64> {
        let normal = |i: usize| match statuses.closed[i] {
            true => -self.stiffness[i] * self.violation(i, at),
            false => at.forces[i],
        };
        let mut residuals: Vec<f64> = (0..at.forces.len()).map(normal).collect();
        for (point, status) in self.points.iter().zip(&statuses.points) {
            let here = self.point(point, at, &statuses.closed);
            let (xi, force) = (point.reach(&here), here.force);
            for (k, i) in point.tangents.into_iter().enumerate() {
                let Some(i) = i else { continue };
                let right = match status {
                    PointStatus::Open => 0.0,
                    PointStatus::Sticks => xi[k],
                    PointStatus::Slips { direction: e, .. } => here.bound * e[k],
                    PointStatus::Parts { direction: e, .. } => {
                        e[k] * (e[0] * force[0] + e[1] * force[1])
                    }
                };
                residuals[i] = at.forces[i] - right;
            }
            if let (PointStatus::Parts { .. }, Some(n)) = (status, point.normal) {
                residuals[n] = at.forces[n];
            }
        }
        residuals
    }
}

#[cfg(test)]
mod tests;
