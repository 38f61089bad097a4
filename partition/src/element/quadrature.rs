//! ∫ f dξ ≈ Σ w_q f(ξ_q): quadrature rules on the reference elements.

use std::f64::consts::PI;

use super::definition::Domain;
use super::reference::ReferenceElement;
pub use super::tables::TabulatedPoint;

/// Reference coordinates and weights of a rule, ∫ f dξ ≈ Σ w_q f(ξ_q). All weights are positive; their sum
/// is the measure of the reference element.
pub type Quadrature = Vec<([f64; 3], f64)>;

impl ReferenceElement {
    /// A rule that is exact for polynomials up to `degree`, on the square and the cube in each direction.
    pub fn quadrature(&self, degree: usize) -> Quadrature {
        // On the line and in each direction of the square and the cube.
        let line = || gauss_legendre(degree / 2 + 1);
        match self.domain() {
            Domain::Point => vec![([0.0; 3], 1.0)],
            Domain::Line => line()
                .into_iter()
                .map(|(x, w)| ([x, 0.0, 0.0], w))
                .collect(),
            Domain::Triangle => triangle(degree),
            Domain::Square => products(&line())
                .map(|(s, t, w)| ([s, t, 0.0], w))
                .collect(),
            Domain::Tetrahedron => tetrahedron(degree),
            Domain::Cube => triple_products(&line()),
        }
    }

    /// The shape functions at the points of the rule of [`quadrature`](Self::quadrature) for
    /// `degree`.
    pub fn tabulate(&self, degree: usize) -> Vec<TabulatedPoint> {
        let points = self.quadrature(degree).into_iter();
        points
            .map(|(xi, weight)| TabulatedPoint {
                xi,
                weight,
                shape: self.shape(xi),
                gradients: self.gradients(xi),
            })
            .collect()
    }
}

/// The symmetric rules of one, three, six and seven points, and products of Gauss-Legendre on the
/// collapsed square for higher degrees.
///
/// Six points: Strang and Fix, An Analysis of the Finite Element Method, table 4.1, in the closed
/// form of Felippa, A compendium of FEM integration formulas, Eng. Comput. 21 (2004); seven:
/// Radon, Zur mechanischen Kubatur, Monatsh. Math. 52 (1948).
fn triangle(degree: usize) -> Quadrature {
    let orbit = |a: f64, weight: f64| {
        let b = 1.0 - 2.0 * a;
        [[a, a, 0.0], [b, a, 0.0], [a, b, 0.0]].map(|point| (point, weight))
    };
    let middle = |weight: f64| ([1.0 / 3.0, 1.0 / 3.0, 0.0], weight);
    match degree {
        0 | 1 => vec![middle(0.5)],
        2 => orbit(1.0 / 6.0, 1.0 / 6.0).to_vec(),
        3 | 4 => {
            let root = 10_f64.sqrt();
            let place = (38.0 - 44.0 * 0.4_f64.sqrt()).sqrt();
            let weight = (213_125.0 - 53_320.0 * root).sqrt();
            let first = orbit((8.0 - root + place) / 18.0, (620.0 + weight) / 7440.0);
            let second = orbit((8.0 - root - place) / 18.0, (620.0 - weight) / 7440.0);
            [first, second].concat()
        }
        5 => {
            let root = 15_f64.sqrt();
            let first = orbit((6.0 - root) / 21.0, (155.0 - root) / 2400.0);
            let second = orbit((6.0 + root) / 21.0, (155.0 + root) / 2400.0);
            [&first[..], &second, &[middle(9.0 / 80.0)]].concat()
        }
        _ => {
            // The Jacobian of the collapse raises the degree in one direction by one.
            let line = gauss_legendre(degree.div_ceil(2) + 1);
            let collapsed = products(&line).map(|(s, t, weight)| {
                let (s, t) = (0.5 * (1.0 + s), 0.5 * (1.0 + t));
                ([s, t * (1.0 - s), 0.0], 0.25 * weight * (1.0 - s))
            });
            collapsed.collect()
        }
    }
}

