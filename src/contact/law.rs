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

/// A point with friction: its limits, and what bounds its force.
#[derive(Clone, Copy, Debug)]
pub struct PointLaw {
    /// The limit of its normal jump, where there is one that carries force.
    pub normal: Option<usize>,
    /// The limit of its first tangential jump.
    pub first: usize,
    /// The limits of its tangential jumps, the second of which may not be one.
    pub tangents: [Option<usize>; 2],
    /// Slip along the second tangent where supports prescribe it (m).
    pub prescribed: f64,
    /// What bounds its tangential force.
    pub bound: ForceBound,
    /// r (N/m).
    pub stiffness: f64,
}

impl PointLaw {
    /// The law of the point whose first tangential limit is `tangent`, with this r (N/m); `None` where it is the second.
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

    /// Whether the point can slip along one line alone.
    pub fn is_along_a_line(&self) -> bool {
        self.tangents[1].is_none() && self.prescribed == 0.0
    }

    /// ξ_t of this slip (m) and force (N/m) under the bound b (N/m). Along a prescribed slip the force is what the bound
    /// leaves.
    pub fn reach(&self, slip: [f64; 2], mut force: [f64; 2], bound: f64) -> [f64; 2] {
        if self.prescribed != 0.0 {
            let along = force[0].abs().min(bound);
            force[1] = ((bound - along) * (bound + along))
                .sqrt()
                .copysign(self.prescribed);
        }
        [0, 1].map(|k| force[k] + self.stiffness * slip[k])
    }

    /// The status under ξ_t and the bound b (N/m): sticking up to b + `slack`.
    pub fn status(&self, xi: [f64; 2], bound: f64, slack: f64) -> PointStatus {
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

    /// κ (N/m), 0 where nothing can slip but along one line.
    pub fn turning(&self, stiffness: f64) -> f64 {
        match self.is_along_a_line() {
            true => 0.0,
            false => stiffness,
        }
    }
}
