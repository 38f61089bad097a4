//! The nodes of contact points, with the data of their subdomains.

use std::collections::BTreeMap;

use contact_dd_partition::model::{Material, Support};
use contact_dd_partition::problem::consistency::NodePlace;
use serde::{Deserialize, Serialize};

use super::block::Block;

/// A node of contact points, with the data of its subdomain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactNode {
    /// Number on Γ.
    pub interface: u32,
    /// Tag in the mesh file.
    pub tag: i64,
    /// Body of the node.
    pub body: usize,
    /// True if it is an auxiliary node between the sides of a point, which belongs to no body.
    pub is_auxiliary: bool,
    /// Coordinates (m).
    pub at: [f64; 3],
    /// The stiffness of the stiffest material around it (Pa).
    pub stiffness: f64,
    /// Directions of its supports, and their prescribed displacements in every load step (m).
    pub supports: Vec<([f64; 3], Vec<f64>)>,
    /// The normal, if only the displacement along it is on Γ; `None` if all components are, as with supports.
    pub slides: Option<[f64; 3]>,
}

impl ContactNode {
    /// The contact nodes for some `nodes` of a block, given as node of the block and number on Γ.
    pub fn of(block: &Block, materials: &[Material], nodes: &[(u32, u32)]) -> Vec<Self> {
        let mut stiffness: BTreeMap<u32, f64> =
            nodes.iter().map(|&(node, _)| (node, 0.0)).collect();
        for cell in block.cells() {
            for node in cell.nodes() {
                if let Some(of_node) = stiffness.get_mut(&node) {
                    *of_node = of_node.max(materials[cell.material].stiffness[0][0]);
                }
            }
        }
        let subdomain = &block.subdomain;
        let steps = subdomain.steps.len().max(1);
        let values: Vec<Vec<Support>> = (0..steps)
            .map(|k| subdomain.supports_in(k).collect())
            .collect();
        let of_node = |&(node, interface): &(u32, u32)| {
            let start = values[0].partition_point(|s| s.node < node);
            let end = values[0].partition_point(|s| s.node <= node);
            let support = |i: usize| {
                (
                    values[0][i].direction,
                    values.iter().map(|step| step[i].value).collect(),
                )
            };
            Self {
                interface,
                tag: subdomain.node_tags[node as usize],
                body: subdomain.body,
                is_auxiliary: node as usize >= subdomain.body_nodes(),
                at: subdomain.points[node as usize],
                stiffness: stiffness[&node],
                supports: (start..end).map(support).collect(),
                slides: (block.slides.get(&node).copied()).filter(|_| start == end),
            }
        };
        nodes.iter().map(of_node).collect()
    }

    /// The position of the node, for the check of contact points.
    pub fn place(&self) -> NodePlace {
        NodePlace {
            tag: self.tag,
            body: self.body,
            at: self.at,
            is_auxiliary: self.is_auxiliary,
        }
    }
}
