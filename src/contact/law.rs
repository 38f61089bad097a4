//! The law of a contact point: Signorini's condition along its normal, Coulomb's or given friction along its tangents.
//!
//! Whatever stiffness r > 0, the law of a point with the normal jump t ≤ g, the slip s and the forces λ, λ_t is
//!
//! ```text
//! λ = max(0, ξ)                 with ξ = λ + r (t − g)
//! λ_t = ξ_t min(1, b / |ξ_t|)   with ξ_t = λ_t + r s,   b = c + μ λ
//! ```
//!
//! P. Alart, A. Curnier, *A mixed formulation for frictional contact problems prone to Newton like solution methods*,
//! Comput. Methods Appl. Mech. Engrg 92 (1991).

use serde::{Deserialize, Serialize};

use super::tangent::{ForceBound, TangentialLimit};

/// The status of a contact point along its tangents.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum PointStatus {
    /// Open: no tangential force.
    Open,
    /// Sticking.
    Sticks,
    /// Slipping along e, under λ_t = b e + κ P s with P = I − e eᵀ.
    Slips {
        /// e.
        direction: [f64; 2],
        /// κ (N/m).
        turning: f64,
    },
    /// Slipping along e while the contact is about to open: without pressure, under the rest of its cohesion and κ P s.
    Parts {
        /// e.
        direction: [f64; 2],
        /// κ (N/m).
        turning: f64,
    },
}

/// The linear law of a tangential force, with forces and slips of limits: Σ factor·force + Σ factor·slip = constant.
#[derive(Clone, Debug)]
pub struct LinearLaw {
    /// The limit whose force the law determines.
    pub limit: usize,
    /// Forces and their factors.
    pub forces: Vec<(usize, f64)>,
    /// Slips and their factors (N/m).
    pub slips: Vec<(usize, f64)>,
    /// The constant (N/m).
    pub constant: f64,
}

/// A point with friction at an iterate.
#[derive(Clone, Copy, Debug)]
pub struct PointState {
    /// s (m).
    pub slip: [f64; 2],
    /// λ_t (N/m).
    pub force: [f64; 2],
    /// b (N/m).
    pub bound: f64,
}

impl PointState {
    /// |λ_t| (N/m).
    pub fn size(&self) -> f64 {
        self.force[0].hypot(self.force[1])
    }

    /// |s| (m).
    pub fn distance(&self) -> f64 {
        self.slip[0].hypot(self.slip[1])
    }

    /// λ_t · s (J/m).
    pub fn work(&self) -> f64 {
        self.force[0] * self.slip[0] + self.force[1] * self.slip[1]
    }
}

/// Component of a force at its bound across a direction along which its component is `along` (N/m).
pub(super) fn rest_of_bound(bound: f64, along: f64) -> f64 {
    let along = along.abs().min(bound);
    ((bound - along) * (bound + along)).sqrt()
}

/// The friction law of a point: its limits and the bound of its force.
#[derive(Clone, Copy, Debug)]
pub struct PointLaw {
    /// The limit of its normal jump, if that carries force.
    pub normal: Option<usize>,
    /// The limit of its first tangential jump.
    pub first: usize,
    /// The limits of its tangential jumps; the second one may be missing.
    pub tangents: [Option<usize>; 2],
    /// Slip along the second tangent where supports prescribe it (m).
    pub prescribed: f64,
    /// Bound of its tangential force.
    pub bound: ForceBound,
    /// r (N/m).
    pub stiffness: f64,
}

impl PointLaw {
    /// The law of the point whose first tangential limit is `tangent`, with this r (N/m); `None` if it is the second.
    pub fn new(tangent: &TangentialLimit, stiffness: f64) -> Option<Self> {
        let (tangents, prescribed) = tangent.of_point()?;
        Some(Self {
            normal: tangent.normal,
            first: tangent.limit,
            tangents,
            prescribed,
            bound: tangent.bound,
            stiffness,
        })
    }

    /// True if the point can slip along a single line only.
    pub fn is_along_a_line(&self) -> bool {
        self.tangents[1].is_none() && self.prescribed == 0.0
    }

    /// The limits of its tangential jumps.
    pub fn limits(&self) -> impl Iterator<Item = usize> {
        self.tangents.into_iter().flatten()
    }

