//! Free rigid motions.

use serde::{Deserialize, Serialize};

/// A free rigid-body motion without load along it: for each body that moves, its coefficients.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FreeMotion {
    /// Bodies and their coefficients.
    pub bodies: Vec<(usize, Vec<f64>)>,
}
