//! Springs between a block and the ground: f = −K_s u.

use contact_dd_partition::model::SpringBlock;
use nalgebra::DMatrix;

use super::block::Block;
use super::body_frame::BodyFrame;
use super::dofs::Dofs;
use crate::schur::pattern::SparseSymmetric;
use crate::vector::dot;

/// The rows of K_s u for a block of K_s: node and contribution, for one or both of its nodes.
fn rows<'a>(
    spring: &'a SpringBlock,
    dim: usize,
    u: &'a [f64],
) -> impl Iterator<Item = (u32, [f64; 3])> + 'a {
    let [a, b] = spring.nodes;
    let turns = if a == b { &[false][..] } else { &[false, true] };
    turns.iter().map(move |&is_transposed| {
        let (row, column) = if is_transposed { (b, a) } else { (a, b) };
        let u = &u[column as usize * dim..][..dim];
        let mut force = [0.0; 3];
        for (i, force) in force.iter_mut().enumerate().take(dim) {
            for (j, u) in u.iter().enumerate() {
                let k = match is_transposed {
                    true => spring.stiffness[j][i],
                    false => spring.stiffness[i][j],
                };
                *force += k * u;
            }
        }
        (row, force)
    })
}

/// The forces of the springs of `block` on its nodes at displacements `u`: constraint, node and force (N per metre of
/// thickness).
pub fn spring_forces<'a>(
    block: &'a Block,
    u: &'a [f64],
) -> impl Iterator<Item = (u32, u32, [f64; 3])> + 'a {
    (block.subdomain.springs.iter()).flat_map(move |spring| {
        let rows = rows(spring, block.dim, u);
        rows.map(|(node, force)| (spring.condition, node, force.map(|f| -f)))
    })
}

/// Adds Tᵀ K_s T to the stiffness.
pub(super) fn add_springs(block: &Block, dofs: &Dofs, stiffness: &mut SparseSymmetric) {
    let dim = block.dim;
    for spring in &block.subdomain.springs {
        let [a, b] = spring.nodes;
        let nodes = if a == b { vec![a] } else { vec![a, b] };
        let unknowns = dofs.unknowns(&nodes);
        let t = |node: u32| {
            let mut t = DMatrix::<f64>::zeros(dim, unknowns.len());
            for component in 0..dim {
                for &(dof, c) in dofs.terms(node, component) {
                    if let Ok(place) = unknowns.binary_search(&dof) {
                        t[(component, place)] += c;
                    }
                }
            }
            t
        };
        let k = DMatrix::from_fn(dim, dim, |i, j| spring.stiffness[i][j]);
        let mut reduced: DMatrix<f64> = t(a).transpose() * k * t(b);
        if a != b {
            reduced += reduced.transpose();
        }
        // The lower triangle is used for both, so that round-off can't make the matrix unsymmetric.
        stiffness.add(&unknowns, |i, j| reduced[(i.max(j), i.min(j))]);
    }
}

/// Rᵀ K_s R for the rigid motions R of a body with this `frame`, row by row.
pub fn against_motions(block: &Block, frame: &BodyFrame) -> Vec<f64> {
    let dim = block.dim;
    let modes = BodyFrame::count(dim);
    let motion = |k: usize| -> Vec<f64> {
        let mut unit = vec![0.0; modes];
        unit[k] = 1.0;
        let of_node = |x: &[f64; 3]| frame.displacement(dim, x, &unit);
        let mut motion: Vec<f64> = (block.body_points().iter())
            .flat_map(|x| of_node(x).into_iter().take(dim))
            .collect();
        motion.resize(dim * block.nodes(), 0.0);
        motion
    };
    if block.subdomain.springs.is_empty() {
        return vec![0.0; modes * modes];
    }
    let motions: Vec<Vec<f64>> = (0..modes).map(motion).collect();
    let of_motions = motions.iter().map(|motion| {
        let mut forces = vec![0.0; motion.len()];
        for (_, node, force) in spring_forces(block, motion) {
            for (sum, f) in forces[node as usize * dim..].iter_mut().zip(&force[..dim]) {
                *sum -= f;
            }
        }
        forces
    });
    let of_motions: Vec<Vec<f64>> = of_motions.collect();
    (0..modes * modes)
        .map(|at| dot(&motions[at / modes], &of_motions[at % modes]))
        .collect()
}
