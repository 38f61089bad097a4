//! The map x(ξ) = Σ N_i(ξ) x_i from a reference element into space, and quantities derived from it.

use super::definition::Domain;
use super::reference::ReferenceElement;

/// a·b.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a − b.
pub fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// a + s·b.
pub fn advance(a: [f64; 3], s: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// a × b.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A vector in space with these `components`; the others are zero.
pub fn padded(components: &[f64]) -> [f64; 3] {
    let mut vector = [0.0; 3];
    vector[..components.len()].copy_from_slice(components);
    vector
}

/// A point or vector as text, with `dim` components: `(1, 2)`.
pub fn shown(vector: [f64; 3], dim: usize) -> String {
    let components = vector.iter().take(dim).map(f64::to_string);
    format!("({})", components.collect::<Vec<_>>().join(", "))
}

/// |a|.
pub fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// a/|a|; `None` for the zero vector.
pub fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let size = length(a);
    (size > 0.0).then(|| a.map(|c| c / size))
}

impl ReferenceElement {
    /// The point x(ξ) = Σ N_i(ξ) x_i of an element with the nodes at `at`, in metres.
    pub fn position(&self, at: &[[f64; 3]], xi: [f64; 3]) -> [f64; 3] {
        self.shape(xi)
            .into_iter()
            .zip(at)
            .fold([0.0; 3], |sum, (value, &x)| advance(sum, value, x))
    }

    /// det ∂x/∂ξ of a cell whose dimension is that of space: positive for positive orientation, and dx = det·dξ
    /// (m^dim).
    pub fn jacobian(&self, at: &[[f64; 3]], xi: [f64; 3]) -> f64 {
        self.determinant(&self.gradients(xi), at)
    }

    /// det ∂x/∂ξ at a point where the shape functions have these `gradients` (m^dim).
    pub fn determinant(&self, gradients: &[[f64; 3]], at: &[[f64; 3]]) -> f64 {
        if self.dim() == 3 {
            let [r, s, t] = tangents(gradients, at);
            return dot(cross(r, s), t);
        }
        // This is evaluated at every point of every cell, so that components out of the plane are left out.
        let mut j = [[0.0; 2]; 2];
        for (gradient, x) in gradients.iter().zip(at) {
            for (row, x) in j.iter_mut().zip(x) {
                row[0] += gradient[0] * x;
                row[1] += gradient[1] * x;
            }
        }
        match self.dim() {
            0 => 1.0,
            1 => j[0][0],
            _ => j[0][0] * j[1][1] - j[0][1] * j[1][0],
        }
    }

    /// ∫ det ∂x/∂ξ dξ of a cell whose dimension is that of space: its area or volume, with the sign of its orientation
    /// (m², m³).
    pub fn measure(&self, at: &[[f64; 3]]) -> f64 {
        // This is evaluated for every cell of a mesh, so that no rule is used where the map is affine.
        match (self.domain(), at) {
            (Domain::Triangle, [a, b, c]) => {
                let (t, s) = (difference(*b, *a), difference(*c, *a));
                return 0.5 * (t[0] * s[1] - t[1] * s[0]);
            }
            (Domain::Tetrahedron, [a, b, c, d]) => {
                let [r, s, t] = [b, c, d].map(|corner| difference(*corner, *a));
                return dot(cross(r, s), t) / 6.0;
            }
            _ => {}
        }
        let points = self.stiffness_points().iter();
        points
            .map(|point| point.weight * self.determinant(&point.gradients, at))
            .sum()
    }

    /// n dS/dξ of a facet whose nodes are ordered like in [`facets`](Self::facets): its unit outward normal times the
    /// measure in space per unit of the reference facet.
    pub fn area_vector(&self, at: &[[f64; 3]], xi: [f64; 3]) -> [f64; 3] {
        let [t, s, _] = tangents(&self.gradients(xi), at);
        match self.dim() {
            0 => [0.0; 3],
            1 => [t[1], -t[0], 0.0],
            _ => cross(t, s),
        }
    }

    /// Points whose convex hull contains a line or face, including its corners (m).
    pub fn hull(&self, at: &[[f64; 3]]) -> Vec<[f64; 3]> {
        match (self.domain(), at) {
            // The middle Bernstein coefficient.
            (Domain::Line, &[p, q, m]) => vec![p, q, bernstein(p, m, q)],
            (Domain::Triangle, &[a, b, c, ab, bc, ca]) => {
                vec![
                    a,
                    b,
                    c,
                    bernstein(a, ab, b),
                    bernstein(b, bc, c),
                    bernstein(c, ca, a),
                ]
            }
            (Domain::Square, _) if !self.is_linear() => {
                let places = [-1.0, 0.0, 1.0];
                let rows = places.map(|t| {
                    let [p, m, q] = places.map(|s| self.position(at, [s, t, 0.0]));
                    [p, bernstein(p, m, q), q]
                });
                let column = |i: usize| {
                    let [p, m, q] = rows.map(|row| row[i]);
                    [p, bernstein(p, m, q), q]
                };
                (0..3).flat_map(column).collect()
            }
            _ => at.to_vec(),
        }
    }

