//! What the points of a contact group with friction do while the active set is frozen, and what is wrong with it.

use crate::contact::friction::{ForceBound, Status};
use crate::contact::limits::{Limits, TangentialLimit};
use crate::fem::contact_group::ContactGroup;

/// A point with friction: its jumps and what bounds its force.
#[derive(Clone, Debug)]
pub(super) struct Point {
    /// Its normal jump, where that carries force.
    pub normal: Option<usize>,
    /// Its tangential jumps, one or two.
    pub tangents: Vec<usize>,
    /// Slip along the second tangent where supports prescribe it (m).
    prescribed: f64,
    bound: ForceBound,
    /// r (N/m).
    stiffness: f64,
}

/// What a point does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Act {
    /// It is open, and bears nothing.
    Rests,
    Sticks,
    Slips,
}

/// The friction of a contact group, and what its points do.
#[derive(Clone, Debug)]
pub(super) struct GroupFriction {
    pub points: Vec<Point>,
    pub acts: Vec<Act>,
    /// The jumps at which closed conditions are (m).
    pub bounds: Vec<f64>,
    /// Which normal and tangential jumps are open, or slip.
    pub open: Vec<bool>,
    /// The force on every jump that slips, 0 on others.
    pub forces: Vec<f64>,
    /// The number of the point of every jump.
    pub of_jumps: Vec<usize>,
    pub is_tangential: Vec<bool>,
}

/// The law of a slipping point at a place: λ_t = b e, and how that changes.
#[derive(Clone, Debug)]
pub struct Law {
    /// The tangential jumps, one or two.
    pub tangents: Vec<usize>,
    /// The normal one, where that carries force.
    pub normal: Option<usize>,
    /// e.
    pub direction: [f64; 2],
    /// b.
    pub bound: f64,
    /// The change of b with the normal force.
    pub slope: f64,
    /// b/|ξ|: how e turns with what of ξ changes across it.
    pub turn: f64,
    /// The share of λ_t in ξ: none where a part of the slip is prescribed.
    pub own: f64,
    /// r.
    pub stiffness: f64,
}

impl Point {
    /// The law where jumps and forces of the group are these.
    pub fn law(&self, group: &GroupFriction, solved: &[Vec<f64>; 2]) -> Law {
        let [jumps, forces] = solved;
        let normal = self.normal.map_or(0.0, |n| forces[n]);
        let is_closed = self.normal.is_some_and(|n| !group.open[n]);
        let bound = self.bound.at(normal, is_closed);
        let own = f64::from(self.prescribed == 0.0);
        let mut xi = [0.0, self.stiffness * self.prescribed];
        for (xi, &t) in xi.iter_mut().zip(&self.tangents) {
            *xi = own * forces[t] + self.stiffness * (jumps[t] - group.bounds[t]);
        }
        let size = xi[0].hypot(xi[1]);
        let part = if size > 0.0 { 1.0 / size } else { 0.0 };
        let presses = is_closed && normal > 0.0;
        Law {
            tangents: self.tangents.clone(),
            normal: self.normal,
            direction: xi.map(|xi| xi * part),
            bound,
            slope: if presses { self.bound.coefficient } else { 0.0 },
            turn: bound * part,
            own,
            stiffness: self.stiffness,
        }
    }

    /// The slip along the force that acts (m).
    fn slip_along(&self, group: &GroupFriction, jumps: &[f64]) -> f64 {
        let forces = self.tangents.iter().map(|&t| group.forces[t]);
        let size = forces.clone().map(|f| f * f).sum::<f64>().sqrt();
        let products = forces.zip(&self.tangents);
        let product: f64 = products
            .map(|(f, &t)| f * (jumps[t] - group.bounds[t]))
            .sum();
        if size > 0.0 { product / size } else { 0.0 }
    }
}

impl GroupFriction {
    /// Contact group `group` within `limits`, all of whose points stick.
    pub fn new(group: &ContactGroup, limits: &Limits) -> Self {
        let conditions: Vec<usize> = group
            .conditions()
            .map(|condition| condition.point)
            .collect();
        let of_limits = limits.conditions_of_limits().into_iter();
        let of_jumps: Vec<usize> = of_limits.map(|j| conditions[j]).collect();
        let mut is_tangential = vec![false; limits.jumps()];
        let mut points = Vec::new();
        for tangent in &limits.tangents {
            is_tangential[tangent.limit] = true;
            let Some((tangents, prescribed)) = tangent.of_point() else {
                continue;
            };
            points.push(Point {
                normal: tangent.normal,
                tangents: tangents.into_iter().flatten().collect(),
                prescribed,
                bound: tangent.bound,
                stiffness: group.stiffness_at(of_jumps[tangent.limit]),
            });
        }
        let mut friction = Self {
            acts: vec![Act::Sticks; points.len()],
            points,
            bounds: limits.bounds.clone(),
            open: vec![false; limits.jumps()],
            forces: vec![0.0; limits.jumps()],
            of_jumps,
            is_tangential,
        };
        friction.begin(&vec![false; limits.jumps()]);
        friction
    }

    /// Goes back to where those normal jumps are open, and all points stick whose sides are closed.
    pub fn begin(&mut self, open: &[bool]) {
        self.open.copy_from_slice(open);
        self.forces.fill(0.0);
        for (act, point) in self.acts.iter_mut().zip(&self.points) {
            *act = match point.prescribed {
                0.0 => Act::Sticks,
                _ => Act::Slips,
            };
        }
        self.settle(&[self.bounds.clone(), self.forces.clone()]);
    }

    /// The points that slip.
    pub fn slipping(&self) -> impl Iterator<Item = &Point> {
        let both = self.points.iter().zip(&self.acts);
        both.filter(|(_, act)| **act == Act::Slips)
            .map(|(point, _)| point)
    }

