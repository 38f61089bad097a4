//! Assembly of Tᵀ K T, K = Σ K_e, and of Tᵀ (f − K c) over the unknowns x of a block, u = T x + c.

use contact_dd_partition::model::Material;
use serde::{Deserialize, Serialize};

use super::block::Block;
use super::dofs::Dofs;
use super::elasticity::ElementMatrix;
use super::gradients::MAX_NODES;
use super::load::BlockLoads;
use super::prescribed::Prescribed;
use super::springs::{add_springs, spring_forces};
use crate::schur::pattern::{LowerPattern, SparseSymmetric};

/// A fixing dof: a spring on one component of a node of a body with a free rigid motion. It carries no force because
/// the load has no component along that motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FixingDof {
    /// Subdomain.
    pub subdomain: u32,
    /// Node of the subdomain.
    pub node: u32,
    /// Component that is held.
    pub component: u32,
}

/// A spring on a component of a node, against a motion that neither supports nor contact restrain and no load drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Node of the block.
    pub node: u32,
    /// Component.
    pub component: usize,
    /// Its stiffness, equal to that of the node itself (Pa).
    pub stiffness: f64,
}

/// Assembles Tᵀ K T of `block`, for u = T x + c, element by element, and adds a spring at every one of `fixing_dofs`,
/// given as node and component.
///
/// Returns `None` if the matrix has more than 2³² entries.
pub fn assemble(
    block: &Block,
    dofs: &Dofs,
    materials: &[Material],
    fixing_dofs: &[(u32, usize)],
) -> Option<(SparseSymmetric, Vec<Spring>)> {
    let cliques = dofs.cliques(block);
    let pattern = LowerPattern::of_sites(dofs.site_starts(), &cliques)?;
    let mut stiffness = SparseSymmetric::zeros(pattern);
    scatter(block, dofs, materials, &mut stiffness);
    add_springs(block, dofs, &mut stiffness);
    let fixing_dofs = fixing_dofs.iter();
    let springs =
        fixing_dofs.map(|&(node, component)| fixing_dof(dofs, node, component, &mut stiffness));
    let springs = springs.collect();
    Some((stiffness, springs))
}

/// Adds a spring as stiff as the node itself.
fn fixing_dof(dofs: &Dofs, node: u32, component: usize, k: &mut SparseSymmetric) -> Spring {
    let terms = dofs.terms(node, component);
    let diagonal = k.diagonal();
    let stiffness = terms
        .iter()
        .map(|&(dof, _)| diagonal[dof as usize])
        .fold(0.0, f64::max);
    let unknowns: Vec<u32> = terms.iter().map(|&(dof, _)| dof).collect();
    k.add(&unknowns, |a, b| stiffness * terms[a].1 * terms[b].1);
    Spring {
        node,
        component,
        stiffness,
    }
}

fn scatter(block: &Block, dofs: &Dofs, materials: &[Material], stiffness: &mut SparseSymmetric) {
    let dim = block.dim;
    let mut nodes = Vec::with_capacity(MAX_NODES);
    let mut points = Vec::with_capacity(MAX_NODES);
    let mut direct = Vec::with_capacity(MAX_NODES);
    let mut k = ElementMatrix::default();
    for cell in block.cells() {
        nodes.clear();
        nodes.extend(cell.nodes());
        points.clear();
        points.extend(nodes.iter().map(|&n| block.points()[n as usize]));
        k.set(&cell.kind, &points, &materials[cell.material]);
        direct.clear();
        direct.extend(nodes.iter().filter_map(|&node| dofs.direct(node)));
        if direct.len() == nodes.len() {
            stiffness.add_runs(&direct, dim, |a, b| k.row(a)[b]);
            continue;
        }
        let unknowns = &dofs.unknowns(&nodes);
        let rows: Vec<Vec<f64>> = nodes
            .iter()
            .flat_map(|&node| (0..dim).map(move |component| (node, component)))
            .map(|(node, component)| {
                let mut row = vec![0.0; unknowns.len()];
                for &(dof, c) in dofs.terms(node, component) {
                    if let Ok(place) = unknowns.binary_search(&dof) {
                        row[place] = c;
                    }
                }
                row
            })
            .collect();
        let n = rows.len();
        let t = nalgebra::DMatrix::from_fn(n, unknowns.len(), |i, j| rows[i][j]);
        let k = nalgebra::DMatrix::from_fn(n, n, |i, j| k.row(i)[j]);
        let reduced = t.transpose() * &k * &t;
        stiffness.add(unknowns, |a, b| {
            // The lower triangle is used for both, so that round-off can't make the matrix unsymmetric.
            reduced[(a.max(b), a.min(b))]
        });
    }
}

/// Tᵀ (f − K c), with c the prescribed displacements and the stiffness of `springs` in K.
pub fn load(
    block: &Block,
    loads: &BlockLoads,
    dofs: &Dofs,
    prescribed: &Prescribed,
    materials: &[Material],
    springs: &[Spring],
) -> Vec<f64> {
    let mut f = loads.nodal_forces(block);
    if !prescribed.is_zero() {
        subtract_held(block, prescribed, materials, &mut f);
        for (_, node, force) in spring_forces(block, prescribed.constants()) {
            let of_node = &mut f[node as usize * block.dim..];
            of_node
                .iter_mut()
                .zip(&force[..block.dim])
                .for_each(|(f, of)| *f += of);
        }
    }
    for spring in springs {
        let row = spring.node as usize * block.dim + spring.component;
        f[row] -= spring.stiffness * prescribed.of_node(spring.node)[spring.component];
    }
    let mut load = vec![0.0; dofs.len()];
    dofs.add_load(&f, &mut load);
    load
}

/// f ← f − K c, element by element.
fn subtract_held(block: &Block, prescribed: &Prescribed, materials: &[Material], f: &mut [f64]) {
    let dim = block.dim;
    let mut points = Vec::with_capacity(MAX_NODES);
    let mut c: Vec<f64> = Vec::with_capacity(dim * MAX_NODES);
    let mut k = ElementMatrix::default();
    for cell in block.cells() {
        c.clear();
        for node in cell.nodes() {
            c.extend(prescribed.of_node(node));
        }
        if c.iter().all(|&c| c == 0.0) {
            continue;
        }
        points.clear();
        points.extend(cell.nodes().map(|node| block.points()[node as usize]));
        k.set(&cell.kind, &points, &materials[cell.material]);
        for (a, node) in cell.nodes().enumerate() {
            for component in 0..dim {
                let row = k.row(dim * a + component).iter();
                let held: f64 = row.zip(&c).map(|(k, c)| k * c).sum();
                f[dim * node as usize + component] -= held;
            }
        }
    }
}
