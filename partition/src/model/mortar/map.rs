//! Interpolation Σ N_i(ξ) v_i on a facet in space as a polynomial, which is fast to evaluate.

use nalgebra::DMatrix;

use crate::element::ElementKind;
use crate::element::geometry::advance;

/// Largest number of nodes of a facet.
const MOST: usize = 9;

/// Reference coordinates on a facet in space.
pub(in crate::model) type Xi = [f64; 2];

/// The polynomial Σ N_i(ξ) v_i of nodal values v_i.
#[derive(Clone, Debug)]
pub(in crate::model) struct Map {
    coefficients: [[f64; 3]; MOST],
    count: usize,
}

/// The monomials that the shape functions of facets with up to 9 nodes consist of.
fn powers([s, t]: Xi) -> [f64; MOST] {
    [
        1.0,
        s,
        t,
        s * t,
        s * s,
        t * t,
        s * s * t,
        s * t * t,
        s * s * t * t,
    ]
}

/// Their derivatives by s and by t.
fn slopes([s, t]: Xi) -> [[f64; MOST]; 2] {
    let (double_s, double_t, double_st) = (2.0 * s, 2.0 * t, 2.0 * s * t);
    [
        [
            0.0,
            1.0,
            0.0,
            t,
            double_s,
            0.0,
            double_st,
            t * t,
            double_st * t,
        ],
        [
            0.0,
            0.0,
            1.0,
            s,
            0.0,
            double_t,
            s * s,
            double_st,
            double_st * s,
        ],
    ]
}

impl Map {
    /// The polynomial with `values` at the nodes of a facet.
    pub fn new(kind: ElementKind, values: &[[f64; 3]]) -> Self {
        let nodes = kind.node_coordinates();
        let count = nodes.len();
        let at_nodes = DMatrix::from_fn(count, count, |i, k| powers([nodes[i][0], nodes[i][1]])[k]);
        let mut right = DMatrix::from_fn(count, 3, |i, k| values[i][k]);
        // The monomials are independent at the nodes of an element.
        at_nodes.lu().solve_mut(&mut right);
        let mut coefficients = [[0.0; 3]; MOST];
        for (i, row) in coefficients.iter_mut().take(count).enumerate() {
            *row = [0, 1, 2].map(|k| right[(i, k)]);
        }
        Self {
            coefficients,
            count,
        }
    }

    /// The value at ξ.
    pub fn at(&self, xi: Xi) -> [f64; 3] {
        self.combine(&powers(xi))
    }

    /// Derivatives ∂/∂ξ.
    pub fn slopes(&self, xi: Xi) -> [[f64; 3]; 2] {
        slopes(xi).map(|powers| self.combine(&powers))
    }

    fn combine(&self, powers: &[f64; MOST]) -> [f64; 3] {
        let terms = self.coefficients[..self.count].iter().zip(powers);
        terms.fold([0.0; 3], |sum, (&c, &power)| advance(sum, power, c))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::ElementKind::{Quad4, Quad8, Quad9, Triangle3, Triangle6};

    #[test]
    fn it_is_what_shape_functions_and_gradients_say() {
        for kind in [Triangle3, Triangle6, Quad4, Quad8, Quad9] {
            let bend = |i: usize| (1.7 * i as f64).sin();
            let values: Vec<_> = (0..kind.nodes())
                .map(|i| [bend(i), bend(i + 9), bend(i + 20)])
                .collect();
            let map = Map::new(kind, &values);
            for [s, t] in [[0.3, -0.4], [-0.9, 0.2], [0.1, 0.6]] {
                let xi = [s, t, 0.0];
                let mut slopes = [[0.0; 3]; 2];
                for (gradient, &v) in kind.gradients(xi).iter().zip(&values) {
                    slopes = [0, 1].map(|k| advance(slopes[k], gradient[k], v));
                }
                let expected = [kind.position(&values, xi), slopes[0], slopes[1]];
                let [by_s, by_t] = map.slopes([s, t]);
                for (found, expected) in [map.at([s, t]), by_s, by_t].iter().zip(expected) {
                    (0..3)
                        .for_each(|k| assert!((found[k] - expected[k]).abs() < 1e-14, "{kind:?}"));
                }
            }
        }
    }
}
