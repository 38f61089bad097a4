//! Linear elasticity of one element: strains, stresses, stiffness.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::model::{Material, PlaneState};

/// Most nodes that an element has.
pub const MAX_NODES: usize = 9;
/// Most dofs that an element has.
pub const MAX_DOFS: usize = 2 * MAX_NODES;

/// Gradients of the shape functions at a point of an element, and the weight of that point.
#[derive(Clone, Copy, Debug)]
pub struct PointGradients {
    /// ∂N_i/∂x_d [1/m].
    pub gradients: [[f64; 2]; MAX_NODES],
    /// Quadrature weight times Jacobian [m²].
    pub weight: f64,
}

/// The quadrature points of an element's stiffness.
pub fn stiffness_points(kind: ElementKind, points: &[[f64; 3]]) -> Vec<PointGradients> {
    debug_assert_eq!(kind, ElementKind::Triangle3);
    let [a, b, c] = [points[0], points[1], points[2]];
    let det = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let mut gradients = [[0.0; 2]; MAX_NODES];
    gradients[0] = [(b[1] - c[1]) / det, (c[0] - b[0]) / det];
    gradients[1] = [(c[1] - a[1]) / det, (a[0] - c[0]) / det];
    gradients[2] = [(a[1] - b[1]) / det, (b[0] - a[0]) / det];
    vec![PointGradients {
        gradients,
        weight: det / 2.0,
    }]
}

/// ε = (ε_xx, ε_yy, γ_xy) at a point for nodal displacements `u`.
pub fn strain(point: &PointGradients, u: &[f64]) -> [f64; 3] {
    let mut strain = [0.0; 3];
    for (g, u) in point.gradients.iter().zip(u.chunks_exact(2)) {
        strain[0] += g[0] * u[0];
        strain[1] += g[1] * u[1];
        strain[2] += g[1] * u[0] + g[0] * u[1];
    }
    strain
}

/// σ = (XX, YY, ZZ, XY, YZ, XZ) for a strain in the plane [Pa].
///
/// σ_zz follows from the material's row out of the plane; where that isn't known it is 0.
pub fn stress(material: &Material, plane: PlaneState, strain: &[f64; 3]) -> [f64; 6] {
    let row = |c: &[f64; 3]| c.iter().zip(strain).map(|(c, e)| c * e).sum::<f64>();
    let c = &material.stiffness;
    let zz = match (plane, &material.out_of_plane) {
        (PlaneState::Strain, Some(out_of_plane)) => row(out_of_plane),
        _ => 0.0,
    };
    [row(&c[0]), row(&c[1]), zz, row(&c[2]), 0.0, 0.0]
}

/// An element's stiffness, row after row.
pub type ElementMatrix = [[f64; MAX_DOFS]; MAX_DOFS];

/// K_e = ∫ Bᵀ C B over an element of unit thickness [Pa], dofs node by node.
pub fn stiffness(kind: ElementKind, points: &[[f64; 3]], c: &[[f64; 3]; 3]) -> ElementMatrix {
    let mut k = [[0.0; MAX_DOFS]; MAX_DOFS];
    let n = kind.nodes();
    for point in stiffness_points(kind, points) {
        // Columns of C B: the stress that a unit displacement of one dof causes.
        let mut cb = [[0.0; 3]; MAX_DOFS];
        for i in 0..n {
            let [gx, gy] = point.gradients[i];
            for r in 0..3 {
                cb[2 * i][r] = c[r][0] * gx + c[r][2] * gy;
                cb[2 * i + 1][r] = c[r][1] * gy + c[r][2] * gx;
            }
        }
        for i in 0..n {
            let [gx, gy] = point.gradients[i];
            for j in 0..2 * n {
                let s = &cb[j];
                k[2 * i][j] += point.weight * (gx * s[0] + gy * s[2]);
                k[2 * i + 1][j] += point.weight * (gy * s[1] + gx * s[2]);
            }
        }
    }
    // Symmetric to the last bit, so that assembling one triangle is assembling both.
    for i in 0..2 * n {
        for j in 0..i {
            k[j][i] = k[i][j];
        }
    }
    k
}

/// (σ_1 ≥ σ_2 ≥ σ_3) of a stress (XX, YY, ZZ, XY, YZ, XZ).
pub fn principal_stresses(s: &[f64; 6]) -> [f64; 3] {
    let matrix = nalgebra::Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]);
    let values = matrix.symmetric_eigenvalues();
    let mut values = [values[0], values[1], values[2]];
    values.sort_unstable_by(|a, b| b.total_cmp(a));
    values
}

/// von Mises' equivalent stress [Pa].
pub fn von_mises(s: &[f64; 6]) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    let shear = s[3].powi(2) + s[4].powi(2) + s[5].powi(2);
    (0.5 * normal + 3.0 * shear).sqrt()
}
