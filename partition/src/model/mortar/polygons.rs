//! The part of a facet of side a covered by side b in space: polygons, clipped in flat coordinates on the facet (Puso
//! and Laursen 2004; Popp, Gitterle, Gee and Wall 2010).
//!
//! All facets of side b are projected along the same averaged normals, so that those with a common edge neither overlap
//! nor leave a gap, also across neighbouring facets of side a.

use std::collections::HashMap;

use nalgebra::DMatrix;

use super::super::clip::{PlanePoint, ProjectedFacet, area, clip, middle, triangles};
use super::super::surface::SurfaceFacet;
use super::chart::{Chart, aside};
use super::cover::{Cover, EXTRA_DEGREE, Opposite, Overlap, Pieces};
use super::field::NormalField;
use super::foot::{foot, middle as middle_of};
use super::map::Xi;
use crate::element::definition::Domain;
use crate::element::geometry::{difference, dot, length};

/// Area of a polygon, relative to that of the facet, below which it is round-off of facets with a common edge.
const SLIVER: f64 = 1e-12;
/// Negligible distance of a curved edge from the chord, relative to the facet.
const NEGLIGIBLE_SAGITTA: f64 = 1e-3;
/// Largest number of straight parts of a curved edge.
const PARTS: f64 = 8.0;
/// Negligible distance of a node from its position under an affine map, relative to the facet.
const AFFINE: f64 = 1e-6;
/// Degree added to that of the shape functions' products for facets that aren't flat, whose integrals no rule computes
/// exactly.
const BEYOND_CURVED: usize = 2;

/// The part of a facet of side a that is covered by side b, and whether a facet of side b there faces the same way.
pub(super) fn cover(opposite: &Opposite, field: &NormalField) -> (Cover, bool) {
    let chart = Chart::new(field);
    let mut outlines = ProjectedOutlines::new(&chart);
    let mut pieces = Vec::new();
    let mut any_back_facing = false;
    for candidate in candidates(opposite, field, &chart) {
        let facet = &opposite.surface.facets[candidate];
        let mut shadow = outlines.of(facet);
        let faces = opposite.faces(candidate, chart.normal());
        if faces {
            shadow.reverse();
        }
        let outline = clip(&shadow, &chart.outline);
        // The comparison is false for NaN, too.
        let is_seen = area(&outline) > SLIVER * chart.area;
        if !is_seen {
            continue;
        }
        let line = chart.line(chart.xi(middle(&outline), center(field.facet())));
        let Some((_, gap)) = foot(&opposite.maps[candidate], line, center(facet)) else {
            continue;
        };
        if gap < -opposite.behind {
            continue;
        }
        match faces {
            true => pieces.push(ProjectedFacet {
                facet: candidate,
                outline,
                gap,
                is_far_side: false,
            }),
            false => any_back_facing = true,
        }
    }
    let mut cover = Cover::new(field.facet().nodes.len());
    let seen = pieces.iter().filter(|piece| !piece.is_hidden(&pieces));
    let overlaps = seen.map(|piece| integrate(&chart, field.facet(), piece, opposite, &mut cover));
    cover.pieces = Pieces::Overlaps(overlaps.collect());
    (cover, any_back_facing)
}

/// ξ at the centre of a facet.
fn center(facet: &SurfaceFacet) -> Xi {
    middle_of(facet.kind.domain())
}

/// The facets of side b that may intersect a normal of `field`: within a cone around the normal at the centre.
fn candidates(opposite: &Opposite, field: &NormalField, chart: &Chart) -> Vec<usize> {
    let facet = field.facet();
    let axis = chart.normal();
    let [start, _] = chart.line(center(facet));
    let away = |x: &[f64; 3]| length(difference(*x, start));
    let tilt = |&normal: &[f64; 3]| {
        let along = dot(normal, axis);
        (1.0 - along * along).max(0.0).sqrt() / along
    };
    // Normals and edges of curved facets exceed the range of those at the nodes by less than this factor.
    let beyond = if facet.kind.is_linear() { 1.0 } else { 1.5 };
    let radius = beyond * facet.at.iter().map(away).fold(0.0, f64::max);
    let spread = beyond * field.normals().iter().map(tilt).fold(0.0, f64::max);
    let mut candidates = opposite.target.facets(|low, high| {
        let center = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
        let size = 0.5 * length(difference(high, low));
        let offset = difference(center, start);
        let along = dot(offset, axis);
        let across = (dot(offset, offset) - along * along).max(0.0).sqrt();
        across <= radius + size + spread * (along.abs() + size)
    });
    candidates.sort_unstable();
    candidates
}

/// Facets of side b projected into a chart.
struct ProjectedOutlines<'a> {
    chart: &'a Chart,
    /// Corners that have been projected already.
    corners: HashMap<u32, PlanePoint>,
}

impl<'a> ProjectedOutlines<'a> {
    fn new(chart: &'a Chart) -> Self {
        Self {
            chart,
            corners: HashMap::new(),
        }
    }

