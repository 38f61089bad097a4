//! Stresses: the mean over each cell, at nodes by recovery, and the error that their difference
//! tells of.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::element::quadrature::TabulatedPoint;
use contact_dd_partition::model::{Material, PlaneState};

use super::block::{Block, BlockCell};
use super::elasticity::{MAX_DOFS, MAX_NODES, gradients, stiffness_points, strain, stress};
use super::estimate::{CellError, Compliance};
use super::patch::{COMPONENTS, PatchSum};
use super::recovery::Recovery;

/// The stresses of a block.
#[derive(Clone, Debug)]
pub struct BlockStress {
    /// Of every cell (Pa), order XX YY ZZ XY YZ XZ.
    pub cells: Vec<[f64; 6]>,
    /// What is recovered in each material, ascending.
    pub recoveries: Vec<Recovery>,
}

/// Stresses at nodes and what they say of the cells' error.
#[derive(Clone, Debug)]
pub struct RecoveredStress {
    /// The block's materials, ascending.
    materials: Vec<usize>,
    /// At every node in each of them (Pa).
    at_nodes: Vec<Vec<[f64; COMPONENTS]>>,
    /// Estimated error of every cell.
    pub errors: Vec<CellError>,
}

impl BlockStress {
    /// The stresses for displacements `u`, node by node; `patches` is memory that may be used.
    pub fn new(
        block: &Block,
        materials: &[Material],
        plane: PlaneState,
        u: &[f64],
        patches: &mut Vec<PatchSum>,
    ) -> Self {
        let mut present: Vec<usize> = (block.subdomain.cell_material.iter())
            .map(|&material| material as usize)
            .collect();
        present.sort_unstable();
        present.dedup();
        patches.clear();
        patches.resize_with(block.nodes() * present.len(), PatchSum::default);
        let mut cells = Vec::with_capacity(block.subdomain.cells.len());
        let mut local = LocalCell::empty();
        for cell in block.cells() {
            local.take(block, &cell, u);
            let material = &materials[cell.material];
            let mean = local.mean(material, plane);
            cells.push(mean);
            let Ok(place) = present.binary_search(&cell.material) else {
                continue;
            };
            let around = &mut patches[place * block.nodes()..][..block.nodes()];
            let corners = &local.nodes[..cell.kind.corners()];
            for (corner, &node) in corners.iter().enumerate() {
                around[node].add_cell(local.turn(corner), !cell.kind.is_linear());
            }
            for point in cell.kind.stress_points() {
                let at = local.place(point);
                let sigma = match cell.kind {
                    // It is the same everywhere.
                    ElementKind::Triangle3 => mean,
                    _ => local.stress(point, material, plane),
                };
                let [xx, yy, zz, xy, ..] = sigma;
                for (&node, from) in corners.iter().zip(&local.points) {
                    around[node].add_sample([at[0] - from[0], at[1] - from[1]], [xx, yy, zz, xy]);
                }
            }
        }
        let recoveries = (present
            .into_iter()
            .zip(patches.chunks(block.nodes().max(1))))
        .map(|(material, patches)| Recovery::new(block, material, patches))
        .collect();
        Self { cells, recoveries }
    }

    /// The stresses at nodes, and the estimate, for the same displacements.
    pub fn recover(&mut self, block: &Block, materials: &[Material], u: &[f64]) -> RecoveredStress {
        let recoveries = std::mem::take(&mut self.recoveries);
        let present: Vec<usize> = recoveries.iter().map(Recovery::material).collect();
        let at_nodes: Vec<_> = (recoveries.into_iter())
            .map(|recovery| recovery.at_nodes(block))
            .collect();
        let mut errors = Vec::with_capacity(self.cells.len());
        let mut local = LocalCell::empty();
        let mut recovered = Vec::with_capacity(MAX_NODES);
        let compliances: Vec<Compliance> = (present.iter())
            .map(|&material| Compliance::new(&materials[material]))
            .collect();
        for (cell, stress) in block.cells().zip(&self.cells) {
            let Ok(place) = present.binary_search(&cell.material) else {
                continue;
            };
            let (at_nodes, compliance) = (&at_nodes[place], &compliances[place]);
            if cell.kind == ElementKind::Triangle3 {
                let mut nodes = cell.nodes().map(|node| node as usize);
                let nodes: [usize; 3] = std::array::from_fn(|_| nodes.next().unwrap_or_default());
                let area = cell.kind.measure(&nodes.map(|node| block.points()[node]));
                let recovered = nodes.map(|node| &at_nodes[node]);
                errors.push(compliance.triangle(area, stress, recovered));
                continue;
            }
            local.take(block, &cell, u);
            recovered.clear();
            recovered.extend(cell.nodes().map(|node| at_nodes[node as usize]));
            let of_cell = (cell.kind, &local.points[..], &local.u[..]);
            errors.push(compliance.cell(of_cell, &recovered, &materials[cell.material]));
        }
        RecoveredStress {
            materials: present,
            at_nodes,
            errors,
        }
    }
}

