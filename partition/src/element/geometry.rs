//! The map of a reference element to its place in space, and what follows from it.

use super::ElementKind;

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

/// |a|.
pub fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

impl ElementKind {
    /// The point x(ξ) = Σ N_i(ξ) x_i of an element with the nodes at `at`, in metres.
    pub fn position(self, at: &[[f64; 3]], xi: [f64; 3]) -> [f64; 3] {
        self.shape(xi)
            .into_iter()
            .zip(at)
            .fold([0.0; 3], |sum, (value, &x)| advance(sum, value, x))
    }

    /// The columns ∂x/∂ξ_j of a cell's or facet's map.
    fn tangents(self, at: &[[f64; 3]], xi: [f64; 3]) -> [[f64; 3]; 3] {
        let mut tangents = [[0.0; 3]; 3];
        for (gradient, &x) in self.gradients(xi).into_iter().zip(at) {
            for (tangent, slope) in tangents.iter_mut().zip(gradient) {
                *tangent = advance(*tangent, slope, x);
            }
        }
        tangents
    }

    /// det ∂x/∂ξ of a cell that fills its space: positive where it is positively oriented, and
    /// dx = det·dξ (m^dim).
    pub fn jacobian(self, at: &[[f64; 3]], xi: [f64; 3]) -> f64 {
        let [t, s, _] = self.tangents(at, xi);
        match self.dim() {
            0 => 1.0,
            1 => t[0],
            _ => t[0] * s[1] - t[1] * s[0],
        }
    }

    /// ∫ det ∂x/∂ξ dξ of a cell that fills its space: its length, area or volume, with the sign of
    /// its orientation (m^dim).
    pub fn measure(self, at: &[[f64; 3]]) -> f64 {
        // One for every cell of a mesh: without a rule on the heap where the map is affine.
        if let (Self::Triangle3, [a, b, c]) = (self, at) {
            let (t, s) = (difference(*b, *a), difference(*c, *a));
            return 0.5 * (t[0] * s[1] - t[1] * s[0]);
        }
        let rule = self.quadrature(1);
        let points = rule.points.iter().zip(&rule.weights);
        points.map(|(&xi, w)| w * self.jacobian(at, xi)).sum()
    }

    /// n dS/dξ of a facet whose cell lies to its left: its unit outward normal times the measure
    /// that a unit of the reference facet has in space.
    pub fn area_vector(self, at: &[[f64; 3]], xi: [f64; 3]) -> [f64; 3] {
        let [t, s, _] = self.tangents(at, xi);
        match self.dim() {
            0 => [0.0; 3],
            1 => [t[1], -t[0], 0.0],
            _ => [
                t[1] * s[2] - t[2] * s[1],
                t[2] * s[0] - t[0] * s[2],
                t[0] * s[1] - t[1] * s[0],
            ],
        }
    }

    /// Where the line x + s·`direction` (a unit vector) crosses the inside of a straight facet of
    /// a plane: s (m). `None` where it passes by, or along it.
    pub fn crossing(self, at: &[[f64; 3]], x: [f64; 3], direction: [f64; 3]) -> Option<f64> {
        match (self, at) {
            (Self::Line2, &[p, q]) => {
                let (p, q) = (difference(p, x), difference(q, x));
                let aside = |r: [f64; 3]| direction[0] * r[1] - direction[1] * r[0];
                let (left, right) = (aside(p), aside(q));
                if left * right >= 0.0 {
                    return None;
                }
                let t = left / (left - right);
                Some(dot(p, direction) * (1.0 - t) + dot(q, direction) * t)
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outward_normals_of_a_triangle_times_their_lengths_add_up_to_zero() {
        let at = [[0.3, -1.0, 0.0], [2.0, 0.5, 0.0], [-0.7, 1.9, 0.0]];
        let mut sum = [0.0; 3];
        let centre = ElementKind::Triangle3.position(&at, [1.0 / 3.0, 1.0 / 3.0, 0.0]);
        for (kind, local) in ElementKind::Triangle3.facets() {
            let ends: Vec<_> = local.iter().map(|&i| at[i]).collect();
            let normal = kind.area_vector(&ends, [0.0; 3]);
            let out = difference(kind.position(&ends, [0.0; 3]), centre);
            assert!(dot(normal, out) > 0.0);
            assert!((2.0 * length(normal) - length(difference(ends[1], ends[0]))).abs() < 1e-15);
            sum = advance(sum, 1.0, normal);
        }
        assert!(length(sum) < 1e-15);
    }

    #[test]
    fn the_jacobian_is_twice_the_area_and_changes_sign_with_the_orientation() {
        let at = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, 2.0, 0.0]];
        let kind = ElementKind::Triangle3;
        assert_eq!(kind.jacobian(&at, [0.0; 3]), 6.0);
        let turned: Vec<_> = kind.reversed().iter().map(|&i| at[i]).collect();
        assert_eq!(kind.jacobian(&turned, [0.0; 3]), -6.0);
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
