//! Shape functions and their gradients at the points of a rule, computed once.

use super::reference::ReferenceElement;

/// Shape functions of a reference element at a point of a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct TabulatedPoint {
    /// Reference coordinates.
    pub xi: [f64; 3],
    /// Weight of the point.
    pub weight: f64,
    /// N_i.
    pub shape: Vec<f64>,
    /// ∂N_i/∂ξ_j.
    pub gradients: Vec<[f64; 3]>,
}

impl ReferenceElement {
    /// The shape functions at the points of the rule of [`quadrature`](Self::quadrature) for
    /// `degree`.
    pub fn tabulate(&self, degree: usize) -> Vec<TabulatedPoint> {
        let rule = self.quadrature(degree);
        let points = rule.points.into_iter().zip(rule.weights);
        points
            .map(|(xi, weight)| TabulatedPoint {
                xi,
                weight,
                shape: self.shape(xi),
                gradients: self.gradients(xi),
            })
            .collect()
    }
}
