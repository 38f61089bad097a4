//! What acts on a block in a load step, and the load that it makes over the block's unknowns.

use contact_dd_partition::model::{Material, Support};

use super::assembly::Spring;
use super::block::Block;
use super::dofs::Dofs;
use super::elasticity::{ElementMatrix, MAX_NODES};
use super::prescribed::Prescribed;

/// What acts on a block in a load step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlockLoads {
    /// Prescribed displacements, in ascending order of the block's nodes.
    pub supports: Vec<Support>,
    /// Forces on the block's nodes, of which a node may have several (N per metre of thickness).
    pub forces: Vec<(u32, [f64; 3])>,
}

impl BlockLoads {
    /// What acts on a block in load step `step`.
    pub fn new(block: &Block, step: usize) -> Self {
        Self {
            supports: block.subdomain.supports_in(step).collect(),
            forces: block.subdomain.forces_in(step).collect(),
        }
    }

    /// Goes back from these loads to what acts part of the way from those `before` to them; from none to them, if
    /// there are none.
    pub fn go_back(&mut self, before: Option<&Self>, part: f64) {
        let forces = self.forces.iter_mut();
        forces.for_each(|(_, force)| *force = force.map(|f| part * f));
        let earlier = before.map_or(&[][..], |before| &before.forces);
        let rest = |(node, force): &(u32, [f64; 3])| (*node, force.map(|f| (1.0 - part) * f));
        self.forces.extend(earlier.iter().map(rest));
        for (i, support) in self.supports.iter_mut().enumerate() {
            let from = before.map_or(0.0, |before| before.supports[i].value);
            support.value = from + part * (support.value - from);
        }
    }

    /// The forces, node by node.
    pub fn nodal_forces(&self, block: &Block) -> Vec<f64> {
        let mut f = vec![0.0; block.nodes() * block.dim];
        for (node, force) in &self.forces {
            for component in 0..block.dim {
                f[*node as usize * block.dim + component] += force[component];
            }
        }
        f
    }
}

/// Tᵀ (f − K c), with c what supports prescribe, and `springs` in K.
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
