//! Elements compared with exact results for linear displacements and uniform stresses.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::element::geometry::cross;

use contact_dd_partition::model::Formulation;

use super::*;

const C: [[f64; 3]; 3] = [[3.0, 1.0, 0.2], [1.0, 2.5, -0.1], [0.2, -0.1, 0.9]];
/// ∂u_i/∂x_j, and its strain in the plane and in space.
const SLOPES: [[f64; 3]; 3] = [[0.1, 0.2, -0.5], [-0.3, 0.4, 0.6], [0.7, -0.8, 0.9]];
const PLANE_STRAIN: [f64; 6] = [0.1, 0.4, -0.1, 0.0, 0.0, 0.0];
const STRAIN: [f64; 6] = [0.1, 0.4, 0.9, -0.2, 0.2, -0.1];

fn material(dim: usize) -> Material {
    let solid: [[f64; 6]; 6] = from_fn(|i| {
        from_fn(|j| 0.1 * ((i * j) as f64).cos() + if i == j { 2.0 + i as f64 } else { 0.0 })
    });
    Material {
        name: "m".into(),
        stiffness: if dim == 2 { C.into() } else { solid.into() },
        out_of_plane: Some([0.3, 0.4, 0.5]),
        poisson: None,
        formulation: Formulation::Full,
    }
}

fn plane(kind: ElementKind) -> Option<PlaneState> {
    (kind.dim() == 2).then_some(PlaneState::Strain)
}

fn size(kind: ElementKind) -> usize {
    if kind.dim() == 2 { 3 } else { 6 }
}

fn cells() -> impl Iterator<Item = ElementKind> {
    [2, 3].into_iter().flat_map(ElementKind::of_dim)
}

/// A cell of irregular shape, with curved edges if its kind has them.
fn points(kind: ElementKind) -> Vec<[f64; 3]> {
    let nodes = kind.node_coordinates().iter();
    nodes
        .map(|&[x, y, z]| {
            [
                0.2 + 1.1 * x + 0.3 * y + 0.1 * y * y + 0.2 * z,
                0.1 + 1.6 * y - 0.2 * x * y + 0.05 * z * z,
                z * (1.2 + 0.1 * x - 0.1 * y),
            ]
        })
        .collect()
}

fn stiffness(kind: ElementKind) -> ElementMatrix {
    let mut k = ElementMatrix::default();
    k.set(&kind, &points(kind), &material(kind.dim()));
    k
}

/// The displacements with [`SLOPES`].
fn linear(kind: ElementKind) -> Vec<f64> {
    let dim = kind.dim();
    let at = |x: &[f64; 3]| {
        let x = *x;
        (0..dim).map(move |i| (0..dim).map(|j| SLOPES[i][j] * x[j]).sum())
    };
    points(kind).iter().flat_map(at).collect()
}

#[test]
fn there_is_room_for_every_kind() {
    for (dim, most) in [(2, MAX_PLANE_NODES), (3, MAX_NODES)] {
        assert!(ElementKind::of_dim(dim).all(|kind| kind.nodes() <= most));
    }
}

#[test]
fn a_linear_displacement_has_its_own_strain() {
    for kind in cells() {
        let (points, u) = (points(kind), linear(kind));
        let exact = if kind.dim() == 2 {
            PLANE_STRAIN
        } else {
            STRAIN
        };
        for point in kind.stiffness_points() {
            let (e, _) = strain(point, &points, &u, size(kind));
            for (e, exact) in e.iter().zip(exact) {
                assert!((e - exact).abs() < 1e-14, "{kind:?}");
            }
        }
    }
}

#[test]
fn stiffness_is_symmetric_and_rigid_motions_cost_nothing() {
    for kind in cells() {
        let (k, dim) = (stiffness(kind), kind.dim());
        let about = if dim == 2 {
            [0.0, 0.0, 1.0]
        } else {
            [0.3, -0.4, 1.0]
        };
        let rotation: Vec<f64> = (points(kind).iter())
            .flat_map(|&x| cross(about, x).into_iter().take(dim))
            .collect();
        for (i, row) in k.rows().enumerate() {
            let force: f64 = row.iter().zip(&rotation).map(|(k, u)| k * u).sum();
            let push: f64 = row.iter().step_by(dim).sum();
            assert!(force.abs() < 1e-12 && push.abs() < 1e-12, "{kind:?}");
            assert!(k.rows().zip(row).all(|(column, k)| column[i] == *k));
        }
    }
}