    /// The state of the point for the violations `beyond` of bounds, these `forces` and the limits that are `closed`.
    pub fn at(&self, beyond: impl Fn(usize) -> f64, forces: &[f64], closed: &[bool]) -> PointState {
        let [first, second] = self.tangents;
        let is_closed = self.is_closed(closed);
        let pressing = self.normal.filter(|_| is_closed);
        PointState {
            slip: [
                first.map_or(0.0, &beyond),
                second.map_or(self.prescribed, &beyond),
            ],
            force: self.tangents.map(|t| t.map_or(0.0, |t| forces[t])),
            bound: (self.bound).at(pressing.map_or(0.0, |n| forces[n]), is_closed),
        }
    }

    /// True if its contact is closed.
    pub fn is_closed(&self, closed: &[bool]) -> bool {
        self.normal.is_some_and(|n| closed[n])
    }

    /// True if its contact is open and its tangential force therefore vanishes.
    pub fn has_opened(&self, closed: &[bool]) -> bool {
        self.bound.only_closed && !self.is_closed(closed)
    }

    /// ξ_t. Along a prescribed slip the force is the rest of the bound.
    pub fn reach(&self, at: &PointState) -> [f64; 2] {
        let [along, mut across] = at.force;
        if self.prescribed != 0.0 {
            across = rest_of_bound(at.bound, along).copysign(self.prescribed);
        }
        let r = self.stiffness;
        [along + r * at.slip[0], across + r * at.slip[1]]
    }

    /// The status in this state: sticking up to b + `slack`.
    pub fn status(&self, at: &PointState, slack: f64) -> PointStatus {
        let (xi, bound) = (self.reach(at), at.bound);
        let size = xi[0].hypot(xi[1]);
        if size <= bound + slack && self.prescribed == 0.0 {
            return PointStatus::Sticks;
        }
        let rest = (size - bound).max(f64::EPSILON * size);
        PointStatus::Slips {
            direction: xi.map(|x| x / size),
            turning: self.turning(self.stiffness * bound / rest),
        }
    }

    /// The linear laws of its tangential forces with this status in a closed or an open contact: with b = c + μ λ and
    /// any r > 0
    ///
    /// ```text
    /// e (eᵀ λ_t − b) + w (P λ_t − κ P s) = 0,    w = r / (r + κ)
    /// ```
    ///
    /// with e λ instead of the first term where the contact is about to open. w keeps residuals as large as forces.
    /// Empty where the point doesn't slip.
    pub fn linear(&self, status: &PointStatus, is_closed: bool) -> Vec<LinearLaw> {
        let (e, turning, parts) = match *status {
            PointStatus::Slips { direction, turning } => (direction, turning, false),
            PointStatus::Parts { direction, turning } => (direction, turning, true),
            PointStatus::Open | PointStatus::Sticks => return Vec::new(),
        };
        let normal = self.normal.filter(|_| is_closed);
        let [cohesion, slope] = match parts {
            true => [0.0, -1.0],
            false => self.bound.line(is_closed),
        };
        let weight = self.stiffness / (self.stiffness + turning);
        // If only one tangential force is unknown, its law is scalar.
        let alone = self.tangents[1].is_none();
        let equation = |(k, limit): (usize, Option<usize>)| {
            let share = e[k] * if alone && !parts { weight } else { 1.0 };
            let mut law = LinearLaw {
                limit: limit?,
                forces: Vec::new(),
                slips: Vec::new(),
                constant: share * cohesion,
            };
            for (l, other) in self.tangents.into_iter().enumerate() {
                let project = if k == l { 1.0 } else { 0.0 } - e[k] * e[l];
                let of_slip = -weight * turning * project;
                let Some(other) = other else {
                    law.constant -= of_slip * self.prescribed;
                    continue;
                };
                let of_force = match (alone, parts) {
                    (true, true) => 0.0,
                    (true, false) => weight,
                    (false, true) => weight * project,
                    (false, false) => e[k] * e[l] + weight * project,
                };
                law.forces.push((other, of_force));
                law.slips.push((other, of_slip));
            }
            law.forces.extend(normal.map(|n| (n, -share * slope)));
            Some(law)
        };
        let tangents = self.tangents.into_iter().enumerate();
        tangents.filter_map(equation).collect()
    }

    /// κ (N/m), 0 for a point that can slip along a single line only.
    pub fn turning(&self, stiffness: f64) -> f64 {
        match self.is_along_a_line() {
            true => 0.0,
            false => stiffness,
        }
    }
}
