use std::f64::consts::PI;

use contact_dd_partition::crack_tip::FaceFacet;
use contact_dd_partition::element::{ElementKind, Elements};
use contact_dd_partition::model::Formulation;
use contact_dd_partition::problem::Subdomain;
use contact_dd_partition::quantity::NodalShares;
use nalgebra::Vector2;

use super::*;

/// Number of rings and sectors around a tip.
const RINGS: usize = 24;
const SECTORS: usize = 40;

/// A tip whose crack points in the direction of 30°, with a disc of 1 m around (2, 1).
fn tip() -> CrackTip {
    let (sin, cos) = (PI / 6.0).sin_cos();
    let ring = |i: usize| i as f64 / RINGS as f64;
    let node = |i: usize, j: usize| match i {
        0 => 0,
        _ => (1 + (i - 1) * (SECTORS + 1) + j) as i64,
    };
    let facets = [0, SECTORS].into_iter().flat_map(|j| {
        (0..RINGS).map(move |i| FaceFacet {
            is_upper: j > 0,
            nodes: [node(i, j), node(i + 1, j), -1],
            distances: [ring(i), ring(i + 1), ring(i + 1)],
        })
    });
    CrackTip {
        name: "tip".into(),
        tag: 0,
        body: 0,
        material: 0,
        position: [2.0, 1.0, 0.0],
        direction: [cos, sin, 0.0],
        radius: 0.9,
        facets: facets.collect(),
    }
}

/// Rings of quadrilaterals around the tip, with triangles in the innermost one; tags are node numbers.
fn block(tip: &CrackTip) -> Block {
    let mut points = vec![tip.position];
    for i in 1..=RINGS {
        for j in 0..=SECTORS {
            let angle = 2.0 * PI * j as f64 / SECTORS as f64 - PI + PI / 6.0;
            let radius = i as f64 / RINGS as f64;
            points.push([2.0 + radius * angle.cos(), 1.0 + radius * angle.sin(), 0.0]);
        }
    }
    let mut cells = Elements::default();
    let node = |i: usize, j: usize| (1 + (i - 1) * (SECTORS + 1) + j) as u32;
    for j in 0..SECTORS {
        cells.push(ElementKind::Triangle3, &[0, node(1, j), node(1, j + 1)]);
        for i in 1..RINGS {
            let corners = [
                node(i, j),
                node(i + 1, j),
                node(i + 1, j + 1),
                node(i, j + 1),
            ];
            cells.push(ElementKind::Quad4, &corners);
        }
    }
    Block {
        subdomain: Subdomain {
            index: 0,
            body: 0,
            node_tags: (0..points.len() as i64).collect(),
            cell_material: vec![0; cells.len()],
            points,
            cells,
            supports: Vec::new(),
            springs: Vec::new(),
            forces: Vec::new(),
            initial_stress: InitialStress::default(),
            interface: Vec::new(),
            shares: NodalShares::default(),
            steps: Vec::new(),
            reference_nodes: 0,
            auxiliary_nodes: 0,
        },
        interface: Vec::new(),
        slides: BTreeMap::new(),
        dim: 2,
    }
}

fn material(values: [[f64; 3]; 3]) -> Material {
    Material {
        name: "test".into(),
        stiffness: values.into(),
        out_of_plane: None,
        poisson: None,
        formulation: Formulation::Full,
    }
}

fn isotropic() -> Material {
    material([[3.0, 1.0, 0.0], [1.0, 3.0, 0.0], [0.0, 0.0, 1.0]])
}

fn orthotropic() -> Material {
    material([[9.0, 1.0, 0.0], [1.0, 3.0, 0.0], [0.0, 0.0, 0.8]])
}

/// K of a plane displacement field, for all radii.
fn factors(
    material: &Material,
    u: impl Fn(&TipDisc<'_>, [f64; 2]) -> [f64; 2],
    initial: impl Fn([f64; 2]) -> [f64; 6],
) -> [Vector2<f64>; RADII.len()] {
    let tip = tip();
    let block = block(&tip);
    let disc = TipDisc::new(&tip, material).unwrap();
    let points = block.points().iter();
    let u = points.clone().flat_map(|x| u(&disc, [x[0], x[1]]));
    let u: Vec<f64> = u.collect();
    let initial = InitialStress {
        cells: Vec::new(),
        nodes: points.map(|x| initial([x[0], x[1]])).collect(),
    };
    let integrals = disc.integrals(&block, &u, &initial).unwrap();
    let h = disc.field.compliance().try_inverse().unwrap();
    integrals.map(|m| 0.5 * h * Vector2::from(m))
}

#[test]
fn uniform_stress_with_its_tractions_on_the_faces_and_turned_bodies_have_none() {
    let none = |_: [f64; 2]| [0.0; 6];
    for material in [isotropic(), orthotropic()] {
        for gradient in [
            [[1.0, 0.0], [0.0, 0.0]],
            [[0.0, 0.0], [0.0, 1.0]],
            [[0.0, 1.0], [1.0, 0.0]],
            [[0.0, 1.0], [-1.0, 0.0]],
        ] {
            let u = |_: &TipDisc<'_>, x: [f64; 2]| {
                gradient.map(|of: [f64; 2]| of[0] * x[0] + of[1] * x[1])
            };
            let k = factors(&material, u, none);
            assert!(k.iter().all(|k| k.norm() < 2e-3), "{gradient:?}: {k:?}");
        }
        let stress = |_: [f64; 2]| [1.0, -2.0, 0.0, 0.5, 0.0, 0.0];
        let k = factors(&material, |_, _| [0.0; 2], stress);
        assert!(k.iter().all(|k| k.norm() < 2e-3), "{k:?}");
    }
}

