//! Traces: the unknowns on Γ.

use crate::comm::{Message, MessageReader};

/// An unknown on Γ: the node's number on Γ and the axis of its frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TraceDof {
    /// Number on Γ.
    pub node: u32,
    /// Axis of the node's frame.
    pub axis: u32,
}

impl TraceDof {
    /// Appends `traces` to a message.
    pub fn pack(traces: &[Self], message: &mut Message) {
        let numbers = traces.iter().flat_map(|dof| [dof.node, dof.axis]);
        message.integers.extend(numbers.map(i64::from));
    }

    /// The next `count` of a message.
    pub fn unpack(reader: &mut MessageReader, count: usize) -> Vec<Self> {
        (0..count)
            .map(|_| Self {
                node: reader.integer() as u32,
                axis: reader.integer() as u32,
            })
            .collect()
    }
}
