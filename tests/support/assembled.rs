//! The discrete problem of a whole model, assembled independently of the program under test.
//!
//! ```text
//! K u + Dᵀ μ + Bᵀ λ + Tᵀ λ_t = f,   D u = v,   B u ≤ g
//! ```
//!
//! with a row of T for each condition that has friction.

use std::collections::BTreeMap;

use contact_dd_partition::contact_point::Law;
use contact_dd_partition::model::{Model, PlaneState};
use faer::sparse::Triplet;

use super::isoparametric::{Cell, Reference};
use super::random::Random;
use super::sparse_system::SparseSystem;
use super::twofold::Twofold;

/// Compliance of rows in the factorized matrix, relative to the largest entry of K: it makes dependent rows harmless,
/// and refinement against the system without it removes its effect.
const SLACK: f64 = 1e-13;

/// A row of a condition: dofs and coefficients.
pub type Row = Vec<(usize, f64)>;

/// A tangential row and its law.
pub struct Tangent {
    /// Number of the condition.
    pub condition: usize,
    pub row: Row,
    /// The direction.
    pub direction: [f64; 3],
    law: Law,
    area: f64,
}

/// Round-off with random signs: in the last digits of K's entries, and as forces up to this size.
#[derive(Clone, Copy, Debug)]
pub struct Disturbance {
    pub force: f64,
    pub seed: u64,
}

/// The condition along a tangent in a linear system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// No force.
    Free,
    /// A tangential jump of this value.
    Stuck(f64),
    /// A force of this value.
    Pushed(f64),
}

/// u, λ and λ_t.
pub struct Solved {
    pub u: Vec<f64>,
    pub forces: Vec<f64>,
    pub tangential: Vec<f64>,
}

/// K, f, D, v, B and g.
pub struct Assembled {
    pub dofs: usize,
    cells: Vec<Cell>,
    /// K by element, entries at the same position not yet added.
    pub stiffness: Vec<Triplet<usize, usize, f64>>,
    /// The largest entry of K: rows of D and B are multiplied by it, λ and μ divided.
    scale: f64,
    pub load: Vec<f64>,
    pub supports: Vec<(Row, f64)>,
    pub conditions: Vec<(Row, f64)>,
    pub tangents: Vec<Tangent>,
}

/// K u − f + Bᵀ λ + Tᵀ λ_t, and the sum of the absolute values of its terms.
pub struct Residual {
    pub value: Vec<f64>,
    pub terms: Vec<f64>,
}

impl Tangent {
    /// Slope and constant of its bound as a linear function of the normal force λ.
    pub fn bound(&self, closed: bool) -> (f64, f64) {
        match self.law {
            Law::Given { bound } => (0.0, bound * self.area),
            Law::Coulomb {
                coefficient,
                cohesion,
            } if closed => (coefficient, cohesion * self.area),
            _ => (0.0, 0.0),
        }
    }

    /// True if the bound doesn't depend on contact.
    pub fn is_given(&self) -> bool {
        matches!(self.law, Law::Given { .. })
    }

    /// The tangential jump of displacements u.
    pub fn jump(&self, u: &[f64]) -> f64 {
        product(&self.row, u)
    }
}

/// Σ c u(dof), with twice the digits of double precision.
fn product(row: &Row, u: &[f64]) -> f64 {
    let mut sum = Twofold::default();
    row.iter().for_each(|&(i, c)| sum.add_product(c, u[i]));
    sum.value()
}

