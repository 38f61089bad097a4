//! The contact points of a block, n·⟦u⟧ ≤ g, as bounds on normal jumps, t ≤ g.

use std::collections::BTreeMap;

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::geometry::{dot, length};
use contact_dd_partition::model::Material;

use super::block::{Block, OwnedBlock};
use super::frame::{Frame, NodeFrames};
use crate::contact::normal_jump::{NormalJumpRow, NormalJumps, OnInterface};

/// The normal jumps of a block's contact points.
///
/// # Errors
/// A condition that lies on Γ.
pub(super) fn jumps(
    owned: &OwnedBlock,
    materials: &[Material],
    frames: &NodeFrames,
) -> Result<NormalJumps, OnInterface> {
    let OwnedBlock { block, points } = owned;
    if points.is_empty() {
        return Ok(NormalJumps::default());
    }
    let dim = block.dim;
    let frame = |node: u32| frames.of(node).unwrap_or(&Frame::CARTESIAN);
    let rows: Vec<_> = (points.iter())
        .map(|point| in_frames(point, frame, dim))
        .collect();
    let on_interface = block.is_on_interface();
    let may_go = |v: u32| !on_interface[v as usize / dim];
    let of_nodes = node_stiffness(block, materials);
    let stiffness = |v: u32| of_nodes[v as usize / dim];
    NormalJumps::new(&rows, may_go, stiffness)
}

/// The stiffest material around every node (Pa).
fn node_stiffness(block: &Block, materials: &[Material]) -> Vec<f64> {
    let mut stiffness = vec![0.0; block.nodes()];
    for cell in block.cells() {
        let modulus = materials[cell.material].stiffness[0][0];
        for node in cell.nodes() {
            let of_node: &mut f64 = &mut stiffness[node as usize];
            *of_node = of_node.max(modulus);
        }
    }
    stiffness
}

/// The normal jump at a point in terms of components along the axes of its nodes' frames.
fn in_frames<'a>(
    point: &ContactPoint<u32>,
    frame: impl Fn(u32) -> &'a Frame,
    dim: usize,
) -> NormalJumpRow {
    let mut constant = 0.0;
    let mut row: BTreeMap<u32, f64> = BTreeMap::new();
    for (node, push) in point.row() {
        let frame = frame(node);
        for axis in 0..dim {
            let along = dot(push, frame.axes[axis]);
            match frame.prescribed[axis] {
                Some(value) => constant += along * value,
                None => *row.entry(node * dim as u32 + axis as u32).or_default() += along,
            }
        }
    }
    // A frame along the point's own normal leaves round-off on its other axes.
    let sizes = point.row().map(|(_, push)| length(push));
    let scale = sizes.fold(0.0, f64::max);
    NormalJumpRow {
        constant,
        terms: row
            .into_iter()
            .filter(|(_, c)| c.abs() > 1e-14 * scale)
            .collect(),
    }
}
