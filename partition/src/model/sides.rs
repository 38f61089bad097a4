//! The two sides of a contact: data for every discretization. Side a is the slave side, side b the master side.

use std::collections::{HashMap, HashSet};

use super::surface::Surface;
use crate::error::InputError;
use crate::mesh::Mesh;

/// Interference up to which two sides face each other, relative to the smaller side: beyond it the bodies' material
/// lies between them.
pub(super) const INTERFERENCE: f64 = 0.1;

/// A node of a side with its outward normal and its tributary area.
pub(super) struct SideNode {
    pub node: u32,
    pub position: [f64; 3],
    pub normal: [f64; 3],
    pub tributary_area: f64,
}

/// Two sides in possible contact.
pub(super) struct Sides<'a> {
    pub mesh: &'a Mesh,
    pub a: &'a Surface,
    pub b: &'a Surface,
    /// The facets around each node of side a.
    pub around_a: HashMap<u32, Vec<usize>>,
    /// The facets around each node of side b.
    pub around_b: HashMap<u32, Vec<usize>>,
    /// Nodes of both sides, crack tips; they carry no constraint.
    pub shared: HashSet<u32>,
    /// The nodes along side a without the shared ones.
    pub nodes_a: Vec<SideNode>,
    /// The nodes along side b without the shared ones.
    pub nodes_b: Vec<SideNode>,
    /// Largest overlap of the sides (m).
    pub behind: f64,
}

impl<'a> Sides<'a> {
    /// Combines two sides. `what` names the contact.
    ///
    /// # Errors
    /// A node at which a side has no normal.
    pub fn new(
        mesh: &'a Mesh,
        a: &'a Surface,
        b: &'a Surface,
        what: &str,
    ) -> Result<Self, InputError> {
        let (around_a, around_b) = (a.around(), b.around());
        let nodes = around_a.keys().copied();
        let shared: HashSet<u32> = nodes.filter(|n| around_b.contains_key(n)).collect();
        Ok(Self {
            nodes_a: side_nodes(mesh, a, what, &shared)?,
            nodes_b: side_nodes(mesh, b, what, &shared)?,
            behind: INTERFERENCE * a.extent().min(b.extent()),
            mesh,
            a,
            b,
            around_a,
            around_b,
            shared,
        })
    }
}

/// Reason why sides have no constraint; `back_facing` if they would have some with one of them reversed.
pub(super) fn apart(back_facing: bool) -> String {
    if back_facing {
        "the sides face the same way; expected them face to face".to_owned()
    } else {
        "no node of side a has one of side b on its outward normal; \
         expected sides that face each other"
            .to_owned()
    }
}

/// The nodes along a side except those in `shared`. `what` names the contact.
///
/// # Errors
/// A node at which the side has no normal.
pub(super) fn side_nodes(
    mesh: &Mesh,
    side: &Surface,
    what: &str,
    shared: &HashSet<u32>,
) -> Result<Vec<SideNode>, InputError> {
    let nodes = side.nodes();
    (side.in_order().into_iter())
        .filter(|node| !shared.contains(node))
        .map(|node| {
            let Some(normal) = nodes[&node].normal() else {
                return Err(InputError::new(format!(
                    "{what}: the side has no normal at node {}, its facets there face \
                     opposite ways",
                    mesh.node_tags[node as usize]
                )));
            };
            Ok(SideNode {
                node,
                position: mesh.points[node as usize],
                normal,
                tributary_area: nodes[&node].tributary_area,
            })
        })
        .collect()
}
