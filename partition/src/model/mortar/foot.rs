//! The intersection of a line with a facet in space.

use super::super::clip::PlanePoint;
use super::super::surface::SurfaceFacet;
use super::map::{Map, Xi};
use crate::contact_point::LocalFrame;
use crate::element::definition::Domain;
use crate::element::geometry::{difference, dot};

/// Number of steps after which Newton's method is given up.
pub(super) const STEPS: usize = 30;
/// Change of ξ whose square is round-off.
pub(super) const ROUND_OFF: f64 = 1e-9;
/// Reference coordinates, of order 1 on the facet, beyond which its shape functions are meaningless.
const FAR: f64 = 4.0;

/// ξ at the centre of a facet.
pub(super) fn middle(domain: Domain) -> Xi {
    match domain {
        Domain::Triangle => [1.0 / 3.0; 2],
        _ => [0.0; 2],
    }
}

/// The solution of a system of two equations.
pub(super) fn solve(j: [[f64; 2]; 2], r: PlanePoint) -> PlanePoint {
    let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    [
        (r[0] * j[1][1] - r[1] * j[0][1]) / det,
        (r[1] * j[0][0] - r[0] * j[1][0]) / det,
    ]
}

/// The intersection of the line through `x` along the unit vector `normal` with a facet or, slightly beyond its edges,
/// with its extension: η, and the distance (m). Newton's method from `start`.
pub(super) fn foot(facet: &Map, [x, normal]: [[f64; 3]; 2], start: Xi) -> Option<(Xi, f64)> {
    let tangents = LocalFrame::new(normal).tangents;
    let mut eta = start;
    for _ in 0..STEPS {
        let offset = difference(facet.at(eta), x);
        let slopes = facet.slopes(eta);
        let j = tangents.map(|t| slopes.map(|slope| dot(t, slope)));
        let step = solve(j, tangents.map(|t| -dot(t, offset)));
        eta = [eta[0] + step[0], eta[1] + step[1]];
        if step[0].abs().max(step[1].abs()) <= ROUND_OFF {
            return Some((eta, dot(difference(facet.at(eta), x), normal)));
        }
        // The comparison is false for NaN, too.
        let is_near = eta[0].abs() <= FAR && eta[1].abs() <= FAR;
        if !is_near {
            return None;
        }
    }
    None
}

/// The intersection of a line with a facet of a surface, by Newton's method from the centre.
pub(in crate::model) fn foot_on(facet: &SurfaceFacet, line: [[f64; 3]; 2]) -> Option<(Xi, f64)> {
    foot(
        &Map::new(facet.kind, &facet.at),
        line,
        middle(facet.kind.domain()),
    )
}
