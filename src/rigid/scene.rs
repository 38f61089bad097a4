//! The scene of the analysis of rigid motions: its bodies, and contact conditions against their motions.

use serde::{Deserialize, Serialize};

use crate::contact::friction::ForceBound;
use crate::fem::body_frame::BodyFrame;

/// Resultant of a body's load, relative to the sum of its absolute forces, that is round-off of these:
/// they may be products of a stiffness themselves.
const RESULTANT_ROUND_OFF: f64 = 1e-12;

/// A body as the analysis sees it.
#[derive(Clone, Debug)]
pub struct BodyState {
    /// Frame of its rigid motions.
    pub frame: BodyFrame,
    /// Rows of its supports against its rigid motions, what they prescribe last (m).
    pub supports: Vec<Vec<f64>>,
    /// True if springs hold it, along rows of its supports that prescribe 0: it isn't moved along its supports.
    pub has_springs: bool,
    /// Resultant of its load against its rigid motions.
    pub load: Vec<f64>,
    /// Sum of its absolute nodal forces.
    pub load_scale: f64,
    /// Nodes at which it may be pinned: subdomain, node, position.
    pub candidates: Vec<(u32, u32, [f64; 3])>,
}

impl BodyState {
    /// Makes nothing of resultants that are round-off: they would drive a body that its load
    /// doesn't move until something stops it.
    pub(super) fn drop_round_off(&mut self) {
        let round_off = RESULTANT_ROUND_OFF * self.load_scale;
        for load in self.load.iter_mut().filter(|load| load.abs() <= round_off) {
            *load = 0.0;
        }
    }
}

/// A contact condition against the rigid motions of the bodies it touches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidRow {
    /// Bodies, and the row against their motions.
    pub bodies: Vec<(usize, Vec<f64>)>,
    /// g (m); a tangential one has none.
    pub gap: f64,
    /// The bound of its force if that is tangential; a normal one presses.
    pub friction: Option<Friction>,
    /// True if it is one of a tie, which holds in both directions.
    pub is_tied: bool,
}

/// The bodies and conditions from which rigid motions follow. On the root.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Dimension of space.
    pub dim: usize,
    /// Bodies.
    pub bodies: Vec<BodyState>,
    /// Names.
    pub names: Vec<String>,
    /// Conditions, group by group.
    pub rows: Vec<RigidRow>,
    /// Number of conditions of every group.
    pub conditions: Vec<usize>,
}

/// The bound of the force of a tangential condition, in space that of both tangents of a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Friction {
    /// The condition along the normal of the same point.
    pub normal: usize,
    /// The bound.
    pub bound: ForceBound,
}

impl Friction {
    /// True if it can give a force where the contact is as `closed` says, and without a normal force.
    pub(super) fn holds_unpressed(&self, closed: bool) -> bool {
        self.bound.at(0.0, closed) > 0.0
    }
}