    /// Intersection of the line x + s·`direction` (a unit vector) with the inside of a facet: s (m), in the plane the
    /// one nearest to x where there are two. `None` where the line misses the facet or is parallel to it.
    pub fn crossing(&self, at: &[[f64; 3]], x: [f64; 3], direction: [f64; 3]) -> Option<f64> {
        let aside = |p: [f64; 3]| {
            let offset = difference(p, x);
            direction[0] * offset[1] - direction[1] * offset[0]
        };
        match (self.domain(), at) {
            (Domain::Line, &[p, q]) => {
                let (left, right) = (aside(p), aside(q));
                if left * right >= 0.0 {
                    return None;
                }
                let t = left / (left - right);
                let ahead = |p: [f64; 3]| dot(difference(p, x), direction);
                Some(ahead(p) * (1.0 - t) + ahead(q) * t)
            }
            (Domain::Line, &[p, q, m]) => {
                let (start, end, middle) = (aside(p), aside(q), aside(m));
                let (half, slope) = (0.5 * (start + end) - middle, 0.5 * (end - start));
                let inside = roots(half, slope, middle).filter(|xi| xi.abs() < 1.0);
                let offsets = inside.map(|xi| {
                    let point = self.position(at, [xi, 0.0, 0.0]);
                    dot(difference(point, x), direction)
                });
                offsets.min_by(|a, b| a.abs().total_cmp(&b.abs()))
            }
            (Domain::Triangle | Domain::Square, _) => self.crossing_of_face(at, x, direction),
            _ => None,
        }
    }

    /// The intersection of a line and a face, including its border, by Newton's method from its centre.
    fn crossing_of_face(&self, at: &[[f64; 3]], x: [f64; 3], direction: [f64; 3]) -> Option<f64> {
        let mut xi = match self.domain() {
            Domain::Triangle => [1.0 / 3.0, 1.0 / 3.0, 0.0],
            _ => [0.0; 3],
        };
        let mut ahead = dot(difference(self.position(at, xi), x), direction);
        for _ in 0..NEWTON_STEPS {
            let offset = difference(self.position(at, xi), advance(x, ahead, direction));
            let [r, s, _] = tangents(&self.gradients(xi), at);
            let normal = cross(r, s);
            // x(ξ + δ) = x + (s + δ_s) direction by Cramer's rule.
            let across = dot(normal, direction);
            if across.abs() <= PARALLEL * length(normal) {
                return None;
            }
            let change = [
                dot(cross(s, offset), direction) / across,
                dot(cross(offset, r), direction) / across,
            ];
            xi = [xi[0] + change[0], xi[1] + change[1], 0.0];
            ahead += dot(normal, offset) / across;
            if change.iter().all(|c| c.abs() <= BORDER) {
                let [s, t, _] = xi;
                let is_inside = match self.domain() {
                    Domain::Triangle => s.min(t).min(1.0 - s - t) >= -BORDER,
                    _ => s.abs().max(t.abs()) <= 1.0 + BORDER,
                };
                return is_inside.then_some(ahead);
            }
        }
        None
    }
}

/// Number of steps after which Newton's method isn't converging to a point of a face.
const NEWTON_STEPS: usize = 20;
/// Distance in reference coordinates up to which points beyond the border of a face belong to it.
const BORDER: f64 = 1e-9;
/// Sine of the angle up to which a line is parallel to a face.
const PARALLEL: f64 = 1e-9;

/// The middle Bernstein coefficient of a quadratic with these values at the ends and in the middle.
fn bernstein(p: [f64; 3], m: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| 2.0 * m[i] - 0.5 * (p[i] + q[i]))
}

/// The columns ∂x/∂ξ_j of the map of an element with the nodes at `at`.
fn tangents(gradients: &[[f64; 3]], at: &[[f64; 3]]) -> [[f64; 3]; 3] {
    let mut tangents = [[0.0; 3]; 3];
    for (gradient, &x) in gradients.iter().zip(at) {
        for (tangent, &slope) in tangents.iter_mut().zip(gradient) {
            *tangent = advance(*tangent, slope, x);
        }
    }
    tangents
}

/// The real roots of a·x² + b·x + c, without cancellation; none for a constant.
fn roots(a: f64, b: f64, c: f64) -> impl Iterator<Item = f64> {
    let square = b * b - 4.0 * a * c;
    let sum = -0.5 * (b + square.sqrt().copysign(b));
    let far = (a != 0.0).then(|| sum / a);
    let near = (sum != 0.0).then(|| c / sum);
    (far.into_iter().chain(near)).filter(move |_| square >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::super::ElementKind;

    #[test]
    fn a_line_crosses_a_curved_facet_where_it_is() {
        // y = 1 − x² for −1 < x < 1.
        let arch = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let crossing = |x, direction| ElementKind::Line3.crossing(&arch, x, direction);
        let up = crossing([0.5, -1.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
        assert!((up - 1.75).abs() < 1e-15);
        let across = crossing([-0.4, 0.75, 0.0], [1.0, 0.0, 0.0]).unwrap();
        assert!((across + 0.1).abs() < 1e-15, "the nearer of two");
        assert_eq!(crossing([0.0, 1.5, 0.0], [1.0, 0.0, 0.0]), None);
        assert_eq!(crossing([1.5, 0.0, 0.0], [0.0, 1.0, 0.0]), None);
        let straight = [[0.0, 1.0, 0.0], [2.0, 3.0, 0.0], [1.0, 2.0, 0.0]];
        let up = ElementKind::Line3.crossing(&straight, [0.5, 0.5, 0.0], [0.0, 1.0, 0.0]);
        assert!((up.unwrap() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_line_crosses_a_facet_only_between_its_ends() {
        let facet = [[0.0, 1.0, 0.0], [2.0, 3.0, 0.0]];
        let up = [0.0, 1.0, 0.0];
        let crossing = |x: f64| ElementKind::Line2.crossing(&facet, [x, 0.5, 0.0], up);
        assert!((crossing(0.5).unwrap() - 1.0).abs() < 1e-15);
        assert_eq!(crossing(-0.5), None);
        assert_eq!(crossing(2.5), None);
    }
}
