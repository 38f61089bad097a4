//! Stress recovery at nodes by superconvergent patches around vertices.
//!
//! A vertex in the interior of a body and of a material uses the polynomial of its own patch; one on their boundary
//! uses the mean of its interior neighbours' polynomials. A node on an edge or in a face uses the mean of the
//! polynomials of its cell's vertices.

use std::collections::BTreeMap;

use contact_dd_partition::element::geometry::difference;

use super::block::{Block, BlockCell};
use super::patch::PatchSum;
use super::polynomial::{NodalStress, Polynomial, Polynomials};

/// A block's part of the patches around the vertices in one material, and the recovered polynomials.
#[derive(Clone, Debug)]
pub struct Recovery {
    material: usize,
    /// Polynomials around the block's vertices, by node.
    polynomials: Polynomials,
    /// Flags of the nodes surrounded by cells.
    is_inner: Vec<bool>,
    /// Patches on Γ, in the order of the block's interface.
    shared: Vec<PatchSum>,
    /// Sums of neighbours' polynomials around vertices on the boundary, and the number of these neighbours.
    neighbours: BTreeMap<usize, (Polynomial, f64)>,
}

impl Recovery {
    /// The recovery from the `patches` around the block's nodes in one material.
    pub fn new(block: &Block, material: usize, patches: &[PatchSum]) -> Self {
        let shared = (block.interface.iter())
            .map(|&(node, _)| patches[node as usize])
            .collect();
        let are_linear = block.cells().all(|cell| cell.kind.is_linear());
        let mut polynomials = Polynomials::zeros(block.dim, block.nodes(), are_linear);
        for (node, patch) in patches.iter().enumerate() {
            if !patch.is_empty() {
                polynomials.set(node, &patch.fit());
            }
        }
        Self {
            material,
            polynomials,
            is_inner: patches.iter().map(PatchSum::is_inner).collect(),
            shared,
            neighbours: BTreeMap::new(),
        }
    }

    /// The material.
    pub fn material(&self) -> usize {
        self.material
    }

    /// Non-empty patches on Γ: the place in the block's interface and the patch.
    pub fn shared(&self) -> impl Iterator<Item = (usize, &PatchSum)> {
        let shared = self.shared.iter().enumerate();
        shared.filter(|(_, patch)| !patch.is_empty())
    }

    /// Replaces this block's part of a patch by the whole patch.
    pub fn set_shared(&mut self, block: &Block, place: usize, whole: &PatchSum) {
        let node = block.interface[place].0 as usize;
        self.polynomials.set(node, &whole.fit());
        self.is_inner[node] = whole.is_inner();
    }

    /// Sums, for the vertices on the boundary, the polynomials of their interior neighbours in this block's cells.
    pub fn gather_neighbours(&mut self, block: &Block) {
        for cell in block.cells().filter(|cell| cell.material == self.material) {
            let corners = corners(&cell);
            if corners.clone().all(|c| self.is_inner[c]) {
                continue;
            }
            for at_boundary in corners.clone().filter(|&c| !self.is_inner[c]) {
                let (sum, count) = (self.neighbours.entry(at_boundary))
                    .or_insert_with(|| (Polynomial::zero(block.dim), 0.0));
                for within in corners.clone().filter(|&c| self.is_inner[c]) {
                    let offset = offset(block, within, at_boundary);
                    sum.add(1.0, &self.polynomials.get(within).seen_from(offset));
                    *count += 1.0;
                }
            }
        }
    }

    /// The boundary vertices on Γ: their place in the block's interface, the sum over neighbours and their number.
    pub fn shared_neighbours(
        &self,
        block: &Block,
    ) -> impl Iterator<Item = (usize, &Polynomial, f64)> {
        let places = block.interface.iter().enumerate();
        places.filter_map(|(place, &(node, _))| {
            let (sum, count) = self.neighbours.get(&(node as usize))?;
            Some((place, sum, *count))
        })
    }

    /// Replaces this block's sum over neighbours by that over all blocks.
    pub fn set_neighbours(&mut self, block: &Block, place: usize, sum: Polynomial, count: f64) {
        let node = block.interface[place].0 as usize;
        self.neighbours.insert(node, (sum, count));
    }

    /// The stress at every node of the block in this material (Pa); 0 at others.
    pub fn at_nodes(mut self, block: &Block) -> Vec<NodalStress> {
        for (&node, (sum, count)) in &self.neighbours {
            if *count > 0.0 {
                let mut mean = Polynomial::zero(block.dim);
                mean.add(count.recip(), sum);
                self.polynomials.set(node, &mean);
            }
        }
        let mut stress: Vec<NodalStress> = (0..block.nodes())
            .map(|node| self.polynomials.get(node).at([0.0; 3]))
            .collect();
        let quadratic =
            |cell: &BlockCell<'_>| cell.material == self.material && !cell.kind.is_linear();
        for cell in block.cells().filter(quadratic) {
            let nodes: Vec<usize> = cell.nodes().map(|node| node as usize).collect();
            for local in cell.kind.corners()..nodes.len() {
                let around = cell.kind.corners_around(local);
                let node = nodes[local];
                let mut mean = [0.0; 6];
                for &vertex in around {
                    let from = nodes[vertex];
                    let value = self.polynomials.get(from).at(offset(block, from, node));
                    for (m, v) in mean.iter_mut().zip(value) {
                        *m += v / around.len() as f64;
                    }
                }
                stress[node] = mean;
            }
        }
        stress
    }
}

/// The nodes at a cell's corners.
fn corners(cell: &BlockCell<'_>) -> impl Iterator<Item = usize> + Clone {
    cell.nodes()
        .take(cell.kind.corners())
        .map(|node| node as usize)
}

/// Vector from one node to another (m).
fn offset(block: &Block, from: usize, to: usize) -> [f64; 3] {
    difference(block.points()[to], block.points()[from])
}
