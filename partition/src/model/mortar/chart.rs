//! Flat coordinates on a facet in space, in which the opposite facets are clipped as polygons.

use super::super::clip::{PlanePoint, area};
use super::field::NormalField;
use super::foot::{ROUND_OFF, STEPS, middle, solve};
use super::map::{Map, Xi};
use crate::contact_point::LocalFrame;
use crate::element::definition::Domain;
use crate::element::geometry::{advance, cross, difference, dot, length};

/// Distance of a node on an edge from the chord, relative to the chord, above which the edge is curved.
const CURVED: f64 = 1e-9;
/// Distance, relative to the facet, that is round-off.
const STEP_TOLERANCE: f64 = 1e-12;

/// Coordinates on a facet: those of the plane perpendicular to its normal, in which straight edges of any facet are
/// straight, so that flat sides are clipped exactly; on a facet with curved edges its reference coordinates, in which
/// at least its own edges are straight.
pub(super) struct Chart {
    domain: Domain,
    positions: Map,
    normals: Map,
    /// (n, t₁, t₂) at the centre.
    frame: LocalFrame,
    origin: [f64; 3],
    size: f64,
    /// True for reference coordinates.
    pub is_curved: bool,
    /// The corners of the facet, counter-clockwise.
    pub outline: Vec<PlanePoint>,
    /// The area within the outline.
    pub area: f64,
}

impl Chart {
    /// The chart of a facet with averaged normals.
    pub fn new(field: &NormalField) -> Self {
        let facet = field.facet();
        let (kind, at) = (facet.kind, &facet.at);
        let mut chart = Self {
            domain: kind.domain(),
            positions: Map::new(kind, at),
            normals: Map::new(kind, field.normals()),
            frame: LocalFrame::new(facet.normal),
            origin: at[0],
            size: facet.size(),
            is_curved: false,
            outline: Vec::new(),
            area: 0.0,
        };
        let flat: Vec<PlanePoint> = at.iter().map(|&x| chart.flat(x)).collect();
        chart.is_curved = kind.facets().iter().any(|(_, edge)| {
            let [p, q] = [flat[edge[0]], flat[edge[1]]];
            let chord = (q[0] - p[0]).hypot(q[1] - p[1]);
            (edge[2..].iter()).any(|&middle| aside(p, q, flat[middle]) > CURVED * chord)
        });
        let corners = 0..kind.corners();
        chart.outline = match chart.is_curved {
            true => {
                let nodes = &kind.node_coordinates()[corners];
                nodes.iter().map(|&[s, t, _]| [s, t]).collect()
            }
            false => flat[corners].to_vec(),
        };
        chart.area = area(&chart.outline);
        chart
    }

    /// Outward normal at the centre.
    pub fn normal(&self) -> [f64; 3] {
        self.frame.normal
    }

    /// The position at ξ and the averaged normal (m).
    pub fn line(&self, xi: Xi) -> [[f64; 3]; 2] {
        // The normals at the nodes of a facet are less than 90° from its own, so that their sum isn't zero.
        let normal = self.normals.at(xi);
        let size = length(normal);
        [self.positions.at(xi), normal.map(|c| c / size)]
    }

    /// Reference coordinates of a point of the chart, by iteration from `near`.
    pub fn xi(&self, p: PlanePoint, near: Xi) -> Xi {
        match self.is_curved {
            true => p,
            false => self.inverse(p, near),
        }
    }

    /// Area in space per unit of area of the chart, at ξ.
    pub fn density(&self, xi: Xi) -> f64 {
        let [x_s, x_t] = self.positions.slopes(xi);
        let vector = cross(x_s, x_t);
        match self.is_curved {
            true => length(vector),
            false => length(vector) / dot(vector, self.frame.normal),
        }
    }

    /// The point of the chart whose averaged normal passes through `y`. Beyond the edges of the facet the normals are
    /// those at the edge.
    pub fn place(&self, y: [f64; 3]) -> PlanePoint {
        let normal = self.frame.normal;
        let mut xi = middle(self.domain);
        let mut flat = self.flat(y);
        for _ in 0..STEPS {
            xi = self.inverse(flat, xi);
            let [x, along] = self.line(clamped(self.domain, xi));
            let ahead = dot(difference(y, x), normal) / dot(along, normal);
            let next = self.flat(advance(y, -ahead, along));
            let moved = (next[0] - flat[0]).hypot(next[1] - flat[1]);
            flat = next;
            if moved <= STEP_TOLERANCE * self.size {
                break;
            }
        }
        match self.is_curved {
            true => self.inverse(flat, xi),
            false => flat,
        }
    }

    /// Coordinates in the plane perpendicular to the normal.
    fn flat(&self, x: [f64; 3]) -> PlanePoint {
        let offset = difference(x, self.origin);
        self.frame.tangents.map(|t| dot(t, offset))
    }

    /// ξ of a point of the plane, by Newton's method from `near`. Beyond its edges the facet is extended linearly.
    fn inverse(&self, p: PlanePoint, near: Xi) -> Xi {
        let tangents = self.frame.tangents;
        let mut xi = near;
        for _ in 0..STEPS {
            let inside = clamped(self.domain, xi);
            let slopes = self.positions.slopes(inside);
            let at = self.flat(self.positions.at(inside));
            let j = tangents.map(|t| slopes.map(|slope| dot(t, slope)));
            let step = solve(j, [p[0] - at[0], p[1] - at[1]]);
            let next = [inside[0] + step[0], inside[1] + step[1]];
            let moved = (next[0] - xi[0]).abs().max((next[1] - xi[1]).abs());
            xi = next;
            if moved <= ROUND_OFF {
                break;
            }
        }
        xi
    }
}

/// The distance of x from the line through p and q.
pub(super) fn aside(p: PlanePoint, q: PlanePoint, x: PlanePoint) -> f64 {
    let (offset, to) = ([q[0] - p[0], q[1] - p[1]], [x[0] - p[0], x[1] - p[1]]);
    (offset[0] * to[1] - offset[1] * to[0]).abs() / offset[0].hypot(offset[1])
}

/// The approximate point of a facet nearest to ξ.
fn clamped(domain: Domain, [s, t]: Xi) -> Xi {
    match domain {
        Domain::Triangle => {
            let (s, t) = (s.max(0.0), t.max(0.0));
            let sum = (s + t).max(1.0);
            [s / sum, t / sum]
        }
        _ => [s.clamp(-1.0, 1.0), t.clamp(-1.0, 1.0)],
    }
}
