//! Patches: the cells around a vertex, and the polynomial that is nearest to their stresses.
//!
//! Zienkiewicz and Zhu, The superconvergent patch recovery and a posteriori error estimates, part 1,
//! Int. J. Numer. Meth. Eng. 33 (1992).

use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};

/// Components of a stress in the plane: XX, YY, ZZ, XY.
pub const COMPONENTS: usize = 4;
/// Terms of a quadratic polynomial: 1, x, y, x², xy, y².
const TERMS: usize = 6;
/// Terms of a linear one.
const LINEAR: usize = 3;
/// Entries of the lower triangle of the normal equations.
const GRAM: usize = TERMS * (TERMS + 1) / 2;

/// How near to a full turn the angles around a vertex within a body add up (rad).
const FULL_TURN: f64 = 1e-6;
/// Pivot, relative to a unit diagonal, below which samples don't determine a polynomial.
const DETERMINED: f64 = 1e-6;

/// The normal equations of the polynomial around a vertex that is nearest to samples of the stress.
/// Those of several blocks add up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PatchSum {
    /// The rotation by the angles of all cells, cosine and sine; 0 where there are none.
    turn: [f64; 2],
    /// Whether any of its cells is linear, and any quadratic.
    has_linear: bool,
    has_quadratic: bool,
    gram: [f64; GRAM],
    load: [[f64; COMPONENTS]; TERMS],
}

impl PatchSum {
    /// Adds a cell with an angle at the vertex, given by its cosine and sine.
    pub fn add_cell(&mut self, turn: [f64; 2], is_quadratic: bool) {
        self.add_turn(turn);
        self.has_linear |= !is_quadratic;
        self.has_quadratic |= is_quadratic;
    }

    /// Adds the stress (Pa) at a point, given from the vertex on (m).
    pub fn add_sample(&mut self, at: [f64; 2], stress: [f64; COMPONENTS]) {
        match self.has_quadratic {
            true => self.add_terms::<TERMS>(at, stress),
            false => self.add_terms::<LINEAR>(at, stress),
        }
    }

    fn add_terms<const N: usize>(&mut self, at: [f64; 2], stress: [f64; COMPONENTS]) {
        let terms = monomials(at);
        let mut entry = 0;
        for i in 0..N {
            for b in &terms[..=i] {
                self.gram[entry] += terms[i] * b;
                entry += 1;
            }
            for (sum, s) in self.load[i].iter_mut().zip(stress) {
                *sum += terms[i] * s;
            }
        }
    }

    /// Rotations take no arctangent.
    fn add_turn(&mut self, [cos, sin]: [f64; 2]) {
        self.turn = match (self.is_empty(), self.turn) {
            (true, _) => [cos, sin],
            (false, [c, s]) => [c * cos - s * sin, c * sin + s * cos],
        };
    }

    /// Whether cells surround the vertex.
    pub fn is_inner(&self) -> bool {
        self.turn[0] > 0.0 && self.turn[1].abs() < FULL_TURN
    }

    /// Whether there are any cells.
    pub fn is_empty(&self) -> bool {
        self.turn == [0.0; 2]
    }

    /// The polynomial: quadratic where all cells are, else linear; where the samples
    /// don't determine it, or lie on one side of the vertex only, one of lower degree.
    pub fn fit(&self) -> Polynomial {
        let quadratic = match self.has_quadratic && !self.has_linear && self.is_inner() {
            true => self.solve::<TERMS>(),
            false => None,
        };
        // A quadratic cell alone has a linear stress; three linear ones have no better than a mean.
        let enough = LINEAR as f64 + if self.has_linear { 1.0 } else { 0.0 };
        let is_enough = self.is_inner() || self.gram[0] >= enough;
        let linear = || match is_enough {
            true => self.solve::<LINEAR>(),
            false => None,
        };
        let best = quadratic.or_else(linear).or_else(|| self.solve::<1>());
        best.unwrap_or_default()
    }

