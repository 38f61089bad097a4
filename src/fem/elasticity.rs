//! Linear elasticity of one element: K_e = ∫ Bᵀ C B dx, (2).
//!
//! ε = B u holds in Voigt's order ε_xx, ε_yy, γ_xy in the plane and ε_xx, ε_yy, ε_zz, γ_yz, γ_xz, γ_xy in space, with
//! γ = 2 ε, from the gradients of the shape functions; σ = C ε. Around the axis x = 0 it is ε_xx, ε_yy, ε_zz, γ_xy with
//! the strain of the hoop ε_zz = u_x/x, and dx is 2πx dx dy. The number of components tells which.

use std::array::from_fn;
use std::f64::consts::PI;

use contact_dd_partition::element::geometry::cross;
use contact_dd_partition::element::quadrature::TabulatedPoint;
use contact_dd_partition::element::reference::ReferenceElement;
use contact_dd_partition::model::{Material, PlaneState};
use contact_dd_partition::stiffness::Stiffness;
use nalgebra::Matrix3;

/// Most nodes that an element has.
pub const MAX_NODES: usize = 27;
/// Components of a strain around an axis.
const RING: usize = 4;
/// Most nodes that one of the plane has.
const MAX_PLANE_NODES: usize = 9;
/// Most dofs that an element has.
pub const MAX_DOFS: usize = 3 * MAX_NODES;

/// A strain or stress in Voigt's order; in the plane the first three components count, around an axis four.
pub type Voigt = [f64; 6];

/// The place of γ_ab in Voigt's order of so many components.
const fn shear(components: usize, a: usize, b: usize) -> usize {
    match components {
        6 => 6 - a - b,
        _ => components - 1,
    }
}

/// The points at which a cell's stiffness is integrated where a strain has so many components.
pub fn stiffness_points(element: &ReferenceElement, components: usize) -> &[TabulatedPoint] {
    match components {
        RING => element.points_around_axis(),
        _ => element.stiffness_points(),
    }
}

/// Gradients of the shape functions at a point of an element with up to N nodes in D dimensions, where a strain has V
/// components, and the weight of that point.
struct PointGradients<const D: usize, const V: usize, const N: usize> {
    /// ∂N_i/∂x_d (1/m).
    gradients: [[f64; D]; N],
    /// N_i/x around an axis (1/m).
    hoop: [f64; N],
    /// Quadrature weight times Jacobian (m², m³).
    weight: f64,
}

