//! Gradients of an element's shape functions and of its incompatible modes at a point.
//!
//! Incompatible modes are displacements 1 − ξ_k² within a linear quadrilateral or hexahedron, which improve its
//! bending. Their gradients use the Jacobian at the center, (det J_0/det J) J_0⁻ᵀ ∂/∂ξ, so that the mean strain of each
//! mode is zero and cells of any shape pass the patch test.
//!
//! R. L. Taylor, P. J. Beresford, E. L. Wilson, *A non-conforming element for stress analysis*, Int. J. Numer. Meth.
//! Eng. 10 (1976).

use std::array::from_fn;
use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::element::geometry::cross;
use contact_dd_partition::element::quadrature::TabulatedPoint;
use contact_dd_partition::element::reference::ReferenceElement;
use contact_dd_partition::model::{Formulation, Material};

/// Most nodes of an element.
pub const MAX_NODES: usize = 27;
/// Number of strain components around an axis.
pub(super) const RING: usize = 4;
/// Most nodes of a plane element.
pub(super) const MAX_PLANE_NODES: usize = 9;
/// Most dofs of an element.
pub const MAX_DOFS: usize = 3 * MAX_NODES;

/// A strain or stress in Voigt's order; in the plane the first three components are used, around an axis four.
pub type Voigt = [f64; 6];

/// Index of γ_ab in Voigt's order with this number of `components`.
pub(super) const fn shear(components: usize, a: usize, b: usize) -> usize {
    match components {
        6 => 6 - a - b,
        _ => components - 1,
    }
}

/// The quadrature points of a cell's stiffness for a material.
pub fn stiffness_points<'a>(
    element: &'a ReferenceElement,
    material: &Material,
) -> &'a [TabulatedPoint] {
    let reduced = element.reduced_points();
    match (material.stiffness.size(), reduced) {
        (_, Some(points)) if material.formulation == Formulation::Reduced => points,
        (RING, _) => element.points_around_axis(),
        _ => element.stiffness_points(),
    }
}

/// True if cells of this kind have incompatible modes for a material: linear quadrilaterals and hexahedra, but not
/// around an axis.
pub fn has_modes(element: &ReferenceElement, material: &Material) -> bool {
    let kind = (element.dim(), element.nodes(), material.stiffness.size());
    material.formulation == Formulation::IncompatibleModes && matches!(kind, (2, 4, 3) | (3, 8, 6))
}

/// Gradients of the shape functions at a quadrature point of an element with up to N nodes in D dimensions and V strain
/// components, and the weight of that point.
pub(super) struct PointGradients<const D: usize, const V: usize, const N: usize> {
    /// ∂N_i/∂x_d (1/m).
    pub gradients: [[f64; D]; N],
    /// N_i/x around an axis (1/m).
    pub hoop: [f64; N],
    /// Quadrature weight times Jacobian (m², m³).
    pub weight: f64,
}

impl<const D: usize, const V: usize, const N: usize> PointGradients<D, V, N> {
    /// The gradients at one point of an element with nodes at `points`.
    #[inline(always)]
    pub fn new(reference: &TabulatedPoint, points: &[[f64; 3]]) -> Self {
        // J = ∂x/∂ξ
        let mut j = [[0.0; D]; D];
        for (x, g) in points.iter().zip(&reference.gradients) {
            for (row, x) in j.iter_mut().zip(x) {
                for (entry, g) in row.iter_mut().zip(g) {
                    *entry += x * g;
                }
            }
        }
        let (cofactors, det) = cofactors(&j);
        let mut gradients = [[0.0; D]; N];
        for (gradient, g) in gradients.iter_mut().zip(&reference.gradients) {
            for (component, row) in gradient.iter_mut().zip(&cofactors) {
                let terms = row.iter().zip(g).map(|(c, g)| c * g);
                *component = terms.reduce(|sum, term| sum + term).unwrap_or_default() / det;
            }
        }
        let mut point = Self {
            gradients,
            hoop: [0.0; N],
            weight: det * reference.weight,
        };
        if V == RING {
            let parts = reference.shape.iter().zip(points);
            let radius: f64 = parts.map(|(n, x)| n * x[0]).sum();
            for (hoop, n) in point.hoop.iter_mut().zip(&reference.shape) {
                *hoop = n / radius;
            }
            point.weight *= 2.0 * PI * radius;
        }
        point
    }

    /// The same, with the gradients of the incompatible modes after those of the nodes at `points`.
    pub fn with_modes(mut self, reference: &TabulatedPoint, points: &[[f64; 3]]) -> Self {
        // J at the center; the first four corners of a hexahedron are those of a quadrilateral.
        let corners = ElementKind::Hexahedron8.reference().node_coordinates();
        let mut j = [[0.0; D]; D];
        for (x, corner) in points.iter().zip(corners) {
            for (row, x) in j.iter_mut().zip(x) {
                for (entry, sign) in row.iter_mut().zip(corner) {
                    *entry += x * sign / points.len() as f64;
                }
            }
        }
        let (cofactors, _) = cofactors(&j);
        let det = self.weight / reference.weight;
        for (k, xi) in reference.xi.iter().enumerate().take(D) {
            let slope = -2.0 * xi / det;
            self.gradients[points.len() + k] = from_fn(|d| cofactors[d][k] * slope);
        }
        self
    }

    /// ε at the point for nodal displacements `u`.
    pub fn strain(&self, u: &[f64]) -> Voigt {
        let mut strain = [0.0; 6];
        for (g, u) in self.gradients.iter().zip(u.chunks_exact(D)) {
            for a in 0..D {
                strain[a] += g[a] * u[a];
                for b in a + 1..D {
                    strain[shear(V, a, b)] += g[b] * u[a] + g[a] * u[b];
                }
            }
        }
        if V == RING {
            let u_x = u.iter().step_by(D);
            strain[2] = self.hoop.iter().zip(u_x).map(|(h, u)| h * u).sum();
        }
        strain
    }
}

/// det J and det J · J⁻ᵀ.
#[inline(always)]
fn cofactors<const D: usize>(j: &[[f64; D]; D]) -> ([[f64; D]; D], f64) {
    let mut cofactors = [[0.0; D]; D];
    if D == 2 {
        cofactors[0] = from_fn(|k| if k == 0 { j[1][1] } else { -j[1][0] });
        cofactors[1] = from_fn(|k| if k == 0 { -j[0][1] } else { j[0][0] });
        return (cofactors, j[0][0] * j[1][1] - j[0][1] * j[1][0]);
    }
    let row = |i: usize| [j[i][0], j[i][1], j[i][2]];
    for (i, cofactors) in cofactors.iter_mut().enumerate() {
        let normal = cross(row((i + 1) % 3), row((i + 2) % 3));
        *cofactors = from_fn(|k| normal[k]);
    }
    let det = (0..D).map(|k| j[0][k] * cofactors[0][k]).sum();
    (cofactors, det)
}