impl Assembled {
    pub fn new(model: &Model) -> Self {
        let dim = model.mesh.dim;
        let row = |entries: &[(u32, [f64; 3])]| -> Row {
            let components = entries.iter().flat_map(|&(node, c)| {
                (0..dim).map(move |axis| (node as usize * dim + axis, c[axis]))
            });
            components.filter(|&(_, c)| c != 0.0).collect()
        };
        let cells = cells(model);
        let stiffness: Vec<_> = cells.iter().flat_map(Cell::entries).collect();
        let mut load = vec![0.0; dim * model.mesh.points.len()];
        for (node, force) in &model.forces {
            for axis in 0..dim {
                load[*node as usize * dim + axis] += force[axis];
            }
        }
        let conditions = model.contacts.iter().flat_map(|c| &c.points);
        let tangents =
            (conditions.clone().enumerate()).filter(|(_, point)| point.law.has_friction());
        let tangents = tangents.flat_map(|(condition, point)| {
            let directions = point.frame.tangents.iter().take(dim - 1);
            directions.map(move |&direction| Tangent {
                condition,
                row: row(&point.row_along(direction).collect::<Vec<_>>()),
                direction,
                law: point.law,
                area: point.area,
            })
        });
        Self {
            tangents: tangents.collect(),
            dofs: load.len(),
            scale: stiffness.iter().fold(0.0, |m, t| t.val.abs().max(m)),
            cells,
            stiffness,
            load,
            supports: (model.supports.iter())
                .map(|s| (row(&[(s.node, s.direction)]), s.value))
                .collect(),
            conditions: conditions
                .map(|c| (row(&c.row().collect::<Vec<_>>()), c.gap))
                .collect(),
        }
    }

    /// g − B u.
    pub fn gaps(&self, u: &[f64]) -> Vec<f64> {
        let left = |(row, gap): &(Row, f64)| {
            let mut sum = Twofold::default();
            sum.add(*gap);
            row.iter().for_each(|&(i, c)| sum.add_product(-c, u[i]));
            sum.value()
        };
        self.conditions.iter().map(left).collect()
    }

    /// K u.
    pub fn times(&self, u: &[f64]) -> Vec<f64> {
        let mut sums = vec![Twofold::default(); self.dofs];
        for t in &self.stiffness {
            sums[t.row].add_product(t.val, u[t.col]);
        }
        sums.iter().map(Twofold::value).collect()
    }

    /// uᵀ K u from the strains, so that a rigid part of u contributes nothing, however large it is.
    fn energy(&self, u: &[f64]) -> f64 {
        self.cells.iter().map(|cell| cell.energy(u)).sum()
    }

    /// ‖u − v‖ over ‖u‖ in the energy norm.
    pub fn energy_difference(&self, u: &[f64], v: &[f64]) -> f64 {
        // Squares of the smallest and largest loads would be 0 and infinite.
        let size = u.iter().fold(0.0, |m: f64, u| m.max(u.abs())).max(1e-300);
        let scaled: Vec<f64> = u.iter().map(|u| u / size).collect();
        let difference: Vec<f64> = u.iter().zip(v).map(|(u, v)| (u - v) / size).collect();
        let (difference, energy) = (self.energy(&difference), self.energy(&scaled));
        // The difference of two rigid motions has no energy.
        if difference == 0.0 {
            0.0
        } else {
            (difference / energy).sqrt()
        }
    }

    /// K u − f + Bᵀ λ + Tᵀ λ_t with twice the digits of double precision.
    pub fn residual(&self, u: &[f64], forces: &[f64], tangential: &[f64]) -> Residual {
        let mut sums = vec![Twofold::default(); self.dofs];
        let mut terms = vec![0.0; self.dofs];
        let mut add = |row: usize, a: f64, b: f64| {
            sums[row].add_product(a, b);
            terms[row] += (a * b).abs();
        };
        for t in &self.stiffness {
            add(t.row, t.val, u[t.col]);
        }
        for (dof, f) in self.load.iter().enumerate() {
            add(dof, -1.0, *f);
        }
        for ((row, _), force) in self.conditions.iter().zip(forces) {
            row.iter().for_each(|&(dof, c)| add(dof, c, *force));
        }
        for (tangent, force) in self.tangents.iter().zip(tangential) {
            (tangent.row.iter()).for_each(|&(dof, c)| add(dof, c, *force));
        }
        Residual {
            value: sums.iter().map(Twofold::value).collect(),
            terms,
        }
    }

