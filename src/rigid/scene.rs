//! The scene of the rigid-body analysis: bodies, and contact constraints on their motions.

use contact_dd_partition::scene::units::Units;
use serde::{Deserialize, Serialize};

use crate::contact::friction::ForceBound;
use crate::fem::body_frame::BodyFrame;

/// Resultant of a body's load, relative to the sum of the magnitudes of its forces, that is round-off; forces may
/// themselves be computed from a stiffness.
const RESULTANT_ROUND_OFF: f64 = 1e-12;

/// A body in the rigid-body analysis.
#[derive(Clone, Debug)]
pub struct BodyState {
    /// Frame of its rigid motions.
    pub frame: BodyFrame,
    /// Units of its coordinates in messages.
    pub units: Units,
    /// Rows of its supports on its rigid motions, the prescribed displacement last (m).
    pub supports: Vec<Vec<f64>>,
    /// True if springs hold it, as rows of its supports that prescribe 0; then supports don't move it.
    pub has_springs: bool,
    /// Resultant of its load on its rigid motions.
    pub load: Vec<f64>,
    /// Sum of the magnitudes of its nodal forces.
    pub load_scale: f64,
    /// Candidate nodes for fixing dofs: subdomain, node, position.
    pub candidates: Vec<(u32, u32, [f64; 3])>,
}

impl BodyState {
    /// Description of one of its rigid motions, with coordinates in their units.
    pub(super) fn describe(&self, dim: usize, z: &[f64]) -> String {
        self.frame.describe(dim, self.units, z)
    }

    /// Sets resultants of round-off to zero: they would move an unloaded body until a contact stops it.
    pub(super) fn drop_round_off(&mut self) {
        let round_off = RESULTANT_ROUND_OFF * self.load_scale;
        for load in self.load.iter_mut().filter(|load| load.abs() <= round_off) {
            *load = 0.0;
        }
    }
}

/// A contact constraint on the rigid motions of its bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidRow {
    /// Bodies, and the constraint's row on their motions.
    pub bodies: Vec<(usize, Vec<f64>)>,
    /// g (m); of no meaning for a tangential constraint.
    pub gap: f64,
    /// The bound of its force if it is tangential; a normal constraint has none.
    pub friction: Option<Friction>,
    /// True for a tie, which is bilateral.
    pub is_tied: bool,
}

/// The bodies and constraints from which rigid motions follow. On the root.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Dimension of space.
    pub dim: usize,
    /// Bodies.
    pub bodies: Vec<BodyState>,
    /// Names.
    pub names: Vec<String>,
    /// Constraints, group by group.
    pub rows: Vec<RigidRow>,
    /// Number of constraints of every group.
    pub conditions: Vec<usize>,
}

/// Bound of a tangential force; in space it bounds the resultant of both tangents of a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Friction {
    /// The normal constraint of the same point.
    pub normal: usize,
    /// The bound.
    pub bound: ForceBound,
}

impl Friction {
    /// True if it can carry a force without normal force, where the contact is closed or not as in `closed`.
    pub(super) fn holds_without_pressure(&self, closed: bool) -> bool {
        self.bound.at(0.0, closed) > 0.0
    }
}
