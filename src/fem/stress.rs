//! Stresses: the mean over each cell, recovered values at nodes, and the error estimated from their difference.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::element::definition::Domain;
use contact_dd_partition::element::geometry::{cross, difference, dot, length};
use contact_dd_partition::element::quadrature::TabulatedPoint;
use contact_dd_partition::model::{Material, PlaneState};

use super::block::{Block, BlockCell};
use super::elasticity::{amplitudes, strain, stress};
use super::estimate::{CellError, Compliance};
use super::gradients::{MAX_DOFS, MAX_NODES, Voigt, has_modes, stiffness_points};
use super::patch::PatchSum;
use super::polynomial::NodalStress;
use super::recovery::Recovery;
use super::strain::LargestStrain;
use crate::vector::axpy;

/// The stresses of a block.
#[derive(Clone, Debug)]
pub struct BlockStress {
    /// Stress of every cell (Pa), order XX YY ZZ XY YZ XZ.
    pub cells: Vec<[f64; 6]>,
    /// The largest strain of a cell.
    pub largest_strain: LargestStrain,
    /// The recovered stresses of each material, ascending.
    pub recoveries: Vec<Recovery>,
}

/// Recovered stresses at nodes and the estimated errors of the cells.
#[derive(Clone, Debug)]
pub struct RecoveredStress {
    /// The block's materials, ascending.
    materials: Vec<usize>,
    /// Stresses at every node in each of its materials (Pa).
    at_nodes: Vec<Vec<NodalStress>>,
    /// Estimated error of every cell.
    pub errors: Vec<CellError>,
}

impl BlockStress {
    /// The stresses for displacements `u`, node by node; `patches` is memory for reuse.
    pub fn new(
        block: &Block,
        materials: &[Material],
        plane: Option<PlaneState>,
        u: &[f64],
        patches: &mut Vec<PatchSum>,
    ) -> Self {
        let mut present: Vec<usize> = (block.subdomain.cell_material.iter())
            .map(|&material| material as usize)
            .collect();
        present.sort_unstable();
        present.dedup();
        patches.iter_mut().for_each(PatchSum::clear);
        patches.resize_with(block.nodes() * present.len(), || PatchSum::empty(block.dim));
        let mut cells = Vec::with_capacity(block.subdomain.cells.len());
        let mut largest_strain = LargestStrain::default();
        let mut local = LocalCell::empty();
        for cell in block.cells() {
            local.take(block, &cell, u, &materials[cell.material]);
            let material = &materials[cell.material];
            let (mean, strain, measure) = local.mean(material, plane);
            cells.push(mean);
            largest_strain.include(&strain, material.stiffness.size(), measure, || {
                local.middle()
            });
            let Ok(place) = present.binary_search(&cell.material) else {
                continue;
            };
            let around = &mut patches[place * block.nodes()..][..block.nodes()];
            let corners = &local.nodes[..cell.kind.corners()];
            for (corner, &node) in corners.iter().enumerate() {
                around[node].add_cell(local.turn(corner), !cell.kind.is_linear());
            }
            for point in stress_points(&cell, material) {
                let at = local.place(point);
                let sigma = match is_uniform(cell.kind, material) {
                    true => mean,
                    false => local.stress(point, material, plane),
                };
                for (&node, from) in corners.iter().zip(&local.points) {
                    around[node].add_sample(difference(at, *from), &sigma);
                }
            }
        }
        let recoveries = (present
            .into_iter()
            .zip(patches.chunks(block.nodes().max(1))))
        .map(|(material, patches)| Recovery::new(block, material, patches))
        .collect();
        Self {
            cells,
            largest_strain,
            recoveries,
        }
    }

    /// Recovered stresses at nodes and the error estimate, for the same displacements; `initial` is the initial stress
    /// of the cells, which isn't recovered, or empty.
    pub fn recover(
        &mut self,
        block: &Block,
        materials: &[Material],
        u: &[f64],
        initial: &[[f64; 6]],
    ) -> RecoveredStress {
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
            local.take(block, &cell, u, &materials[cell.material]);
            recovered.clear();
            recovered.extend(cell.nodes().map(|node| at_nodes[node as usize]));
            if is_uniform(cell.kind, &materials[cell.material]) {
                let measure = cell.kind.measure(&local.points);
                errors.push(compliance.simplex(measure, stress, &recovered));
                continue;
            }
            let of_cell = (cell.kind, &local.points[..], &local.u[..]);
            errors.push(compliance.cell(of_cell, &recovered, &materials[cell.material]));
        }
        for ((cell, error), initial) in block.cells().zip(&mut errors).zip(initial) {
            if let Ok(place) = present.binary_search(&cell.material) {
                local.take(block, &cell, u, &materials[cell.material]);
                let measure = cell.kind.measure(&local.points);
                error.initial = compliances[place].initial(measure, initial);
            }
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
            place.map_or([0.0; 6], |place| self.at_nodes[place][node])
        };
        material.iter().enumerate().map(stress).collect()
    }
}

