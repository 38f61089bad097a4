//! Polygons in a plane: intersection, and visibility of facets projected into it.

/// A point of the plane.
pub(super) type PlanePoint = [f64; 2];

/// a × b.
fn cross(a: PlanePoint, b: PlanePoint) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn difference(a: PlanePoint, b: PlanePoint) -> PlanePoint {
    [a[0] - b[0], a[1] - b[1]]
}

/// The area of a polygon, positive where its corners run counter-clockwise.
pub(super) fn area(polygon: &[PlanePoint]) -> f64 {
    let Some(&first) = polygon.first() else {
        return 0.0;
    };
    let arms = polygon.windows(2).map(|edge| {
        let [p, q] = [difference(edge[0], first), difference(edge[1], first)];
        0.5 * cross(p, q)
    });
    arms.sum()
}

/// The average of a polygon's corners.
pub(super) fn middle(polygon: &[PlanePoint]) -> PlanePoint {
    let part = 1.0 / polygon.len() as f64;
    (polygon.iter()).fold([0.0; 2], |sum, p| {
        [sum[0] + part * p[0], sum[1] + part * p[1]]
    })
}

/// Triangles around the centre of a polygon, which is the second corner of each: there the quadrature rules for
/// triangles are collapsed, so that they don't depend on the polygon's first corner.
pub(super) fn triangles(polygon: &[PlanePoint]) -> impl Iterator<Item = [PlanePoint; 3]> {
    let middle = middle(polygon);
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(move |(&p, &q)| [q, middle, p])
}

/// True if a point lies in a convex polygon whose corners run counter-clockwise.
pub(super) fn contains(polygon: &[PlanePoint], x: PlanePoint) -> bool {
    let next = polygon.iter().cycle().skip(1);
    (polygon.iter().zip(next)).all(|(&p, &q)| cross(difference(q, p), difference(x, p)) >= 0.0)
}

/// The part of a polygon that lies in a convex one whose corners run counter-clockwise (Sutherland and Hodgman,
/// Commun. ACM 17, 1974).
pub(super) fn clip(polygon: &[PlanePoint], convex: &[PlanePoint]) -> Vec<PlanePoint> {
    let mut inside = polygon.to_vec();
    for (i, &start) in convex.iter().enumerate() {
        let offset = difference(convex[(i + 1) % convex.len()], start);
        let side = |p: PlanePoint| cross(offset, difference(p, start));
        let all = std::mem::take(&mut inside);
        let Some(mut before) = all.last().copied() else {
            break;
        };
        for p in all {
            let (here, there) = (side(p), side(before));
            if (here >= 0.0) != (there >= 0.0) {
                // Evaluated from the inside out in either case, so that neighbours are cut at the same point.
                let (from, to, a, b) = match here >= 0.0 {
                    true => (p, before, here, there),
                    false => (before, p, there, here),
                };
                let t = a / (a - b);
                inside.push([0, 1].map(|k| from[k] + t * (to[k] - from[k])));
            }
            if here >= 0.0 {
                inside.push(p);
            }
            before = p;
        }
    }
    inside
}

/// A facet projected into the plane of another one.
pub(super) struct ProjectedFacet {
    /// Its index.
    pub facet: usize,
    /// Its visible part.
    pub outline: Vec<PlanePoint>,
    /// Distance along the normal at the centre of that part (m).
    pub gap: f64,
    /// True if it is the far side of the observing facet's own body.
    pub is_far_side: bool,
}

impl ProjectedFacet {
    /// True if another facet of `all`, or the observing facet's own body, lies in front of its centre.
    pub fn is_hidden(&self, all: &[Self]) -> bool {
        let x = middle(&self.outline);
        let hides = |other: &Self| {
            let is_nearer = match other.is_far_side {
                true => self.gap < other.gap,
                false => self.gap.abs() > other.gap.abs(),
            };
            is_nearer && other.facet != self.facet && contains(&other.outline, x)
        };
        self.is_far_side || all.iter().any(hides)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [PlanePoint; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];

    #[test]
    fn what_two_polygons_share_is_cut_out() {
        let corner = clip(&[[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]], &SQUARE);
        assert_eq!(area(&corner), 1.0);
        let octagon = clip(&[[1.0, -0.5], [2.5, 1.0], [1.0, 2.5], [-0.5, 1.0]], &SQUARE);
        assert_eq!((octagon.len(), area(&octagon)), (8, 3.5));
        assert_eq!(area(&clip(&SQUARE, &SQUARE)), 4.0);
        assert!(clip(&[[3.0, 0.0], [4.0, 0.0], [4.0, 1.0]], &SQUARE).is_empty());
        let around = clip(&[[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]], &SQUARE);
        assert_eq!(area(&around), 4.0);
        assert!(contains(&octagon, [1.0, 1.0]) && !contains(&octagon, [0.1, 0.1]));
    }

    #[test]
    fn tiles_of_the_plane_cover_a_polygon_once() {
        let tiles = |x: f64, y: f64| {
            let at = |i: f64, j: f64| [x + i + 0.3 * (y + j).sin(), y + j + 0.2 * (x + i).cos()];
            [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)]
        };
        let pentagon = [[0.1, 0.2], [3.3, 0.4], [3.9, 2.2], [2.0, 3.7], [0.3, 2.9]];
        let pieces = (-2..6).flat_map(|i| (-2..6).map(move |j| (f64::from(i), f64::from(j))));
        let parts = pieces.map(|(x, y)| clip(&tiles(x, y), &pentagon));
        let mut sum = 0.0;
        for part in parts.filter(|part| !part.is_empty()) {
            let by_triangles: f64 = triangles(&part).map(|t| area(&t)).sum();
            assert!((by_triangles - area(&part)).abs() < 1e-15);
            sum += by_triangles;
        }
        assert!((sum - area(&pentagon)).abs() < 1e-14);
    }
}
