//! The estimate of Zienkiewicz and Zhu: the error of the stress is about its difference to the
//! recovered one.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::model::Material;
use nalgebra::{Matrix3, Vector3};

use super::elasticity::{stiffness_points, strain, stress_in_plane};
use super::patch::COMPONENTS;

/// Squares of energy norms over a cell (N, per metre of thickness).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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

/// The error of a cell: its kind, coordinates and displacements, and the stress `recovered` at its
/// nodes.
pub fn cell_error(
    (kind, points, u): (ElementKind, &[[f64; 3]], &[f64]),
    recovered: &[[f64; COMPONENTS]],
    material: &Material,
) -> CellError {
    let c = Matrix3::from_fn(|i, j| material.stiffness[i][j]);
    let Some(compliance) = c.try_inverse() else {
        return CellError::default();
    };
    let norm = |s: &[f64; 3]| {
        let s = Vector3::from(*s);
        s.dot(&(compliance * s))
    };
    let mut sum = CellError::default();
    for (reference, point) in (kind.stiffness_points().iter()).zip(stiffness_points(kind, points)) {
        let stress = stress_in_plane(material, &strain(&point, u));
        sum.energy += point.weight * norm(&stress);
        if kind == ElementKind::Triangle3 {
            // The difference is linear, and one point too few: ∫ over its values at the corners.
            let mut total = [0.0; 3];
            let mut squares = 0.0;
            for at_node in recovered {
                let d = difference(at_node, &stress);
                squares += norm(&d);
                total = std::array::from_fn(|k| total[k] + d[k]);
            }
            sum.error += point.weight / 12.0 * (squares + norm(&total));
            continue;
        }
        let mut smooth = [0.0; COMPONENTS];
        for (n, at_node) in reference.shape.iter().zip(recovered) {
            for (s, v) in smooth.iter_mut().zip(at_node) {
                *s += n * v;
            }
        }
        sum.error += point.weight * norm(&difference(&smooth, &stress));
    }
    sum
}

/// Recovered (XX, YY, ZZ, XY) less (XX, YY, XY).
fn difference(recovered: &[f64; COMPONENTS], stress: &[f64; 3]) -> [f64; 3] {
    let [xx, yy, _, xy] = recovered;
    [xx - stress[0], yy - stress[1], xy - stress[2]]
}
