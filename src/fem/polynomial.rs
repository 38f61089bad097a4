//! Stresses that are polynomials of the position.

use crate::vector::axpy;
use serde::{Deserialize, Serialize};

/// A stress at a node: XX, YY, ZZ, XY, YZ, XZ; in the plane the last two are 0.
pub type NodalStress = [f64; 6];

/// Terms of a quadratic polynomial in space: 1, x, y, z, x², xy, y², xz, yz, z².
pub(super) const TERMS: usize = 10;

/// Components of a stress in `dim` dimensions: XX, YY, ZZ, XY in the plane.
pub(super) const fn components(dim: usize) -> usize {
    if dim == 2 { 4 } else { 6 }
}

/// Number of terms of a quadratic polynomial; a linear one has `dim` + 1.
pub(super) const fn terms(dim: usize) -> usize {
    (dim + 1) * (dim + 2) / 2
}

/// A stress that is a polynomial of the position relative to a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "Coefficients", from = "Coefficients")]
pub struct Polynomial {
    dim: usize,
    /// The components of each term, term by term.
    pub(super) coefficients: [f64; 6 * TERMS],
}

/// The coefficients of a polynomial in its dimension, without unused ones.
#[derive(Serialize, Deserialize)]
struct Coefficients {
    dim: usize,
    coefficients: Vec<f64>,
}

impl From<Polynomial> for Coefficients {
    fn from(polynomial: Polynomial) -> Self {
        let dim = polynomial.dim;
        Self {
            dim,
            coefficients: polynomial.coefficients[..components(dim) * terms(dim)].to_vec(),
        }
    }
}

impl From<Coefficients> for Polynomial {
    fn from(message: Coefficients) -> Self {
        let mut polynomial = Self::zero(message.dim);
        let coefficients = polynomial.coefficients.iter_mut();
        coefficients
            .zip(message.coefficients)
            .for_each(|(a, b)| *a = b);
        polynomial
    }
}

impl Polynomial {
    /// The polynomial that is 0 everywhere.
    pub fn zero(dim: usize) -> Self {
        Self {
            dim,
            coefficients: [0.0; 6 * TERMS],
        }
    }

    /// The coefficients of its terms.
    pub(super) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        let rows = self.coefficients.chunks_exact(components(self.dim));
        rows.take(terms(self.dim))
    }

    /// Value at a point relative to the vertex (m).
    pub fn at(&self, at: [f64; 3]) -> NodalStress {
        let mut value = [0.0; 6];
        let monomials: [f64; TERMS] = monomials(at, self.dim);
        for (term, coefficients) in monomials.iter().zip(self.rows()) {
            axpy(*term, coefficients, &mut value);
        }
        value
    }

    /// The same polynomial, expressed relative to the point `at`.
    #[must_use]
    pub fn seen_from(&self, at: [f64; 3]) -> Self {
        let mut seen = *self;
        let width = components(self.dim);
        seen.coefficients[..width].copy_from_slice(&self.at(at)[..width]);
        for axis in 0..self.dim {
            let factors = slopes(at, self.dim, axis);
            let linear = &mut seen.coefficients[(axis + 1) * width..][..width];
            for (k, sum) in linear.iter_mut().enumerate() {
                *sum = factors.iter().zip(self.rows()).map(|(f, c)| f * c[k]).sum();
            }
        }
        seen
    }

    /// Adds a multiple of another polynomial, expressed relative to the same point.
    pub fn add(&mut self, factor: f64, other: &Self) {
        let others = &other.coefficients[..components(self.dim) * terms(self.dim)];
        axpy(factor, others, &mut self.coefficients);
    }
}

/// Polynomials of nodes in compact storage, as there is one for every vertex of a mesh.
#[derive(Clone, Debug)]
pub struct Polynomials {
    dim: usize,
    width: usize,
    values: Vec<f64>,
}

impl Polynomials {
    /// Zeros for `count` nodes, for linear polynomials only or for quadratic ones, too.
    pub fn zeros(dim: usize, count: usize, are_linear: bool) -> Self {
        let width = components(dim) * if are_linear { dim + 1 } else { terms(dim) };
        Self {
            dim,
            width,
            values: vec![0.0; width * count],
        }
    }

    /// The polynomial of a node.
    pub fn get(&self, node: usize) -> Polynomial {
        let mut polynomial = Polynomial::zero(self.dim);
        let coefficients = &mut polynomial.coefficients[..self.width];
        coefficients.copy_from_slice(&self.values[self.width * node..][..self.width]);
        polynomial
    }

    /// Sets the polynomial of a node; in storage for linear ones, only the linear terms of a quadratic polynomial.
    pub fn set(&mut self, node: usize, polynomial: &Polynomial) {
        let values = &mut self.values[self.width * node..][..self.width];
        values.copy_from_slice(&polynomial.coefficients[..self.width]);
    }
}

/// The first N monomials: 1, the coordinates, their products.
pub(super) fn monomials<const N: usize>(at: [f64; 3], dim: usize) -> [f64; N] {
    let mut terms = [0.0; N];
    terms[0] = 1.0;
    terms
        .iter_mut()
        .skip(1)
        .zip(&at[..dim])
        .for_each(|(term, x)| *term = *x);
    let products = (0..dim).flat_map(|i| (0..=i).map(move |j| (j, i)));
    let quadratic = terms.iter_mut().skip(dim + 1);
    quadratic
        .zip(products)
        .for_each(|(term, (j, i))| *term = at[j] * at[i]);
    terms
}

/// Derivatives of the monomials along an axis.
fn slopes(at: [f64; 3], dim: usize, axis: usize) -> [f64; TERMS] {
    let mut slopes = [0.0; TERMS];
    slopes[axis + 1] = 1.0;
    let products = (0..dim).flat_map(|i| (0..=i).map(move |j| [j, i]));
    for (slope, pair) in slopes.iter_mut().skip(dim + 1).zip(products) {
        *slope = match pair.map(|k| k == axis) {
            [true, true] => 2.0 * at[axis],
            [true, false] => at[pair[1]],
            [false, true] => at[pair[0]],
            [false, false] => 0.0,
        };
    }
    slopes
}
