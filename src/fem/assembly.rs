//! Assembly: Tᵀ K T and Tᵀ (f − K c), K = Σ K_e, over the unknowns x of a block, u = T x + c.

use contact_dd_partition::model::Material;

use super::block::Block;
use super::dofs::Dofs;
use super::elasticity::{ElementMatrix, MAX_NODES};
use crate::schur::pattern::{LowerPattern, SparseSymmetric};

/// Tᵀ K T and Tᵀ (f − K c) of a block, for u = T x + c.
#[derive(Clone, Debug)]
pub struct BlockSystem {
    /// Stiffness.
    pub stiffness: SparseSymmetric,
    /// Load.
    pub load: Vec<f64>,
}

/// Nodal forces of a block, node by node (N per metre of thickness).
pub fn nodal_forces(block: &Block) -> Vec<f64> {
    let mut f = vec![0.0; block.nodes() * block.dim];
    for (member, node_of) in block.members.iter().zip(&block.node_of) {
        for &(node, force) in &member.forces {
            let node = node_of[node as usize] as usize;
            for component in 0..block.dim {
                f[node * block.dim + component] += force[component];
            }
        }
    }
    f
}

/// Assembles `block` by scattering every element into the pattern; `pins` are components of nodes
/// that a spring holds, because nothing else does and no load moves them.
///
/// Returns `None` where the matrix has more than 2³² entries.
pub fn assemble(
    block: &Block,
    dofs: &Dofs,
    materials: &[Material],
    pins: &[(u32, usize)],
) -> Option<BlockSystem> {
    let cliques = dofs.cliques(block);
    let pattern = LowerPattern::of_sites(dofs.site_starts(), &cliques)?;
    let mut system = BlockSystem {
        stiffness: SparseSymmetric::zeros(pattern),
        load: vec![0.0; dofs.len()],
    };
    dofs.add_load(&nodal_forces(block), &mut system.load);
    scatter(block, dofs, materials, &mut system);
    for &(node, component) in pins {
        pin(dofs, node, component, &mut system);
    }
    Some(system)
}

/// Adds a spring as stiff as the node itself.
fn pin(dofs: &Dofs, node: u32, component: usize, system: &mut BlockSystem) {
    let terms = dofs.terms(node, component);
    let diagonal = system.stiffness.diagonal();
    let spring = terms
        .iter()
        .map(|&(dof, _)| diagonal[dof as usize])
        .fold(0.0, f64::max);
    let unknowns: Vec<u32> = terms.iter().map(|&(dof, _)| dof).collect();
    system
        .stiffness
        .add(&unknowns, |a, b| spring * terms[a].1 * terms[b].1);
    for &(dof, c) in terms {
        system.load[dof as usize] -= spring * c * dofs.constant(node, component);
    }
}

fn scatter(block: &Block, dofs: &Dofs, materials: &[Material], system: &mut BlockSystem) {
    let dim = block.dim;
    let mut nodes = Vec::with_capacity(MAX_NODES);
    let mut points = Vec::with_capacity(MAX_NODES);
    let mut direct = Vec::with_capacity(MAX_NODES);
    let mut k = ElementMatrix::default();
    for cell in block.cells() {
        nodes.clear();
        nodes.extend(cell.nodes());
        points.clear();
        points.extend(nodes.iter().map(|&n| block.points[n as usize]));
        k.set(&cell.kind, &points, &materials[cell.material].stiffness);
        direct.clear();
        direct.extend(nodes.iter().filter_map(|&node| dofs.direct(node)));
        if direct.len() == nodes.len() {
            system.stiffness.add_runs(&direct, dim, |a, b| k.row(a)[b]);
            continue;
        }
        let unknowns = &dofs.unknowns(&nodes);
        let rows: Vec<(Vec<f64>, f64)> = nodes
            .iter()
            .flat_map(|&node| (0..dim).map(move |component| (node, component)))
            .map(|(node, component)| {
                let mut row = vec![0.0; unknowns.len()];
                for &(dof, c) in dofs.terms(node, component) {
                    if let Ok(place) = unknowns.binary_search(&dof) {
                        row[place] = c;
                    }
                }
                (row, dofs.constant(node, component))
            })
            .collect();
        let n = rows.len();
        let t = nalgebra::DMatrix::from_fn(n, unknowns.len(), |i, j| rows[i].0[j]);
        let k = nalgebra::DMatrix::from_fn(n, n, |i, j| k.row(i)[j]);
        let c = nalgebra::DVector::from_fn(n, |i, _| rows[i].1);
        let reduced = t.transpose() * &k * &t;
        let load = t.transpose() * (&k * c);
        system.stiffness.add(unknowns, |a, b| {
            // The lower triangle speaks for both, so that round-off can't make them differ.
            reduced[(a.max(b), a.min(b))]
        });
        for (&dof, load) in unknowns.iter().zip(load.iter()) {
            system.load[dof as usize] -= load;
        }
    }
}
