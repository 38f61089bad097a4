//! From values at the quadrature points of a cell to values at its nodes.

use std::sync::LazyLock;

use contact_dd_partition::element::ElementKind;

/// For every node of a cell of `kind` what the values at its stiffness' quadrature points
/// contribute to the value there.
///
/// It is the value of the best fit in the sense of ∫ (…)² dξ by 1 on linear triangles, 1, ξ, η on
/// quadratic ones, 1, ξ, η, ξη on quadrilaterals. On quadrilaterals of eight or nine nodes that is
/// to go through the values at 2 × 2 points of Gauss, where stresses are one order more accurate
/// (Barlow, Int. J. Numer. Meth. Eng. 10, 1976).
pub fn nodal_weights(kind: ElementKind) -> &'static [Vec<f64>] {
    static WEIGHTS: LazyLock<[Vec<Vec<f64>>; ElementKind::ALL.len()]> =
        LazyLock::new(|| ElementKind::ALL.map(weights));
    &WEIGHTS[kind as usize]
}

fn weights(kind: ElementKind) -> Vec<Vec<f64>> {
    let points = kind.stiffness_points();
    let basis = basis(kind);
    let norms: Vec<f64> = (basis.iter())
        .map(|of| points.iter().map(|p| p.weight * of(p.xi).powi(2)).sum())
        .collect();
    let at_node = |&node: &[f64; 3]| {
        let of_point = points.iter().map(|point| {
            let terms = basis.iter().zip(&norms);
            let terms = terms.map(|(of, norm)| of(node) * of(point.xi) * point.weight / norm);
            terms.sum()
        });
        of_point.collect()
    };
    kind.node_coordinates().iter().map(at_node).collect()
}

type Polynomial = fn([f64; 3]) -> f64;

/// Polynomials that are orthogonal on the reference cell.
fn basis(kind: ElementKind) -> &'static [Polynomial] {
    match kind {
        ElementKind::Triangle6 => &[
            |_| 1.0,
            |xi| 2.0 * xi[0] + xi[1] - 1.0,
            |xi| 3.0 * xi[1] - 1.0,
        ],
        ElementKind::Quad4 | ElementKind::Quad8 | ElementKind::Quad9 => {
            &[|_| 1.0, |xi| xi[0], |xi| xi[1], |xi| xi[0] * xi[1]]
        }
        ElementKind::Point1 | ElementKind::Line2 | ElementKind::Line3 | ElementKind::Triangle3 => {
            &[|_| 1.0]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_a_polynomial_that_the_fit_has_come_out_exactly() {
        let cases: [(ElementKind, Polynomial); 5] = [
            (ElementKind::Triangle3, |_| 2.5),
            (ElementKind::Triangle6, |xi| 2.5 - xi[0] + 3.0 * xi[1]),
            (ElementKind::Quad4, |xi| {
                2.5 - xi[0] + 3.0 * xi[1] + xi[0] * xi[1]
            }),
            (ElementKind::Quad8, |xi| {
                2.5 - xi[0] + 3.0 * xi[1] + xi[0] * xi[1]
            }),
            (ElementKind::Quad9, |xi| {
                2.5 - xi[0] + 3.0 * xi[1] + xi[0] * xi[1]
            }),
        ];
        for (kind, field) in cases {
            let points = kind.stiffness_points();
            for (&node, weights) in kind.node_coordinates().iter().zip(nodal_weights(kind)) {
                let terms = weights.iter().zip(points);
                let value: f64 = terms.map(|(w, point)| w * field(point.xi)).sum();
                assert!((value - field(node)).abs() < 1e-14, "{kind:?}");
            }
        }
    }

    #[test]
    fn quadratic_quadrilaterals_are_fitted_at_the_points_of_gauss() {
        // Zero at ±1/√3 in either direction.
        let field = |xi: [f64; 3]| 3.0 * xi[0] * xi[0] - 1.0;
        let points = ElementKind::Quad8.stiffness_points();
        for weights in nodal_weights(ElementKind::Quad8) {
            let terms = weights.iter().zip(points);
            let value: f64 = terms.map(|(w, point)| w * field(point.xi)).sum();
            assert!(value.abs() < 1e-14);
        }
    }
}
