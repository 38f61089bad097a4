//! The quadrature rules for loads.

use super::parts::Formulation;
use crate::element::ElementKind;
use crate::element::quadrature::TabulatedPoint;
use crate::scene::material::PlaneState;

/// The degree added for the radius, of linear and of quadratic cells.
const RADIUS: [usize; 2] = [1, 2];

/// The degree of a rule that is exact with the radius as a factor if the scene is axisymmetric.
pub(super) fn around(plane: Option<PlaneState>, degree: usize, is_linear: bool) -> usize {
    match plane {
        Some(PlaneState::Axisymmetric) => degree + RADIUS[usize::from(!is_linear)],
        _ => degree,
    }
}

/// The quadrature rule for loads over cells; with reduced integration that of the stiffness.
pub(super) fn rule_of_cells(
    kind: ElementKind,
    formulation: Formulation,
    plane: Option<PlaneState>,
    is_constant: bool,
) -> Vec<TabulatedPoint> {
    let reduced = kind.reduced_points();
    if let Some(points) = reduced.filter(|_| formulation == Formulation::Reduced) {
        return points.to_vec();
    }
    let degree = kind.rules().map(|rules| match is_constant {
        true => rules.constant_load,
        false => rules.cubic_load,
    });
    degree.map_or_else(Vec::new, |degree| {
        kind.tabulate(around(plane, degree, kind.is_linear()))
    })
}
