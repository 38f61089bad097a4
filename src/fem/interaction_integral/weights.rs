//! The interaction integral as a linear function of displacements.

use contact_dd_partition::problem::InitialStress;

use super::{Block, LocalCell, OfCell, TipDisc, amplitudes};

/// M of both modes over a block: weights of its displacements, node by node, and the constant part.
pub struct TipWeights {
    /// The weights.
    pub of_nodes: [Vec<f64>; 2],
    /// The constant part (Pa √m · m).
    pub constants: [f64; 2],
}

impl TipDisc<'_> {
    /// M over the cells of a block in the largest disc; `None` if none lies in it.
    pub fn weights(&self, block: &Block, initial: &InitialStress) -> Option<TipWeights> {
        let mut sum = None;
        self.each_cell(block, initial, 1, |cell, found| {
            let sum = sum.get_or_insert_with(|| TipWeights {
                of_nodes: [0, 1].map(|_| vec![0.0; 2 * block.nodes()]),
                constants: [0.0; 2],
            });
            for (mode, found) in found[0].iter().enumerate() {
                sum.constants[mode] += found.constant;
                let of_nodes = self.without_modes(cell, found);
                for (&node, of_node) in cell.numbers.iter().zip(of_nodes.as_chunks().0) {
                    let back = self.turn_back(*of_node);
                    sum.of_nodes[mode][2 * node] += back[0];
                    sum.of_nodes[mode][2 * node + 1] += back[1];
                }
            }
        });
        sum
    }

    /// Cartesian components of a vector given in the frame of the tip.
    fn turn_back(&self, x: [f64; 2]) -> [f64; 2] {
        let [cos, sin, _] = self.tip.direction;
        [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]]
    }

    /// The coefficients of the displacements of a cell's nodes, with the amplitudes of its incompatible modes
    /// eliminated, in the frame of the tip.
    fn without_modes(&self, cell: &LocalCell<'_>, found: &OfCell) -> Vec<f64> {
        let (nodes, modes) = found.slopes.split_at(cell.nodes.len());
        let (mut of_nodes, modes) = (nodes.concat(), modes.concat());
        if modes.is_empty() {
            return of_nodes;
        }
        for place in 0..of_nodes.len() {
            let mut unit = vec![0.0; of_nodes.len()];
            unit[place] = 1.0;
            let follow = amplitudes(&cell.kind, &cell.points, &self.material, &unit);
            let parts = follow.iter().zip(&modes);
            of_nodes[place] += parts
                .map(|(amplitude, slope)| amplitude * slope)
                .sum::<f64>();
        }
        of_nodes
    }
}
