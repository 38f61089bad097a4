//! Crack tips of a plane mesh: data for the evaluation of stress intensity factors.

use serde::{Deserialize, Serialize};

/// A node at which both faces of a crack end, and the disc around it in which the crack is straight and the near field
/// of the tip is undisturbed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CrackTip {
    /// Name.
    pub name: String,
    /// Tag of its node.
    pub tag: i64,
    /// Index of its body.
    pub body: u32,
    /// Index of the material around it.
    pub material: u32,
    /// Position (m).
    pub position: [f64; 3],
    /// The unit vector of straight crack growth.
    pub direction: [f64; 3],
    /// Radius of the disc (m).
    pub radius: f64,
    /// The facets of its faces in the disc.
    pub facets: Vec<FaceFacet>,
}

/// A facet of a crack face, with its nodes: the end nearer to the tip, the other end, and the middle node.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FaceFacet {
    /// True if the body lies on the left of the crack's direction.
    pub is_upper: bool,
    /// Tags of the nodes; −1 without a middle node.
    pub nodes: [i64; 3],
    /// Distances of the nodes from the tip (m).
    pub distances: [f64; 3],
}

impl FaceFacet {
    /// Tags of its nodes.
    pub fn nodes(&self) -> &[i64] {
        match self.nodes[2] {
            -1 => &self.nodes[..2],
            _ => &self.nodes,
        }
    }
}
