//! Patches: the cells around a vertex, and the least-squares polynomial of their stresses.
//!
//! Zienkiewicz and Zhu, The superconvergent patch recovery and a posteriori error estimates, part 1,
//! Int. J. Numer. Meth. Eng. 33 (1992).

use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};

use super::polynomial::{NodalStress, Polynomial, TERMS, components, monomials, terms};
use crate::vector::axpy;

/// Entries of the lower triangle of the normal equations.
const GRAM: usize = TERMS * (TERMS + 1) / 2;

/// Largest deviation from 2π of the sum of angles around an interior vertex (rad).
const FULL_TURN: f64 = 1e-6;
/// Pivot, relative to a unit diagonal, below which samples don't determine a polynomial.
const DETERMINED: f64 = 1e-6;

/// The normal equations of the least-squares polynomial of the stress around a vertex; those of the parts of a patch in
/// several blocks are added.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "Sums", from = "Sums")]
pub struct PatchSum {
    dim: usize,
    /// Cosine and sine of the sum of the cells' angles at the vertex, in space of half their solid angles; both 0
    /// without cells.
    turn: [f64; 2],
    /// True if any of its cells is linear, or any quadratic.
    has_linear: bool,
    has_quadratic: bool,
    gram: [f64; GRAM],
    /// The components of each term, term by term.
    load: [f64; 6 * TERMS],
}

/// The entries of a patch sum in its dimension, without unused ones.
#[derive(Serialize, Deserialize)]
struct Sums {
    dim: usize,
    turn: [f64; 2],
    has_linear: bool,
    has_quadratic: bool,
    sums: Vec<f64>,
}

impl From<PatchSum> for Sums {
    fn from(patch: PatchSum) -> Self {
        let (gram, load) = patch.parts();
        Self {
            dim: patch.dim,
            turn: patch.turn,
            has_linear: patch.has_linear,
            has_quadratic: patch.has_quadratic,
            sums: [&patch.gram[..gram], &patch.load[..load]].concat(),
        }
    }
}

impl From<Sums> for PatchSum {
    fn from(sums: Sums) -> Self {
        let mut patch = Self::empty(sums.dim);
        patch.turn = sums.turn;
        patch.has_linear = sums.has_linear;
        patch.has_quadratic = sums.has_quadratic;
        let (gram, load) = patch.parts();
        let of_load = sums.sums.iter().skip(gram);
        patch.gram[..gram]
            .iter_mut()
            .zip(&sums.sums)
            .for_each(|(a, b)| *a = *b);
        patch.load[..load]
            .iter_mut()
            .zip(of_load)
            .for_each(|(a, b)| *a = *b);
        patch
    }
}

impl PatchSum {
    /// A patch without cells.
    pub fn empty(dim: usize) -> Self {
        Self {
            dim,
            turn: [0.0; 2],
            has_linear: false,
            has_quadratic: false,
            gram: [0.0; GRAM],
            load: [0.0; 6 * TERMS],
        }
    }

    /// Removes all cells, which is faster than creating an empty patch.
    pub fn clear(&mut self) {
        let (gram, load) = self.parts();
        self.gram[..gram].fill(0.0);
        self.load[..load].fill(0.0);
        self.turn = [0.0; 2];
        self.has_linear = false;
        self.has_quadratic = false;
    }

    /// Number of entries of `gram` and `load` in this dimension.
    fn parts(&self) -> (usize, usize) {
        let terms = terms(self.dim);
        (terms * (terms + 1) / 2, terms * components(self.dim))
    }

    /// Adds a cell by cosine and sine of its angle at the vertex, in space of half its solid angle.
    pub fn add_cell(&mut self, turn: [f64; 2], is_quadratic: bool) {
        self.add_turn(turn);
        self.has_linear |= !is_quadratic;
        self.has_quadratic |= is_quadratic;
    }

    /// Adds the stress (Pa) at a point relative to the vertex (m).
    pub fn add_sample(&mut self, at: [f64; 3], stress: &NodalStress) {
        match (self.dim, self.has_quadratic) {
            (2, true) => self.add_terms::<6, 4>(at, stress),
            (2, false) => self.add_terms::<3, 4>(at, stress),
            (_, true) => self.add_terms::<10, 6>(at, stress),
            (_, false) => self.add_terms::<4, 6>(at, stress),
        }
    }

