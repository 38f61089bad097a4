//! The reference: one system for the whole mesh, without subdomains and Schur complements.
//!
//! Displacements u of all nodes, support forces μ and contact forces λ solve
//!
//! ```text
//! K u + Dᵀ μ + Bᵀ λ = f,   D u = v,   B u ≤ g,   λ ≥ 0,   λ (B u − g) = 0
//! ```
//!
//! by a primal-dual active set: with the closed conditions A as equations the system is linear,
//! indefinite and sparse; conditions of A in tension open, penetrating ones close.

use std::collections::HashSet;

use contact_dd_partition::model::Model;
use faer::Mat;
use faer::Par;
use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};

/// Force or penetration, relative to the largest force or displacement, that counts as none.
const ROUND_OFF: f64 = 1e-13;

/// A row of a condition: dofs and coefficients.
type Row = Vec<(usize, f64)>;

/// The solution of a model.
#[derive(Clone, Debug)]
pub struct Monolithic {
    /// Displacement, dof by dof in the order of nodes [m].
    pub u: Vec<f64>,
    /// Contact force of every condition in the order of contacts [N/m].
    pub forces: Vec<f64>,
    /// Gap that is left at every condition [m].
    pub gaps: Vec<f64>,
    stiffness: Vec<Triplet<usize, usize, f64>>,
}

struct Kkt {
    dofs: usize,
    stiffness: Vec<Triplet<usize, usize, f64>>,
    /// The largest entry of K: rows of D and B are multiplied by it, λ and μ divided.
    scale: f64,
    load: Vec<f64>,
    equations: Vec<(Row, f64)>,
    conditions: Vec<(Row, f64)>,
}

impl Monolithic {
    pub fn new(model: &Model) -> Self {
        Self::with(model, Vec::new())
    }

    /// The solution that meets `equations`, Σ coefficient·u(dof) = 0, too: with a free motion it
    /// takes them to make it the only one.
    pub fn with(model: &Model, equations: Vec<Row>) -> Self {
        let mut kkt = Kkt::new(model);
        kkt.equations
            .extend(equations.into_iter().map(|row| (row, 0.0)));
        let (u, forces) = kkt.solve();
        let gaps = kkt.gaps(&u);
        Self {
            u,
            forces,
            gaps,
            stiffness: kkt.stiffness,
        }
    }

    /// ‖u − v‖ over ‖u‖ in the norm of the energy.
    pub fn energy_difference(&self, v: &[f64]) -> f64 {
        let d: Vec<f64> = self.u.iter().zip(v).map(|(u, v)| u - v).collect();
        (self.energy(&d) / self.energy(&self.u)).sqrt()
    }

    fn energy(&self, v: &[f64]) -> f64 {
        let terms = (self.stiffness.iter()).map(|t| t.val * v[t.row] * v[t.col]);
        terms.sum::<f64>().max(0.0)
    }
}

impl Kkt {
    fn new(model: &Model) -> Self {
        let dim = model.mesh.dim;
        let row = |entries: &[(u32, [f64; 3])]| -> Row {
            let components = entries.iter().flat_map(|&(node, c)| {
                (0..dim).map(move |axis| (node as usize * dim + axis, c[axis]))
            });
            components.filter(|&(_, c)| c != 0.0).collect()
        };
        let stiffness = stiffness(model);
        let mut load = vec![0.0; dim * model.mesh.points.len()];
        for (node, force) in &model.forces {
            for axis in 0..dim {
                load[*node as usize * dim + axis] += force[axis];
            }
        }
        let conditions = model.contacts.iter().flat_map(|c| &c.conditions);
        Self {
            dofs: load.len(),
            scale: stiffness.iter().fold(0.0, |m, t| t.val.abs().max(m)),
            stiffness,
            load,
            equations: (model.supports.iter())
                .map(|s| (row(&[(s.node, s.direction)]), s.value))
                .collect(),
            conditions: conditions.map(|c| (row(&c.entries), c.gap)).collect(),
        }
    }

    fn gaps(&self, u: &[f64]) -> Vec<f64> {
        let left = |(row, gap): &(Row, f64)| gap - row.iter().map(|&(i, c)| c * u[i]).sum::<f64>();
        self.conditions.iter().map(left).collect()
    }

