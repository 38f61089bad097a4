//! Where a line meets a facet of space.

use super::super::surface::SurfaceFacet;
use super::clip::Point;
use crate::contact_point::LocalFrame;
use crate::element::geometry::{advance, difference, dot};
use crate::element::reference::Domain;

/// Steps of Newton's method after which a line misses the facet.
const STEPS: usize = 30;
/// Change of ξ that is none.
const ROUND_OFF: f64 = 1e-14;
/// Reference coordinates, of order 1 on the facet, beyond which its shape functions mean nothing.
const FAR: f64 = 4.0;

/// ξ in the middle of a facet.
pub(super) fn middle(domain: Domain) -> [f64; 3] {
    match domain {
        Domain::Triangle => [1.0 / 3.0, 1.0 / 3.0, 0.0],
        _ => [0.0; 3],
    }
}

/// x(ξ) of a facet and its slopes ∂x/∂ξ (m).
pub(super) fn point(facet: &SurfaceFacet, xi: [f64; 3]) -> ([f64; 3], [[f64; 3]; 2]) {
    let mut slopes = [[0.0; 3]; 2];
    for (gradient, &x) in facet.kind.gradients(xi).iter().zip(&facet.at) {
        for (slope, &value) in slopes.iter_mut().zip(gradient) {
            *slope = advance(*slope, value, x);
        }
    }
    (facet.kind.position(&facet.at, xi), slopes)
}

/// The solution of two equations.
pub(super) fn solve(j: [[f64; 2]; 2], r: Point) -> Point {
    let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    [
        (r[0] * j[1][1] - r[1] * j[0][1]) / det,
        (r[1] * j[0][0] - r[0] * j[1][0]) / det,
    ]
}

/// Where the line through `x` along the unit vector `normal` meets a facet or, a little beyond its edges, what
/// it goes on as: η, and the distance (m). Newton's method from `start`.
pub(super) fn foot(
    facet: &SurfaceFacet,
    x: [f64; 3],
    normal: [f64; 3],
    start: [f64; 3],
) -> Option<([f64; 3], f64)> {
    let tangents = LocalFrame::new(normal).tangents;
    let mut eta = start;
    for _ in 0..STEPS {
        let (y, slopes) = point(facet, eta);
        let way = difference(y, x);
        let j = tangents.map(|t| slopes.map(|slope| dot(t, slope)));
        let step = solve(j, tangents.map(|t| -dot(t, way)));
        eta = [eta[0] + step[0], eta[1] + step[1], 0.0];
        let moved = step[0].abs().max(step[1].abs());
        if moved <= ROUND_OFF {
            let way = difference(facet.kind.position(&facet.at, eta), x);
            return Some((eta, dot(way, normal)));
        }
        // False of what isn't a number, too.
        let is_near = eta[0].abs() <= FAR && eta[1].abs() <= FAR;
        if !is_near {
            return None;
        }
    }
    None
}
