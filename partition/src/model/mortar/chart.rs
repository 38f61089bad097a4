//! Flat coordinates on a facet of space, in which what covers it is cut into polygons.

use super::clip::{Point, area};
use super::field::Field;
use super::foot::{middle, point, solve};
use crate::contact_point::LocalFrame;
use crate::element::geometry::{advance, difference, dot, length};
use crate::element::reference::Domain;

/// Distance of a node on an edge from the chord, relative to the chord, from which on the edge is curved.
const CURVED: f64 = 1e-9;
/// Steps after which an iteration that still moves is left where it is.
const STEPS: usize = 30;
/// Change of a coordinate of order 1 that is none.
const ROUND_OFF: f64 = 1e-14;

/// Coordinates on a facet: those of the plane across its normal, in which straight edges are straight wherever
/// they come from, so that flat sides are cut exactly; on a facet with curved edges its reference coordinates,
/// in which at least its own are straight.
pub(super) struct Chart<'a> {
    field: &'a Field<'a>,
    /// (n, t₁, t₂) in its middle.
    frame: LocalFrame,
    origin: [f64; 3],
    is_curved: bool,
    /// The corners of the facet, counter-clockwise.
    pub outline: Vec<Point>,
    /// The area within.
    pub area: f64,
}

impl<'a> Chart<'a> {
    /// The chart of a facet with averaged normals.
    pub fn new(field: &'a Field<'a>) -> Self {
        let facet = field.facet();
        let (kind, at) = (facet.kind, &facet.at);
        let mut chart = Self {
            field,
            frame: LocalFrame::new(facet.normal),
            origin: at[0],
            is_curved: false,
            outline: Vec::new(),
            area: 0.0,
        };
        let flat: Vec<Point> = at.iter().map(|&x| chart.flat(x)).collect();
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

    /// Its outward normal in the middle.
    pub fn normal(&self) -> [f64; 3] {
        self.frame.normal
    }

    /// Coordinates in the plane across the normal.
    fn flat(&self, x: [f64; 3]) -> Point {
        let way = difference(x, self.origin);
        self.frame.tangents.map(|t| dot(t, way))
    }

    /// Reference coordinates of a point of the chart.
    pub fn xi(&self, p: Point) -> [f64; 3] {
        match self.is_curved {
            true => [p[0], p[1], 0.0],
            false => self.inverse(p, self.middle()),
        }
    }

    /// Area that a unit of the chart's has in space, at ξ.
    pub fn density(&self, xi: [f64; 3]) -> f64 {
        let facet = self.field.facet();
        let vector = facet.kind.area_vector(&facet.at, xi);
        match self.is_curved {
            true => length(vector),
            false => length(vector) / dot(vector, self.frame.normal),
        }
    }

    /// The point of the chart from which the averaged normals lead to `y`. Beyond the edges of the facet the
    /// normals are those at the edge.
    pub fn place(&self, y: [f64; 3]) -> Point {
        let normal = self.frame.normal;
        let height = |x: [f64; 3]| dot(difference(y, x), normal);
        let mut xi = self.middle();
        let mut flat = self.flat(y);
        for _ in 0..STEPS {
            let [s, t] = clamped(self.domain(), [xi[0], xi[1]]);
            let inside = [s, t, 0.0];
            let along = self.field.normal(inside);
            let ahead = height(self.field.position(inside)) / dot(along, normal);
            let next = self.flat(advance(y, -ahead, along));
            let moved = (next[0] - flat[0]).hypot(next[1] - flat[1]);
            flat = next;
            if moved <= ROUND_OFF * self.field.facet().size() {
                break;
            }
            xi = self.inverse(flat, xi);
        }
        match self.is_curved {
            true => {
                let [s, t, _] = self.inverse(flat, xi);
                [s, t]
            }
            false => flat,
        }
    }

    fn domain(&self) -> Domain {
        self.field.facet().kind.domain()
    }

    fn middle(&self) -> [f64; 3] {
        middle(self.domain())
    }

    /// ξ of a point of the plane, by Newton's method from `start`. Beyond its edges the facet goes on straight.
    fn inverse(&self, p: Point, start: [f64; 3]) -> [f64; 3] {
        let facet = self.field.facet();
        let [t_1, t_2] = self.frame.tangents;
        let mut xi = [start[0], start[1]];
        for _ in 0..STEPS {
            let [s, t] = clamped(self.domain(), xi);
            let inside = [s, t, 0.0];
            let (x, [x_s, x_t]) = point(facet, inside);
            let j = [
                [dot(t_1, x_s), dot(t_1, x_t)],
                [dot(t_2, x_s), dot(t_2, x_t)],
            ];
            let at = self.flat(x);
            let step = solve(j, [p[0] - at[0], p[1] - at[1]]);
            let next = [s + step[0], t + step[1]];
            let moved = (next[0] - xi[0]).abs().max((next[1] - xi[1]).abs());
            xi = next;
            if moved <= ROUND_OFF {
                break;
            }
        }
        [xi[0], xi[1], 0.0]
    }
}

/// The distance of x from the line through p and q.
pub(super) fn aside(p: Point, q: Point, x: Point) -> f64 {
    let (way, to) = ([q[0] - p[0], q[1] - p[1]], [x[0] - p[0], x[1] - p[1]]);
    (way[0] * to[1] - way[1] * to[0]).abs() / way[0].hypot(way[1])
}

/// The point of a facet nearest to ξ, more or less.
fn clamped(domain: Domain, [s, t]: Point) -> Point {
    match domain {
        Domain::Triangle => {
            let (s, t) = (s.max(0.0), t.max(0.0));
            let sum = (s + t).max(1.0);
            [s / sum, t / sum]
        }
        _ => [s.clamp(-1.0, 1.0), t.clamp(-1.0, 1.0)],
    }
}
