//! Stresses: the mean over each cell, and at nodes the mean of what the cells around them have
//! there, weighted by their area; across Γ, but never across a contact or a change of material.

use contact_dd_partition::model::{Material, PlaneState};

use super::block::Block;
use super::elasticity::{MAX_NODES, stiffness_points, strain, stress};
use super::recovery::nodal_weights;

/// Area-weighted sum of stresses, such as those around a node, and the area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StressSum {
    /// Σ area·σ (N), order XX YY ZZ XY YZ XZ.
    pub stress: [f64; 6],
    /// Area (m²).
    pub area: f64,
}

impl StressSum {
    /// Adds another part of the surroundings.
    pub fn add(&mut self, other: &Self) {
        for (a, b) in self.stress.iter_mut().zip(&other.stress) {
            *a += b;
        }
        self.area += other.area;
    }

    /// The mean stress (Pa).
    pub fn mean(&self) -> [f64; 6] {
        self.stress.map(|s| s / self.area)
    }
}

/// The stresses of a block.
#[derive(Clone, Debug)]
pub struct BlockStress {
    /// Of every cell, member by member (Pa).
    pub cells: Vec<[f64; 6]>,
    /// Its materials, ascending.
    materials: Vec<u32>,
    /// Around every node, for each of the materials.
    sums: Vec<Vec<StressSum>>,
}

impl BlockStress {
    /// The stresses for displacements `u`, node by node.
    pub fn new(block: &Block, materials: &[Material], plane: PlaneState, u: &[f64]) -> Self {
        let dim = block.dim;
        let mut present: Vec<u32> = (block.members.iter())
            .flat_map(|member| &member.cell_material)
            .copied()
            .collect();
        present.sort_unstable();
        present.dedup();
        let mut sums = vec![vec![StressSum::default(); block.nodes()]; present.len()];
        let count = block.members.iter().map(|m| m.cells.len()).sum();
        let mut cells = Vec::with_capacity(count);
        let mut points = Vec::with_capacity(MAX_NODES);
        let mut u_e = Vec::with_capacity(dim * MAX_NODES);
        let mut at_points = Vec::new();
        for cell in block.cells() {
            points.clear();
            u_e.clear();
            at_points.clear();
            for node in cell.nodes() {
                let node = node as usize;
                points.push(block.points[node]);
                u_e.extend_from_slice(&u[dim * node..dim * (node + 1)]);
            }
            let mut sum = StressSum::default();
            for point in stiffness_points(cell.kind, &points) {
                let sigma = stress(&materials[cell.material], plane, &strain(&point, &u_e));
                sum.add(&StressSum {
                    stress: sigma.map(|s| s * point.weight),
                    area: point.weight,
                });
                at_points.push(sigma);
            }
            cells.push(sum.mean());
            if let Ok(place) = present.binary_search(&(cell.material as u32)) {
                for (node, weights) in cell.nodes().zip(nodal_weights(cell.kind)) {
                    let mut at_node = [0.0; 6];
                    for (weight, sigma) in weights.iter().zip(&at_points) {
                        for (total, s) in at_node.iter_mut().zip(sigma) {
                            *total += weight * sum.area * s;
                        }
                    }
                    sums[place][node as usize].add(&StressSum {
                        stress: at_node,
                        area: sum.area,
                    });
                }
            }
        }
        Self {
            cells,
            materials: present,
            sums,
        }
    }

    /// What this block knows of the surroundings of the nodes it shares: number on Γ, material,
    /// sum.
    pub fn shared<'a>(
        &'a self,
        block: &'a Block,
    ) -> impl Iterator<Item = (u32, u32, StressSum)> + 'a {
        block.interface.iter().flat_map(move |&(node, id)| {
            (self.materials.iter().zip(&self.sums))
                .map(move |(&material, around)| (id, material, around[node as usize]))
                .filter(|(_, _, sum)| sum.area > 0.0)
        })
    }

    /// Puts the sums over all blocks in the place of this block's own, in the order of
    /// [`shared`](Self::shared).
    pub fn set_shared(&mut self, block: &Block, totals: &[StressSum]) {
        let mut totals = totals.iter();
        for &(node, _) in &block.interface {
            for around in &mut self.sums {
                let sum = &mut around[node as usize];
                if sum.area > 0.0
                    && let Some(total) = totals.next()
                {
                    *sum = *total;
                }
            }
        }
    }

    /// The stress recovered at the nodes of member `m`; where two of its materials meet, that of
    /// the first one.
    pub fn at_nodes(&self, block: &Block, m: usize) -> Vec<[f64; 6]> {
        let member = &block.members[m];
        let mut material = vec![u32::MAX; member.points.len()];
        for ((_, nodes), &cell_material) in member.cells.iter().zip(&member.cell_material) {
            for &node in nodes {
                let material = &mut material[node as usize];
                *material = cell_material.min(*material);
            }
        }
        block.node_of[m]
            .iter()
            .zip(&material)
            .map(|(&node, material)| {
                self.materials
                    .binary_search(material)
                    .map_or([0.0; 6], |place| self.sums[place][node as usize].mean())
            })
            .collect()
    }
}
