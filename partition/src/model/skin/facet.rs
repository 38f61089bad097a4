//! A facet of the boundary, and the distances up to which two of them touch.

use super::super::surface::SurfaceFacet;
use crate::mesh::topology::CellFacet;

/// Distance up to which facets touch within round-off, relative to their size.
pub(in crate::model) const ROUND_OFF: f64 = 1e-6;

/// Distance up to which straight facets that approximate curves touch, relative to their size: twice the sagitta of a
/// circle of fifteen sides.
pub(in crate::model) const STANDING_OFF: f64 = 0.05;

/// A facet of the boundary.
pub(in crate::model) struct SkinFacet {
    pub place: CellFacet,
    pub shape: SurfaceFacet,
    /// Body of its cell.
    pub body: u32,
    /// Connected piece of the mesh that its cell belongs to.
    pub(super) piece: u32,
}
