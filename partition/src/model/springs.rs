//! Springs between a body and the ground, and elastic foundations: f = −K_s u, K_s = ∫ Nᵀ k N dS on sides.

use super::bodies::Bodies;
use super::groups;
use super::rules::around;
use super::surface::{Surface, SurfaceFacet};
use crate::element::geometry::length;
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::scene::Scene;
use crate::scene::spring::{Spring, SpringStiffness};

/// Degree of exactness on lines and faces: the product of two quadratic functions along a curved side.
const DEGREES: [usize; 2] = [7, 9];

/// The block of K_s that couples two nodes of one cell (N/m, per metre of thickness in the plane).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringBlock {
    /// Row and column of nodes; the transposed block is omitted.
    pub nodes: [u32; 2],
    /// The block, row by row.
    pub stiffness: [[f64; 3]; 3],
    /// Index of its name in [`Model::support_names`](super::Model::support_names).
    pub condition: u32,
}

/// The springs of a scene.
#[derive(Default)]
pub(super) struct Springs {
    /// Names of the springs in the scene.
    pub names: Vec<String>,
    /// Blocks, each with a cell that contains both of its nodes, in the order of the scene.
    pub blocks: Vec<(u32, SpringBlock)>,
}

impl Springs {
    /// The springs of `scene`, whose names follow those of `supports`.
    ///
    /// # Errors
    /// Groups that don't exist, negative stiffnesses, a side without a cell.
    pub fn new(
        scene: &Scene,
        bodies: &Bodies,
        topology: &Topology,
        supports: usize,
    ) -> Result<Self, InputError> {
        let mesh = &bodies.mesh;
        let mut all = Self::default();
        for (number, (index, spring)) in scene.springs_to_ground().enumerate() {
            let what = format!("spring[{}] on {}", index + 1, spring.on);
            let condition = (supports + number) as u32;
            if groups::are_of_facets(mesh, &spring.on) {
                let facets = groups::facets(mesh, &spring.on, &what)?;
                let surface = Surface::new(mesh, topology, scene.plane, &facets, &what)?;
                for (facet, &listed) in surface.facets.iter().zip(&facets) {
                    let cell = topology.cells_at(mesh.facets.nodes_of(listed as usize))[0].cell;
                    let blocks = foundation(facet, spring, condition);
                    let blocks = blocks.map_err(InputError::about(&what))?;
                    all.blocks
                        .extend(blocks.into_iter().map(|block| (cell, block)));
                }
            } else {
                let nodes = groups::boundary_nodes(mesh, &spring.on, &what)?;
                let blocks = at_points(mesh, &nodes, spring, condition);
                all.blocks.extend(blocks.map_err(InputError::about(&what))?);
            }
            all.names.push(what);
        }
        Ok(all)
    }
}

/// The blocks of an elastic foundation under a facet.
fn foundation(
    facet: &SurfaceFacet,
    spring: &Spring,
    condition: u32,
) -> Result<Vec<SpringBlock>, String> {
    let n = facet.nodes.len();
    let mut k = vec![[[0.0; 3]; 3]; n * n];
    let degree = DEGREES[facet.kind.dim() - 1];
    for (xi, weight) in (facet.kind).quadrature(around(facet.plane, degree, facet.kind.is_linear()))
    {
        let x = facet.kind.position(&facet.at, xi);
        let area = facet.kind.area_vector(&facet.at, xi);
        let size = length(area);
        let of_place = spring.stiffness.at(x, area.map(|c| c / size))?;
        let (weight, shape) = (weight * facet.density(xi), facet.kind.shape(xi));
        for (a, &of_a) in shape.iter().enumerate() {
            for (b, &of_b) in shape.iter().enumerate().take(a + 1) {
                for (row, of_place) in k[a * n + b].iter_mut().zip(&of_place) {
                    for (sum, k) in row.iter_mut().zip(of_place) {
                        *sum += weight * of_a * of_b * k;
                    }
                }
            }
        }
    }
    let pairs = (0..n).flat_map(|a| (0..=a).map(move |b| (a, b)));
    let blocks = pairs.map(|(a, b)| SpringBlock {
        nodes: [facet.nodes[a], facet.nodes[b]],
        stiffness: k[a * n + b],
        condition,
    });
    Ok(blocks
        .filter(|block| block.stiffness != [[0.0; 3]; 3])
        .collect())
}

/// A spring at every node.
fn at_points(
    mesh: &Mesh,
    nodes: &[u32],
    spring: &Spring,
    condition: u32,
) -> Result<Vec<(u32, SpringBlock)>, String> {
    if let SpringStiffness::Foundation { .. } = spring.stiffness {
        return Err("points have no normal; expected 'stiffness' along the axes".into());
    }
    let mut cells = vec![None; mesh.points.len()];
    for (cell, (_, of_cell)) in (0..).zip(mesh.cells.iter()) {
        for &node in of_cell {
            cells[node as usize].get_or_insert(cell);
        }
    }
    let mut blocks = Vec::with_capacity(nodes.len());
    for &node in nodes {
        let stiffness = spring.stiffness.at(mesh.points[node as usize], [0.0; 3])?;
        let Some(cell) = cells[node as usize] else {
            let tag = mesh.node_tags[node as usize];
            return Err(format!("node {tag} belongs to no cell of a body"));
        };
        let block = SpringBlock {
            nodes: [node; 2],
            stiffness,
            condition,
        };
        blocks.push((cell, block));
    }
    Ok(blocks)
}
