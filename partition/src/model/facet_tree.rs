//! Facets found by the boxes around them: those near a line, near a box, or in boxes of any choice.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree, SelectionFunction};

use super::surface::SurfaceFacet;
use crate::mesh::bounding_box::BoundingBox;

/// The box around a facet, and its number.
type Leaf = GeomWithData<Rectangle<[f64; 3]>, usize>;

/// The boxes in which a search looks further.
struct Boxes<F>(F);

impl<F: Fn([f64; 3], [f64; 3]) -> bool> SelectionFunction<Leaf> for Boxes<F> {
    fn should_unpack_parent(&self, envelope: &AABB<[f64; 3]>) -> bool {
        self.0(envelope.lower(), envelope.upper())
    }

    fn should_unpack_leaf(&self, leaf: &Leaf) -> bool {
        self.0(leaf.geom().lower(), leaf.geom().upper())
    }
}

/// The boxes around facets, by their numbers.
pub(super) struct FacetTree(RTree<Leaf>);

impl FacetTree {
    /// The tree of `facets`, whose boxes are wider by a `margin` (m). O(n log n) for n facets.
    pub fn new<'f>(
        facets: impl Iterator<Item = &'f SurfaceFacet>,
        margin: impl Fn(&SurfaceFacet) -> f64,
    ) -> Self {
        let leaf = |(number, facet): (usize, &SurfaceFacet)| {
            let BoundingBox { low, high } = around(facet, margin(facet));
            Leaf::new(Rectangle::from_corners(low, high), number)
        };
        Self(RTree::bulk_load(facets.enumerate().map(leaf).collect()))
    }

    /// The facets in boxes, given by their least and largest coordinates, for which `may_hold` says
    /// so; it must do so of every box that holds one of them.
    pub fn within(
        &self,
        may_hold: impl Fn([f64; 3], [f64; 3]) -> bool,
    ) -> impl Iterator<Item = usize> {
        let found = self.0.locate_with_selection_function(Boxes(may_hold));
        found.map(|leaf| leaf.data)
    }

    /// The facets whose boxes a line through `start` along `direction` meets, either way.
    pub fn along(&self, start: [f64; 3], direction: [f64; 3]) -> impl Iterator<Item = usize> {
        self.within(move |low, high| meets(start, direction, low, high))
    }

    /// The facets whose boxes are no farther than a `margin` from that of a facet (m).
    pub fn near(&self, facet: &SurfaceFacet, margin: f64) -> impl Iterator<Item = usize> {
        let BoundingBox { low, high } = around(facet, margin);
        let found = (self.0).locate_in_envelope_intersecting(AABB::from_corners(low, high));
        found.map(|leaf| leaf.data)
    }
}

/// The box around a facet, wider by a `margin` (m).
fn around(facet: &SurfaceFacet, margin: f64) -> BoundingBox {
    let own = BoundingBox::around(&facet.kind.hull(&facet.at));
    BoundingBox {
        low: own.low.map(|c| c - margin),
        high: own.high.map(|c| c + margin),
    }
}

/// True if the line through `start` along `direction`, both ways, goes through a box: the ranges in
/// which it lies between the opposite faces have something in common.
fn meets(start: [f64; 3], direction: [f64; 3], low: [f64; 3], high: [f64; 3]) -> bool {
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (start, slope) = (start[axis], direction[axis]);
        if slope == 0.0 {
            if start < low[axis] || start > high[axis] {
                return false;
            }
            continue;
        }
        let (a, b) = ((low[axis] - start) / slope, (high[axis] - start) / slope);
        from = from.max(a.min(b));
        to = to.min(a.max(b));
    }
    from <= to
}
