//! The part of a line of side a covered by side b: segments between the projected ends of facets of side b.

use super::super::surface::SurfaceFacet;
use super::cover::{Cover, Opposite, Pieces, Sample};
use super::extent::Extent;
use super::field::{NormalField, ahead, beside, cross};
use super::root::{ENDS, root};
use crate::element::geometry::difference;

/// Degree of exactness on a segment. The product of two straight facets' shape functions has degree 2; projections
/// between facets that aren't parallel are rational functions.
const DEGREE: usize = 9;

/// The part of a facet of side a that is covered by side b, and whether a facet of side b there faces the same way.
///
/// The facet is divided at the projected ends of facets of side b; the first facet that the normal at the centre of a
/// piece intersects covers the whole piece.
pub(super) fn cover(opposite: &Opposite, field: &NormalField) -> (Cover, bool) {
    let candidates = candidates(opposite, field);
    let mut cuts = ENDS.to_vec();
    for &facet in &candidates {
        let facet = &opposite.surface.facets[facet];
        for end in ENDS {
            let x = facet.kind.position(&facet.at, [end, 0.0, 0.0]);
            cuts.extend(root(|xi| field.aside(xi, x)));
        }
    }
    cuts.sort_by(f64::total_cmp);
    let mut samples = Samples {
        list: Vec::new(),
        extent: Extent::new(),
        least_gap: f64::INFINITY,
    };
    let mut any_back_facing = false;
    for ends in cuts.windows(2).filter(|ends| ends[0] < ends[1]) {
        let middle = 0.5 * (ends[0] + ends[1]);
        match nearest(opposite, field, middle, &candidates) {
            Ok(found) => samples.add(opposite, field, [ends[0], ends[1]], found),
            Err(back_facing) => any_back_facing |= back_facing,
        }
    }
    (samples.cover(field), any_back_facing)
}

/// The facets of side b that may intersect a normal of `field`: between its first and its last one.
fn candidates(opposite: &Opposite, field: &NormalField) -> Vec<usize> {
    let lines = ENDS.map(|end| {
        (
            field.position([end, 0.0, 0.0]),
            field.normal([end, 0.0, 0.0]),
        )
    });
    let mut candidates = opposite.target.facets(|low, high| {
        let corners = [
            [low[0], low[1], 0.0],
            [high[0], low[1], 0.0],
            [low[0], high[1], 0.0],
            [high[0], high[1], 0.0],
        ];
        let sides = lines.map(|(x, n)| corners.map(|corner| cross(n, difference(corner, x))));
        let all = |is: fn(f64) -> bool| sides.iter().flatten().all(|&side| is(side));
        !all(|side| side > 0.0) && !all(|side| side < 0.0)
    });
    candidates.sort_unstable();
    candidates
}

/// The first facet that the line at ξ intersects face to face, in either sense but not too far backwards; if there is
/// none, whether it intersects one that faces the same way.
fn nearest(
    opposite: &Opposite,
    field: &NormalField,
    xi: f64,
    candidates: &[usize],
) -> Result<usize, bool> {
    let (x, normal) = (field.position([xi, 0.0, 0.0]), field.normal([xi, 0.0, 0.0]));
    let mut nearest: Option<(usize, f64)> = None;
    let mut back_facing = false;
    for &candidate in candidates {
        let facet = &opposite.surface.facets[candidate];
        let Some(eta) = root(|eta| beside(facet, x, normal, eta)) else {
            continue;
        };
        let distance = ahead(facet, x, normal, eta);
        if distance < -opposite.behind {
            continue;
        }
        if !opposite.faces(candidate, normal) {
            back_facing = true;
        } else if nearest.is_none_or(|(_, other)| distance.abs() < other.abs()) {
            nearest = Some((candidate, distance));
        }
    }
    nearest.map(|(facet, _)| facet).ok_or(back_facing)
}

/// The quadrature points of segments, in their order along a facet.
struct Samples {
    list: Vec<Sample>,
    extent: Extent,
    least_gap: f64,
}

impl Samples {
    /// Adds the quadrature points of the segment between `ends`, which the facet `found` of side b covers.
    fn add(&mut self, opposite: &Opposite, field: &NormalField, ends: [f64; 2], found: usize) {
        let (a, b) = (field.facet(), &opposite.surface.facets[found]);
        let [from, to] = ends;
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        for end in ends {
            let (_, gap) = project(field, b, end);
            self.extent.include([end, 0.0]);
            self.least_gap = self.least_gap.min(gap);
        }
        for (point, weight) in a.kind.quadrature(DEGREE) {
            let xi = middle + half * point[0];
            let (eta, gap) = project(field, b, xi);
            let xi = [xi, 0.0, 0.0];
            self.least_gap = self.least_gap.min(gap);
            self.list.push(Sample {
                weight: weight * half * a.density(xi),
                shape: a.kind.shape(xi),
                opposite: found,
                opposite_shape: b.kind.shape([eta, 0.0, 0.0]),
                gap,
            });
        }
    }

    fn cover(self, field: &NormalField) -> Cover {
        let mut cover = Cover::new(field.facet().nodes.len());
        for sample in &self.list {
            cover.add(sample.weight, &sample.shape, sample.gap);
        }
        cover.extent = self.extent;
        cover.least_gap = self.least_gap;
        cover.pieces = Pieces::Samples(self.list);
        cover
    }
}

/// Point η at which the line at ξ intersects an opposite facet, and the gap (m).
fn project(field: &NormalField, facet: &SurfaceFacet, xi: f64) -> (f64, f64) {
    let (x, normal) = (field.position([xi, 0.0, 0.0]), field.normal([xi, 0.0, 0.0]));
    let side = |eta: f64| beside(facet, x, normal, eta);
    let eta = root(side).unwrap_or_else(|| {
        // By round-off the line may miss the end that it passes through.
        let [low, high] = ENDS;
        if side(low)[0].abs() < side(high)[0].abs() {
            low
        } else {
            high
        }
    });
    (eta, ahead(facet, x, normal, eta))
}
