//! An exact field of stress: the loads that it asks for, and how far a solution is from it.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::model::Model;
use nalgebra::{DMatrix, DVector};

use super::super::isoparametric::{gradients, shapes};
use super::super::solution::Solution;

/// Gauss's rule of six points on [−1, 1].
const GAUSS: [(f64, f64); 6] = [
    (-0.932_469_514_203_152, 0.171_324_492_379_170),
    (-0.661_209_386_466_265, 0.360_761_573_048_139),
    (-0.238_619_186_083_197, 0.467_913_934_572_691),
    (0.238_619_186_083_197, 0.467_913_934_572_691),
    (0.661_209_386_466_265, 0.360_761_573_048_139),
    (0.932_469_514_203_152, 0.171_324_492_379_170),
];

/// A field of stress.
pub enum Exact {
    /// (σ_xx, σ_yy, σ_xy).
    Plane(Box<dyn Fn([f64; 2]) -> [f64; 3]>),
    /// (σ_xx, σ_yy, σ_zz, σ_xy) around an axis.
    Ring(Box<dyn Fn([f64; 2]) -> [f64; 4]>),
}

/// N, ∂N/∂ξ and the weight at a point of a reference cell.
type Sample = (Vec<f64>, Vec<[f64; 3]>, f64);

fn samples(kind: ElementKind) -> Vec<Sample> {
    let pairs = GAUSS.iter().flat_map(|a| GAUSS.iter().map(move |b| (a, b)));
    let at = pairs.map(|(a, b)| match kind.corners() {
        // A square whose upper side becomes a corner.
        3 => {
            let [s, t] = [0.5 * (1.0 + a.0), 0.5 * (1.0 + b.0)];
            ([s * (1.0 - t), t, 0.0], 0.25 * a.1 * b.1 * (1.0 - t))
        }
        _ => ([a.0, b.0, 0.0], a.1 * b.1),
    });
    at.map(|(xi, weight)| (shapes(kind, xi), gradients(kind, xi), weight))
        .collect()
}

impl Exact {
    /// σ at a point in Voigt's order.
    pub fn at(&self, x: [f64; 2]) -> DVector<f64> {
        match self {
            Self::Plane(stress) => DVector::from_column_slice(&stress(x)),
            Self::Ring(stress) => DVector::from_column_slice(&stress(x)),
        }
    }

    /// What a unit of area or length stands for.
    fn around(&self, x: [f64; 2]) -> f64 {
        match self {
            Self::Plane(_) => 1.0,
            Self::Ring(_) => 2.0 * PI * x[0],
        }
    }

    /// ‖σ_h − σ‖ over ‖σ‖, both in the norm of C⁻¹, σ_h by the displacements of the solution.
    pub fn energy_error(&self, model: &Model, solution: &Solution) -> f64 {
        let mesh = &model.mesh;
        let mut rules: BTreeMap<ElementKind, Vec<Sample>> = BTreeMap::new();
        let (mut error, mut energy) = (0.0, 0.0);
        for ((kind, nodes), &material) in mesh.cells.iter().zip(&model.cell_material) {
            let stiffness = &model.materials[material as usize].stiffness;
            let size = stiffness.size();
            let stiffness = DMatrix::from_fn(size, size, |i, j| stiffness[i][j]);
            let compliance = stiffness.clone().try_inverse().unwrap();
            let at: Vec<[f64; 3]> = nodes.iter().map(|&n| mesh.points[n as usize]).collect();
            let displaced = nodes
                .iter()
                .map(|&n| solution.displacement[&mesh.node_tags[n as usize]]);
            let displaced: Vec<[f64; 3]> = displaced.collect();
            for (shape, slopes, weight) in rules.entry(kind).or_insert_with(|| samples(kind)) {
                let along = |of: &[[f64; 3]], i: usize, k: usize| -> f64 {
                    of.iter().zip(slopes.iter()).map(|(v, g)| v[i] * g[k]).sum()
                };
                let [a, b, c, d] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, k)| along(&at, i, k));
                let det = a * d - b * c;
                let slope = |i: usize| {
                    let (s, t) = (along(&displaced, i, 0), along(&displaced, i, 1));
                    [(d * s - c * t) / det, (a * t - b * s) / det]
                };
                let ([xx, xy], [yx, yy]) = (slope(0), slope(1));
                let x = [0, 1].map(|i| at.iter().zip(shape.iter()).map(|(p, n)| p[i] * n).sum());
                let stress = self.at(x);
                let strain = &compliance * &stress;
                let found = match self {
                    Self::Plane(_) => DVector::from_column_slice(&[xx, yy, xy + yx]),
                    Self::Ring(_) => {
                        let radial = displaced.iter().zip(shape.iter()).map(|(u, n)| u[0] * n);
                        let hoop = radial.sum::<f64>() / x[0];
                        DVector::from_column_slice(&[xx, yy, hoop, xy + yx])
                    }
                };
                let difference = found - &strain;
                let weight = *weight * det.abs() * self.around(x);
                error += weight * difference.dot(&(&stiffness * &difference));
                energy += weight * strain.dot(&stress);
            }
        }
        (error / energy).sqrt()
    }

    /// Adds the tractions that this stress exerts on groups of facets, each of which faces a
    /// direction.
    pub fn load(&self, model: &mut Model, sides: &[(&str, [f64; 2])]) {
        let mut forces: BTreeMap<u32, [f64; 3]> = model.forces.iter().copied().collect();
        for (group, outward) in sides {
            for &facet in &model.mesh.groups[*group].members {
                let nodes = model.mesh.facets.nodes_of(facet as usize);
                let at: Vec<[f64; 3]> =
                    (nodes.iter().map(|&n| model.mesh.points[n as usize])).collect();
                for (s, weight) in GAUSS {
                    let (shape, slope) = line(nodes.len(), s);
                    let sum = |by: &[f64], i: usize| -> f64 {
                        at.iter().zip(by).map(|(p, n)| p[i] * n).sum()
                    };
                    let (tx, ty) = (sum(&slope, 0), sum(&slope, 1));
                    let side = (ty * outward[0] - tx * outward[1]).signum() * weight;
                    let x = [sum(&shape, 0), sum(&shape, 1)];
                    let side = side * self.around(x);
                    let (nx, ny) = (side * ty, -side * tx);
                    let stress = self.at(x);
                    let (xx, yy, xy) = (stress[0], stress[1], stress[stress.len() - 1]);
                    for (&node, n) in nodes.iter().zip(&shape) {
                        let force = forces.entry(node).or_default();
                        force[0] += n * (xx * nx + xy * ny);
                        force[1] += n * (xy * nx + yy * ny);
                    }
                }
            }
        }
        model.forces = forces.into_iter().collect();
    }
}

/// N and dN/dξ of a line of two or three nodes, the third in its middle.
fn line(nodes: usize, s: f64) -> (Vec<f64>, Vec<f64>) {
    match nodes {
        2 => (vec![0.5 * (1.0 - s), 0.5 * (1.0 + s)], vec![-0.5, 0.5]),
        _ => (
            vec![0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s * s],
            vec![s - 0.5, s + 0.5, -2.0 * s],
        ),
    }
}
