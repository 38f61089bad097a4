//! Linear elasticity of one element in the plane: K_e = ∫ Bᵀ C B dx, (2).
//!
//! ε = B u holds ε_xx, ε_yy and γ_xy = 2 ε_xy, from the gradients of the shape functions; σ = C ε.

use contact_dd_partition::element::quadrature::TabulatedPoint;
use contact_dd_partition::element::reference::ReferenceElement;
use contact_dd_partition::model::{Material, PlaneState};
use contact_dd_partition::stiffness::Stiffness;

/// Most nodes that an element has.
pub const MAX_NODES: usize = 9;
/// Most dofs that an element has.
pub const MAX_DOFS: usize = 2 * MAX_NODES;

/// Gradients of the shape functions at a point of an element, and the weight of that point.
#[derive(Clone, Copy, Debug)]
pub struct PointGradients {
    /// ∂N_i/∂x_d (1/m).
    pub gradients: [[f64; 2]; MAX_NODES],
    /// Quadrature weight times Jacobian (m²).
    pub weight: f64,
}

/// The quadrature points of an element's stiffness.
pub fn stiffness_points(
    element: &ReferenceElement,
    points: &[[f64; 3]],
) -> impl Iterator<Item = PointGradients> {
    let reference = element.stiffness_points().iter();
    reference.map(move |reference| gradients(reference, points))
}

/// The gradients at one point of the element with the nodes at `points`.
pub fn gradients(reference: &TabulatedPoint, points: &[[f64; 3]]) -> PointGradients {
    // J = ∂x/∂ξ
    let mut j = [[0.0; 2]; 2];
    for (x, g) in points.iter().zip(&reference.gradients) {
        for (row, x) in j.iter_mut().zip(x) {
            row[0] += x * g[0];
            row[1] += x * g[1];
        }
    }
    let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    let mut gradients = [[0.0; 2]; MAX_NODES];
    for (gradient, g) in gradients.iter_mut().zip(&reference.gradients) {
        gradient[0] = (j[1][1] * g[0] - j[1][0] * g[1]) / det;
        gradient[1] = (j[0][0] * g[1] - j[0][1] * g[0]) / det;
    }
    PointGradients {
        gradients,
        weight: det * reference.weight,
    }
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

/// σ = (XX, YY, ZZ, XY, YZ, XZ) for a strain in the plane (Pa).
///
/// σ_zz follows from the material's row out of the plane; where that isn't known it is 0.
pub fn stress(material: &Material, plane: PlaneState, strain: &[f64; 3]) -> [f64; 6] {
    let [xx, yy, xy] = stress_in_plane(material, strain);
    let zz = match (plane, &material.out_of_plane) {
        (PlaneState::Strain, Some(out_of_plane)) => product(out_of_plane, strain),
        _ => 0.0,
    };
    [xx, yy, zz, xy, 0.0, 0.0]
}

/// σ = (XX, YY, XY) for a strain in the plane (Pa).
pub fn stress_in_plane(material: &Material, strain: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| product(&material.stiffness[i], strain))
}