    /// u and λ with the `closed` conditions and `equations` as equations and without the other conditions.
    pub fn solve(&self, closed: &[bool], equations: &[(Row, f64)]) -> (Vec<f64>, Vec<f64>) {
        let free = vec![Along::Free; self.tangents.len()];
        let solved = self.solve_along(closed, &free, equations, None);
        (solved.u, solved.forces)
    }

    /// The solution of that problem with conditions along the tangents. The `disturbed` data change it as much as
    /// round-off does at the scene's condition number.
    pub fn solve_along(
        &self,
        closed: &[bool],
        along: &[Along],
        equations: &[(Row, f64)],
        disturbed: Option<Disturbance>,
    ) -> Solved {
        let active: Vec<usize> = (0..closed.len()).filter(|&j| closed[j]).collect();
        let stuck: Vec<(usize, f64)> = (along.iter().enumerate())
            .filter_map(|(k, along)| match along {
                Along::Stuck(jump) => Some((k, *jump)),
                _ => None,
            })
            .collect();
        let fixed = self.supports.iter().chain(equations);
        let rows: Vec<(&Row, f64)> = (fixed.chain(active.iter().map(|&j| &self.conditions[j])))
            .map(|(row, value)| (row, *value))
            .chain(stuck.iter().map(|&(k, jump)| (&self.tangents[k].row, jump)))
            .collect();
        let n = self.dofs + rows.len();
        let mut entries = self.stiffness.clone();
        let mut rhs = self.load.clone();
        if let Some(Disturbance { force, seed }) = disturbed {
            let mut random = Random::new(seed);
            for entry in &mut entries {
                entry.val *= 1.0 + f64::EPSILON * random.signed();
            }
            for load in &mut rhs {
                *load += force * random.signed();
            }
        }
        for (k, (row, value)) in rows.iter().enumerate() {
            for &(dof, c) in *row {
                entries.push(Triplet::new(self.dofs + k, dof, c * self.scale));
                entries.push(Triplet::new(dof, self.dofs + k, c * self.scale));
            }
            rhs.push(value * self.scale);
        }
        for (tangent, along) in self.tangents.iter().zip(along) {
            if let Along::Pushed(force) = along {
                (tangent.row.iter()).for_each(|&(dof, c)| rhs[dof] -= force * c);
            }
        }
        let x = SparseSystem::new(n, entries, self.dofs, SLACK * self.scale).solve(&rhs);
        let multipliers = &x[n - active.len() - stuck.len()..];
        let (of_active, of_stuck) = multipliers.split_at(active.len());
        let mut forces = vec![0.0; closed.len()];
        for (&j, force) in active.iter().zip(of_active) {
            forces[j] = force * self.scale;
        }
        let pushed = along.iter().map(|along| match along {
            Along::Pushed(force) => *force,
            Along::Free | Along::Stuck(_) => 0.0,
        });
        let mut tangential: Vec<f64> = pushed.collect();
        for (&(k, _), force) in stuck.iter().zip(of_stuck) {
            tangential[k] = force * self.scale;
        }
        Solved {
            u: x[..self.dofs].to_vec(),
            forces,
            tangential,
        }
    }
}

fn cells(model: &Model) -> Vec<Cell> {
    let mesh = &model.mesh;
    let is_ring = model.plane == Some(PlaneState::Axisymmetric);
    let mut references = BTreeMap::new();
    (mesh.cells.iter().zip(&model.cell_material))
        .map(|((kind, nodes), &material)| {
            let nodes: Vec<usize> = nodes.iter().map(|&node| node as usize).collect();
            let points: Vec<_> = nodes.iter().map(|&node| mesh.points[node]).collect();
            let stiffness = &model.materials[material as usize].stiffness;
            let reference =
                (references.entry(kind)).or_insert_with(|| Reference::new(kind, is_ring));
            Cell::new(reference, &points, nodes, stiffness)
        })
        .collect()
}
