//! The estimate of Zienkiewicz and Zhu: the error of the stress σ_h is about its difference to the
//! recovered one σ*.
//!
//! > ‖e‖² ≈ ∫ (σ* − σ_h)ᵀ C⁻¹ (σ* − σ_h) dx

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::model::Material;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::elasticity::{stiffness_points, strain, stress_in_plane};
use super::patch::COMPONENTS;

/// Squares of energy norms over a cell (N, per metre of thickness).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CellError {
    /// ‖σ* − σ_h‖² = ∫ (σ* − σ_h) C⁻¹ (σ* − σ_h), with σ* the recovered stress.
    pub error: f64,
    /// ‖σ_h‖².
    pub energy: f64,
}

impl CellError {
    /// Adds that of other cells.
    pub fn add(&mut self, other: Self) {
        self.error += other.error;
        self.energy += other.energy;
    }

    /// ‖σ* − σ_h‖ relative to ‖σ‖, the square of which is about ‖σ_h‖² + ‖σ* − σ_h‖².
    pub fn relative(&self) -> f64 {
        match self.error {
            0.0 => 0.0,
            error => (error / (error + self.energy)).sqrt(),
        }
    }
}

/// C⁻¹ of a material (1/Pa), in whose norm stresses are measured.
#[derive(Clone, Copy, Debug)]
pub struct Compliance(Matrix3<f64>);

impl Compliance {
    /// That of a material; zero where its stiffness is singular.
    pub fn new(material: &Material) -> Self {
        let c = Matrix3::from_fn(|i, j| material.stiffness[i][j]);
        Self(c.try_inverse().unwrap_or_default())
    }

    /// s C⁻¹ s of (XX, YY, XY).
    fn norm(&self, s: &[f64; 3]) -> f64 {
        let s = Vector3::from(*s);
        s.dot(&(self.0 * s))
    }

    /// The error of a linear triangle with an area, whose stress is the same everywhere.
    pub fn triangle(
        &self,
        area: f64,
        stress: &[f64; 6],
        recovered: [&[f64; COMPONENTS]; 3],
    ) -> CellError {
        let stress = [stress[0], stress[1], stress[3]];
        // The difference is linear: ∫ over its values at the corners.
        let mut total = [0.0; 3];
        let mut squares = 0.0;
        for at_node in recovered {
            let d = difference(at_node, &stress);
            squares += self.norm(&d);
            total = std::array::from_fn(|k| total[k] + d[k]);
        }
        CellError {
            error: area / 12.0 * (squares + self.norm(&total)),
            energy: area * self.norm(&stress),
        }
    }

    /// The error of a cell: its kind, coordinates and displacements, and the stress `recovered` at
    /// its nodes.
    pub fn cell(
        &self,
        (kind, points, u): (ElementKind, &[[f64; 3]], &[f64]),
        recovered: &[[f64; COMPONENTS]],
        material: &Material,
    ) -> CellError {
        let mut sum = CellError::default();
        let references = kind.stiffness_points().iter();
        for (reference, point) in references.zip(stiffness_points(&kind, points)) {
            let stress = stress_in_plane(material, &strain(&point, u));
            let mut smooth = [0.0; COMPONENTS];
            for (n, at_node) in reference.shape.iter().zip(recovered) {
                for (s, v) in smooth.iter_mut().zip(at_node) {
                    *s += n * v;
                }
            }
            sum.energy += point.weight * self.norm(&stress);
            sum.error += point.weight * self.norm(&difference(&smooth, &stress));
        }
        sum
    }
}

/// Recovered (XX, YY, ZZ, XY) less (XX, YY, XY).
fn difference(recovered: &[f64; COMPONENTS], stress: &[f64; 3]) -> [f64; 3] {
    let [xx, yy, _, xy] = recovered;
    [xx - stress[0], yy - stress[1], xy - stress[2]]
}
