//! Assembly: Tᵀ K T, K = Σ K_e, over the unknowns x of a block, u = T x + c.

use contact_dd_partition::model::Material;

use super::block::Block;
use super::dofs::Dofs;
use super::elasticity::{ElementMatrix, MAX_NODES};
use crate::schur::pattern::{LowerPattern, SparseSymmetric};

/// A spring on a component of a node, which holds what nothing else does and no load moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Node of the block.
    pub node: u32,
    /// Component.
    pub component: usize,
    /// Its stiffness, that of the node itself (Pa).
    pub stiffness: f64,
}

/// Assembles Tᵀ K T of `block`, for u = T x + c, by scattering every element into the pattern, and adds a
/// spring at every one of `fixing_dofs`, components of nodes.
///
/// Returns `None` where the matrix has more than 2³² entries.
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
        k.set(&cell.kind, &points, &materials[cell.material].stiffness);
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
            // The lower triangle speaks for both, so that round-off can't make them differ.
            reduced[(a.max(b), a.min(b))]
        });
    }
}