/// True if the stress is uniform in a cell: in linear triangles and tetrahedra, but not around an axis.
fn is_uniform(kind: ElementKind, material: &Material) -> bool {
    let is_ring = material.stiffness.size() == 4;
    !is_ring && kind.is_linear() && matches!(kind.domain(), Domain::Triangle | Domain::Tetrahedron)
}

/// The points at which a cell's stress is sampled for recovery: its superconvergent points, or with incompatible modes
/// all quadrature points.
fn stress_points<'a>(cell: &'a BlockCell<'_>, material: &Material) -> &'a [TabulatedPoint] {
    match has_modes(&cell.kind, material) {
        true => stiffness_points(&cell.kind, material),
        false => cell.kind.stress_points(),
    }
}

/// A cell with its nodes, their coordinates and displacements.
struct LocalCell {
    kind: ElementKind,
    nodes: Vec<usize>,
    points: Vec<[f64; 3]>,
    /// Displacements, then the amplitudes of incompatible modes.
    u: Vec<f64>,
}

impl LocalCell {
    /// An empty cell, whose memory is reused.
    fn empty() -> Self {
        Self {
            kind: ElementKind::Triangle3,
            nodes: Vec::with_capacity(MAX_NODES),
            points: Vec::with_capacity(MAX_NODES),
            u: Vec::with_capacity(MAX_DOFS),
        }
    }

    fn take(&mut self, block: &Block, cell: &BlockCell<'_>, u: &[f64], material: &Material) {
        self.kind = cell.kind;
        self.nodes.clear();
        self.points.clear();
        self.u.clear();
        for node in cell.nodes().map(|node| node as usize) {
            self.nodes.push(node);
            self.points.push(block.points()[node]);
            (self.u).extend_from_slice(&u[block.dim * node..block.dim * (node + 1)]);
        }
        if has_modes(&self.kind, material) {
            let amplitudes = amplitudes(&self.kind, &self.points, material, &self.u);
            self.u.extend(amplitudes);
        }
    }

    /// The mean stress, the mean strain, and the measure.
    fn mean(&self, material: &Material, plane: Option<PlaneState>) -> ([f64; 6], Voigt, f64) {
        let (mut sum, mut strains, mut measure) = ([0.0; 6], [0.0; 6], 0.0);
        let components = material.stiffness.size();
        for point in stiffness_points(&self.kind, material) {
            let (strain, weight) = strain(point, &self.points, &self.u, components);
            let sigma = stress(material, plane, &strain);
            axpy(weight, &sigma, &mut sum);
            axpy(weight, &strain, &mut strains);
            measure += weight;
        }
        (
            sum.map(|s| s / measure),
            strains.map(|e| e / measure),
            measure,
        )
    }

    /// The mean of its corners (m).
    fn middle(&self) -> [f64; 3] {
        let corners = &self.points[..self.kind.corners()];
        let mut middle = [0.0; 3];
        for corner in corners {
            axpy(1.0 / corners.len() as f64, corner, &mut middle);
        }
        middle
    }

    /// Position of a quadrature point (m).
    fn place(&self, point: &TabulatedPoint) -> [f64; 3] {
        let mut at = [0.0; 3];
        for (n, x) in point.shape.iter().zip(&self.points) {
            axpy(*n, x, &mut at);
        }
        at
    }

    /// The stress at a quadrature point.
    fn stress(
        &self,
        point: &TabulatedPoint,
        material: &Material,
        plane: Option<PlaneState>,
    ) -> [f64; 6] {
        let components = material.stiffness.size();
        let (strain, _) = strain(point, &self.points, &self.u, components);
        stress(material, plane, &strain)
    }

    /// Cosine and sine of the angle between the edges at a corner, in space of half the solid angle.
    fn turn(&self, corner: usize) -> [f64; 2] {
        let [cos, sin] = match self.kind.dim() {
            2 => {
                let [out, back, _] = self.edges(corner);
                [
                    out[0] * back[0] + out[1] * back[1],
                    out[0] * back[1] - out[1] * back[0],
                ]
            }
            _ => {
                // Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983).
                let [a, b, c] = self.edges(corner).map(|edge| {
                    let size = length(edge);
                    edge.map(|x| x / size)
                });
                [
                    1.0 + dot(a, b) + dot(b, c) + dot(c, a),
                    dot(cross(a, b), c).abs(),
                ]
            }
        };
        let length = (cos * cos + sin * sin).sqrt();
        [cos / length, sin / length]
    }

    /// The directions of the edges at a corner: in the plane that to the next corner, then that to the previous one; in
    /// space all three.
    fn edges(&self, corner: usize) -> [[f64; 3]; 3] {
        let mut edges = [[0.0; 3]; 3];
        let at_corner = self.kind.edges_at(corner);
        for (edge, &(end, middle)) in edges.iter_mut().zip(at_corner) {
            let offset = difference(self.points[end], self.points[corner]);
            *edge = match middle {
                None => offset,
                // The derivative at the end of a parabola through three points.
                Some(middle) => {
                    let half = difference(self.points[middle], self.points[corner]);
                    [0, 1, 2].map(|k| 4.0 * half[k] - offset[k])
                }
            };
        }
        edges
    }
}
