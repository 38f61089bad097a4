//! Projection of rigid-body motions out of nodal displacements or forces.

use std::collections::BTreeMap;

use contact_dd_partition::disjoint_sets::DisjointSets;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::vector::{axpy, dot};

/// Sums over the nodes of a body of the products of its rigid motions with each other and with a field.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyProducts {
    /// Σ z_i·z_j.
    gram: Vec<f64>,
    /// Σ z_i·v.
    field: Vec<f64>,
}

impl BodyProducts {
    /// Sums over no nodes yet, for `n` motions.
    pub fn zeros(n: usize) -> Self {
        Self {
            gram: vec![0.0; n * n],
            field: vec![0.0; n],
        }
    }

    /// Adds a node whose displacements in the motions are `moves`.
    pub fn add_node(&mut self, moves: &[[f64; 3]]) {
        let n = moves.len();
        for i in 0..n {
            for j in 0..n {
                self.gram[i * n + j] += dot(&moves[i], &moves[j]);
            }
        }
    }

    /// Adds the value `v` of the field at such a node.
    pub fn add_value(&mut self, moves: &[[f64; 3]], v: &[f64]) {
        for (sum, z) in self.field.iter_mut().zip(moves) {
            *sum += dot(z, v);
        }
    }

    /// Adds the sums over other nodes.
    pub fn add(&mut self, other: &Self) {
        axpy(1.0, &other.gram, &mut self.gram);
        axpy(1.0, &other.field, &mut self.field);
    }
}

/// Inner products of rigid motions of many bodies with each other, if they have a body in common, and with a field.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionProducts {
    /// Σ z_i·z_j.
    gram: BTreeMap<(usize, usize), f64>,
    /// Σ z_i·v.
    field: Vec<f64>,
}

impl MotionProducts {
    /// The products of `n` motions with no body added yet.
    pub fn zeros(n: usize) -> Self {
        Self {
            gram: BTreeMap::new(),
            field: vec![0.0; n],
        }
    }

    /// Adds the sums of a body, `of_body`, over its own rigid motions; `shares` are the coefficients on these of the
    /// motions with the given numbers.
    pub fn add_body(&mut self, shares: &[(usize, &[f64])], of_body: &BodyProducts) {
        let modes = of_body.field.len();
        for &(i, z_i) in shares {
            self.field[i] += dot(z_i, &of_body.field);
            let mut row = vec![0.0; modes];
            for (z, of_mode) in z_i.iter().zip(of_body.gram.chunks(modes)) {
                axpy(*z, of_mode, &mut row);
            }
            for &(j, z_j) in shares {
                *self.gram.entry((i, j)).or_default() += dot(&row, z_j);
            }
        }
    }

    /// Σ z_i·z_j of all motions.
    pub fn gram(&self) -> DMatrix<f64> {
        let n = self.field.len();
        let mut gram = DMatrix::zeros(n, n);
        self.gram.iter().for_each(|(&at, &value)| gram[at] = value);
        gram
    }

    /// Coefficients of the projection of the field onto the motions.
    pub fn coefficients(&self) -> Vec<f64> {
        let mut coefficients = vec![0.0; self.field.len()];
        for together in self.sharing_bodies() {
            let size = together.len();
            let gram = |i: usize, j: usize| {
                let product = self.gram.get(&(together[i], together[j]));
                product.copied().unwrap_or_default()
            };
            let gram = DMatrix::from_fn(size, size, gram);
            let rhs = DVector::from_fn(size, |i, _| self.field[together[i]]);
            if let Ok(found) = gram.svd(true, true).solve(&rhs, 1e-14) {
                for (&i, found) in together.iter().zip(found.iter()) {
                    coefficients[i] = *found;
                }
            }
        }
        coefficients
    }

    /// Sets of motions coupled by non-zero products, directly or through others.
    fn sharing_bodies(&self) -> Vec<Vec<usize>> {
        let mut sets = DisjointSets::new(self.field.len());
        for (&(i, j), _) in self.gram.iter().filter(|(_, product)| **product != 0.0) {
            sets.unite(i as u32, j as u32);
        }
        let mut of_root: BTreeMap<u32, usize> = BTreeMap::new();
        let mut all: Vec<Vec<usize>> = Vec::new();
        for i in 0..self.field.len() {
            let at = *of_root.entry(sets.find(i as u32)).or_insert(all.len());
            if at == all.len() {
                all.push(Vec::new());
            }
            all[at].push(i);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_motions_follow_from_those_of_their_bodies() {
        let units = |x: f64| [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, x, 0.0]];
        let shares = [[0.3, -0.2, 0.7], [1.0, 0.4, 0.0]];
        let (mut of_body, mut direct) = (BodyProducts::zeros(3), BodyProducts::zeros(3));
        for (x, v) in [(0.0, [0.3, 0.1]), (2.0, [-0.2, 0.7]), (0.5, [1.0, 0.4])] {
            of_body.add_node(&units(x));
            of_body.add_value(&units(x), &v);
            let moved = |z: [f64; 3]| [z[0], z[1] + z[2] * x, 0.0];
            let moves = [moved(shares[0]), moved(shares[1]), [0.0; 3]];
            direct.add_node(&moves);
            direct.add_value(&moves, &v);
        }
        let mut combined = MotionProducts::zeros(3);
        combined.add_body(&[(0, &shares[0]), (1, &shares[1])], &of_body);
        let gram = combined.gram();
        let pairs = gram.iter().zip(&direct.gram);
        for (a, b) in pairs.chain(combined.field.iter().zip(&direct.field)) {
            assert!((a - b).abs() < 1e-14);
        }
    }

    #[test]
    fn what_is_taken_out_leaves_nothing_along_the_motions() {
        let nodes: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.5, 3.0, 0.0]];
        let moves = |x: &[f64; 3]| [[1.0, 0.0, 0.0], [-x[1], x[0], 0.0]];
        let u = [[0.3, 0.1], [-0.2, 0.7], [1.0, 0.4]];
        let mut products = BodyProducts::zeros(2);
        for (x, u) in nodes.iter().zip(&u) {
            products.add_node(&moves(x));
            products.add_value(&moves(x), u);
        }
        let mut of_motions = MotionProducts::zeros(2);
        of_motions.add_body(&[(0, &[1.0, 0.0]), (1, &[0.0, 1.0])], &products);
        let c = of_motions.coefficients();
        for motion in 0..2 {
            let left: f64 = nodes
                .iter()
                .zip(&u)
                .map(|(x, u)| {
                    let z = moves(x);
                    (0..2)
                        .map(|k| z[motion][k] * (u[k] - c[0] * z[0][k] - c[1] * z[1][k]))
                        .sum::<f64>()
                })
                .sum();
            assert!(left.abs() < 1e-14);
        }
    }
}
