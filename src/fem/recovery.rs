//! Stress recovery at nodes: superconvergent patches around vertices.
//!
//! A vertex within a body and a material has the polynomial of its own patch; one at their boundary has the mean
//! of its neighbours' within. A node on an edge or in a face has the mean of what the vertices of
//! its cell say there.

use contact_dd_partition::element::ElementKind;

use super::block::{Block, BlockCell};
use super::patch::{COMPONENTS, PatchSum, Polynomial};

/// A block's part of the patches around the vertices in one material, and what comes of them.
#[derive(Clone, Debug)]
pub struct Recovery {
    material: usize,
    /// Polynomials around the block's vertices, by node.
    polynomials: Vec<Polynomial>,
    /// Whether cells surround them.
    is_inner: Vec<bool>,
    /// Patches on Γ, in the order of the block's interface.
    shared: Vec<PatchSum>,
    /// Sums of neighbours' polynomials around vertices at the boundary, and how many these are.
    neighbours: Vec<(Polynomial, f64)>,
}

impl Recovery {
    /// Takes the `patches` around the block's nodes in one material.
    pub fn new(block: &Block, material: usize, patches: Vec<PatchSum>) -> Self {
        let shared = (block.interface.iter())
            .map(|&(node, _)| patches[node as usize].clone())
            .collect();
        Self {
            material,
            polynomials: patches.iter().map(PatchSum::fit).collect(),
            is_inner: patches.iter().map(PatchSum::is_inner).collect(),
            shared,
            neighbours: Vec::new(),
        }
    }

    /// The material.
    pub fn material(&self) -> usize {
        self.material
    }

    /// Its patches on Γ that hold any cell: the place in the block's interface and the patch.
    pub fn shared(&self) -> impl Iterator<Item = (usize, &PatchSum)> {
        let shared = self.shared.iter().enumerate();
        shared.filter(|(_, patch)| !patch.is_empty())
    }

    /// Puts the whole patch in the place of this block's part.
    pub fn set_shared(&mut self, block: &Block, place: usize, whole: &PatchSum) {
        let node = block.interface[place].0 as usize;
        self.polynomials[node] = whole.fit();
        self.is_inner[node] = whole.is_inner();
    }

    /// Adds up, for the vertices at the boundary, what this block's cells say of their neighbours
    /// within.
    pub fn gather_neighbours(&mut self, block: &Block) {
        self.neighbours = vec![(Polynomial::default(), 0.0); block.nodes()];
        for cell in block.cells().filter(|cell| cell.material == self.material) {
            let corners = corners(&cell);
            for at_boundary in corners.clone().filter(|&c| !self.is_inner[c]) {
                let (sum, count) = &mut self.neighbours[at_boundary];
                for within in corners.clone().filter(|&c| self.is_inner[c]) {
                    let way = way(block, within, at_boundary);
                    sum.add(1.0, &self.polynomials[within].seen_from(way));
                    *count += 1.0;
                }
            }
        }
    }

    /// The vertices on Γ at the boundary: their place in the block's interface, the sum over
    /// neighbours and their number.
    pub fn shared_neighbours(
        &self,
        block: &Block,
    ) -> impl Iterator<Item = (usize, &Polynomial, f64)> {
        let places = block.interface.iter().enumerate();
        places.filter_map(|(place, &(node, _))| {
            let (sum, count) = self.neighbours.get(node as usize)?;
            let node = node as usize;
            let is_vertex = !self.shared[place].is_empty();
            (is_vertex && !self.is_inner[node]).then_some((place, sum, *count))
        })
    }

    /// Puts the sum over the neighbours in all blocks in the place of this block's.
    pub fn set_neighbours(&mut self, block: &Block, place: usize, sum: Polynomial, count: f64) {
        self.neighbours[block.interface[place].0 as usize] = (sum, count);
    }

    /// The stress at every node of the block in this material (Pa): XX, YY, ZZ, XY; 0 at others.
    pub fn at_nodes(mut self, block: &Block) -> Vec<[f64; COMPONENTS]> {
        for (polynomial, (sum, count)) in self.polynomials.iter_mut().zip(&self.neighbours) {
            if *count > 0.0 {
                let mut mean = Polynomial::default();
                mean.add(count.recip(), sum);
                *polynomial = mean;
            }
        }
        let mut stress = vec![[0.0; COMPONENTS]; block.nodes()];
        for cell in block.cells().filter(|cell| cell.material == self.material) {
            let nodes: Vec<usize> = cell.nodes().map(|node| node as usize).collect();
            for (local, &node) in nodes.iter().enumerate() {
                let around = vertices_of(cell.kind, local);
                let mut mean = [0.0; COMPONENTS];
                for &vertex in around {
                    let from = nodes[vertex];
                    let value = self.polynomials[from].at(way(block, from, node));
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

/// The nodes of a cell's corners.
pub fn corners(cell: &BlockCell<'_>) -> impl Iterator<Item = usize> + Clone {
    cell.nodes()
        .take(cell.kind.corners())
        .map(|node| node as usize)
}

/// From one node to another (m).
fn way(block: &Block, from: usize, to: usize) -> [f64; 2] {
    [0, 1].map(|k| block.points[to][k] - block.points[from][k])
}

/// The corners that a local node lies between; itself if it is one.
fn vertices_of(kind: ElementKind, local: usize) -> &'static [usize] {
    const ALONE: [[usize; 1]; 4] = [[0], [1], [2], [3]];
    if local < kind.corners() {
        return &ALONE[local];
    }
    let mut edges = kind.facets().iter();
    match edges.find(|(_, nodes)| nodes.get(2) == Some(&local)) {
        Some((_, nodes)) => &nodes[..2],
        None => &[0, 1, 2, 3],
    }
}
