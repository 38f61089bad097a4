//! The load of a block over its unknowns, Tᵀ (f − K c) for u = T x + c.

use contact_dd_partition::model::Material;

use super::assembly::Spring;
use super::block::Block;
use super::dofs::Dofs;
use super::elasticity::{ElementMatrix, MAX_NODES};

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

/// Tᵀ (f − K c), with c what supports prescribe and approaches begin with, and `springs` in K.
pub fn load(block: &Block, dofs: &Dofs, materials: &[Material], springs: &[Spring]) -> Vec<f64> {
    let mut f = nodal_forces(block);
    if dofs.has_constants() {
        subtract_held(block, dofs, materials, &mut f);
    }
    for spring in springs {
        let row = spring.node as usize * block.dim + spring.component;
        f[row] -= spring.stiffness * dofs.constant(spring.node, spring.component);
    }
    let mut load = vec![0.0; dofs.len()];
    dofs.add_load(&f, &mut load);
    load
}

/// f ← f − K c, element by element.
fn subtract_held(block: &Block, dofs: &Dofs, materials: &[Material], f: &mut [f64]) {
    let dim = block.dim;
    let mut points = Vec::with_capacity(MAX_NODES);
    let mut c = Vec::with_capacity(dim * MAX_NODES);
    let mut k = ElementMatrix::default();
    for cell in block.cells() {
        c.clear();
        for node in cell.nodes() {
            c.extend((0..dim).map(|component| dofs.constant(node, component)));
        }
        if c.iter().all(|&c| c == 0.0) {
            continue;
        }
        points.clear();
        points.extend(cell.nodes().map(|node| block.points[node as usize]));
        k.set(&cell.kind, &points, &materials[cell.material].stiffness);
        for (a, node) in cell.nodes().enumerate() {
            for component in 0..dim {
                let row = k.row(dim * a + component).iter();
                let held: f64 = row.zip(&c).map(|(k, c)| k * c).sum();
                f[dim * node as usize + component] -= held;
            }
        }
    }
}