    /// The projected corners of a facet in their order, with curved edges divided into straight parts.
    fn of(&mut self, facet: &SurfaceFacet) -> Vec<PlanePoint> {
        let chart = self.chart;
        let corners = facet.nodes.iter().zip(&facet.at).take(facet.kind.corners());
        let corners: Vec<PlanePoint> = corners
            .map(|(&node, &x)| *self.corners.entry(node).or_insert_with(|| chart.place(x)))
            .collect();
        // Straight edges stay straight in a plane.
        if facet.kind.is_linear() && !chart.is_curved {
            return corners;
        }
        let mut shadow = Vec::new();
        for (i, (kind, local)) in facet.kind.facets().iter().enumerate() {
            let at: Vec<_> = local.iter().map(|&node| facet.at[node]).collect();
            let along = |s: f64| chart.place(kind.position(&at, [s, 0.0, 0.0]));
            let (p, q) = (corners[i], corners[(i + 1) % corners.len()]);
            shadow.push(p);
            let sagitta = aside(p, q, along(0.0)) / (NEGLIGIBLE_SAGITTA * chart.area.sqrt());
            let parts = sagitta.sqrt().ceil().clamp(1.0, PARTS);
            shadow.extend((1..parts as usize).map(|part| along(2.0 * part as f64 / parts - 1.0)));
        }
        shadow
    }
}

/// Adds a piece, covered by a facet of side b, to `cover`.
fn integrate(
    chart: &Chart,
    facet: &SurfaceFacet,
    piece: &ProjectedFacet,
    opposite: &Opposite,
    cover: &mut Cover,
) -> Overlap {
    let other = &opposite.surface.facets[piece.facet];
    let mut overlap = Overlap {
        opposite: piece.facet,
        products: DMatrix::zeros(facet.nodes.len(), other.nodes.len()),
        gaps: vec![0.0; facet.nodes.len()],
    };
    // The last point is a good start for the next one.
    let (mut xi, mut eta) = (center(facet), center(other));
    let mut across = |p: PlanePoint| {
        xi = chart.xi(p, xi);
        let gap;
        (eta, gap) = foot(&opposite.maps[piece.facet], chart.line(xi), eta)?;
        Some((xi, eta, gap))
    };
    for &corner in &piece.outline {
        if let Some((xi, _, gap)) = across(corner) {
            cover.extent.include(xi);
            cover.least_gap = cover.least_gap.min(gap);
        }
    }
    let rule = &opposite.rules[degree(facet, other)];
    for [p, q, r] in triangles(&piece.outline) {
        let double = 2.0 * area(&[p, q, r]);
        for &([s, t, _], weight) in rule {
            let at = [0, 1].map(|k| p[k] + s * (q[k] - p[k]) + t * (r[k] - p[k]));
            let Some((xi, eta, gap)) = across(at) else {
                continue;
            };
            let weight = weight * double * chart.density(xi);
            let shape = facet.kind.shape([xi[0], xi[1], 0.0]);
            cover.add(weight, &shape, gap);
            cover.least_gap = cover.least_gap.min(gap);
            let others = other.kind.shape([eta[0], eta[1], 0.0]);
            for (i, n) in shape.iter().enumerate() {
                overlap.gaps[i] += weight * n * gap;
                for (k, m) in others.iter().enumerate() {
                    overlap.products[(i, k)] += weight * n * m;
                }
            }
        }
    }
    overlap
}

/// The degree of exactness for products of the shape functions of two facets.
fn degree(a: &SurfaceFacet, b: &SurfaceFacet) -> usize {
    let [own, other] = [a, b].map(|facet| {
        let order = if facet.kind.is_linear() { 1 } else { 2 };
        match facet.kind.domain() {
            Domain::Square => 2 * order,
            _ => order,
        }
    });
    let product = own + own.max(other);
    match [a, b] {
        both if both.iter().all(|facet| is_affine(facet)) => product,
        both if both.iter().all(|facet| is_flat(facet)) => product + EXTRA_DEGREE,
        _ => product + BEYOND_CURVED,
    }
}

/// True if all nodes of a facet lie in a plane.
fn is_flat(facet: &SurfaceFacet) -> bool {
    let height = |&x: &[f64; 3]| dot(difference(x, facet.at[0]), facet.normal);
    (facet.at.iter()).all(|x| height(x).abs() <= AFFINE * facet.size())
}

/// True if a facet is the image of the reference facet under an affine map.
fn is_affine(facet: &SurfaceFacet) -> bool {
    let kind = facet.kind;
    let nodes = kind.node_coordinates();
    // Three corners determine the map: the first, the second and the last.
    let (origin, ends) = (nodes[0], [1, kind.corners() - 1]);
    let image = |xi: [f64; 3]| {
        let mut x = facet.at[0];
        for (k, end) in ends.into_iter().enumerate() {
            let part = (xi[k] - origin[k]) / (nodes[end][k] - origin[k]);
            let edge = difference(facet.at[end], facet.at[0]);
            x = [0, 1, 2].map(|i| x[i] + part * edge[i]);
        }
        x
    };
    let off = |(&xi, &x): (&[f64; 3], &[f64; 3])| length(difference(image(xi), x));
    (nodes.iter().zip(&facet.at)).all(|pair| off(pair) <= AFFINE * facet.size())
}
