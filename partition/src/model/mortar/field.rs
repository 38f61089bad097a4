//! The continuous field of averaged normals along a facet of side a.

use super::super::surface::SurfaceFacet;
use crate::element::ElementKind;
use crate::element::geometry::{advance, difference, dot, length};

/// A facet of side a with the averaged normals at its nodes, interpolated like its positions: n(ξ) = Σ N_i(ξ) n_i. The
/// line through x(ξ) along n(ξ) is its projection onto side b.
pub(super) struct NormalField<'a> {
    facet: &'a SurfaceFacet,
    normals: Vec<[f64; 3]>,
}

/// Σ ∂N_i/∂ξ v_i of nodal values on a line.
fn slope(kind: ElementKind, values: &[[f64; 3]], xi: f64) -> [f64; 3] {
    let gradients = kind.gradients([xi, 0.0, 0.0]).into_iter();
    gradients
        .zip(values)
        .fold([0.0; 3], |sum, (gradient, &v)| advance(sum, gradient[0], v))
}

/// The component of a × b perpendicular to the plane.
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

impl<'a> NormalField<'a> {
    /// A facet with a normal for each of its nodes.
    pub fn new(facet: &'a SurfaceFacet, normals: Vec<[f64; 3]>) -> Self {
        Self { facet, normals }
    }

    /// The facet.
    pub fn facet(&self) -> &'a SurfaceFacet {
        self.facet
    }

    /// The normals at its nodes.
    pub fn normals(&self) -> &[[f64; 3]] {
        &self.normals
    }

    /// x(ξ) (m).
    pub fn position(&self, xi: [f64; 3]) -> [f64; 3] {
        self.facet.kind.position(&self.facet.at, xi)
    }

    /// n(ξ), normalized. The normals at the nodes of a facet are less than 90° from its own, so
    /// that their sum isn't zero.
    pub fn normal(&self, xi: [f64; 3]) -> [f64; 3] {
        let sum = self.facet.kind.position(&self.normals, xi);
        let size = length(sum);
        sum.map(|c| c / size)
    }

    /// Signed distance of the point x from the line at ξ, in the plane: n(ξ) × (x − x(ξ)) and its derivative by ξ, zero
    /// on the line (m).
    pub fn aside(&self, xi: f64, x: [f64; 3]) -> [f64; 2] {
        let SurfaceFacet { kind, at, .. } = self.facet;
        let normal = kind.position(&self.normals, [xi, 0.0, 0.0]);
        let offset = difference(x, self.position([xi, 0.0, 0.0]));
        let turn = slope(*kind, &self.normals, xi);
        let step = slope(*kind, at, xi);
        [
            cross(normal, offset),
            cross(turn, offset) - cross(normal, step),
        ]
    }
}

/// n × (y(η) − x) of a facet y(η) and its derivative by η: zero where the line through x along n intersects the facet
/// (m).
pub(super) fn beside(facet: &SurfaceFacet, x: [f64; 3], normal: [f64; 3], eta: f64) -> [f64; 2] {
    let y = facet.kind.position(&facet.at, [eta, 0.0, 0.0]);
    let step = slope(facet.kind, &facet.at, eta);
    [cross(normal, difference(y, x)), cross(normal, step)]
}

/// The distance of y(η) from x along n (m).
pub(super) fn ahead(facet: &SurfaceFacet, x: [f64; 3], normal: [f64; 3], eta: f64) -> f64 {
    let y = facet.kind.position(&facet.at, [eta, 0.0, 0.0]);
    dot(difference(y, x), normal)
}
