//! Intersections of a straight line with a surface.

use super::facet_tree::FacetTree;
use super::surface::Surface;
use crate::element::geometry::{advance, difference, dot, length};

/// Distance from a line up to which a node lies on it, relative to the length of the facet that the node belongs to.
/// Averaged normals of neighbouring facets of different lengths, and that of the last facet at the end of a curve,
/// deviate from the partner by the gap times a small angle.
const ON_LINE: f64 = 1e-2;
/// Cosine of the angle between a line and the inward normal of a facet above which they meet face to face.
pub(super) const FACING: f64 = 0.1;

/// A surface, prepared for intersection with lines.
pub(super) struct Target<'a> {
    surface: &'a Surface,
    tree: FacetTree,
}

/// The first intersection of a line.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Hit {
    /// Nodes, several if they coincide.
    Nodes(Vec<u32>),
    /// The inside of a facet.
    Facet(usize),
    /// No facet; there may be facets in the line that face the same way.
    Nothing {
        /// True if there are such facets.
        back_facing: bool,
    },
}

impl Hit {
    /// The nearest of the `nodes` on a line, each with its distance along the line and the allowed one from it, or the
    /// facet that the line crossed before them, with its distance.
    fn nearest(
        nodes: &[(u32, f64, f64)],
        crossed: Option<(usize, f64)>,
        back_facing: bool,
    ) -> Self {
        let nearest = nodes
            .iter()
            .copied()
            .min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        match (nearest, crossed) {
            (Some((_, ahead, slack)), crossed)
                if crossed.is_none_or(|(_, other)| ahead.abs() <= other.abs() + slack) =>
            {
                let mut together: Vec<u32> = (nodes.iter())
                    .filter(|node| (node.1 - ahead).abs() <= slack)
                    .map(|node| node.0)
                    .collect();
                together.sort_unstable();
                Hit::Nodes(together)
            }
            (_, Some((facet, _))) => Hit::Facet(facet),
            _ => Hit::Nothing { back_facing },
        }
    }
}

impl<'a> Target<'a> {
    /// Prepares a surface for the search: O(n log n) for n facets.
    pub fn new(surface: &'a Surface) -> Self {
        Self {
            surface,
            tree: FacetTree::new(surface.facets.iter(), |facet| ON_LINE * facet.size()),
        }
    }

    /// The facets in boxes, given by their least and largest coordinates, for which `may_hold` is true; it has to be
    /// true for every box that contains such a facet's box.
    pub fn facets(&self, may_hold: impl Fn([f64; 3], [f64; 3]) -> bool) -> Vec<usize> {
        self.tree.within(may_hold).collect()
    }

    /// First intersection of the line from `start` along the unit vector `direction`, at most `behind` backwards, with
    /// facets that face it; nodes for which `passes` is true are ignored. O(log n) for a surface that isn't parallel to
    /// the line.
    pub fn hit(
        &self,
        start: [f64; 3],
        direction: [f64; 3],
        behind: f64,
        passes: impl Fn(u32) -> bool,
    ) -> Hit {
        let mut nodes: Vec<(u32, f64, f64)> = Vec::new();
        let mut crossed: Option<(usize, f64)> = None;
        let mut back_facing = false;
        for number in self.tree.along(start, direction) {
            let facet = &self.surface.facets[number];
            let slack = ON_LINE * facet.size();
            let faces = dot(facet.normal, direction) <= -FACING;
            let mut at_node = false;
            for (&node, &at) in facet.nodes.iter().zip(&facet.at) {
                let offset = difference(at, start);
                let ahead = dot(offset, direction);
                if length(advance(offset, -ahead, direction)) > slack {
                    continue;
                }
                at_node = true;
                if passes(node) || ahead < -behind {
                    continue;
                }
                back_facing |= !faces;
                if faces && !nodes.iter().any(|(other, ..)| *other == node) {
                    nodes.push((node, ahead, slack));
                }
            }
            if at_node {
                continue;
            }
            let Some(ahead) = facet.kind.crossing(&facet.at, start, direction) else {
                continue;
            };
            if ahead < -behind {
                continue;
            }
            back_facing |= !faces;
            if faces && crossed.is_none_or(|(_, other)| ahead.abs() < other.abs()) {
                crossed = Some((number, ahead));
            }
        }
        Hit::nearest(&nodes, crossed, back_facing)
    }
}
