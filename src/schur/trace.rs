//! Traces: the unknowns on Γ.

/// An unknown on Γ: the node's number on Γ and the axis of its frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TraceDof {
    /// Number on Γ.
    pub node: u32,
    /// Axis of the node's frame.
    pub axis: u32,
}
