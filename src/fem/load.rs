//! The loads on a block in a load step.

use contact_dd_partition::model::Support;

use super::block::Block;

/// The loads on a block in a load step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlockLoads {
    /// Prescribed displacements, in ascending order of the block's nodes.
    pub supports: Vec<Support>,
    /// Forces on the block's nodes; a node may have several (N per metre of thickness).
    pub forces: Vec<(u32, [f64; 3])>,
}

impl BlockLoads {
    /// The loads on a block in load step `step`.
    pub fn new(block: &Block, step: usize) -> Self {
        Self {
            supports: block.subdomain.supports_in(step).collect(),
            forces: block.subdomain.forces_in(step).collect(),
        }
    }

    /// Reduces these loads to `before` + `part` · (these − `before`); without loads before, to the `part` of these.
    pub fn go_back(&mut self, before: Option<&Self>, part: f64) {
        let forces = self.forces.iter_mut();
        forces.for_each(|(_, force)| *force = force.map(|f| part * f));
        let earlier = before.map_or(&[][..], |before| &before.forces);
        let rest = |(node, force): &(u32, [f64; 3])| (*node, force.map(|f| (1.0 - part) * f));
        self.forces.extend(earlier.iter().map(rest));
        for (i, support) in self.supports.iter_mut().enumerate() {
            let from = before.map_or(0.0, |before| before.supports[i].value);
            support.value = from + part * (support.value - from);
        }
    }

    /// The forces, node by node.
    pub fn nodal_forces(&self, block: &Block) -> Vec<f64> {
        let mut f = vec![0.0; block.nodes() * block.dim];
        for (node, force) in &self.forces {
            for component in 0..block.dim {
                f[*node as usize * block.dim + component] += force[component];
            }
        }
        f
    }
}
