//! The facets of side a that side b covers.

use nalgebra::DMatrix;

use super::super::surface::SurfaceFacet;
use super::cover::Cover;

/// A facet of side a and what of side b covers it.
pub(super) struct Covered<'a> {
    pub facet: &'a SurfaceFacet,
    pub cover: Cover,
    /// The part that is covered; `None` where it extends over the whole.
    pub part: Option<Part>,
}

/// A covered part of a facet as a facet of its own.
pub(super) struct Part {
    /// Shape functions as rows of coefficients of those of the facet.
    pub functions: DMatrix<f64>,
    /// Integrals over the covered part.
    pub cover: Cover,
}
