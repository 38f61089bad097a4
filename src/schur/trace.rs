//! Traces: the unknowns on Γ.

use serde::{Deserialize, Serialize};

/// An unknown on Γ: the node's number on Γ and the axis of its frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct TraceDof {
    /// Number on Γ.
    pub node: u32,
    /// Axis of the node's frame.
    pub axis: u32,
}