    /// What is wrong by more than `least` of the largest force or jump, and by how much at most.
    pub fn faults(&self, solved: &[Vec<f64>; 2], scales: [f64; 2], least: f64) -> GroupFaults {
        let [jumps, forces] = solved;
        let scales = scales.map(|scale| scale.max(f64::MIN_POSITIVE));
        let mut faults = GroupFaults::default();
        for i in (0..jumps.len()).filter(|&i| !self.is_tangential[i]) {
            let excess = match self.open[i] {
                true => (jumps[i] - self.bounds[i]) / scales[1],
                false => -forces[i] / scales[0],
            };
            faults.active += usize::from(!self.open[i]);
            faults.largest = faults.largest.max(excess);
            if excess > least {
                faults.normals.push(i);
            }
        }
        let opens = |n: usize| faults.normals.binary_search(&n).is_ok() && !self.open[n];
        for (k, (point, act)) in self.points.iter().zip(&self.acts).enumerate() {
            if point.bound.only_closed && point.normal.is_some_and(opens) {
                continue;
            }
            let excess = match act {
                Act::Rests => 0.0,
                Act::Sticks => {
                    let force = point.tangents.iter().map(|&t| forces[t] * forces[t]);
                    (force.sum::<f64>().sqrt() - point.law(self, solved).bound) / scales[0]
                }
                Act::Slips if point.prescribed != 0.0 => 0.0,
                Act::Slips => -point.slip_along(self, jumps) / scales[1],
            };
            faults.largest = faults.largest.max(excess);
            if excess > least {
                faults.points.push(k);
            }
        }
        faults
    }

    /// Exchanges what is wrong.
    pub fn exchange(&mut self, faults: &GroupFaults, solved: &[Vec<f64>; 2]) {
        for &i in &faults.normals {
            self.open[i] = !self.open[i];
        }
        for &k in &faults.points {
            self.acts[k] = match self.acts[k] {
                Act::Sticks => Act::Slips,
                _ => Act::Sticks,
            };
        }
        self.settle(solved);
    }

    /// Makes what tangential jumps do go with what their points do: what closes goes on as it slipped, and what begins to
    /// slip does so under what held it.
    fn settle(&mut self, solved: &[Vec<f64>; 2]) {
        for k in 0..self.points.len() {
            let point = &self.points[k];
            let is_closed = point.normal.is_some_and(|n| !self.open[n]);
            let can_bear = is_closed || !point.bound.only_closed;
            let act = match (can_bear, self.acts[k]) {
                (false, _) => Act::Rests,
                (true, Act::Rests) => Act::Slips,
                (true, act) => act,
            };
            let law = point.law(self, solved);
            let is_new =
                act == Act::Slips && !point.tangents.iter().any(|&t| self.forces[t] != 0.0);
            for (at, t) in point.tangents.clone().into_iter().enumerate() {
                self.open[t] = act != Act::Sticks;
                if is_new {
                    self.forces[t] = law.bound * law.direction[at];
                } else if act != Act::Slips {
                    self.forces[t] = 0.0;
                }
            }
            self.acts[k] = act;
        }
    }
}

impl Law {
    /// How λ_t turns where forces and jumps of the group change by these.
    pub fn across(&self, forces: &[f64], jumps: &[f64]) -> [f64; 2] {
        let mut xi = [0.0; 2];
        for (xi, &t) in xi.iter_mut().zip(&self.tangents) {
            *xi = self.own * forces[t] + self.stiffness * jumps[t];
        }
        let e = self.direction;
        let along = xi[0] * e[0] + xi[1] * e[1];
        [0, 1].map(|k| self.turn * (xi[k] - along * e[k]))
    }

    /// The laws of the points of a `group` within `limits` that slip as these statuses of limits say, under these `forces`
    /// of their conditions, whose directions turn with the slip by κ, the second of what is said of limits; b is what
    /// these lack of it.
    pub fn of_slipping(
        group: &ContactGroup,
        limits: &Limits,
        (statuses, said): (&[Status], &[[f64; 2]]),
        forces: &[f64],
    ) -> Vec<Self> {
        let of_limits = limits.conditions_of_limits();
        let points: Vec<usize> = group.conditions().map(|one| one.point).collect();
        let law = |tangent: &TangentialLimit| {
            let (tangents, prescribed) = tangent.of_point()?;
            let tangents: Vec<usize> = tangents.into_iter().flatten().collect();
            let mut direction = [0.0; 2];
            for (e, &t) in direction.iter_mut().zip(&tangents) {
                *e = forces[of_limits[t]];
            }
            let presses = tangent.normal.filter(|&n| statuses[n].is_closed());
            let normal = presses.map_or(0.0, |n| forces[of_limits[n]]);
            let bound = tangent.bound.at(normal, presses.is_some());
            let size = match prescribed == 0.0 {
                true => direction[0].hypot(direction[1]),
                false => bound,
            };
            let slips = tangents.iter().all(|&t| !statuses[t].is_closed());
            let [_, turns] = said[tangent.limit];
            let stiffness = group.stiffness_at(points[of_limits[tangent.limit]]);
            (slips && size > 0.0).then(|| Self {
                direction: direction.map(|e| e / size),
                tangents,
                normal: presses,
                bound: bound - size,
                slope: tangent.bound.coefficient,
                turn: turns / (turns + stiffness),
                own: 1.0,
                stiffness,
            })
        };
        limits.tangents.iter().filter_map(law).collect()
    }
}

/// What is wrong in a group: normal jumps, and points with friction.
#[derive(Clone, Debug, Default)]
pub(super) struct GroupFaults {
    pub normals: Vec<usize>,
    pub points: Vec<usize>,
    pub active: usize,
    pub largest: f64,
}
