//! The constant part of a block's displacement in a load step: c of u = T x + c.

use super::block::Block;
use super::dofs::Dofs;
use super::frame::support_frames;
use super::load::BlockLoads;
use crate::vector::axpy;

/// Displacements that supports prescribe in a load step.
#[derive(Clone, Debug)]
pub struct Prescribed {
    dim: usize,
    /// c, node by node (m).
    constants: Vec<f64>,
}

impl Prescribed {
    /// The displacements prescribed in a block by `loads`.
    pub fn new(block: &Block, loads: &BlockLoads) -> Self {
        let dim = block.dim;
        let mut constants = vec![0.0; dim * block.nodes()];
        for (node, frame) in support_frames(&loads.supports, dim) {
            for axis in 0..dim {
                if let Some(value) = frame.prescribed[axis] {
                    let of_node = &mut constants[node as usize * dim..][..dim];
                    axpy(value, &frame.axes[axis], of_node);
                }
            }
        }
        Self { dim, constants }
    }

    /// c of a node (m).
    pub fn of_node(&self, node: u32) -> &[f64] {
        &self.constants[node as usize * self.dim..][..self.dim]
    }

    /// c, node by node (m).
    pub fn constants(&self) -> &[f64] {
        &self.constants
    }

    /// True if c is zero.
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
