//! Shape functions on the reference elements.
//!
//! A line is −1 ≤ ξ ≤ 1, a triangle has the corners (0, 0), (1, 0), (0, 1), a quadrilateral is
//! −1 ≤ ξ, η ≤ 1.

use super::ElementKind;

impl ElementKind {
    /// Values of the shape functions N_i(ξ), one for each node; their sum is 1.
    pub fn shape(self, xi: [f64; 3]) -> Vec<f64> {
        let [s, t, _] = xi;
        match self {
            Self::Point1 => vec![1.0],
            Self::Line2 => vec![0.5 * (1.0 - s), 0.5 * (1.0 + s)],
            Self::Line3 => ENDS_AND_MIDDLE.map(|a| lagrange(a, s)).to_vec(),
            Self::Triangle3 => vec![1.0 - s - t, s, t],
            Self::Triangle6 => {
                let r = 1.0 - s - t;
                vec![
                    r * (2.0 * r - 1.0),
                    s * (2.0 * s - 1.0),
                    t * (2.0 * t - 1.0),
                    4.0 * r * s,
                    4.0 * s * t,
                    4.0 * t * r,
                ]
            }
            Self::Quad4 => self
                .signs()
                .map(|[a, b]| 0.25 * (1.0 + a * s) * (1.0 + b * t))
                .collect(),
            Self::Quad8 => self.signs().map(|at| serendipity(at, [s, t])).collect(),
            Self::Quad9 => self
                .signs()
                .map(|[a, b]| lagrange(a, s) * lagrange(b, t))
                .collect(),
        }
    }

