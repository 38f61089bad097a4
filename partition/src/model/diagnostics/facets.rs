//! Straight facets in place of a smooth curve: a difference of geometry, of which the estimated errors of quantities
//! know nothing.

use super::Diagnostics;
use crate::magnitude::short;
use crate::model::surface::Surface;

impl Diagnostics<'_> {
    /// The warning of a boundary whose straight facets turn like a smooth curve, where quantities are asked for.
    pub(super) fn facets_of_curves(&self) -> Option<String> {
        if self.scene.quantity.is_empty() {
            return None;
        }
        let mesh = &self.bodies.mesh;
        let surface = Surface::of_all(mesh, self.topology, self.scene.plane);
        let (off, node) = surface.stands_off_smooth_curve()?;
        Some(format!(
            "the boundary around node {} at {} turns from facet to facet like a smooth curve, from which its straight facets \
             stand off by up to {} {}: if it is one, this difference of geometry is an error beyond those that quantities \
             state; expected quadratic cells with nodes on the curve, or a second mesh with smaller facets to compare",
            mesh.node_tags[node as usize],
            self.place(mesh.points[node as usize]),
            short(off),
            self.scene.units.length()
        ))
    }
}
