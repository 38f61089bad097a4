//! An exact stress field: the loads that it requires, and a solution's distance from it.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::element::geometry::{cross, dot, padded};
use contact_dd_partition::model::Model;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::super::isoparametric::{gradients, shapes};
use super::super::solution::Solution;

/// Gauss's rule of six points on [−1, 1].
const SIX: [(f64, f64); 6] = [
    (-0.932_469_514_203_152, 0.171_324_492_379_170),
    (-0.661_209_386_466_265, 0.360_761_573_048_139),
    (-0.238_619_186_083_197, 0.467_913_934_572_691),
    (0.238_619_186_083_197, 0.467_913_934_572_691),
    (0.661_209_386_466_265, 0.360_761_573_048_139),
    (0.932_469_514_203_152, 0.171_324_492_379_170),
];

/// Gauss's rule of four points.
const FOUR: [(f64, f64); 4] = [
    (-0.861_136_311_594_053, 0.347_854_845_137_454),
    (-0.339_981_043_584_856, 0.652_145_154_862_546),
    (0.339_981_043_584_856, 0.652_145_154_862_546),
    (0.861_136_311_594_053, 0.347_854_845_137_454),
];

/// A field of stress.
pub enum Exact {
    /// (σ_xx, σ_yy, σ_xy).
    Plane(Box<dyn Fn([f64; 2]) -> [f64; 3]>),
    /// (σ_xx, σ_yy, σ_zz, σ_xy) around an axis.
    Ring(Box<dyn Fn([f64; 2]) -> [f64; 4]>),
    /// (σ_xx, σ_yy, σ_zz, σ_yz, σ_xz, σ_xy).
    Space(Box<dyn Fn([f64; 3]) -> [f64; 6]>),
}

/// N, ∂N/∂ξ and the weight at a point of a reference cell or facet.
type Sample = (Vec<f64>, Vec<[f64; 3]>, f64);

/// Points of the cube, or of the face or edge of it that remains in lower dimensions.
fn samples(kind: ElementKind) -> Vec<Sample> {
    let rule: &[(f64, f64)] = if kind.dim() == 3 { &FOUR } else { &SIX };
    let mut points = vec![([0.0; 3], 1.0)];
    for axis in 0..kind.dim() {
        let finer = points.iter().flat_map(|&(mut at, weight)| {
            rule.iter().map(move |&(x, w)| {
                at[axis] = x;
                (at, weight * w)
            })
        });
        points = finer.collect();
    }
    let at = points.into_iter().map(|(at, weight)| {
        let [s, t, r] = at.map(|c| 0.5 * (1.0 + c));
        match (kind.dim(), kind.corners()) {
            // Upper faces collapse to an edge and a corner.
            (2, 3) => ([s * (1.0 - t), t, 0.0], 0.25 * weight * (1.0 - t)),
            (3, 4) => {
                let (left, far) = (1.0 - r, (1.0 - t) * (1.0 - r));
                ([s * far, t * left, r], 0.125 * weight * far * left)
            }
            _ => (at, weight),
        }
    });
    at.map(|(xi, weight)| (shapes(kind, xi), gradients(kind, xi), weight))
        .collect()
}

/// Σ N v.
fn sum(of: &[[f64; 3]], shape: &[f64]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (v, n) in of.iter().zip(shape) {
        (0..3).for_each(|i| sum[i] += v[i] * n);
    }
    sum
}

/// Σ v ⊗ ∂N/∂ξ.
fn slope(of: &[[f64; 3]], slopes: &[[f64; 3]]) -> [[f64; 3]; 3] {
    let mut sum = [[0.0; 3]; 3];
    for (v, g) in of.iter().zip(slopes) {
        (0..9).for_each(|k| sum[k / 3][k % 3] += v[k / 3] * g[k % 3]);
    }
    sum
}

fn matrix(rows: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| rows[i][j])
}

impl Exact {
    /// σ at a point in Voigt's order.
    pub fn at(&self, [x, y, z]: [f64; 3]) -> DVector<f64> {
        match self {
            Self::Plane(stress) => DVector::from_column_slice(&stress([x, y])),
            Self::Ring(stress) => DVector::from_column_slice(&stress([x, y])),
            Self::Space(stress) => DVector::from_column_slice(&stress([x, y, z])),
        }
    }

    /// σ n.
    fn traction(&self, x: [f64; 3], n: [f64; 3]) -> [f64; 3] {
        let stress = self.at(x);
        let shears = match self {
            Self::Space(_) => [stress[3], stress[4], stress[5]],
            _ => [0.0, 0.0, stress[stress.len() - 1]],
        };
        let [yz, xz, xy] = shears;
        let (xx, yy, zz) = (stress[0], stress[1], stress[2]);
        [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|row| dot(row, n))
    }

