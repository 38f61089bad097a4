//! The error estimator of Zienkiewicz and Zhu: the error of the stress σ_h is approximately its difference from the
//! recovered stress σ*.
//!
//! > ‖e‖² ≈ ∫ (σ* − σ_h)ᵀ C⁻¹ (σ* − σ_h) dx

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::model::Material;
use nalgebra::{Matrix3, Matrix4, Matrix6, Vector3, Vector4, Vector6};
use serde::{Deserialize, Serialize};

use super::elasticity::{strain, voigt_stress};
use super::gradients::{Voigt, stiffness_points};
use super::polynomial::NodalStress;
use crate::vector::axpy;

/// Square of an error, relative to that of an initial stress, below which it is round-off.
const ROUND_OFF: f64 = 1e-20;

/// Squares of energy norms over a cell (N m, in the plane per metre of thickness).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CellError {
    /// ‖σ* − σ_h‖² = ∫ (σ* − σ_h) C⁻¹ (σ* − σ_h), with σ* the recovered stress.
    pub error: f64,
    /// ‖σ_h‖² without the initial stress.
    pub energy: f64,
    /// ‖σ_i‖² of the initial stress; errors below its round-off count as zero.
    pub initial: f64,
}

impl CellError {
    /// Adds the squares of other cells.
    pub fn add(&mut self, other: Self) {
        self.error += other.error;
        self.energy += other.energy;
        self.initial += other.initial;
    }

    /// ‖σ* − σ_h‖ relative to ‖σ‖, the square of which is about ‖σ_h‖² + ‖σ* − σ_h‖².
    pub fn relative(&self) -> f64 {
        match self.error {
            error if error <= ROUND_OFF * self.initial => 0.0,
            error => (error / (error + self.energy)).sqrt(),
        }
    }
}

/// C⁻¹ of a material (1/Pa), which defines the energy norm of stresses.
#[derive(Clone, Debug)]
pub enum Compliance {
    /// Compliance in the plane.
    Plane(Matrix3<f64>),
    /// Compliance around an axis.
    Ring(Matrix4<f64>),
    /// Compliance in space.
    Solid(Box<Matrix6<f64>>),
}

impl Compliance {
    /// The compliance of a material; zero where its stiffness is singular.
    pub fn new(material: &Material) -> Self {
        let c = &material.stiffness;
        match c.size() {
            3 => {
                let c = Matrix3::from_fn(|i, j| c[i][j]);
                Self::Plane(c.try_inverse().unwrap_or_default())
            }
            4 => {
                let c = Matrix4::from_fn(|i, j| c[i][j]);
                Self::Ring(c.try_inverse().unwrap_or_default())
            }
            _ => {
                let c = Matrix6::from_fn(|i, j| c[i][j]);
                Self::Solid(Box::new(c.try_inverse().unwrap_or_default()))
            }
        }
    }

    /// ‖σ_i‖² of a stress, in the order of results, over a cell with this `measure`.
    pub fn initial(&self, measure: f64, stress: &NodalStress) -> f64 {
        measure * self.norm(&self.voigt(stress))
    }

    /// s C⁻¹ s.
    fn norm(&self, s: &Voigt) -> f64 {
        match self {
            Self::Plane(inverse) => {
                let s = Vector3::new(s[0], s[1], s[2]);
                s.dot(&(inverse * s))
            }
            Self::Ring(inverse) => {
                let s = Vector4::new(s[0], s[1], s[2], s[3]);
                s.dot(&(inverse * s))
            }
            Self::Solid(inverse) => {
                let s = Vector6::from(*s);
                s.dot(&(inverse.as_ref() * s))
            }
        }
    }

    /// A stress in the order of results, rearranged to Voigt's order.
    fn voigt(&self, &[xx, yy, zz, xy, yz, xz]: &NodalStress) -> Voigt {
        match self {
            Self::Plane(_) => [xx, yy, xy, 0.0, 0.0, 0.0],
            Self::Ring(_) => [xx, yy, zz, xy, 0.0, 0.0],
            Self::Solid(_) => [xx, yy, zz, yz, xz, xy],
        }
    }

    /// The error of a linear triangle or tetrahedron with this `measure`, whose stress is uniform.
    pub fn simplex(&self, measure: f64, stress: &[f64; 6], recovered: &[NodalStress]) -> CellError {
        let stress = self.voigt(stress);
        // The difference is linear: its square is integrated exactly from the values at the corners.
        let mut total = [0.0; 6];
        let mut squares = 0.0;
        for at_node in recovered {
            let d = difference(&self.voigt(at_node), &stress);
            squares += self.norm(&d);
            total = std::array::from_fn(|k| total[k] + d[k]);
        }
        let corners = recovered.len();
        CellError {
            error: measure / (corners * (corners + 1)) as f64 * (squares + self.norm(&total)),
            energy: measure * self.norm(&stress),
            initial: 0.0,
        }
    }

    /// The error of a cell from its kind, coordinates and displacements, and the stress `recovered` at its nodes.
    pub fn cell(
        &self,
        (kind, points, u): (ElementKind, &[[f64; 3]], &[f64]),
        recovered: &[NodalStress],
        material: &Material,
    ) -> CellError {
        let mut sum = CellError::default();
        let components = material.stiffness.size();
        for reference in stiffness_points(&kind, material) {
            let (strain, weight) = strain(reference, points, u, components);
            let stress = voigt_stress(material, &strain);
            let mut smooth = [0.0; 6];
            for (n, at_node) in reference.shape.iter().zip(recovered) {
                axpy(*n, at_node, &mut smooth);
            }
            sum.energy += weight * self.norm(&stress);
            sum.error += weight * self.norm(&difference(&self.voigt(&smooth), &stress));
        }
        sum
    }
}

fn difference(a: &Voigt, b: &Voigt) -> Voigt {
    std::array::from_fn(|k| a[k] - b[k])
}