    /// Gradients ∂N_i/∂ξ_j of the shape functions, one for each node; components beyond the
    /// element's dimension are zero.
    pub fn gradients(self, xi: [f64; 3]) -> Vec<[f64; 3]> {
        let [s, t, _] = xi;
        match self {
            Self::Point1 => vec![[0.0; 3]],
            Self::Line2 => vec![[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]],
            Self::Line3 => ENDS_AND_MIDDLE
                .map(|a| [lagrange_slope(a, s), 0.0, 0.0])
                .to_vec(),
            Self::Triangle3 => vec![[-1.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            Self::Triangle6 => {
                let r = 1.0 - s - t;
                vec![
                    [1.0 - 4.0 * r, 1.0 - 4.0 * r, 0.0],
                    [4.0 * s - 1.0, 0.0, 0.0],
                    [0.0, 4.0 * t - 1.0, 0.0],
                    [4.0 * (r - s), -4.0 * s, 0.0],
                    [4.0 * t, 4.0 * s, 0.0],
                    [-4.0 * t, 4.0 * (r - t), 0.0],
                ]
            }
            Self::Quad4 => self
                .signs()
                .map(|[a, b]| [0.25 * a * (1.0 + b * t), 0.25 * b * (1.0 + a * s), 0.0])
                .collect(),
            Self::Quad8 => self
                .signs()
                .map(|at| serendipity_gradient(at, [s, t]))
                .collect(),
            Self::Quad9 => self
                .signs()
                .map(|[a, b]| {
                    [
                        lagrange_slope(a, s) * lagrange(b, t),
                        lagrange(a, s) * lagrange_slope(b, t),
                        0.0,
                    ]
                })
                .collect(),
        }
    }

    /// Reference coordinates of the nodes.
    pub fn node_coordinates(self) -> &'static [[f64; 3]] {
        const LINE: &[[f64; 3]] = &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
        const TRIANGLE: &[[f64; 3]] = &[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.5, 0.0, 0.0],
            [0.5, 0.5, 0.0],
            [0.0, 0.5, 0.0],
        ];
        const QUADRILATERAL: &[[f64; 3]] = &[
            [-1.0, -1.0, 0.0],
            [1.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
        ];
        let all = match self {
            Self::Point1 => &[[0.0; 3]],
            Self::Line2 | Self::Line3 => LINE,
            Self::Triangle3 | Self::Triangle6 => TRIANGLE,
            Self::Quad4 | Self::Quad8 | Self::Quad9 => QUADRILATERAL,
        };
        &all[..self.nodes()]
    }

    /// The coordinates −1, 0, 1 of the nodes of a quadrilateral.
    fn signs(self) -> impl Iterator<Item = [f64; 2]> {
        self.node_coordinates().iter().map(|&[a, b, _]| [a, b])
    }
}

const ENDS_AND_MIDDLE: [f64; 3] = [-1.0, 1.0, 0.0];

/// The quadratic that is 1 at `a` and 0 at the others of −1, 0, 1.
fn lagrange(a: f64, x: f64) -> f64 {
    match a == 0.0 {
        true => (1.0 - x) * (1.0 + x),
        false => 0.5 * x * (x + a),
    }
}

fn lagrange_slope(a: f64, x: f64) -> f64 {
    match a == 0.0 {
        true => -2.0 * x,
        false => x + 0.5 * a,
    }
}

/// The serendipity function of the node at (a, b) of a quadrilateral of eight nodes.
fn serendipity([a, b]: [f64; 2], [s, t]: [f64; 2]) -> f64 {
    match (a == 0.0, b == 0.0) {
        (true, _) => 0.5 * (1.0 - s * s) * (1.0 + b * t),
        (_, true) => 0.5 * (1.0 + a * s) * (1.0 - t * t),
        _ => 0.25 * (1.0 + a * s) * (1.0 + b * t) * (a * s + b * t - 1.0),
    }
}

fn serendipity_gradient([a, b]: [f64; 2], [s, t]: [f64; 2]) -> [f64; 3] {
    match (a == 0.0, b == 0.0) {
        (true, _) => [-s * (1.0 + b * t), 0.5 * b * (1.0 - s * s), 0.0],
        (_, true) => [0.5 * a * (1.0 - t * t), -t * (1.0 + a * s), 0.0],
        _ => [
            0.25 * a * (1.0 + b * t) * (2.0 * a * s + b * t),
            0.25 * b * (1.0 + a * s) * (2.0 * b * t + a * s),
            0.0,
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_function_is_one_at_its_node_and_zero_at_the_others() {
        for kind in ElementKind::ALL {
            for (i, &xi) in kind.node_coordinates().iter().enumerate() {
                for (j, value) in kind.shape(xi).into_iter().enumerate() {
                    assert_eq!(value, if i == j { 1.0 } else { 0.0 }, "{kind:?}");
                }
            }
        }
    }

    #[test]
    fn shape_functions_reproduce_the_polynomials_that_their_kind_has() {
        use ElementKind::*;
        let linear: &[[i32; 2]] = &[[0, 0], [1, 0], [0, 1]];
        let quadratic: &[[i32; 2]] = &[[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2]];
        let more: &[[i32; 2]] = &[[2, 1], [1, 2]];
        let cases = [
            (Triangle3, linear.to_vec()),
            (Triangle6, quadratic.to_vec()),
            (Quad4, [linear, &[[1, 1]]].concat()),
            (Quad8, [quadratic, more].concat()),
            (Quad9, [quadratic, more, &[[2, 2]]].concat()),
        ];
        for (kind, powers) in cases {
            for [p, q] in powers {
                let monomial = |xi: [f64; 3]| xi[0].powi(p) * xi[1].powi(q);
                let at = [0.3, -0.45, 0.0];
                let values = kind.shape(at).into_iter().zip(kind.node_coordinates());
                let sum: f64 = values.map(|(n, &node)| n * monomial(node)).sum();
                assert!((sum - monomial(at)).abs() < 1e-15, "{kind:?} {p} {q}");
            }
        }
    }

    #[test]
    fn gradients_are_the_difference_quotients_of_the_shape_functions() {
        let (xi, step) = ([0.2, 0.3, 0.0], 1e-5);
        for kind in ElementKind::ALL {
            let gradients = kind.gradients(xi);
            for axis in 0..kind.dim() {
                let (mut ahead, mut behind) = (xi, xi);
                ahead[axis] += step;
                behind[axis] -= step;
                let (ahead, behind) = (kind.shape(ahead), kind.shape(behind));
                for i in 0..kind.nodes() {
                    let quotient = (ahead[i] - behind[i]) / (2.0 * step);
                    assert!((quotient - gradients[i][axis]).abs() < 1e-9, "{kind:?}");
                }
            }
        }
    }

    #[test]
    fn the_nodes_of_a_facet_are_those_of_the_cell_on_it() {
        for kind in ElementKind::ALL.into_iter().filter(|kind| kind.dim() == 2) {
            for (facet, local) in kind.facets() {
                assert_eq!(facet.nodes(), local.len());
                let at: Vec<[f64; 3]> = local.iter().map(|&i| kind.node_coordinates()[i]).collect();
                let xi = [0.37, 0.0, 0.0];
                let on_cell = kind.shape(facet.position(&at, xi));
                for (i, value) in on_cell.into_iter().enumerate() {
                    let place = local.iter().position(|&n| n == i);
                    let on_facet = place.map_or(0.0, |place| facet.shape(xi)[place]);
                    assert!((value - on_facet).abs() < 1e-15, "{kind:?} {i}");
                }
            }
        }
    }
}
