//! Spatial search for facets by their bounding boxes: near a line, near a box, or in boxes selected by a predicate.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree, SelectionFunction};

use super::surface::SurfaceFacet;
use crate::mesh::bounding_box::BoundingBox;

/// The bounding box of a facet, and its number.
type Leaf = GeomWithData<Rectangle<[f64; 3]>, usize>;

/// The predicate that selects the boxes to be searched.
struct Boxes<F>(F);

impl<F: Fn([f64; 3], [f64; 3]) -> bool> SelectionFunction<Leaf> for Boxes<F> {
    fn should_unpack_parent(&self, envelope: &AABB<[f64; 3]>) -> bool {
        self.0(envelope.lower(), envelope.upper())
    }

    fn should_unpack_leaf(&self, leaf: &Leaf) -> bool {
        self.0(leaf.geom().lower(), leaf.geom().upper())
    }
}

/// The bounding boxes of facets, with their numbers.
pub(super) struct FacetTree(RTree<Leaf>);

impl FacetTree {
    /// The tree of `facets`, whose boxes are enlarged by a `margin` (m). O(n log n) for n facets.
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

    /// The facets in boxes, given by their least and largest coordinates, for which `may_hold` is true; it has to be
    /// true for every box that contains such a facet's box.
    pub fn within(
        &self,
        may_hold: impl Fn([f64; 3], [f64; 3]) -> bool,
    ) -> impl Iterator<Item = usize> {
        let found = self.0.locate_with_selection_function(Boxes(may_hold));
        found.map(|leaf| leaf.data)
    }

    /// The facets whose boxes intersect the line through `start` along `direction`, in either sense.
    pub fn along(&self, start: [f64; 3], direction: [f64; 3]) -> impl Iterator<Item = usize> {
        self.within(move |low, high| meets(start, direction, low, high))
    }

    /// The facets whose boxes are within a `margin` of that of a facet (m).
    pub fn near(&self, facet: &SurfaceFacet, margin: f64) -> impl Iterator<Item = usize> {
        let BoundingBox { low, high } = around(facet, margin);
        let found = (self.0).locate_in_envelope_intersecting(AABB::from_corners(low, high));
        found.map(|leaf| leaf.data)
    }
}

/// The bounding box of a facet, enlarged by a `margin` (m).
fn around(facet: &SurfaceFacet, margin: f64) -> BoundingBox {
    let own = BoundingBox::around(&facet.kind.hull(&facet.at));
    BoundingBox {
        low: own.low.map(|c| c - margin),
        high: own.high.map(|c| c + margin),
    }
}

/// True if the line through `start` along `direction` intersects a box: its intervals between opposite faces overlap.
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