    /// Adds the equations of a point, for N terms and C components.
    fn add_terms<const N: usize, const C: usize>(&mut self, at: [f64; 3], stress: &NodalStress) {
        let terms: [f64; N] = monomials(at, if C == 4 { 2 } else { 3 });
        let mut entry = 0;
        for i in 0..N {
            for b in &terms[..=i] {
                self.gram[entry] += terms[i] * b;
                entry += 1;
            }
            axpy(terms[i], stress, &mut self.load[C * i..C * (i + 1)]);
        }
    }

    /// Adds an angle by rotation, without an arctangent.
    fn add_turn(&mut self, [cos, sin]: [f64; 2]) {
        self.turn = match (self.is_empty(), self.turn) {
            (true, _) => [cos, sin],
            (false, [c, s]) => [c * cos - s * sin, c * sin + s * cos],
        };
    }

    /// True if cells surround the vertex.
    pub fn is_inner(&self) -> bool {
        self.turn[0] > 0.0 && self.turn[1].abs() < FULL_TURN
    }

    /// True if there are any cells.
    pub fn is_empty(&self) -> bool {
        self.turn == [0.0; 2]
    }

    /// The polynomial: quadratic if all cells are, else linear; of lower degree if the samples don't determine it, or
    /// the vertex is at the boundary.
    pub fn fit(&self) -> Polynomial {
        let (linear, quadratic): (Solve, Solve) = match self.dim {
            2 => (Self::solve::<3, 4>, Self::solve::<6, 4>),
            _ => (Self::solve::<4, 6>, Self::solve::<10, 6>),
        };
        let constant: Solve = match self.dim {
            2 => Self::solve::<1, 4>,
            _ => Self::solve::<1, 6>,
        };
        let quadratic = match self.has_quadratic && !self.has_linear && self.is_inner() {
            true => quadratic(self),
            false => None,
        };
        // A single quadratic cell gives a linear stress; as many linear cells as there are terms give no better fit
        // than their mean.
        let enough = (self.dim + 1) as f64 + if self.has_linear { 1.0 } else { 0.0 };
        let is_enough = self.is_inner() || self.gram[0] >= enough;
        let linear = || match is_enough {
            true => linear(self),
            false => None,
        };
        let best = quadratic.or_else(linear).or_else(|| constant(self));
        best.unwrap_or_else(|| Polynomial::zero(self.dim))
    }

    fn solve<const N: usize, const C: usize>(&self) -> Option<Polynomial> {
        let mut gram = SMatrix::<f64, N, N>::zeros();
        let mut entry = 0;
        for i in 0..N {
            for j in 0..=i {
                gram[(i, j)] = self.gram[entry];
                gram[(j, i)] = self.gram[entry];
                entry += 1;
            }
        }
        // Scaling to a unit diagonal removes the length scale.
        let scale: [f64; N] = std::array::from_fn(|i| gram[(i, i)].sqrt().recip());
        for i in 0..N {
            for j in 0..N {
                gram[(i, j)] *= scale[i] * scale[j];
            }
        }
        let load = SMatrix::<f64, N, C>::from_fn(|i, c| scale[i] * self.load[C * i + c]);
        let factor = gram.cholesky()?;
        let is_determined = |i: usize| factor.l_dirty()[(i, i)].powi(2) > DETERMINED;
        if !(0..N).all(is_determined) {
            return None;
        }
        let solution = factor.solve(&load);
        let mut polynomial = Polynomial::zero(self.dim);
        for (i, coefficients) in polynomial
            .coefficients
            .chunks_exact_mut(C)
            .take(N)
            .enumerate()
        {
            for (c, coefficient) in coefficients.iter_mut().enumerate() {
                *coefficient = scale[i] * solution[(i, c)];
            }
        }
        Some(polynomial)
    }

    /// Adds the part of the patch in another block.
    pub fn add(&mut self, other: &Self) {
        if !other.is_empty() {
            self.add_turn(other.turn);
        }
        self.has_linear |= other.has_linear;
        self.has_quadratic |= other.has_quadratic;
        let (gram, load) = self.parts();
        axpy(1.0, &other.gram[..gram], &mut self.gram);
        axpy(1.0, &other.load[..load], &mut self.load);
    }
}

/// Solution of the normal equations for a polynomial of some degree.
type Solve = fn(&PatchSum) -> Option<Polynomial>;

#[cfg(test)]
mod tests {
    use super::*;

    fn field([x, y, z]: [f64; 3], dim: usize, degree: usize) -> NodalStress {
        let quadratic = if degree > 1 { 1.0 } else { 0.0 };
        let mut stress = [1.0, -2.0, 0.5, 3.0, -1.5, 2.5].map(|c| {
            c + 2.0 * x - c * y
                + 1.5 * z
                + quadratic * (x * x - 0.3 * x * y + c * y * y + 0.4 * x * z - c * y * z + z * z)
        });
        stress[components(dim)..].fill(0.0);
        stress
    }

