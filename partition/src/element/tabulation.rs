//! Shape functions and their gradients at the points of a rule, computed once.

use std::sync::LazyLock;

use super::ElementKind;

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

impl ElementKind {
    /// The shape functions at the points of the rule of [`quadrature`](Self::quadrature) for
    /// `degree`.
    pub fn tabulate(self, degree: usize) -> Vec<TabulatedPoint> {
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

    /// The points at which a cell's stiffness is integrated; facets have none.
    ///
    /// The rule is exact for ∫ ∇N_i, and with it the patch test, on cells of any shape with curved
    /// edges, and for the stiffness of cells with an affine map.
    pub fn stiffness_points(self) -> &'static [TabulatedPoint] {
        static RULES: LazyLock<[Vec<TabulatedPoint>; ElementKind::ALL.len()]> =
            LazyLock::new(|| {
                ElementKind::ALL.map(|kind| match kind {
                    ElementKind::Point1 | ElementKind::Line2 | ElementKind::Line3 => Vec::new(),
                    ElementKind::Triangle3 => kind.tabulate(0),
                    ElementKind::Triangle6 => kind.tabulate(4),
                    ElementKind::Quad4 => kind.tabulate(3),
                    ElementKind::Quad8 | ElementKind::Quad9 => kind.tabulate(5),
                })
            });
        &RULES[self as usize]
    }
}
