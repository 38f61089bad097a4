//! Linear elasticity of one element: K_e = ∫ Bᵀ C B dx, (2).
//!
//! ε = B u holds in Voigt's order ε_xx, ε_yy, γ_xy in the plane and ε_xx, ε_yy, ε_zz, γ_yz, γ_xz, γ_xy in space, with γ
//! = 2 ε, from the gradients of the shape functions; σ = C ε. Around the axis x = 0 it is ε_xx, ε_yy, ε_zz, γ_xy with
//! the hoop strain ε_zz = u_x/x, and dx is 2πx dx dy. The number of components distinguishes these cases.
//!
//! Incompatible modes, if an element has some, are condensed within it: no force acts on them, so that their amplitudes
//! α follow from the nodal displacements,
//!
//! > K_αα α = −K_αu u, K_e = K_uu − K_uα K_αα⁻¹ K_αu.

use std::array::from_fn;

use contact_dd_partition::element::quadrature::TabulatedPoint;
use contact_dd_partition::element::reference::ReferenceElement;
use contact_dd_partition::model::{Material, PlaneState};
use nalgebra::{DMatrix, DVector, Matrix3};

use super::gradients::{
    MAX_DOFS, MAX_NODES, MAX_PLANE_NODES, PointGradients, RING, Voigt, has_modes, shear,
    stiffness_points,
};

/// Number of nodes of a hexahedron plus its incompatible modes.
const SOLID: usize = 11;

/// ε, with this number of `components`, at a point of an element, and the point's weight: quadrature weight times
/// Jacobian (m², m³). The nodes are at `points`; `u` are their displacements, optionally followed by the amplitudes of
/// incompatible modes.
pub fn strain(
    reference: &TabulatedPoint,
    points: &[[f64; 3]],
    u: &[f64],
    components: usize,
) -> (Voigt, f64) {
    match components {
        3 => {
            let mut point = PointGradients::<2, 3, MAX_PLANE_NODES>::new(reference, points);
            if u.len() > 2 * points.len() {
                point = point.with_modes(reference, points);
            }
            (point.strain(u), point.weight)
        }
        RING => {
            let point = PointGradients::<2, RING, MAX_PLANE_NODES>::new(reference, points);
            (point.strain(u), point.weight)
        }
        _ => {
            let mut point = PointGradients::<3, 6, MAX_NODES>::new(reference, points);
            if u.len() > 3 * points.len() {
                point = point.with_modes(reference, points);
            }
            (point.strain(u), point.weight)
        }
    }
}

/// σ = (XX, YY, ZZ, XY, YZ, XZ) for a strain (Pa).
///
/// Around an axis ZZ is the hoop stress. In the plane σ_zz follows from the material's out-of-plane row; it is 0 if
/// that is unknown.
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

/// Voigt's order in space rearranged to that of results, XX, YY, ZZ, XY, YZ, XZ.
fn result_order(&[xx, yy, zz, yz, xz, xy]: &Voigt) -> [f64; 6] {
    [xx, yy, zz, xy, yz, xz]
}

fn product(row: &[f64], strain: &[f64]) -> f64 {
    row.iter().zip(strain).map(|(c, e)| c * e).sum()
}