#[test]
fn what_expands_freely_has_none() {
    // u of a temperature proportional to x, with isotropic thermal expansion: ε = x, no shear.
    let u = |_: &TipDisc<'_>, [x, y]: [f64; 2]| [0.5 * (x * x - y * y), x * y];
    let material = isotropic();
    let stress = |[x, _]: [f64; 2]| [-4.0 * x, -4.0 * x, 0.0, 0.0, 0.0, 0.0];
    let k = factors(&material, u, stress);
    assert!(k.iter().all(|k| k.norm() < 5e-3), "{k:?}");
}

/// Arbitrary displacements, also with cells that have incompatible modes.
#[test]
fn weights_times_displacements_are_the_integral() {
    let tip = tip();
    let block = block(&tip);
    let points = block.points().iter();
    let u = points
        .clone()
        .map(|x| [(7.0 * x[0] + x[1]).sin(), (5.0 * x[1] * x[0]).cos()]);
    let u: Vec<f64> = u.flatten().collect();
    let initial = InitialStress {
        cells: Vec::new(),
        nodes: points.map(|x| [x[0], 2.0, 0.0, x[1], 0.0, 0.0]).collect(),
    };
    for formulation in [Formulation::Full, Formulation::IncompatibleModes] {
        let material = Material {
            formulation,
            ..orthotropic()
        };
        let disc = TipDisc::new(&tip, &material).unwrap();
        let [expected, ..] = disc.integrals(&block, &u, &initial).unwrap();
        let found = disc.weights(&block, &initial).unwrap();
        for (mode, expected) in expected.into_iter().enumerate() {
            let products = found.of_nodes[mode].iter().zip(&u);
            let sum: f64 = products.map(|(weight, u)| weight * u).sum();
            let off = sum + found.constants[mode] - expected;
            assert!(
                off.abs() < 1e-11 * expected.abs(),
                "{off:e} of {expected:e}"
            );
        }
    }
}

#[test]
fn lower_degrees_integrate_near_fields_as_well_far_from_the_tip() {
    let field = NearField::new(Matrix3::from_row_slice(isotropic().stiffness.values())).unwrap();
    for kind in [ElementKind::Triangle3, ElementKind::Triangle6] {
        for size in [0.01, 0.039, 0.119] {
            for turn in 0..12 {
                let angle = 0.1 + PI * f64::from(turn) / 6.0;
                let (sin, cos) = angle.sin_cos();
                let corner = |[x, y]: [f64; 2]| LocalNode {
                    place: [cos + size * x, sin + size * y],
                    q: [0.0; RADII.len()],
                    work: Default::default(),
                };
                let far = [0.5 * cos.signum(), 0.8 * sin.signum()];
                let corners = [[0.0, 0.0], [far[0], 0.0], far];
                let middles = [[0, 1], [1, 2], [2, 0]].map(|[a, b]: [usize; 2]| {
                    [0, 1].map(|k| 0.5 * (corners[a][k] + corners[b][k]))
                });
                let all = corners.iter().chain(&middles).take(kind.nodes());
                let nodes: Vec<LocalNode> = all.map(|&x| corner(x)).collect();
                let points: Vec<[f64; 3]> = (nodes.iter())
                    .map(|of| [of.place[0], of.place[1], 0.0])
                    .collect();
                let cell = LocalCell {
                    kind,
                    has_modes: false,
                    numbers: (0..nodes.len()).collect(),
                    nodes: nodes.iter().collect(),
                    points: points.clone(),
                    initial: Vec::new(),
                };
                assert!(cell.degree() < DEGREE, "{size}");
                let mean = |degree: usize| {
                    let mut sum = [0.0; 8];
                    for point in kind.tabulate(degree) {
                        let at = |k: usize| -> f64 {
                            point.shape.iter().zip(&points).map(|(n, x)| n * x[k]).sum()
                        };
                        let [x, y] = [at(0), at(1)];
                        let both = field.gradients(x.hypot(y), y.atan2(x));
                        let values = both.as_flattened().as_flattened();
                        for (sum, value) in sum.iter_mut().zip(values) {
                            *sum += 2.0 * point.weight * value;
                        }
                    }
                    sum
                };
                let (exact, lower) = (mean(10), mean(cell.degree()));
                let size = exact.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                for (exact, lower) in exact.iter().zip(lower) {
                    assert!((exact - lower).abs() < 2e-6 * size, "{kind:?}");
                }
            }
        }
    }
}
