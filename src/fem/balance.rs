//! Nodal balance f − K u − Bᵀ λ of a block, computed element by element without any factorization.

use std::cell::RefCell;
use std::rc::Rc;

use contact_dd_partition::id::{BlockId, OnBlocks};
use contact_dd_partition::model::Material;

use super::block::Block;
use super::elasticity::ElementMatrix;
use super::gradients::MAX_NODES;
use super::load::BlockLoads;
use super::springs::spring_forces;

/// f − K u − Bᵀλ of a block and the scale of its terms, node by node (N/m).
#[derive(Clone, Debug)]
pub struct Balance {
    /// f − K u − Bᵀλ.
    pub residual: Vec<f64>,
    /// |f| + Σ_e |K_e||u| + |Bᵀλ|.
    pub scale: Vec<f64>,
    /// External forces on nodes, including contact and springs: f − Bᵀλ − K_s u.
    pub external: Vec<f64>,
    /// Forces of springs on nodes, −K_s u, a part of the external forces.
    pub springs: Vec<f64>,
    /// ‖f‖∞.
    pub largest_load: f64,
}

impl Balance {
    /// The balance for displacements `u` and contact forces; `pushes` is Bᵀλ by node.
    pub fn new(
        block: &Block,
        loads: &BlockLoads,
        materials: &[Material],
        u: &[f64],
        pushes: &[(u32, [f64; 3])],
    ) -> Self {
        let dim = block.dim;
        let mut external = loads.nodal_forces(block);
        let mut scale: Vec<f64> = external.iter().map(|f| f.abs()).collect();
        let largest_load = scale.iter().fold(0.0, |m: f64, f| m.max(*f));
        for &(node, push) in pushes {
            for component in 0..dim {
                external[node as usize * dim + component] -= push[component];
                scale[node as usize * dim + component] += push[component].abs();
            }
        }
        let mut springs = vec![0.0; external.len()];
        for (_, node, force) in spring_forces(block, u) {
            for (component, force) in force.into_iter().enumerate().take(dim) {
                let row = node as usize * dim + component;
                springs[row] += force;
                external[row] += force;
                scale[row] += force.abs();
            }
        }
        let mut balance = Self {
            residual: external.clone(),
            scale,
            external,
            springs,
            largest_load,
        };
        balance.subtract_elements(block, materials, u);
        balance
    }

    /// Subtracts the forces K_e u of every element from the residual.
    fn subtract_elements(&mut self, block: &Block, materials: &[Material], u: &[f64]) {
        let dim = block.dim;
        let mut points = Vec::with_capacity(MAX_NODES);
        let mut u_e = Vec::with_capacity(dim * MAX_NODES);
        let mut k = ElementMatrix::default();
        for cell in block.cells() {
            points.clear();
            u_e.clear();
            for node in cell.nodes() {
                let node = node as usize;
                points.push(block.points()[node]);
                u_e.extend_from_slice(&u[dim * node..dim * (node + 1)]);
            }
            k.set(&cell.kind, &points, &materials[cell.material]);
            for (a, node) in cell.nodes().enumerate() {
                for component in 0..dim {
                    let (mut sum, mut absolute) = (0.0, 0.0);
                    for (k, u) in k.row(dim * a + component).iter().zip(&u_e) {
                        let term = k * u;
                        sum += term;
                        absolute += term.abs();
                    }
                    let row = dim * node as usize + component;
                    self.residual[row] -= sum;
                    self.scale[row] += absolute;
                }
            }
        }
    }
}

/// The last balance of every block under the same loads, for the next check of the same solution: integrating the stiffness
/// of hexahedra of 27 nodes takes an eighth of the time of factorizing them.
#[derive(Debug, Default)]
pub struct LastBalances(RefCell<OnBlocks<LastBalance>>);

#[derive(Debug)]
struct LastBalance {
    u: Vec<f64>,
    pushes: Vec<(u32, [f64; 3])>,
    balance: Rc<Balance>,
}

impl LastBalances {
    /// The balance of block b for these displacements and contact forces: the last one if it is theirs, else a new one
    /// by `compute`.
    pub fn of(
        &self,
        b: BlockId,
        (u, pushes): (&[f64], &[(u32, [f64; 3])]),
        compute: impl FnOnce() -> Balance,
    ) -> Rc<Balance> {
        let mut last = self.0.borrow_mut();
        if let Some(last) = last
            .get(&b)
            .filter(|last| last.u == u && last.pushes == pushes)
        {
            return last.balance.clone();
        }
        let balance = Rc::new(compute());
        let of_block = LastBalance {
            u: u.to_vec(),
            pushes: pushes.to_vec(),
            balance: balance.clone(),
        };
        last.insert(b, of_block);
        balance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_balance_is_computed_again_for_another_solution_only() {
        let (last, b) = (LastBalances::default(), BlockId::new(3));
        let computed = |u: &[f64], push: f64| {
            let mut is_new = false;
            let balance = last.of(b, (u, &[(0, [push, 0.0, 0.0])]), || {
                is_new = true;
                let [residual, scale, external, springs] = [(); 4].map(|()| u.to_vec());
                Balance {
                    residual,
                    scale,
                    external,
                    springs,
                    largest_load: push,
                }
            });
            assert_eq!((&balance.residual[..], balance.largest_load), (u, push));
            is_new
        };
        assert!(computed(&[1.0, 2.0], 5.0));
        assert!(!computed(&[1.0, 2.0], 5.0));
        assert!(computed(&[1.0, 3.0], 5.0));
        assert!(computed(&[1.0, 3.0], 6.0));
        assert!(!computed(&[1.0, 3.0], 6.0));
    }
}