impl<const D: usize, const V: usize, const N: usize> PointGradients<D, V, N> {
    /// The gradients at one point of the element with the nodes at `points`.
    #[inline(always)]
    fn new(reference: &TabulatedPoint, points: &[[f64; 3]]) -> Self {
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

    /// ε at the point for nodal displacements `u`.
    fn strain(&self, u: &[f64]) -> Voigt {
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

/// ε, of so many components, at a point of the element with the nodes at `points` for their displacements `u`, and the
/// weight of the point, that of quadrature times the Jacobian (m², m³).
pub fn strain(
    reference: &TabulatedPoint,
    points: &[[f64; 3]],
    u: &[f64],
    components: usize,
) -> (Voigt, f64) {
    match components {
        3 => {
            let point = PointGradients::<2, 3, MAX_PLANE_NODES>::new(reference, points);
            (point.strain(u), point.weight)
        }
        RING => {
            let point = PointGradients::<2, RING, MAX_PLANE_NODES>::new(reference, points);
            (point.strain(u), point.weight)
        }
        _ => {
            let point = PointGradients::<3, 6, MAX_NODES>::new(reference, points);
            (point.strain(u), point.weight)
        }
    }
}

/// σ = (XX, YY, ZZ, XY, YZ, XZ) for a strain (Pa).
///
/// Around an axis ZZ is the stress of the hoop. In the plane σ_zz follows from the material's row out of the plane; where that isn't known it is 0.
pub fn stress(material: &Material, plane: Option<PlaneState>, strain: &Voigt) -> [f64; 6] {
    let s = voigt_stress(material, strain);
    let zz = match (plane, &material.out_of_plane) {
        (None, _) => return result_order(&s),
        (Some(PlaneState::Axisymmetric), _) => return [s[0], s[1], s[2], s[3], 0.0, 0.0],
        (Some(PlaneState::Strain), Some(out_of_plane)) => product(out_of_plane, strain),
        _ => 0.0,
    };
    [s[0], s[1], zz, s[2], 0.0, 0.0]
}

/// σ = C ε (Pa).
pub fn voigt_stress(material: &Material, strain: &Voigt) -> Voigt {
    let mut stress = [0.0; 6];
    for (i, stress) in stress
        .iter_mut()
        .enumerate()
        .take(material.stiffness.size())
    {
        *stress = product(&material.stiffness[i], strain);
    }
    stress
}

/// Voigt's order of space as results have it, XX, YY, ZZ, XY, YZ, XZ.
fn result_order(&[xx, yy, zz, yz, xz, xy]: &Voigt) -> [f64; 6] {
    [xx, yy, zz, xy, yz, xz]
}

fn product(row: &[f64], strain: &[f64]) -> f64 {
    row.iter().zip(strain).map(|(c, e)| c * e).sum()
}

/// An element's stiffness, both triangles.
#[derive(Clone, Debug)]
pub struct ElementMatrix {
    order: usize,
    values: [f64; MAX_DOFS * MAX_DOFS],
}

impl Default for ElementMatrix {
    fn default() -> Self {
        Self {
            order: 0,
            values: [0.0; MAX_DOFS * MAX_DOFS],
        }
    }
}

impl ElementMatrix {
    /// Its row `i`.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.order..(i + 1) * self.order]
    }

    /// Its rows.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        (0..self.order).map(|i| self.row(i))
    }

    /// Becomes K_e = ∫ Bᵀ C B over an element, in the plane of unit thickness (Pa; around an axis and in space N/m), dofs
    /// node by node.
    pub fn set(&mut self, element: &ReferenceElement, points: &[[f64; 3]], c: &Stiffness) {
        if element.dim() == 3 {
            let c = &c.rows::<6>();
            return match element.nodes() {
                4 => self.integrate::<3, 6, 4>(4, element, points, c),
                8 => self.integrate::<3, 6, 8>(8, element, points, c),
                nodes => self.integrate::<3, 6, MAX_NODES>(nodes, element, points, c),
            };
        }
        if c.size() == RING {
            let c = &c.rows::<RING>();
            let nodes = element.nodes();
            return self.integrate::<2, RING, MAX_PLANE_NODES>(nodes, element, points, c);
        }
        let c = &c.rows::<3>();
        // The compiler unrolls what it knows the size of.
        match element.nodes() {
            3 => self.integrate::<2, 3, MAX_PLANE_NODES>(3, element, points, c),
            4 => self.integrate::<2, 3, MAX_PLANE_NODES>(4, element, points, c),
            6 => self.integrate::<2, 3, MAX_PLANE_NODES>(6, element, points, c),
            8 => self.integrate::<2, 3, MAX_PLANE_NODES>(8, element, points, c),
            9 => self.integrate::<2, 3, MAX_PLANE_NODES>(9, element, points, c),
            nodes => self.integrate::<2, 3, MAX_PLANE_NODES>(nodes, element, points, c),
        }
    }

    /// In D dimensions, with V components of strain, for up to N nodes.
    #[inline(always)]
    fn integrate<const D: usize, const V: usize, const N: usize>(
        &mut self,
        nodes: usize,
        element: &ReferenceElement,
        points: &[[f64; 3]],
        c: &[[f64; V]; V],
    ) {
        let order = D * nodes;
        self.order = order;
        self.values[..order * order].fill(0.0);
        for reference in stiffness_points(element, V) {
            let point = PointGradients::<D, V, N>::new(reference, &points[..nodes]);
            self.add_lower(nodes, &point, c);
        }
        // Symmetric to the last bit, so that assembling one triangle is assembling both.
        for i in 0..order {
            for j in 0..i {
                self.values[j * order + i] = self.values[i * order + j];
            }
        }
    }

    /// Adds the lower triangle of a point's contribution.
    #[inline(always)]
    fn add_lower<const D: usize, const V: usize, const N: usize>(
        &mut self,
        nodes: usize,
        point: &PointGradients<D, V, N>,
        c: &[[f64; V]; V],
    ) {
        let order = D * nodes;
        for j in 0..nodes {
            let g = &point.gradients[j];
            // The stress that a unit displacement of each component causes.
            let stresses: [[f64; V]; D] = from_fn(|a| {
                from_fn(|r| {
                    let others = (0..D).filter(|&b| b != a);
                    let s = others.fold(c[r][a] * g[a], |sum, b| sum + c[r][shear(V, a, b)] * g[b]);
                    match V == RING && a == 0 {
                        true => s + c[r][2] * point.hoop[j],
                        false => s,
                    }
                })
            });
            for i in j..nodes {
                let g = &point.gradients[i];
                for (component, s) in stresses.iter().enumerate() {
                    let k = &mut self.values[D * i * order + D * j + component..];
                    for a in 0..D {
                        let others = (0..D).filter(|&b| b != a);
                        let mut force =
                            others.fold(g[a] * s[a], |sum, b| sum + g[b] * s[shear(V, a, b)]);
                        if V == RING && a == 0 {
                            force += point.hoop[i] * s[2];
                        }
                        k[a * order] += point.weight * force;
                    }
                }
            }
        }
    }
}

/// (σ_1 ≥ σ_2 ≥ σ_3) of a stress (XX, YY, ZZ, XY, YZ, XZ); by Mohr's circle where it has none of the last two, as in the
/// plane.
pub fn principal_stresses(s: &[f64; 6]) -> [f64; 3] {
    let [xx, yy, zz, xy, yz, xz] = *s;
    let mut values: [f64; 3] = if yz == 0.0 && xz == 0.0 {
        let (center, radius) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        [center + radius, center - radius, zz]
    } else {
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        tensor.symmetric_eigenvalues().into()
    };
    values.sort_unstable_by(|a, b| b.total_cmp(a));
    values
}

/// von Mises' equivalent stress (Pa).
pub fn von_mises(s: &[f64; 6]) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    let shear = s[3].powi(2) + s[4].powi(2) + s[5].powi(2);
    (0.5 * normal + 3.0 * shear).sqrt()
}

#[cfg(test)]
mod tests;