impl RecoveredStress {
    /// The stress recovered at the nodes (Pa); where two materials meet, that of the first one.
    pub fn at_nodes(&self, block: &Block) -> Vec<[f64; 6]> {
        let mut material = vec![usize::MAX; block.nodes()];
        for cell in block.cells() {
            for node in cell.nodes() {
                let material = &mut material[node as usize];
                *material = cell.material.min(*material);
            }
        }
        let stress = |(node, material): (usize, &usize)| {
            let place = self.materials.binary_search(material);
            let [xx, yy, zz, xy] = place.map_or([0.0; 4], |place| self.at_nodes[place][node]);
            [xx, yy, zz, xy, 0.0, 0.0]
        };
        material.iter().enumerate().map(stress).collect()
    }
}

/// A cell with its nodes, their coordinates and displacements.
struct LocalCell {
    kind: ElementKind,
    nodes: Vec<usize>,
    points: Vec<[f64; 3]>,
    u: Vec<f64>,
}

impl LocalCell {
    /// Room for a cell.
    fn empty() -> Self {
        Self {
            kind: ElementKind::Triangle3,
            nodes: Vec::with_capacity(MAX_NODES),
            points: Vec::with_capacity(MAX_NODES),
            u: Vec::with_capacity(MAX_DOFS),
        }
    }

    fn take(&mut self, block: &Block, cell: &BlockCell<'_>, u: &[f64]) {
        self.kind = cell.kind;
        self.nodes.clear();
        self.points.clear();
        self.u.clear();
        for node in cell.nodes().map(|node| node as usize) {
            self.nodes.push(node);
            self.points.push(block.points()[node]);
            (self.u).extend_from_slice(&u[block.dim * node..block.dim * (node + 1)]);
        }
    }

    /// The mean stress.
    fn mean(&self, material: &Material, plane: PlaneState) -> [f64; 6] {
        let (mut sum, mut area) = ([0.0; 6], 0.0);
        for point in stiffness_points(&self.kind, &self.points) {
            let sigma = stress(material, plane, &strain(&point, &self.u));
            for (sum, s) in sum.iter_mut().zip(sigma) {
                *sum += point.weight * s;
            }
            area += point.weight;
        }
        sum.map(|s| s / area)
    }

    /// Where a point is (m).
    fn place(&self, point: &TabulatedPoint) -> [f64; 2] {
        let mut at = [0.0; 2];
        for (n, x) in point.shape.iter().zip(&self.points) {
            at[0] += n * x[0];
            at[1] += n * x[1];
        }
        at
    }

    /// The stress at a point.
    fn stress(&self, point: &TabulatedPoint, material: &Material, plane: PlaneState) -> [f64; 6] {
        let strain = strain(&gradients(point, &self.points), &self.u);
        stress(material, plane, &strain)
    }

    /// Cosine and sine of the angle between the edges at a corner.
    fn turn(&self, corner: usize) -> [f64; 2] {
        let edges = self.kind.facets();
        let vertex = self.points[corner];
        let tangent = |other: usize, edge: &[usize]| {
            let end = self.points[other];
            let way = [0, 1].map(|k| end[k] - vertex[k]);
            match edge.get(2) {
                None => way,
                // The derivative at the end of a parabola through three points.
                Some(&middle) => {
                    [0, 1].map(|k| 4.0 * (self.points[middle][k] - vertex[k]) - way[k])
                }
            }
        };
        let (after, before) = (
            edges[corner].1,
            edges[(corner + edges.len() - 1) % edges.len()].1,
        );
        let out = tangent(after[1], after);
        let back = tangent(before[0], before);
        let cos = out[0] * back[0] + out[1] * back[1];
        let sin = out[0] * back[1] - out[1] * back[0];
        let length = (cos * cos + sin * sin).sqrt();
        [cos / length, sin / length]
    }
}