/// The symmetric rules of one, four, eight and fourteen points, and products of Gauss-Legendre on the
/// collapsed cube for higher degrees.
///
/// Eight points: in the closed form of Felippa, as for the triangle; fourteen: Walkington, Quadrature on
/// simplices of arbitrary dimension (2000).
fn tetrahedron(degree: usize) -> Quadrature {
    let orbit = |a: f64, weight: f64| {
        let b = 1.0 - 3.0 * a;
        [[a, a, a], [b, a, a], [a, b, a], [a, a, b]].map(|point| (point, weight))
    };
    match degree {
        0 | 1 => vec![([0.25; 3], 1.0 / 6.0)],
        2 => orbit((5.0 - 5_f64.sqrt()) / 20.0, 1.0 / 24.0).to_vec(),
        3 => {
            let root = 17_f64.sqrt();
            let place = (1022.0 - 134.0 * root).sqrt();
            let weight = ((1_715_161_837.0 - 406_006_699.0 * root) / 23_101.0).sqrt() / 3120.0;
            let first = orbit((55.0 - 3.0 * root + place) / 196.0, (0.125 + weight) / 6.0);
            let second = orbit((55.0 - 3.0 * root - place) / 196.0, (0.125 - weight) / 6.0);
            [first, second].concat()
        }
        4 | 5 => {
            let (a, weight) = (0.045_503_704_125_649_65, 0.007_091_003_462_846_911);
            let b = 0.5 - a;
            let edges = [
                [a, a, b],
                [a, b, a],
                [b, a, a],
                [a, b, b],
                [b, a, b],
                [b, b, a],
            ];
            let first = orbit(0.310_885_919_263_300_6, 0.018_781_320_953_002_642);
            let second = orbit(0.092_735_250_310_891_23, 0.012_248_840_519_393_658);
            [&first[..], &second, &edges.map(|point| (point, weight))].concat()
        }
        _ => {
            // The Jacobian of the collapse raises the degree in one direction by two.
            let points = triple_products(&gauss_legendre(degree / 2 + 2)).into_iter();
            let collapsed = points.map(|(point, weight)| {
                let at = point.map(|x| 0.5 * (1.0 + x));
                let [s, t, _] = at;
                let weight = 0.125 * weight * (1.0 - s) * (1.0 - s) * (1.0 - t);
                (Domain::Tetrahedron.of_unit_cube(at), weight)
            });
            collapsed.collect()
        }
    }
}

/// The tensor product of a rule on the line in three directions.
fn triple_products(line: &[(f64, f64)]) -> Quadrature {
    let pairs = products(line);
    pairs
        .flat_map(|(s, t, weight)| line.iter().map(move |&(r, w)| ([s, t, r], weight * w)))
        .collect()
}

/// The tensor product of a rule on the line in two directions.
fn products(line: &[(f64, f64)]) -> impl Iterator<Item = (f64, f64, f64)> {
    let with =
        |&(s, weight): &(f64, f64)| line.iter().map(move |&(t, other)| (s, t, weight * other));
    line.iter().flat_map(with)
}

/// Points and weights of Gauss-Legendre quadrature on [−1, 1], exact to degree 2·`count` − 1: the roots of the Legendre
/// polynomial by Newton's method.
fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let mut points = vec![(0.0, 0.0); count];
    for i in 0..count.div_ceil(2) {
        let mut x = (PI * (i as f64 + 0.75) / (count as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=count {
                let k = k as f64;
                (before, value) = (
                    value,
                    ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k,
                );
            }
            slope = count as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        if 2 * i + 1 == count {
            x = 0.0;
        }
        let weight = 2.0 / ((1.0 - x * x) * slope * slope);
        (points[i], points[count - 1 - i]) = ((-x, weight), (x, weight));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::super::ElementKind::{Hexahedron8, Line2, Quad9, Tetrahedron4, Triangle3};
    use super::*;

    fn factorial(n: usize) -> f64 {
        (1..=n).map(|i| i as f64).product()
    }

    /// ∫ x^p y^q z^r over a reference element.
    fn exact(domain: Domain, powers: [usize; 3]) -> f64 {
        let on_line = |p: usize| match p.is_multiple_of(2) {
            true => 2.0 / (p as f64 + 1.0),
            false => 0.0,
        };
        let [p, q, r] = powers;
        match domain {
            Domain::Point => 1.0,
            Domain::Line => on_line(p),
            Domain::Triangle => factorial(p) * factorial(q) / factorial(p + q + 2),
            Domain::Square => on_line(p) * on_line(q),
            Domain::Tetrahedron => {
                powers.map(factorial).iter().product::<f64>() / factorial(p + q + r + 3)
            }
            Domain::Cube => powers.map(on_line).iter().product(),
        }
    }

    #[test]
    fn rules_are_exact_to_their_degree() {
        for (kind, most, tolerance) in [
            (Line2, 12, 1e-14),
            (Triangle3, 9, 1e-15),
            (Quad9, 9, 1e-14),
            (Tetrahedron4, 9, 1e-15),
            (Hexahedron8, 7, 3e-14),
        ] {
            for degree in 0..=most {
                let rule = kind.quadrature(degree);
                assert!(rule.iter().all(|&(_, w)| w > 0.0));
                let is_simplex = matches!(kind.domain(), Domain::Triangle | Domain::Tetrahedron);
                let all = (0..(degree + 1).pow(kind.dim() as u32)).map(|i| {
                    let each = degree + 1;
                    [i % each, i / each % each, i / (each * each)]
                });
                for powers in
                    all.filter(|powers| !is_simplex || powers.iter().sum::<usize>() <= degree)
                {
                    let value = |x: &[f64; 3]| -> f64 {
                        x.iter()
                            .zip(powers)
                            .map(|(x, p)| x.powi(p as i32))
                            .product()
                    };
                    let sum: f64 = rule.iter().map(|(x, w)| w * value(x)).sum();
                    let error = (sum - exact(kind.domain(), powers)).abs();
                    assert!(
                        error < tolerance,
                        "{kind:?}, degree {degree}, {powers:?}: {error:e}"
                    );
                }
            }
        }
    }
}
