//! The view from a facet of the boundary along its normal.

use super::super::clip::{PlanePoint, ProjectedFacet, area, clip, middle};
use super::super::mortar::foot_on;
use super::super::surface::SurfaceFacet;
use super::facet::{ROUND_OFF, STANDING_OFF, SkinFacet};
use crate::contact_point::LocalFrame;
use crate::element::geometry::{advance, difference, dot};
use crate::mesh::Mesh;

/// Least overlap of two facets, relative to the smaller one: less is round-off of facets that end beside each other.
const LEAST: f64 = 1e-6;

/// Overlap, relative to the thinner one of the cells behind two facets, above which the material of the body lies
/// between them, whatever the width of the cells.
const MATERIAL: f64 = 0.5;

/// The plane of a facet, into which others are projected and clipped. A line is treated as a strip as wide as it is
/// long, so that one method serves both dimensions.
pub(super) struct View<'a> {
    facet: &'a SkinFacet,
    mesh: &'a Mesh,
    frame: LocalFrame,
    /// Width of a strip; 0 of a face (m).
    width: f64,
    outline: Vec<PlanePoint>,
}

impl<'a> View<'a> {
    /// The view from a facet of the boundary of `mesh`.
    pub fn new(facet: &'a SkinFacet, mesh: &'a Mesh) -> Self {
        let mut view = Self {
            facet,
            mesh,
            frame: LocalFrame::new(facet.shape.normal),
            width: if mesh.dim == 2 {
                facet.shape.size()
            } else {
                0.0
            },
            outline: Vec::new(),
        };
        view.outline = view.flat(&facet.shape);
        view
    }

    /// The visible parts of `opposite` facets, which face this one, each with its index: index, distance along the
    /// normal at the centre of the visible part, length or area of that (m).
    pub fn of(&self, opposite: &[(usize, &SkinFacet)]) -> Vec<(usize, f64, f64)> {
        let seen = opposite
            .iter()
            .filter_map(|(index, other)| self.seen(*index, other));
        let all: Vec<ProjectedFacet> = seen.collect();
        let visible = all.iter().filter(|seen| !seen.is_hidden(&all));
        visible
            .map(|seen| (seen.facet, seen.gap, self.measure(&seen.outline)))
            .collect()
    }

    /// The length of a part of a strip, or the area of a part of a face.
    fn measure(&self, outline: &[PlanePoint]) -> f64 {
        match self.width > 0.0 {
            true => area(outline) / self.width,
            false => area(outline),
        }
    }

    /// The visible part of another facet.
    fn seen(&self, index: usize, other: &SkinFacet) -> Option<ProjectedFacet> {
        let (own, shape) = (&self.facet.shape, &other.shape);
        let mut shadow = self.flat(shape);
        shadow.reverse();
        let outline = clip(&shadow, &self.outline);
        // The comparison is false for NaN, too.
        let is_seen = area(&outline) > LEAST * area(&self.outline).min(area(&shadow));
        if !is_seen {
            return None;
        }
        let x = self.place(middle(&outline));
        let gap = self.height(shape, x) - self.height(own, x);
        Some(ProjectedFacet {
            facet: index,
            gap,
            outline,
            is_far_side: self.facet.piece == other.piece && self.is_beyond(other, gap),
        })
    }

    /// True if another facet of the same piece lies so far behind this one that it isn't the other face of a crack.
    fn is_beyond(&self, other: &SkinFacet, gap: f64) -> bool {
        let (own, shape) = (&self.facet.shape, &other.shape);
        let size = own.size().min(shape.size());
        let cell = |of: &SkinFacet| self.mesh.cells.nodes_of(of.place.cell as usize);
        let is_thin = || (cell(self.facet).iter()).any(|node| cell(other).contains(node));
        gap < -STANDING_OFF * size
            || (gap < -ROUND_OFF * size && is_thin())
            || gap < -MATERIAL * self.thickness(self.facet).min(self.thickness(other))
    }

    /// Thickness of the cell behind a facet (m).
    fn thickness(&self, facet: &SkinFacet) -> f64 {
        let nodes = self.mesh.cells.nodes_of(facet.place.cell as usize).iter();
        let depth = |&node: &u32| {
            let offset = difference(facet.shape.at[0], self.mesh.points[node as usize]);
            dot(offset, facet.shape.normal)
        };
        nodes.map(depth).fold(0.0, f64::max)
    }

    /// The corners of a facet in the plane, counter-clockwise if it faces the same way.
    fn flat(&self, shape: &SurfaceFacet) -> Vec<PlanePoint> {
        let corners = shape.at.iter().take(shape.kind.corners());
        let mut flat: Vec<PlanePoint> = corners
            .map(|&x| {
                let offset = difference(x, self.facet.shape.at[0]);
                self.frame.tangents.map(|t| dot(t, offset))
            })
            .collect();
        if let ([p, q], true) = (&flat[..], self.width > 0.0) {
            let [p, q] = [*p, *q];
            flat.extend([q, p].map(|[s, _]| [s, self.width]));
        }
        flat
    }

    /// The position in space of a point in the plane (m).
    fn place(&self, [s, t]: PlanePoint) -> [f64; 3] {
        let [along, across] = self.frame.tangents;
        let x = advance(self.facet.shape.at[0], s, along);
        match self.width > 0.0 {
            true => x,
            false => advance(x, t, across),
        }
    }

    /// The distance from `x` along the normal to a facet, or to its extension where the line misses it: edges of curved
    /// facets deviate from the chords between their corners (m).
    fn height(&self, shape: &SurfaceFacet, x: [f64; 3]) -> f64 {
        let normal = self.frame.normal;
        let crossing = shape.kind.crossing(&shape.at, x, normal);
        let beyond = || {
            let is_curved = shape.kind.dim() > 1 && !shape.kind.is_linear();
            let foot = is_curved.then(|| foot_on(shape, [x, normal])).flatten();
            foot.map(|(_, offset)| offset)
        };
        crossing.or_else(beyond).unwrap_or_else(|| {
            let to_plane = dot(difference(shape.at[0], x), shape.normal);
            to_plane / dot(normal, shape.normal)
        })
    }
}