fn product(row: &[f64], strain: &[f64; 3]) -> f64 {
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

    /// Becomes K_e = ∫ Bᵀ C B over an element of unit thickness (Pa), dofs node by node.
    pub fn set(&mut self, element: &ReferenceElement, points: &[[f64; 3]], c: &Stiffness) {
        let c = &c.rows::<3>();
        // The compiler unrolls what it knows the size of.
        match element.nodes() {
            3 => self.integrate(3, element, points, c),
            4 => self.integrate(4, element, points, c),
            6 => self.integrate(6, element, points, c),
            8 => self.integrate(8, element, points, c),
            9 => self.integrate(9, element, points, c),
            nodes => self.integrate(nodes, element, points, c),
        }
    }

    #[inline(always)]
    fn integrate(
        &mut self,
        nodes: usize,
        element: &ReferenceElement,
        points: &[[f64; 3]],
        c: &[[f64; 3]; 3],
    ) {
        let order = 2 * nodes;
        self.order = order;
        self.values[..order * order].fill(0.0);
        for point in stiffness_points(element, &points[..nodes]) {
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
    fn add_lower(&mut self, nodes: usize, point: &PointGradients, c: &[[f64; 3]; 3]) {
        let order = 2 * nodes;
        for j in 0..nodes {
            let [gx, gy] = point.gradients[j];
            // The stress that a unit displacement of either component causes.
            let x = [0, 1, 2].map(|r| c[r][0] * gx + c[r][2] * gy);
            let y = [0, 1, 2].map(|r| c[r][1] * gy + c[r][2] * gx);
            for i in j..nodes {
                let [gx, gy] = point.gradients[i];
                for (column, s) in [(2 * j, x), (2 * j + 1, y)] {
                    let k = &mut self.values[2 * i * order + column..];
                    k[0] += point.weight * (gx * s[0] + gy * s[2]);
                    k[order] += point.weight * (gy * s[1] + gx * s[2]);
                }
            }
        }
    }
}

/// (σ_1 ≥ σ_2 ≥ σ_3) of a stress (XX, YY, ZZ, XY, 0, 0): by Mohr's circle, and the stress across the
/// plane.
pub fn principal_stresses(s: &[f64; 6]) -> [f64; 3] {
    let (center, radius) = (0.5 * (s[0] + s[1]), (0.5 * (s[0] - s[1])).hypot(s[3]));
    let mut values = [center + radius, center - radius, s[2]];
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
mod tests {
    use contact_dd_partition::element::ElementKind;

    use super::*;

    const C: [[f64; 3]; 3] = [[3.0, 1.0, 0.2], [1.0, 2.5, -0.1], [0.2, -0.1, 0.9]];

    fn material() -> Material {
        Material {
            name: "m".into(),
            stiffness: C.into(),
            out_of_plane: Some([0.3, 0.4, 0.5]),
            poisson: None,
        }
    }

    /// A cell of no special shape, its edges curved where they can be.
    fn points(kind: ElementKind) -> Vec<[f64; 3]> {
        let nodes = kind.node_coordinates().iter();
        nodes
            .map(|&[x, y, _]| {
                [
                    0.2 + 1.1 * x + 0.3 * y + 0.1 * y * y,
                    0.1 + 1.6 * y - 0.2 * x * y,
                    0.0,
                ]
            })
            .collect()
    }

    fn stiffness(kind: ElementKind) -> ElementMatrix {
        let mut k = ElementMatrix::default();
        k.set(&kind, &points(kind), &C.into());
        k
    }

    #[test]
    fn there_is_room_for_every_kind() {
        assert!(ElementKind::of_dim(2).all(|kind| kind.nodes() <= MAX_NODES));
    }

    #[test]
    fn a_linear_displacement_has_its_own_strain() {
        for kind in ElementKind::of_dim(2) {
            let points = points(kind);
            let u: Vec<f64> = (points.iter())
                .flat_map(|x| [0.1 * x[0] + 0.2 * x[1], -0.3 * x[0] + 0.4 * x[1]])
                .collect();
            for point in stiffness_points(&kind, &points) {
                let e = strain(&point, &u);
                for (e, exact) in e.iter().zip([0.1, 0.4, -0.1]) {
                    assert!((e - exact).abs() < 1e-14, "{kind:?}");
                }
            }
        }
    }

    #[test]
    fn stiffness_is_symmetric_and_rigid_motions_cost_nothing() {
        for kind in ElementKind::of_dim(2) {
            let k = stiffness(kind);
            let rotation: Vec<f64> = points(kind).iter().flat_map(|x| [-x[1], x[0]]).collect();
            for (i, row) in k.rows().enumerate() {
                let force: f64 = row.iter().zip(&rotation).map(|(k, u)| k * u).sum();
                let push: f64 = row.iter().step_by(2).sum();
                assert!(force.abs() < 1e-13 && push.abs() < 1e-13, "{kind:?}");
                assert!(k.rows().zip(row).all(|(column, k)| column[i] == *k));
            }
        }
    }

    /// ∫ Bᵀ σ for a uniform stress is ∮ N σ n, with nothing at nodes inside.
    #[test]
    fn the_forces_of_a_uniform_stress_are_its_tractions_on_the_edges() {
        for kind in ElementKind::of_dim(2) {
            let (k, at) = (stiffness(kind), points(kind));
            let u: Vec<f64> = (at.iter())
                .flat_map(|x| [0.1 * x[0] + 0.2 * x[1], -0.3 * x[0] + 0.4 * x[1]])
                .collect();
            let s = stress(&material(), PlaneState::Strain, &[0.1, 0.4, -0.1]);
            let mut exact = vec![0.0; u.len()];
            for (facet, local) in kind.facets() {
                let on: Vec<_> = local.iter().map(|&i| at[i]).collect();
                for (xi, weight) in facet.quadrature(7) {
                    let n = facet.area_vector(&on, xi);
                    let traction = [s[0] * n[0] + s[3] * n[1], s[3] * n[0] + s[1] * n[1]];
                    for (&i, shape) in local.iter().zip(facet.shape(xi)) {
                        exact[2 * i] += weight * shape * traction[0];
                        exact[2 * i + 1] += weight * shape * traction[1];
                    }
                }
            }
            for (row, exact) in k.rows().zip(&exact) {
                let force: f64 = row.iter().zip(&u).map(|(k, u)| k * u).sum();
                assert!((force - exact).abs() < 1e-13, "{kind:?}");
            }
        }
    }

    #[test]
    fn the_energy_is_half_stress_times_strain_times_area() {
        for kind in ElementKind::of_dim(2) {
            let u: Vec<f64> = (0..2 * kind.nodes())
                .map(|i| (1.7 * i as f64).sin())
                .collect();
            let k = stiffness(kind);
            let forces = k
                .rows()
                .map(|row| row.iter().zip(&u).map(|(k, u)| k * u).sum::<f64>());
            let energy: f64 = forces.zip(&u).map(|(force, u)| force * u).sum();
            let exact: f64 = stiffness_points(&kind, &points(kind))
                .map(|point| {
                    let e = strain(&point, &u);
                    let s = stress(&material(), PlaneState::Strain, &e);
                    point.weight * (s[0] * e[0] + s[1] * e[1] + s[3] * e[2])
                })
                .sum();
            assert!((energy - exact).abs() < 1e-12 * exact, "{kind:?}");
        }
    }

    #[test]
    fn principal_stresses_and_von_mises_of_known_states() {
        let shear = [0.0, 0.0, 0.0, 2.0, 0.0, 0.0];
        let exact = [2.0, 0.0, -2.0];
        for (s, e) in principal_stresses(&shear).iter().zip(exact) {
            assert!((s - e).abs() < 1e-15);
        }
        assert!((von_mises(&shear) - 2.0 * 3f64.sqrt()).abs() < 1e-15);
        assert_eq!(von_mises(&[5.0, 5.0, 5.0, 0.0, 0.0, 0.0]), 0.0);
    }
}