    fn solve<const N: usize>(&self) -> Option<Polynomial> {
        let mut gram = SMatrix::<f64, N, N>::zeros();
        let mut entry = 0;
        for i in 0..N {
            for j in 0..=i {
                gram[(i, j)] = self.gram[entry];
                gram[(j, i)] = self.gram[entry];
                entry += 1;
            }
        }
        // A unit diagonal: lengths drop out.
        let scale: [f64; N] = std::array::from_fn(|i| gram[(i, i)].sqrt().recip());
        for i in 0..N {
            for j in 0..N {
                gram[(i, j)] *= scale[i] * scale[j];
            }
        }
        let load = SMatrix::<f64, N, COMPONENTS>::from_fn(|i, c| scale[i] * self.load[i][c]);
        let factor = gram.cholesky()?;
        let is_determined = |i: usize| factor.l_dirty()[(i, i)].powi(2) > DETERMINED;
        if !(0..N).all(is_determined) {
            return None;
        }
        let solution = factor.solve(&load);
        let mut polynomial = Polynomial::default();
        for (i, coefficients) in polynomial.coefficients[..N].iter_mut().enumerate() {
            for (c, coefficient) in coefficients.iter_mut().enumerate() {
                *coefficient = scale[i] * solution[(i, c)];
            }
        }
        Some(polynomial)
    }

    /// Adds what another block has of the patch.
    pub fn add(&mut self, other: &Self) {
        if !other.is_empty() {
            self.add_turn(other.turn);
        }
        self.has_linear |= other.has_linear;
        self.has_quadratic |= other.has_quadratic;
        for (a, b) in self.gram.iter_mut().zip(&other.gram) {
            *a += b;
        }
        let others = other.load.as_flattened();
        for (a, b) in self.load.as_flattened_mut().iter_mut().zip(others) {
            *a += b;
        }
    }
}

/// A stress that varies as a polynomial of the place, seen from a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Polynomial {
    coefficients: [[f64; COMPONENTS]; TERMS],
}

impl Polynomial {
    /// Its value at a point, given from the vertex on (m).
    pub fn at(&self, at: [f64; 2]) -> [f64; COMPONENTS] {
        let mut value = [0.0; COMPONENTS];
        for (term, coefficients) in monomials(at).iter().zip(&self.coefficients) {
            for (v, c) in value.iter_mut().zip(coefficients) {
                *v += term * c;
            }
        }
        value
    }

    /// The same polynomial as it is seen from a point.
    #[must_use]
    pub fn seen_from(&self, [x, y]: [f64; 2]) -> Self {
        let c = &self.coefficients;
        let of = |factors: [f64; TERMS]| {
            std::array::from_fn(|k| factors.iter().zip(c).map(|(f, c)| f * c[k]).sum())
        };
        Self {
            coefficients: [
                self.at([x, y]),
                of([0.0, 1.0, 0.0, 2.0 * x, y, 0.0]),
                of([0.0, 0.0, 1.0, 0.0, x, 2.0 * y]),
                c[3],
                c[4],
                c[5],
            ],
        }
    }

    /// Adds a multiple of another one that is seen from the same point.
    pub fn add(&mut self, factor: f64, other: &Self) {
        let others = other.coefficients.as_flattened();
        for (a, b) in self.coefficients.as_flattened_mut().iter_mut().zip(others) {
            *a += factor * b;
        }
    }
}

/// Polynomials around nodes, in as little memory as they need: there is one for every vertex of a
/// mesh.
#[derive(Clone, Debug)]
pub struct Polynomials {
    width: usize,
    values: Vec<f64>,
}

impl Polynomials {
    /// Zeros for `count` nodes, of linear polynomials alone or of quadratic ones too.
    pub fn zeros(count: usize, are_linear: bool) -> Self {
        let width = COMPONENTS * if are_linear { LINEAR } else { TERMS };
        Self {
            width,
            values: vec![0.0; width * count],
        }
    }