/// An element's stiffness; both triangles are stored.
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
    /// The row `i`.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.order..(i + 1) * self.order]
    }

    /// The rows.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        (0..self.order).map(|i| self.row(i))
    }

    /// Sets the matrix to K_e = ∫ Bᵀ C B over an element, in the plane for unit thickness (Pa; around an axis and in
    /// space N/m), dofs node by node; incompatible modes, if any, are condensed.
    pub fn set(&mut self, element: &ReferenceElement, points: &[[f64; 3]], material: &Material) {
        if has_modes(element, material) {
            return self.set_bending(element, points, material);
        }
        let c = &material.stiffness;
        let rule = stiffness_points(element, material);
        if element.dim() == 3 {
            let c = &c.rows::<6>();
            return match element.nodes() {
                4 => self.integrate::<3, 6, 4>(4, rule, points, c),
                8 => self.integrate::<3, 6, 8>(8, rule, points, c),
                nodes => self.integrate::<3, 6, MAX_NODES>(nodes, rule, points, c),
            };
        }
        if c.size() == RING {
            let c = &c.rows::<RING>();
            let nodes = element.nodes();
            return self.integrate::<2, RING, MAX_PLANE_NODES>(nodes, rule, points, c);
        }
        let c = &c.rows::<3>();
        // Constant sizes let the compiler unroll the loops.
        match element.nodes() {
            3 => self.integrate::<2, 3, MAX_PLANE_NODES>(3, rule, points, c),
            4 => self.integrate::<2, 3, MAX_PLANE_NODES>(4, rule, points, c),
            6 => self.integrate::<2, 3, MAX_PLANE_NODES>(6, rule, points, c),
            8 => self.integrate::<2, 3, MAX_PLANE_NODES>(8, rule, points, c),
            9 => self.integrate::<2, 3, MAX_PLANE_NODES>(9, rule, points, c),
            nodes => self.integrate::<2, 3, MAX_PLANE_NODES>(nodes, rule, points, c),
        }
    }

    /// The integral in D dimensions, with V strain components, for up to N nodes.
    #[inline(always)]
    fn integrate<const D: usize, const V: usize, const N: usize>(
        &mut self,
        nodes: usize,
        rule: &[TabulatedPoint],
        points: &[[f64; 3]],
        c: &[[f64; V]; V],
    ) {
        let order = D * nodes;
        self.order = order;
        self.values[..order * order].fill(0.0);
        for reference in rule {
            let point = PointGradients::<D, V, N>::new(reference, &points[..nodes]);
            self.add_lower(nodes, &point, c);
        }
        // The upper triangle is copied, so that assembly of one triangle is exact.
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
            // Stresses of a unit displacement of each component.
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

/// Condensation of a cell's incompatible modes: −K_αα⁻¹ K_αu, which gives their amplitudes from the nodal
/// displacements, and K_αu.
struct Eliminated {
    coupling: DMatrix<f64>,
    amplitudes: DMatrix<f64>,
}

impl ElementMatrix {
    /// Sets the matrix to the stiffness of an element with its incompatible modes condensed.
    pub(super) fn set_bending(
        &mut self,
        element: &ReferenceElement,
        points: &[[f64; 3]],
        material: &Material,
    ) {
        self.set_with_modes(element, points, material);
        let order = element.dim() * element.nodes();
        let mut condensed = DMatrix::from_fn(order, order, |i, j| self.row(i.max(j))[i.min(j)]);
        // The modes are left out where K_αα is singular.
        if let Some(modes) = self.eliminated(order) {
            condensed += modes.coupling.transpose() * modes.amplitudes;
        }
        self.order = order;
        for i in 0..order {
            for j in 0..=i {
                self.values[i * order + j] = condensed[(i, j)];
                self.values[j * order + i] = condensed[(i, j)];
            }
        }
    }

    /// Sets the lower triangle to the stiffness of an element and its modes.
    fn set_with_modes(
        &mut self,
        element: &ReferenceElement,
        points: &[[f64; 3]],
        material: &Material,
    ) {
        let rule = stiffness_points(element, material);
        match element.dim() {
            3 => {
                let c = &material.stiffness.rows::<6>();
                self.integrate_with_modes::<3, 6, SOLID>(element.nodes(), rule, points, c);
            }
            _ => {
                let c = &material.stiffness.rows::<3>();
                self.integrate_with_modes::<2, 3, MAX_PLANE_NODES>(
                    element.nodes(),
                    rule,
                    points,
                    c,
                );
            }
        }
    }

    fn integrate_with_modes<const D: usize, const V: usize, const N: usize>(
        &mut self,
        nodes: usize,
        rule: &[TabulatedPoint],
        points: &[[f64; 3]],
        c: &[[f64; V]; V],
    ) {
        let places = nodes + D;
        self.order = D * places;
        self.values[..self.order * self.order].fill(0.0);
        for reference in rule {
            let point = PointGradients::<D, V, N>::new(reference, points);
            self.add_lower(places, &point.with_modes(reference, points), c);
        }
    }

    /// The condensation of the modes, which come after the first `order` dofs.
    fn eliminated(&self, order: usize) -> Option<Eliminated> {
        let own = self.order - order;
        let stiffness = DMatrix::from_fn(own, own, |i, j| {
            self.row(order + i.max(j))[order + i.min(j)]
        });
        let coupling = DMatrix::from_fn(own, order, |i, j| self.row(order + i)[j]);
        let amplitudes = -stiffness.cholesky()?.solve(&coupling);
        Some(Eliminated {
            coupling,
            amplitudes,
        })
    }
}

/// Amplitudes α of the incompatible modes of an element with nodes at `points` displaced by `u`.
pub fn amplitudes(
    element: &ReferenceElement,
    points: &[[f64; 3]],
    material: &Material,
    u: &[f64],
) -> Vec<f64> {
    let mut k = ElementMatrix::default();
    k.set_with_modes(element, points, material);
    match k.eliminated(u.len()) {
        Some(modes) => {
            let amplitudes = modes.amplitudes * DVector::from_column_slice(u);
            amplitudes.iter().copied().collect()
        }
        None => vec![0.0; k.order - u.len()],
    }
}

/// (σ_1 ≥ σ_2 ≥ σ_3) of a stress (XX, YY, ZZ, XY, YZ, XZ); by Mohr's circle if YZ and XZ are 0, as in the plane.
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