    fn patch(dim: usize, degree: usize, points: &[[f64; 3]]) -> PatchSum {
        let mut sum = PatchSum::empty(dim);
        sum.add_cell([1.0, 0.0], degree > 1);
        for &at in points {
            sum.add_sample(at, &field(at, dim, degree));
        }
        sum
    }

    const POINTS: [[f64; 2]; 12] = [
        [1e-3, 2e-3],
        [-2e-3, 1e-3],
        [0.5e-3, -1e-3],
        [2e-3, -1.5e-3],
        [-1e-3, -2e-3],
        [1.5e-3, 1.7e-3],
        [-0.2e-3, 2.2e-3],
        [1.1e-3, 0.3e-3],
        [-0.7e-3, -0.4e-3],
        [0.1e-3, 0.9e-3],
        [0.6e-3, -2.1e-3],
        [-1.8e-3, 1.9e-3],
    ];

    fn points(dim: usize) -> Vec<[f64; 3]> {
        let height = |i: usize| {
            if dim == 2 {
                0.0
            } else {
                1e-3 * (2.3 * i as f64).sin()
            }
        };
        let count = if dim == 2 { 7 } else { 12 };
        let plane = POINTS[..count].iter().enumerate();
        plane.map(|(i, &[x, y])| [x, y, height(i)]).collect()
    }

    /// A point of a plane, which is inclined in space.
    fn above(dim: usize, x: f64, y: f64) -> [f64; 3] {
        [x, y, if dim == 2 { 0.0 } else { 0.4 * x - 0.7 * y }]
    }

    fn is_near(a: NodalStress, b: NodalStress) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-11)
    }

    #[test]
    fn a_polynomial_is_found_from_its_values() {
        for (dim, degree) in [(2, 1), (2, 2), (3, 1), (3, 2)] {
            let polynomial = patch(dim, degree, &points(dim)).fit();
            for at in [[0.0; 3], above(dim, 1e-3, -1e-3)] {
                assert!(
                    is_near(polynomial.at(at), field(at, dim, degree)),
                    "{dim} {degree}"
                );
            }
        }
    }

    #[test]
    fn too_few_samples_have_a_polynomial_of_lower_degree() {
        for dim in [2, 3] {
            let points = points(dim);
            let linear = patch(dim, 2, &points[..terms(dim) - 1]).fit();
            assert!(linear.rows().skip(dim + 1).flatten().all(|&c| c == 0.0));
            let mean = patch(dim, 1, &points[..2]).fit();
            assert!(mean.rows().skip(1).flatten().all(|&c| c == 0.0));
            let [a, b] = [points[0], points[1]].map(|at| field(at, dim, 1));
            let half = std::array::from_fn(|c| 0.5 * (a[c] + b[c]));
            assert!(is_near(mean.at(above(dim, 1.0, 1.0)), half));
            let on_a_line: Vec<[f64; 3]> = [1.0, 2.0, -1.0, 3.0, 4.0]
                .iter()
                .map(|&s| above(dim, s, s))
                .collect();
            let on_a_line = patch(dim, 1, &on_a_line).fit();
            assert!(on_a_line.rows().skip(1).flatten().all(|&c| c == 0.0));
        }
    }

    #[test]
    fn a_polynomial_is_the_same_from_anywhere() {
        for dim in [2, 3] {
            let polynomial = patch(dim, 2, &points(dim)).fit();
            let moved = polynomial.seen_from(above(dim, 1e-3, 2e-3));
            let [a, b] = [(3e-3, -1e-3), (4e-3, 1e-3)].map(|(x, y)| above(dim, x, y));
            assert!(is_near(moved.at(a), polynomial.at(b)));
        }
    }

    #[test]
    fn parts_of_a_patch_add_up_whatever_their_degree() {
        for (dim, degree) in [(2, 1), (2, 2), (3, 1), (3, 2)] {
            let points = points(dim);
            let whole = patch(dim, degree, &points);
            let mut parts = patch(dim, degree, &points[..3]);
            parts.add(&patch(dim, degree, &points[3..]));
            assert!(parts.is_inner());
            let [a, b] = [whole.fit(), parts.fit()].map(|p| p.at(above(dim, 1e-3, 1e-3)));
            assert!(is_near(a, b));
            let sent = PatchSum::from(Sums::from(parts));
            assert_eq!(sent, parts);
        }
    }
}
