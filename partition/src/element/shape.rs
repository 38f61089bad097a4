//! Shape functions on the reference elements.
//!
//! A line is −1 ≤ ξ ≤ 1, a triangle has the corners (0, 0), (1, 0), (0, 1).

use super::ElementKind;

impl ElementKind {
    /// Values of the shape functions N_i(ξ), one for each node; their sum is 1.
    pub fn shape(self, xi: [f64; 3]) -> Vec<f64> {
        match self {
            Self::Point1 => vec![1.0],
            Self::Line2 => vec![0.5 * (1.0 - xi[0]), 0.5 * (1.0 + xi[0])],
            Self::Triangle3 => vec![1.0 - xi[0] - xi[1], xi[0], xi[1]],
        }
    }

    /// Gradients ∂N_i/∂ξ_j of the shape functions, one for each node; components beyond the
    /// element's dimension are zero.
    pub fn gradients(self, _xi: [f64; 3]) -> Vec<[f64; 3]> {
        match self {
            Self::Point1 => vec![[0.0; 3]],
            Self::Line2 => vec![[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]],
            Self::Triangle3 => vec![[-1.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        }
    }

    /// Reference coordinates of the nodes.
    pub fn node_coordinates(self) -> &'static [[f64; 3]] {
        match self {
            Self::Point1 => &[[0.0; 3]],
            Self::Line2 => &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
            Self::Triangle3 => &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [ElementKind; 3] = [
        ElementKind::Point1,
        ElementKind::Line2,
        ElementKind::Triangle3,
    ];

    #[test]
    fn a_shape_function_is_one_at_its_node_and_zero_at_the_others() {
        for kind in KINDS {
            for (i, &xi) in kind.node_coordinates().iter().enumerate() {
                for (j, value) in kind.shape(xi).into_iter().enumerate() {
                    assert_eq!(value, if i == j { 1.0 } else { 0.0 }, "{kind:?}");
                }
            }
        }
    }

    #[test]
    fn gradients_are_the_difference_quotients_of_the_shape_functions() {
        let (xi, step) = ([0.2, 0.3, 0.0], 1e-5);
        for kind in KINDS {
            let gradients = kind.gradients(xi);
            for axis in 0..kind.dim() {
                let (mut ahead, mut behind) = (xi, xi);
                ahead[axis] += step;
                behind[axis] -= step;
                let (ahead, behind) = (kind.shape(ahead), kind.shape(behind));
                for i in 0..kind.nodes() {
                    let quotient = (ahead[i] - behind[i]) / (2.0 * step);
                    assert!((quotient - gradients[i][axis]).abs() < 1e-9, "{kind:?}");
                }
            }
        }
    }
}
