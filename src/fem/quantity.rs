//! Quantities of interest of the solution and their derivatives, for the report.

use contact_dd_partition::id::OnBlocks;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Estimate of an error, relative to its bar, from which on its sign can be trusted.
const TRUSTED: f64 = 0.5;

/// A quantity that the scene requests.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct QuantityValue {
    /// The name in the scene.
    pub name: String,
    /// The kind, named as in the scene.
    pub kind: String,
    /// The value (m, Pa, Pa √m, N, N m or J; forces, moments and energies in the plane per metre of thickness).
    pub value: f64,
    /// Estimated discretization error: approximately the value less the exact one; `null` without an estimate.
    pub error: Option<f64>,
    /// The bar of that estimate: the exact value is expected at most this far from `value`. Where `error` is smaller
    /// than half of it, its sign can't be trusted; `null` without an estimate.
    pub error_bar: Option<f64>,
    /// Tag of the node whose value it is, or that has the largest pressure; `null` of other quantities.
    pub node: Option<i64>,
    /// The derivatives with respect to the parameters of the scene; empty without parameters.
    pub derivatives: Vec<Derivative>,
}

impl QuantityValue {
    /// The estimate, if its sign can be trusted; else the bar.
    pub fn told_error(&self) -> Option<ToldError> {
        let (error, bar) = (self.error?, self.error_bar?);
        Some(match error.abs() >= TRUSTED * bar {
            true => ToldError::Signed(error),
            false => ToldError::Within(bar),
        })
    }
}

/// The estimated error of a quantity as it is printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToldError {
    /// With its sign: the value less the exact one.
    Signed(f64),
    /// The exact value is expected at most this far from the value.
    Within(f64),
}

/// Derivative of a quantity with respect to a parameter of the scene, with fixed contact status.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Derivative {
    /// Name of the parameter.
    pub parameter: String,
    /// The kind: "load", a factor that is 1; "stiffness", Young's modulus or a factor of a stiffness; "gap" and
    /// "displacement", an addition to those of the scene; "friction", the coefficient.
    pub kind: String,
    /// The value; `null` where it isn't the same everywhere.
    pub at: Option<f64>,
    /// The derivative: change of the quantity over change of the parameter.
    pub derivative: f64,
}

/// The quantities of a load step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Quantities {
    /// Their values and derivatives, in the order of the scene.
    pub values: Vec<QuantityValue>,
    /// Contact points whose status is about to change, as text.
    pub about_to_change: Vec<String>,
    /// Contributions of the cells of every block of this rank to the estimated error of the first quantity.
    pub errors_of_cells: OnBlocks<Vec<f64>>,
    /// Reason why derivatives, or those of one quantity, are missing, as text.
    pub without_derivatives: Option<String>,
}
