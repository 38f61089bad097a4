//! The largest values in a check of the discrete problem.

use serde::{Deserialize, Serialize};

use crate::vector::larger;

/// Largest terms in a block, or in several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Most {
    /// Residual along free directions (N/m).
    pub residual: f64,
    /// The terms of a residual (N/m).
    pub scale: f64,
    /// Penetration (m).
    pub penetration: f64,
    /// Tension in a contact (N/m).
    pub tension: f64,
    /// Contact force (N/m).
    pub contact_force: f64,
    /// Load, contact force or support reaction at a node (N/m).
    pub external: f64,
    /// Load at a node (N/m).
    pub load: f64,
    /// Product of contact force and gap (N).
    pub complementarity: f64,
    /// Bound of a tangential force (N/m).
    pub bound: f64,
    /// Tangential force beyond its bound (N/m).
    pub beyond_bound: f64,
    /// Displacement of a sticking point from where it sticks (m).
    pub astray: f64,
    /// Slip times the part of the tangential force across it (N).
    pub aside: f64,
    /// Displacement (m).
    pub displacement: f64,
    /// Prescribed displacement, gap, slip before, or closing motion (m).
    pub driven: f64,
    /// Jump of the displacement across Γ (m).
    pub jump: f64,
    /// Force that the bodies' closing motions would cause if they weren't rigid (N/m).
    pub rest: f64,
}

impl Most {
    /// The larger of two in every value.
    pub fn include(&mut self, other: Self) {
        *self = Self {
            residual: larger(self.residual, other.residual),
            scale: larger(self.scale, other.scale),
            penetration: larger(self.penetration, other.penetration),
            tension: larger(self.tension, other.tension),
            contact_force: larger(self.contact_force, other.contact_force),
            external: larger(self.external, other.external),
            load: larger(self.load, other.load),
            complementarity: larger(self.complementarity, other.complementarity),
            bound: larger(self.bound, other.bound),
            beyond_bound: larger(self.beyond_bound, other.beyond_bound),
            astray: larger(self.astray, other.astray),
            aside: larger(self.aside, other.aside),
            displacement: larger(self.displacement, other.displacement),
            driven: larger(self.driven, other.driven),
            jump: larger(self.jump, other.jump),
            rest: larger(self.rest, other.rest),
        };
    }
}
