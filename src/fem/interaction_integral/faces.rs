//! Crack faces: W at their nodes, where the near field is singular.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use contact_dd_partition::crack_tip::FaceFacet;
use contact_dd_partition::element::ElementKind;

use super::{DEGREE, RADII, TipDisc, Work};

impl TipDisc<'_> {
    /// W at the nodes of the faces: ∫ N q a,₁ ds over ∫ N ds. The share of the tip is added to the next node of its
    /// facet, that of a node outside the disc to the end of its facet nearer to the tip, because not all cells around
    /// the tip and outside the disc are evaluated.
    pub(super) fn work_on_faces(&self) -> BTreeMap<i64, [Work; RADII.len()]> {
        let mut sums: BTreeMap<i64, ([Work; RADII.len()], f64)> = BTreeMap::new();
        for facet in &self.tip.facets {
            let next = *facet.nodes().last().unwrap_or(&self.tip.tag);
            for point in FacePoint::of(facet) {
                let angle = if facet.is_upper { PI } else { -PI };
                let fields = self.field.gradients(point.distance, angle);
                let nodes = facet.nodes().iter().zip(&facet.distances);
                for ((&tag, &distance), &n) in nodes.zip(&point.shape) {
                    let owner = match tag == self.tip.tag {
                        true => next,
                        false if distance >= self.tip.radius => facet.nodes[0],
                        false => tag,
                    };
                    let (works, area) = sums.entry(owner).or_default();
                    *area += if owner == tag { n * point.weight } else { 0.0 };
                    for (radius, work) in works.iter_mut().enumerate() {
                        let nodes = facet.distances.iter().zip(&point.shape);
                        let q: f64 = nodes.map(|(s, n)| n * self.weight(radius, *s)).sum();
                        for (work, field) in work.iter_mut().zip(&fields) {
                            for (work, gradient) in work.iter_mut().zip(field) {
                                *work += n * point.weight * q * gradient[0];
                            }
                        }
                    }
                }
            }
        }
        let mean = |(works, area): ([Work; RADII.len()], f64)| {
            works.map(|work| work.map(|of_mode| of_mode.map(|w| w / area)))
        };
        sums.into_iter()
            .map(|(tag, sum)| (tag, mean(sum)))
            .collect()
    }
}

/// A quadrature point of a facet of a crack face.
struct FacePoint {
    /// Distance from the tip (m).
    distance: f64,
    /// The shape functions of the facet's nodes at the point.
    shape: Vec<f64>,
    /// Quadrature weight times Jacobian (m).
    weight: f64,
}

impl FacePoint {
    /// The quadrature points of a facet: with ξ = 2η² − 1, functions like 1/√r become polynomials in η.
    fn of(facet: &FaceFacet) -> Vec<Self> {
        let count = facet.nodes().len();
        let line = if count == 3 {
            ElementKind::Line3
        } else {
            ElementKind::Line2
        };
        let rule = ElementKind::Line2.quadrature(2 * DEGREE);
        let at = |(eta, weight): ([f64; 3], f64)| {
            let eta = 0.5 * (1.0 + eta[0]);
            let xi = [2.0 * eta * eta - 1.0, 0.0, 0.0];
            let shape = line.shape(xi);
            let slopes = line.gradients(xi);
            let sum = |factors: &mut dyn Iterator<Item = f64>| -> f64 {
                factors.zip(&facet.distances).map(|(f, s)| f * s).sum()
            };
            let jacobian = sum(&mut slopes.iter().map(|slope| slope[0]));
            Self {
                distance: sum(&mut shape.iter().copied()),
                weight: 0.5 * weight * 4.0 * eta * jacobian,
                shape,
            }
        };
        rule.into_iter().map(at).collect()
    }
}
