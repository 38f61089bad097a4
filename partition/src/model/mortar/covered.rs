//! The facets of side a that side b covers.

use nalgebra::DMatrix;

use super::super::surface::SurfaceFacet;
use super::cover::Cover;

/// A facet of side a with the part covered by side b.
pub(super) struct Covered<'a> {
    pub facet: &'a SurfaceFacet,
    pub cover: Cover,
    /// The covered part; `None` where the whole facet is covered.
    pub part: Option<Part>,
}

/// A covered part of a facet, treated as a facet itself.
pub(super) struct Part {
    /// Its shape functions, as rows of coefficients of those of the facet.
    pub functions: DMatrix<f64>,
    /// Integrals over the covered part.
    pub cover: Cover,
}