    /// u and λ by the active set, all conditions closed at first.
    fn solve(&self) -> (Vec<f64>, Vec<f64>) {
        let mut closed = vec![true; self.conditions.len()];
        let mut seen = HashSet::new();
        let mut one_at_a_time = false;
        for _ in 0..500 {
            one_at_a_time |= !seen.insert(closed.clone());
            let (u, forces) = self.linear(&closed);
            let gaps = self.gaps(&u);
            let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let no_force = ROUND_OFF * largest(&forces).max(largest(&self.load));
            let given = (self.conditions.iter()).fold(0.0, |m: f64, (_, g)| m.max(g.abs()));
            let no_gap = ROUND_OFF * largest(&u).max(given);
            let wrong: Vec<usize> = (0..closed.len())
                .filter(|&j| match closed[j] {
                    true => forces[j] < -no_force,
                    false => gaps[j] < -no_gap,
                })
                .collect();
            match wrong.last() {
                None => return (u, forces),
                Some(&j) if one_at_a_time => closed[j] = !closed[j],
                Some(_) => wrong.iter().for_each(|&j| closed[j] = !closed[j]),
            }
        }
        panic!("the reference's active set doesn't settle");
    }

    /// u and λ with the `closed` conditions as equations and the others away.
    fn linear(&self, closed: &[bool]) -> (Vec<f64>, Vec<f64>) {
        let active: Vec<usize> = (0..closed.len()).filter(|&j| closed[j]).collect();
        let rows: Vec<&(Row, f64)> = (self.equations.iter())
            .chain(active.iter().map(|&j| &self.conditions[j]))
            .collect();
        let n = self.dofs + rows.len();
        let mut entries = self.stiffness.clone();
        let mut rhs = self.load.clone();
        for (k, (row, value)) in rows.iter().enumerate() {
            for &(dof, c) in row {
                entries.push(Triplet::new(self.dofs + k, dof, c * self.scale));
                entries.push(Triplet::new(dof, self.dofs + k, c * self.scale));
            }
            rhs.push(value * self.scale);
        }
        faer::set_global_parallelism(Par::Seq);
        let matrix = SparseColMat::try_new_from_triplets(n, n, &entries).unwrap();
        let lu = matrix.sp_lu().unwrap();
        let rhs = Mat::from_fn(n, 1, |i, _| rhs[i]);
        let mut x = lu.solve(&rhs);
        for _ in 0..2 {
            let residual = &rhs - &matrix * &x;
            x += lu.solve(&residual);
        }
        let mut forces = vec![0.0; closed.len()];
        let first = self.dofs + self.equations.len();
        for (k, &j) in active.iter().enumerate() {
            forces[j] = x[(first + k, 0)] * self.scale;
        }
        ((0..self.dofs).map(|i| x[(i, 0)]).collect(), forces)
    }
}

/// K = Σ A Gᵀ C G over the triangles, G the constant strains (ε_xx, ε_yy, γ_xy) of each dof.
pub fn stiffness(model: &Model) -> Vec<Triplet<usize, usize, f64>> {
    let mesh = &model.mesh;
    let mut entries = Vec::with_capacity(36 * mesh.cells.len());
    for ((_, nodes), &material) in mesh.cells.iter().zip(&model.cell_material) {
        let c = &model.materials[material as usize].stiffness;
        let [p, q, r] = [0, 1, 2].map(|i| mesh.points[nodes[i] as usize]);
        let twice_area = (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]);
        // ∇N_i = (y_j − y_k, x_k − x_j) / 2A
        let slopes = [(q, r), (r, p), (p, q)]
            .map(|(j, k)| [(j[1] - k[1]) / twice_area, (k[0] - j[0]) / twice_area]);
        let strain = |i: usize| match i % 2 {
            0 => [slopes[i / 2][0], 0.0, slopes[i / 2][1]],
            _ => [0.0, slopes[i / 2][1], slopes[i / 2][0]],
        };
        for i in 0..6 {
            for j in 0..6 {
                let (a, b) = (strain(i), strain(j));
                let sum: f64 = (0..9).map(|k| a[k / 3] * c[k / 3][k % 3] * b[k % 3]).sum();
                let dof = |i: usize| 2 * nodes[i / 2] as usize + i % 2;
                entries.push(Triplet::new(dof(i), dof(j), sum * twice_area.abs() / 2.0));
            }
        }
    }
    entries
}
