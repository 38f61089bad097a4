//! Stress intensity factors of crack tips, for the report.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Stress intensity of a crack tip in the plane, after K. σ ≈ K/√(2πr) ahead of it. Both faces may be in contact, with friction,
/// and under pressure.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StressIntensity {
    /// Name of the tip: the contact between the faces of its crack, and a number in the order of positions.
    pub tip: String,
    /// Tag of its node.
    pub node: i64,
    /// Undeformed position (m).
    pub position: [f64; 3],
    /// Direction in which the crack would grow straight on.
    pub direction: [f64; 3],
    /// K_I, of opening (Pa √m). Below 0 the faces penetrate each other, which contact prevents.
    #[serde(rename = "k_i")]
    pub opening: f64,
    /// K_II, of sliding (Pa √m): positive if the material to the left of `direction` moves along it.
    #[serde(rename = "k_ii")]
    pub sliding: f64,
    /// Energy that is released by growth straight on (J/m², N/m): J.
    pub energy_release_rate: f64,
    /// Radius of the disc that was evaluated (m).
    pub radius: f64,
    /// Largest difference of the factors in discs of three quarters and of half the radius, over their size: it shows the error
    /// of the mesh.
    pub dependence_on_radius: f64,
}
