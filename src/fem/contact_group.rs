//! A contact group: the contact points that belong to one node of the hierarchy, where all that have one of
//! their nodes come together, and what they need to know of these nodes.

use std::collections::BTreeMap;

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::geometry::{dot, length};
use contact_dd_partition::model::{Material, Support};
use contact_dd_partition::problem::consistency::Place;
use serde::{Deserialize, Serialize};

use super::block::Block;
use super::frame::{Frame, support_frames};
use crate::contact::normal_jump::{NoUnknown, NormalJumpRow, NormalJumps, Sum, Variable};
use crate::schur::condensed::InterfaceDof;
use crate::schur::substitution::Replaced;

/// A node of contact points, as its subdomain describes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactNode {
    /// Its number on Γ.
    pub interface: u32,
    /// The mesh file's tag.
    pub tag: i64,
    /// Its body.
    pub body: usize,
    /// Coordinates (m).
    pub at: [f64; 3],
    /// The stiffest material around it (Pa).
    pub stiffness: f64,
    /// Directions of its supports, and what they prescribe in every load step (m).
    pub supports: Vec<([f64; 3], Vec<f64>)>,
}

impl ContactNode {
    /// Some `nodes` of a block: the block's node and its number on Γ.
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
                at: subdomain.points[node as usize],
                stiffness: stiffness[&node],
                supports: (start..end).map(support).collect(),
            }
        };
        nodes.iter().map(of_node).collect()
    }

    /// It as the check of contact points sees it.
    pub fn place(&self) -> Place {
        Place {
            tag: self.tag,
            body: self.body,
            at: self.at,
        }
    }
}

/// Contact points over nodes of their own numbering.
#[derive(Clone, Debug, Default)]
pub struct ContactGroup {
    /// The points.
    pub points: Vec<ContactPoint<u32>>,
    /// Their nodes.
    pub nodes: Vec<ContactNode>,
    /// Number of dofs of a node.
    pub dim: usize,
}

/// What acts on a contact group in a load step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupLoads {
    /// The gap at every point (m).
    pub gaps: Vec<f64>,
    /// What the supports of every node prescribe (m).
    pub held: Vec<Vec<f64>>,
}

impl GroupLoads {
    /// What acts on `group` in load step k.
    pub fn new(group: &ContactGroup, k: usize) -> Self {
        let held = |node: &ContactNode| node.supports.iter().map(|(_, values)| values[k]).collect();
        Self {
            gaps: group.points.iter().map(|point| point.gap).collect(),
            held: group.nodes.iter().map(held).collect(),
        }
    }

    /// The largest displacement that is prescribed, gaps among them (m).
    pub fn largest_prescribed(&self) -> f64 {
        let all = self.held.iter().flatten().chain(&self.gaps);
        all.fold(0.0, |m: f64, x| m.max(x.abs()))
    }
}

impl ContactGroup {
    /// The gaps that displacements `u`, node by node, leave at the points: g − n·⟦u⟧ (m).
    pub fn gaps_left(&self, loads: &GroupLoads, u: &[f64]) -> Vec<f64> {
        let gaps = self.points.iter().zip(&loads.gaps);
        gaps.map(|(point, gap)| gap - point.normal_jump(self.dim, u))
            .collect()
    }

    /// The gaps that supports leave where what is free doesn't move (m): the bounds on the normal jumps t = b·x.
    pub fn bounds(&self, loads: &GroupLoads) -> Vec<f64> {
        let frames = self.frames();
        let bound = |(point, gap): (&ContactPoint<u32>, &f64)| {
            let prescribed = point.row().flat_map(|(node, push)| {
                let (axes, held) = (frames[node as usize].axes, &loads.held[node as usize]);
                (held.iter().zip(axes)).map(move |(value, axis)| dot(push, axis) * value)
            });
            gap - prescribed.sum::<f64>()
        };
        self.points.iter().zip(&loads.gaps).map(bound).collect()
    }

    /// The normal jumps of the points, for the displacements along the axes of their nodes that supports leave
    /// free. They replace displacements of nodes that are `eliminated` where the points belong.
    ///
    /// # Errors
    /// A point that no displacement can be replaced for.
    pub fn normal_jumps(&self, eliminated: &[u32]) -> Result<NormalJumps, NoUnknown> {
        let frames = self.frames();
        let rows: Vec<_> = self
            .points
            .iter()
            .map(|point| self.row(point, &frames))
            .collect();
        let node = |v: u32| &self.nodes[v as usize / self.dim];
        let may_go = |v: u32| eliminated.binary_search(&node(v).interface).is_ok();
        NormalJumps::new(&rows, may_go, |v| node(v).stiffness)
    }

    /// What normal jumps replace, in the words of Γ.
    pub fn replaced(&self, jumps: &NormalJumps) -> Vec<Replaced> {
        let dof = |v: u32| InterfaceDof {
            node: self.nodes[v as usize / self.dim].interface,
            axis: v % self.dim as u32,
        };
        let replaced = |pivot: &u32| {
            let Sum { terms } = &jumps.replaced[pivot];
            let staying = terms.iter().filter_map(|&(variable, c)| match variable {
                Variable::Displacement(v) => Some((dof(v), c)),
                Variable::NormalJump(_) => None,
            });
            let of_jumps = terms.iter().filter_map(|&(variable, c)| match variable {
                Variable::Displacement(_) => None,
                Variable::NormalJump(t) => Some((t as usize, c)),
            });
            Replaced {
                dof: dof(*pivot),
                staying: staying.collect(),
                jumps: of_jumps.collect(),
            }
        };
        jumps.pivots.iter().map(replaced).collect()
    }

    /// What contact `forces`, one a point, make of Bᵀλ: on every node its parts.
    pub fn pushes(&self, forces: &[f64]) -> Vec<Vec<[f64; 3]>> {
        let mut pushes = vec![Vec::new(); self.nodes.len()];
        for (point, force) in self.points.iter().zip(forces) {
            for (node, row) in point.row() {
                pushes[node as usize].push(row.map(|n| n * force));
            }
        }
        pushes
    }

    /// The frames of the nodes; what supports prescribe in the first load step stands for all.
    fn frames(&self) -> Vec<Frame> {
        let of_node = |node: &ContactNode| {
            let support = |(direction, values): &([f64; 3], Vec<f64>)| Support {
                node: 0,
                direction: *direction,
                value: values[0],
                condition: 0,
            };
            let supports: Vec<Support> = node.supports.iter().map(support).collect();
            let frame = support_frames(&supports, self.dim).remove(&0);
            frame.unwrap_or(Frame::CARTESIAN)
        };
        self.nodes.iter().map(of_node).collect()
    }

    /// The normal jump at a point in terms of what is free along the axes of its nodes' frames.
    fn row(&self, point: &ContactPoint<u32>, frames: &[Frame]) -> NormalJumpRow {
        let mut row: BTreeMap<u32, f64> = BTreeMap::new();
        for (node, push) in point.row() {
            let frame = &frames[node as usize];
            for axis in (0..self.dim).filter(|&axis| frame.prescribed[axis].is_none()) {
                let v = node * self.dim as u32 + axis as u32;
                *row.entry(v).or_default() += dot(push, frame.axes[axis]);
            }
        }
        // A frame along the point's own normal leaves round-off on its other axes.
        let sizes = point.row().map(|(_, push)| length(push));
        let scale = sizes.fold(0.0, f64::max);
        row.retain(|_, c| c.abs() > 1e-14 * scale);
        row.into_iter().collect()
    }
}
