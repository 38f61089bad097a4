//! Tangential jumps that supports prescribe: their forces follow from the pressure alone.

use serde::{Deserialize, Serialize};

use super::law::rest_of_bound;
use super::tangent::ForceBound;

/// A tangential jump that supports prescribe on both sides, so that its force changes no displacement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PrescribedSlip {
    /// The condition.
    pub condition: usize,
    /// The normal condition of its point.
    pub normal: usize,
    /// Bound of its force.
    pub bound: ForceBound,
    /// The slip in the load step (m).
    pub slip: f64,
    /// The slip along the point's other tangent if that is prescribed, too (m).
    pub beside: f64,
    /// The condition along the other tangent if supports leave that one free.
    pub other: Option<usize>,
}

impl PrescribedSlip {
    /// The force that opposes the slip, given the forces of other conditions.
    pub fn force(&self, forces: &[f64]) -> f64 {
        let normal = forces[self.normal];
        let bound = self.bound.at(normal, normal > 0.0);
        let size = match self.other {
            Some(other) => rest_of_bound(bound, forces[other]),
            None if self.beside == 0.0 => bound,
            None => bound * (self.slip.abs() / self.slip.hypot(self.beside)),
        };
        size.copysign(self.slip)
    }
}
