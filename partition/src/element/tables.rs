//! Tables of a reference element: shape functions at quadrature points, gradients at the sampling points of the
//! Jacobian.

use nalgebra::DMatrix;

use super::definition::{Definition, Domain};

/// Shape functions of a reference element at a quadrature point.
#[derive(Clone, Debug, PartialEq)]
pub struct TabulatedPoint {
    /// Reference coordinates.
    pub xi: [f64; 3],
    /// Weight of the point.
    pub weight: f64,
    /// N_i.
    pub shape: Vec<f64>,
    /// ∂N_i/∂ξ_j.
    pub gradients: Vec<[f64; 3]>,
}

/// Sampling points of the Jacobian, which divide each direction of the unit square or cube into as many equal parts as
/// the Jacobian's degree there.
#[derive(Debug)]
pub(super) struct Lattice {
    pub degree: usize,
    /// Gradients of the shape functions at these points, the first direction fastest.
    pub gradients: Vec<Vec<[f64; 3]>>,
    /// The matrix from values at the points of a line to Bernstein coefficients.
    pub to_bernstein: DMatrix<f64>,
}

impl Lattice {
    /// The sampling points for a cell with this definition.
    pub fn new(element: &Definition) -> Self {
        let degree: usize = match (element.domain, element.is_linear()) {
            (Domain::Cube, true) => 2,
            (Domain::Cube, false) => 5,
            _ => 3,
        };
        let count = degree + 1;
        let share = |i: usize| i as f64 / degree as f64;
        let places = (0..count.pow(element.domain.dim() as u32))
            .map(|i| [i % count, i / count % count, i / (count * count)].map(share));
        let binomial =
            |k: usize| (0..k).fold(1.0_f64, |b, j| b * (degree - j) as f64 / (j + 1) as f64);
        let bernstein = DMatrix::from_fn(count, count, |i, k| {
            let x = share(i);
            binomial(k) * x.powi(k as i32) * (1.0 - x).powi((degree - k) as i32)
        });
        Self {
            degree,
            gradients: places
                .map(|place| (element.gradients)(element.domain.of_unit_cube(place)))
                .collect(),
            to_bernstein: bernstein.try_inverse().unwrap_or_default(),
        }
    }
}
