//! What of side b covers a facet of side a, cut into segments and sampled for integration.

use super::super::ray_search::{FACING, Target};
use super::super::surface::{Surface, SurfaceFacet};
use super::field::{Field, ahead, beside, cross};
use super::root::{ENDS, root};
use crate::element::geometry::{difference, dot, length};

/// Degree to which a segment is integrated. The product of two straight facets' shape functions
/// has degree 2; projections between facets that aren't parallel are rational.
const DEGREE: usize = 9;

/// A point at which a segment is integrated.
pub(super) struct Sample {
    /// Quadrature weight times the measure (m).
    pub weight: f64,
    /// Shape functions of the facet of side a.
    pub shape: Vec<f64>,
    /// Facet of side b opposite.
    pub opposite: usize,
    /// Its shape functions at the projection.
    pub opposite_shape: Vec<f64>,
    /// The gap along the averaged normal (m).
    pub gap: f64,
}

/// The part of a facet of side a that side b covers.
pub(super) struct Cover {
    /// Its samples, segment by segment along the facet.
    pub samples: Vec<Sample>,
    /// The least gap, ends of segments included (m).
    pub least_gap: f64,
}

/// Side b as side a sees it.
pub(super) struct Opposite<'a> {
    surface: &'a Surface,
    target: Target<'a>,
    behind: f64,
}

impl<'a> Opposite<'a> {
    /// Makes side b ready to be searched; `behind` is how far backwards it may lie (m).
    pub fn new(surface: &'a Surface, behind: f64) -> Self {
        Self {
            surface,
            target: Target::new(surface),
            behind,
        }
    }

    /// What of side b covers a facet of side a, and whether some of it faces the same way.
    ///
    /// The facet is cut wherever an end of a facet of side b is projected onto it; what the middle
    /// of a piece meets first is opposite all of it.
    pub fn cover(&self, field: &Field) -> (Cover, bool) {
        let candidates = self.candidates(field);
        let mut cuts = ENDS.to_vec();
        for &facet in &candidates {
            let facet = &self.surface.facets[facet];
            for end in ENDS {
                let x = facet.kind.position(&facet.at, [end, 0.0, 0.0]);
                cuts.extend(root(|xi| field.aside(xi, x)));
            }
        }
        cuts.sort_by(f64::total_cmp);
        let mut cover = Cover {
            samples: Vec::new(),
            least_gap: f64::INFINITY,
        };
        let mut any_back_facing = false;
        for ends in cuts.windows(2).filter(|ends| ends[0] < ends[1]) {
            let middle = 0.5 * (ends[0] + ends[1]);
            let (x, normal) = (field.position(middle), field.normal(middle));
            match self.nearest(x, normal, &candidates) {
                Ok(opposite) => self.integrate(field, [ends[0], ends[1]], opposite, &mut cover),
                Err(back_facing) => any_back_facing |= back_facing,
            }
        }
        (cover, any_back_facing)
    }

    /// The facets of side b that may lie on a line of `field`: between its first and its last.
    fn candidates(&self, field: &Field) -> Vec<usize> {
        let lines = ENDS.map(|end| (field.position(end), field.normal(end)));
        let mut candidates = self.target.facets(|low, high| {
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

    /// The facet that the line through `x` along `normal` meets first face to face, either way but not
    /// too far backwards; where there is none, whether it meets one that faces the same way.
    fn nearest(&self, x: [f64; 3], normal: [f64; 3], candidates: &[usize]) -> Result<usize, bool> {
        let mut nearest: Option<(usize, f64)> = None;
        let mut back_facing = false;
        for &candidate in candidates {
            let facet = &self.surface.facets[candidate];
            let Some(eta) = root(|eta| beside(facet, x, normal, eta)) else {
                continue;
            };
            let distance = ahead(facet, x, normal, eta);
            if distance < -self.behind {
                continue;
            }
            if dot(facet.normal, normal) > -FACING {
                back_facing = true;
            } else if nearest.is_none_or(|(_, other)| distance.abs() < other.abs()) {
                nearest = Some((candidate, distance));
            }
        }
        nearest.map(|(facet, _)| facet).ok_or(back_facing)
    }

    /// Adds the samples of the segment between `ends`, which the facet `opposite` covers.
    fn integrate(&self, field: &Field, ends: [f64; 2], opposite: usize, cover: &mut Cover) {
        let (a, b) = (field.facet(), &self.surface.facets[opposite]);
        let [from, to] = ends;
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        for end in ends {
            let (_, gap) = project(field, b, end);
            cover.least_gap = cover.least_gap.min(gap);
        }
        for (point, weight) in a.kind.quadrature(DEGREE) {
            let xi = middle + half * point[0];
            let (eta, gap) = project(field, b, xi);
            let xi = [xi, 0.0, 0.0];
            cover.least_gap = cover.least_gap.min(gap);
            cover.samples.push(Sample {
                weight: weight * half * length(a.kind.area_vector(&a.at, xi)),
                shape: a.kind.shape(xi),
                opposite,
                opposite_shape: b.kind.shape([eta, 0.0, 0.0]),
                gap,
            });
        }
    }
}

/// Where the line at ξ meets a facet that is opposite: η, and the gap (m).
fn project(field: &Field, facet: &SurfaceFacet, xi: f64) -> (f64, f64) {
    let (x, normal) = (field.position(xi), field.normal(xi));
    let side = |eta: f64| beside(facet, x, normal, eta);
    let eta = root(side).unwrap_or_else(|| {
        // Round-off has the line pass by the end that it goes through.
        let [low, high] = ENDS;
        if side(low)[0].abs() < side(high)[0].abs() {
            low
        } else {
            high
        }
    });
    (eta, ahead(facet, x, normal, eta))
}