    /// Length around the axis at a point of a ring, else 1.
    fn around(&self, x: [f64; 3]) -> f64 {
        match self {
            Self::Ring(_) => 2.0 * PI * x[0],
            _ => 1.0,
        }
    }

    /// The strain of a displacement gradient in Voigt's order; around an axis with `hoop`, the radial displacement over
    /// the radius.
    fn strain(&self, h: &Matrix3<f64>, hoop: f64) -> DVector<f64> {
        let shear = |i, j| h[(i, j)] + h[(j, i)];
        let (xx, yy, zz) = (h[(0, 0)], h[(1, 1)], h[(2, 2)]);
        DVector::from_vec(match self {
            Self::Plane(_) => vec![xx, yy, shear(0, 1)],
            Self::Ring(_) => vec![xx, yy, hoop, shear(0, 1)],
            Self::Space(_) => vec![xx, yy, zz, shear(1, 2), shear(0, 2), shear(0, 1)],
        })
    }

    /// ‖σ_h − σ‖ over ‖σ‖, both in the norm of C⁻¹, with σ_h from the displacements of the solution.
    pub fn energy_error(&self, model: &Model, solution: &Solution) -> f64 {
        let mesh = &model.mesh;
        let mut rules: BTreeMap<ElementKind, Vec<Sample>> = BTreeMap::new();
        let inverses: Vec<_> = (model.materials.iter())
            .map(|material| {
                let size = material.stiffness.size();
                let stiffness = DMatrix::from_fn(size, size, |i, j| material.stiffness[i][j]);
                (stiffness.clone(), stiffness.try_inverse().unwrap())
            })
            .collect();
        let (mut error, mut energy) = (0.0, 0.0);
        for ((kind, nodes), &material) in mesh.cells.iter().zip(&model.cell_material) {
            let (stiffness, compliance) = &inverses[material as usize];
            let at: Vec<[f64; 3]> = nodes.iter().map(|&n| mesh.points[n as usize]).collect();
            let displaced = nodes
                .iter()
                .map(|&n| solution.displacement[&mesh.node_tags[n as usize]]);
            let displaced: Vec<[f64; 3]> = displaced.collect();
            for (shape, slopes, weight) in rules.entry(kind).or_insert_with(|| samples(kind)) {
                let mut j = matrix(slope(&at, slopes));
                if mesh.dim == 2 {
                    j[(2, 2)] = 1.0;
                }
                let h = matrix(slope(&displaced, slopes)) * j.try_inverse().unwrap();
                let x = sum(&at, shape);
                let found = self.strain(&h, sum(&displaced, shape)[0] / x[0]);
                let stress = self.at(x);
                let strain = compliance * &stress;
                let difference = found - &strain;
                let weight = *weight * j.determinant().abs() * self.around(x);
                error += weight * difference.dot(&(stiffness * &difference));
                energy += weight * strain.dot(&stress);
            }
        }
        (error / energy).sqrt()
    }

    /// Adds the tractions of this stress to groups of facets, each facing one direction.
    pub fn load<const N: usize>(&self, model: &mut Model, sides: &[(&str, [f64; N])]) {
        let mesh = &model.mesh;
        let mut rules: BTreeMap<ElementKind, Vec<Sample>> = BTreeMap::new();
        let mut forces: BTreeMap<u32, [f64; 3]> = model.forces.iter().copied().collect();
        for (group, outward) in sides {
            for &facet in &mesh.groups[*group].members {
                let kind = mesh.facets.kind(facet as usize);
                let nodes = mesh.facets.nodes_of(facet as usize);
                let at: Vec<[f64; 3]> = nodes.iter().map(|&n| mesh.points[n as usize]).collect();
                for (shape, slopes, weight) in rules.entry(kind).or_insert_with(|| samples(kind)) {
                    let along = matrix(slope(&at, slopes));
                    let second = match kind.dim() {
                        1 => [0.0, 0.0, 1.0],
                        _ => Vector3::from(along.column(1)).into(),
                    };
                    let normal = cross(Vector3::from(along.column(0)).into(), second);
                    let x = sum(&at, shape);
                    let side = dot(normal, padded(outward)).signum() * *weight * self.around(x);
                    let traction = self.traction(x, normal.map(|c| side * c));
                    for (&node, n) in nodes.iter().zip(shape.iter()) {
                        let force = forces.entry(node).or_default();
                        (0..mesh.dim).for_each(|i| force[i] += n * traction[i]);
                    }
                }
            }
        }
        model.forces = forces.into_iter().collect();
    }
}