/// ∫ Bᵀ σ for a uniform stress is ∮ N σ n, 0 at interior nodes.
#[test]
fn the_forces_of_a_uniform_stress_are_its_tractions_on_the_facets() {
    for kind in cells() {
        let (k, at, dim) = (stiffness(kind), points(kind), kind.dim());
        let u = linear(kind);
        let of = if dim == 2 { &PLANE_STRAIN } else { &STRAIN };
        let [xx, yy, zz, xy, yz, xz] = stress(&material(dim), plane(kind), of);
        let mut exact = vec![0.0; u.len()];
        for (facet, local) in kind.facets() {
            let on: Vec<_> = local.iter().map(|&i| at[i]).collect();
            for (xi, weight) in facet.quadrature(7) {
                let [nx, ny, nz] = facet.area_vector(&on, xi);
                let traction = [
                    xx * nx + xy * ny + xz * nz,
                    xy * nx + yy * ny + yz * nz,
                    xz * nx + yz * ny + zz * nz,
                ];
                for (&i, shape) in local.iter().zip(facet.shape(xi)) {
                    for (component, traction) in traction.iter().enumerate().take(dim) {
                        exact[dim * i + component] += weight * shape * traction;
                    }
                }
            }
        }
        for (row, exact) in k.rows().zip(&exact) {
            let force: f64 = row.iter().zip(&u).map(|(k, u)| k * u).sum();
            assert!((force - exact).abs() < 1e-12, "{kind:?}: {force} {exact}");
        }
    }
}

#[test]
fn the_energy_is_half_stress_times_strain_times_measure() {
    for kind in cells() {
        let material = material(kind.dim());
        let u: Vec<f64> = (0..kind.dim() * kind.nodes())
            .map(|i| (1.7 * i as f64).sin())
            .collect();
        let k = stiffness(kind);
        let forces = k
            .rows()
            .map(|row| row.iter().zip(&u).map(|(k, u)| k * u).sum::<f64>());
        let energy: f64 = forces.zip(&u).map(|(force, u)| force * u).sum();
        let exact: f64 = (kind.stiffness_points().iter())
            .map(|point| {
                let (e, weight) = strain(point, &points(kind), &u, size(kind));
                weight * product(&voigt_stress(&material, &e), &e)
            })
            .sum();
        assert!((energy - exact).abs() < 1e-12 * exact, "{kind:?}");
    }
}

#[test]
fn principal_stresses_and_von_mises_of_known_states() {
    for place in 3..6 {
        let mut shear = [0.0; 6];
        shear[place] = 2.0;
        for (s, e) in principal_stresses(&shear).iter().zip([2.0, 0.0, -2.0]) {
            assert!((s - e).abs() < 1e-15);
        }
        assert!((von_mises(&shear) - 2.0 * 3f64.sqrt()).abs() < 1e-15);
    }
    assert_eq!(von_mises(&[5.0, 5.0, 5.0, 0.0, 0.0, 0.0]), 0.0);
}

/// Two points in each direction sample 3 strain components each in the plane and 6 in space.
#[test]
fn a_reduced_integration_leaves_as_many_motions_without_energy_as_it_has_too_few_points() {
    for kind in cells() {
        let material = Material {
            formulation: Formulation::Reduced,
            ..material(kind.dim())
        };
        let mut k = ElementMatrix::default();
        k.set(&kind, &points(kind), &material);
        let order = kind.dim() * kind.nodes();
        let expected = match (kind.dim(), kind.nodes()) {
            (2, 8) => order - 4 * 3,
            (3, 20) => order - 8 * 6,
            (2, _) => 3,
            _ => 6,
        };
        let matrix = DMatrix::from_fn(order, order, |i, j| k.row(i)[j]);
        let values = matrix.symmetric_eigenvalues();
        let most = values.max();
        let free = values
            .iter()
            .filter(|value| value.abs() < 1e-10 * most)
            .count();
        assert_eq!(free, expected, "{kind:?}");
    }
}
