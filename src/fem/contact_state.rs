//! The solution at contact points.

use contact_dd_partition::contact_point::ContactPoint;
use serde::{Deserialize, Serialize};

/// The solution at a contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// The remaining gap, g − n·⟦u⟧ ≥ 0 (m).
    pub gap: f64,
    /// Normal force ≥ 0 (N, per metre of thickness in the plane).
    pub force: f64,
    /// True if the contact is closed.
    pub closed: bool,
    /// Tangential force on side a, as a rule the slave side, −λ_t t₁ (N, per metre of thickness in the plane).
    pub tangential_force: [f64; 3],
    /// Tangential jump since the unloaded state, w t₁ (m).
    pub slip: [f64; 3],
    /// True if it slips in this load step.
    pub slipping: bool,
    /// Work dissipated by friction in this load step, λ_t Δw (J, per metre of thickness in the plane).
    pub dissipated: f64,
}

impl ContactState {
    /// The number of its status in the result file: 0 open, 1 closed (with friction: sticking), 2 slipping.
    pub fn status(&self) -> u8 {
        match (self.closed, self.slipping) {
            (false, _) => 0,
            (true, false) => 1,
            (true, true) => 2,
        }
    }
}

/// A contact point and the solution there.
pub type ContactRow = (ContactPoint<u32>, ContactState);
