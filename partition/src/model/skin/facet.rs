//! A facet of the boundary, and how far apart two of them touch.

use super::super::surface::SurfaceFacet;
use crate::mesh::topology::CellFacet;

/// Distance up to which facets touch but for round-off, relative to their size.
pub(in crate::model) const ROUND_OFF: f64 = 1e-6;

/// Distance up to which facets touch where straight ones stand off the curves that they stand for, relative to their
/// size: those of a circle of fifteen sides stand off by half of it.
pub(in crate::model) const STANDING_OFF: f64 = 0.05;

/// A facet of the boundary.
pub(in crate::model) struct SkinFacet {
    pub place: CellFacet,
    pub shape: SurfaceFacet,
    /// Body of its cell.
    pub body: u32,
    /// Piece of the mesh that its cell hangs together with.
    pub(super) piece: u32,
}