    /// That of a node.
    pub fn get(&self, node: usize) -> Polynomial {
        let mut polynomial = Polynomial::default();
        let coefficients = polynomial.coefficients.as_flattened_mut();
        coefficients[..self.width].copy_from_slice(&self.values[self.width * node..][..self.width]);
        polynomial
    }

    /// Sets that of a node; of a quadratic one, among linear ones, its linear terms.
    pub fn set(&mut self, node: usize, polynomial: &Polynomial) {
        let values = &mut self.values[self.width * node..][..self.width];
        values.copy_from_slice(&polynomial.coefficients.as_flattened()[..self.width]);
    }
}

fn monomials([x, y]: [f64; 2]) -> [f64; TERMS] {
    [1.0, x, y, x * x, x * y, y * y]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field([x, y]: [f64; 2], degree: usize) -> [f64; COMPONENTS] {
        let quadratic = if degree > 1 { 1.0 } else { 0.0 };
        [1.0, -2.0, 0.5, 3.0]
            .map(|c| c + 2.0 * x - c * y + quadratic * (x * x - 0.3 * x * y + c * y * y))
    }

    fn patch(degree: usize, points: &[[f64; 2]]) -> PatchSum {
        let mut sum = PatchSum::default();
        sum.add_cell([1.0, 0.0], degree > 1);
        for &at in points {
            sum.add_sample(at, field(at, degree));
        }
        sum
    }

    const POINTS: [[f64; 2]; 7] = [
        [1e-3, 2e-3],
        [-2e-3, 1e-3],
        [0.5e-3, -1e-3],
        [2e-3, -1.5e-3],
        [-1e-3, -2e-3],
        [1.5e-3, 1.7e-3],
        [-0.2e-3, 2.2e-3],
    ];

    fn is_near(a: [f64; COMPONENTS], b: [f64; COMPONENTS]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-11)
    }

    #[test]
    fn a_polynomial_is_found_from_its_values() {
        for degree in [1, 2] {
            let polynomial = patch(degree, &POINTS).fit();
            for at in [[0.0, 0.0], [1e-3, -1e-3]] {
                assert!(is_near(polynomial.at(at), field(at, degree)));
            }
        }
    }

    #[test]
    fn too_few_samples_have_a_polynomial_of_lower_degree() {
        let linear = patch(2, &POINTS[..5]).fit();
        assert_eq!(linear.coefficients[3], [0.0; COMPONENTS]);
        let mean = patch(1, &POINTS[..2]).fit();
        assert_eq!(mean.coefficients[1], [0.0; COMPONENTS]);
        let [a, b] = [POINTS[0], POINTS[1]].map(|at| field(at, 1));
        assert!(is_near(
            mean.at([1.0, 1.0]),
            std::array::from_fn(|c| 0.5 * (a[c] + b[c]))
        ));
        let on_a_line = patch(1, &[[1.0, 1.0], [2.0, 2.0], [-1.0, -1.0], [3.0, 3.0]]).fit();
        assert_eq!(on_a_line.coefficients[1], [0.0; COMPONENTS]);
    }

    #[test]
    fn a_polynomial_is_the_same_from_anywhere() {
        let polynomial = patch(2, &POINTS).fit();
        let moved = polynomial.seen_from([1e-3, 2e-3]);
        assert!(is_near(
            moved.at([3e-3, -1e-3]),
            polynomial.at([4e-3, 1e-3])
        ));
    }

    #[test]
    fn parts_of_a_patch_add_up_whatever_their_degree() {
        for degree in [1, 2] {
            let whole = patch(degree, &POINTS);
            let mut parts = patch(degree, &POINTS[..3]);
            parts.add(&patch(degree, &POINTS[3..]));
            assert!(parts.is_inner());
            let [a, b] = [whole.fit(), parts.fit()].map(|p| p.at([1e-3, 1e-3]));
            assert!(is_near(a, b));
        }
    }
}
