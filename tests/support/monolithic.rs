//! The reference: one system for the whole mesh, without subdomains and Schur complements.
//!
//! Displacements u of all nodes, support forces μ and contact forces λ solve
//!
//! ```text
//! K u + Dᵀ μ + Bᵀ λ = f,   D u = v,   B u ≤ g,   λ ≥ 0,   λ (B u − g) = 0
//! ```
//!
//! by a primal-dual active set: with the closed conditions A as equations the system is linear, indefinite and sparse;
//! conditions of A in tension open, penetrating ones close.

use std::collections::HashSet;

use contact_dd_partition::model::Model;

use super::assembled::{Assembled, Row};

/// Force or penetration, relative to the largest force or displacement, below which it counts as zero.
const ROUND_OFF: f64 = 1e-13;

/// The solution of a model.
pub struct Monolithic {
    /// Displacement, dof by dof in the order of nodes [m].
    pub u: Vec<f64>,
    /// Contact force of every condition in the order of contacts [N/m].
    pub forces: Vec<f64>,
    /// Remaining gap at every condition [m].
    pub gaps: Vec<f64>,
    assembled: Assembled,
}

impl Monolithic {
    pub fn new(model: &Model) -> Self {
        Self::with(model, Vec::new())
    }

    /// The solution that also fulfils `equations`, Σ coefficient·u(dof) = 0, which make it unique where a motion is
    /// free.
    pub fn with(model: &Model, equations: Vec<Row>) -> Self {
        let assembled = Assembled::new(model);
        let equations: Vec<(Row, f64)> = equations.into_iter().map(|row| (row, 0.0)).collect();
        let (u, forces) = active_set(&assembled, &equations);
        let gaps = assembled.gaps(&u);
        Self {
            u,
            forces,
            gaps,
            assembled,
        }
    }

    /// ‖u − v‖ over ‖u‖ in the energy norm.
    pub fn energy_difference(&self, v: &[f64]) -> f64 {
        self.assembled.energy_difference(&self.u, v)
    }
}

/// u and λ by the active set, all conditions closed at first.
fn active_set(assembled: &Assembled, equations: &[(Row, f64)]) -> (Vec<f64>, Vec<f64>) {
    let mut closed = vec![true; assembled.conditions.len()];
    let mut seen = HashSet::new();
    let mut one_at_a_time = false;
    for _ in 0..500 {
        one_at_a_time |= !seen.insert(closed.clone());
        let (u, forces) = assembled.solve(&closed, equations);
        let gaps = assembled.gaps(&u);
        let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let no_force = ROUND_OFF * largest(&forces).max(largest(&assembled.load));
        let given = (assembled.conditions.iter()).fold(0.0, |m: f64, (_, g)| m.max(g.abs()));
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
