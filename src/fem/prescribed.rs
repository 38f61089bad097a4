//! The constant part of a block's displacement in a load step: c of u = T x + c.

use std::collections::BTreeMap;

use contact_dd_partition::model::Material;

use super::block::OwnedBlock;
use super::bounds::jumps;
use super::dofs::{DofError, Dofs};
use super::frame::{Frame, NodeFrames};
use super::load::BlockLoads;
use crate::contact::normal_jump::{NormalJumpOf, NormalJumps, OnInterface};

/// What supports prescribe in a load step.
#[derive(Clone, Debug)]
pub struct Prescribed {
    dim: usize,
    /// c, node by node (m).
    constants: Vec<f64>,
    /// Where the normal jump of each contact point is found.
    pub jump_of: Vec<NormalJumpOf>,
}

impl Prescribed {
    /// What `loads` prescribe in a block with these unknowns.
    ///
    /// # Errors
    /// A contact point that lies on Γ.
    pub fn new(
        owned: &OwnedBlock,
        loads: &BlockLoads,
        materials: &[Material],
    ) -> Result<Self, DofError> {
        let frames = NodeFrames::new(owned, loads);
        let jumps =
            jumps(owned, materials, &frames).map_err(|OnInterface(j)| DofError::OnInterface(j))?;
        let dim = owned.block.dim;
        let mut prescribed = Self {
            dim,
            constants: vec![0.0; dim * owned.block.nodes()],
            jump_of: Vec::new(),
        };
        prescribed.add_supports(&frames);
        prescribed.add_replaced(&frames, &jumps);
        prescribed.jump_of = jumps.of;
        Ok(prescribed)
    }

    fn add_supports(&mut self, frames: &NodeFrames) {
        for (node, frame) in frames.special() {
            for axis in 0..self.dim {
                if let Some(value) = frame.prescribed[axis] {
                    self.add(node, frame.axes[axis], value);
                }
            }
        }
    }

    /// Adds the constants of the displacements that normal jumps replace.
    fn add_replaced(&mut self, frames: &NodeFrames, jumps: &NormalJumps) {
        // In the order of the unknowns: a hash map has none.
        let replaced: BTreeMap<u32, f64> = (jumps.replaced.iter())
            .map(|(&raw, value)| (raw, value.constant))
            .collect();
        for (raw, value) in replaced {
            let (node, axis) = (raw / self.dim as u32, raw as usize % self.dim);
            let frame = frames.of(node).unwrap_or(&Frame::CARTESIAN);
            self.add(node, frame.axes[axis], value);
        }
    }

    fn add(&mut self, node: u32, along: [f64; 3], value: f64) {
        let start = node as usize * self.dim;
        let constants = &mut self.constants[start..start + self.dim];
        for (constant, along) in constants.iter_mut().zip(along) {
            *constant += along * value;
        }
    }

    /// c of a node (m).
    pub fn of_node(&self, node: u32) -> &[f64] {
        &self.constants[node as usize * self.dim..][..self.dim]
    }

    /// Whether c is zero.
    pub fn is_zero(&self) -> bool {
        self.constants.iter().all(|&c| c == 0.0)
    }

    /// u = T x + c, node by node (m).
    pub fn displacement(&self, dofs: &Dofs, x: &[f64]) -> Vec<f64> {
        let mut u = self.constants.clone();
        dofs.add_change(x, &mut u);
        u
    }
}
