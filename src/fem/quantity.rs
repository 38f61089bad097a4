//! Quantities of interest of the solution and their derivatives, for the report.

use contact_dd_partition::id::OnBlocks;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// Tag of the node whose value it is, or that has the largest pressure; `null` of other quantities.
    pub node: Option<i64>,
    /// The derivatives with respect to the parameters of the scene; empty without parameters.
    pub derivatives: Vec<Derivative>,
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
