//! Taking rigid motions out of a field on nodes, of displacements or of forces.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::vector::{axpy, dot};

/// Sums over nodes of the products of rigid motions with each other and with a field.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionProducts {
    /// Σ z_i·z_j.
    pub gram: Vec<f64>,
    /// Σ z_i·v.
    pub field: Vec<f64>,
}

impl MotionProducts {
    /// Sums over no nodes, for `n` motions.
    pub fn zeros(n: usize) -> Self {
        Self {
            gram: vec![0.0; n * n],
            field: vec![0.0; n],
        }
    }

    /// Adds a node that the motions displace by `moves`.
    pub fn add_node(&mut self, moves: &[[f64; 3]]) {
        let n = moves.len();
        for i in 0..n {
            for j in 0..n {
                self.gram[i * n + j] += dot(&moves[i], &moves[j]);
            }
        }
    }

    /// Adds a value `v` of the field at such a node.
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

    /// Adds what a body has, `of_body` with its own rigid motions, where `shares` are those of each
    /// motion in these; none where the body takes no part.
    pub fn add_body(&mut self, shares: &[&[f64]], of_body: &Self) {
        let (n, modes) = (shares.len(), of_body.field.len());
        let taking_part = || (shares.iter().enumerate()).filter(|(_, z)| !z.is_empty());
        for (i, z_i) in taking_part() {
            self.field[i] += dot(z_i, &of_body.field);
            let mut row = vec![0.0; modes];
            for (z, of_mode) in z_i.iter().zip(of_body.gram.chunks(modes)) {
                axpy(*z, of_mode, &mut row);
            }
            for (j, z_j) in taking_part() {
                self.gram[i * n + j] += dot(&row, z_j);
            }
        }
    }

    /// How much of each motion the field has.
    pub fn coefficients(&self) -> Vec<f64> {
        let n = self.field.len();
        let mut coefficients = vec![0.0; n];
        for together in self.sharing_bodies() {
            let size = together.len();
            let gram = |i: usize, j: usize| self.gram[together[i] * n + together[j]];
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

    /// The motions whose products with each other aren't nothing, directly or by others.
    fn sharing_bodies(&self) -> Vec<Vec<usize>> {
        let n = self.field.len();
        let mut is_taken = vec![false; n];
        let mut all = Vec::new();
        for first in 0..n {
            if std::mem::replace(&mut is_taken[first], true) {
                continue;
            }
            let mut together = vec![first];
            let mut next = 0;
            while next < together.len() {
                let row = &self.gram[together[next] * n..][..n];
                for (j, product) in row.iter().enumerate() {
                    if *product != 0.0 && !std::mem::replace(&mut is_taken[j], true) {
                        together.push(j);
                    }
                }
                next += 1;
            }
            together.sort_unstable();
            all.push(together);
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
        let (mut of_body, mut direct) = (MotionProducts::zeros(3), MotionProducts::zeros(3));
        for (x, v) in [(0.0, [0.3, 0.1]), (2.0, [-0.2, 0.7]), (0.5, [1.0, 0.4])] {
            of_body.add_node(&units(x));
            of_body.add_value(&units(x), &v);
            let moved = |z: [f64; 3]| [z[0], z[1] + z[2] * x, 0.0];
            let moves = [moved(shares[0]), moved(shares[1]), [0.0; 3]];
            direct.add_node(&moves);
            direct.add_value(&moves, &v);
        }
        let mut combined = MotionProducts::zeros(3);
        combined.add_body(&[&shares[0], &shares[1], &[]], &of_body);
        let pairs = combined.gram.iter().zip(&direct.gram);
        for (a, b) in pairs.chain(combined.field.iter().zip(&direct.field)) {
            assert!((a - b).abs() < 1e-14);
        }
    }

    #[test]
    fn what_is_taken_out_leaves_nothing_along_the_motions() {
        let nodes: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.5, 3.0, 0.0]];
        let moves = |x: &[f64; 3]| [[1.0, 0.0, 0.0], [-x[1], x[0], 0.0]];
        let u = [[0.3, 0.1], [-0.2, 0.7], [1.0, 0.4]];
        let mut products = MotionProducts::zeros(2);
        for (x, u) in nodes.iter().zip(&u) {
            products.add_node(&moves(x));
            products.add_value(&moves(x), u);
        }
        let c = products.coefficients();
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
