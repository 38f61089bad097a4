//! Back-substitution: from U on Γ to displacements and contact forces everywhere.

pub mod conditioning;
pub mod fixed_active_set;
pub mod minimum_norm;
pub mod motions;
mod reactions;
pub mod refine;
pub mod solution;
pub mod stresses;

use std::collections::BTreeMap;

use crate::bytes::Reals;
use crate::condense::substitute::Factors;
use crate::contact::pair::ContactPair;
use crate::context::Context;
use crate::step::StepProblem;

/// The solution on a block.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockSolution {
    /// Displacement, node by node (m).
    pub u: Vec<f64>,
    /// Force of every condition (N/m).
    pub forces: Vec<f64>,
    /// Which conditions are closed.
    pub closed: Vec<bool>,
}

/// The displacement of every block, node by node.
pub fn displacements(
    solutions: &BTreeMap<usize, BlockSolution>,
) -> impl Iterator<Item = (usize, &[f64])> {
    solutions.iter().map(|(&b, solution)| (b, &solution.u[..]))
}

/// Sends every cluster its part of U and recovers its interior. Collective; `root` holds U and the
/// numbers of every cluster's traces.
pub fn recover(
    factors: Factors<'_>,
    step: &StepProblem<'_>,
    root: Option<(&[f64], &[Vec<u32>])>,
) -> BTreeMap<usize, BlockSolution> {
    let Context { comm, plan, .. } = factors.context;
    let mut boundaries: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    comm.scatter(
        &plan.cluster_owners(),
        |c| {
            Reals(root.map_or_else(Vec::new, |(u, numbers)| {
                numbers[c].iter().map(|&i| u[i as usize]).collect()
            }))
        },
        |c, Reals(interface_dofs)| {
            let pair = plan.contact_place(c).and_then(|p| step.pairs.get(&p));
            let mut x = pair.map_or_else(Vec::new, |pair| pair.jumps().to_vec());
            x.extend(interface_dofs);
            boundaries.insert(plan.clusters[c].node, x);
        },
    );
    let mut conditions = conditions(factors, &step.pairs);
    factors
        .recover(&step.condensed, boundaries)
        .into_iter()
        .filter_map(|(b, x)| {
            let of_block = conditions.remove(&b).unwrap_or_default();
            let (forces, closed) = of_block.into_iter().unzip();
            let dofs = &factors.condensed.blocks.get(&b)?.dofs;
            let solution = BlockSolution {
                u: step.prescribed.get(&b)?.displacement(dofs, &x),
                forces,
                closed,
            };
            Some((b, solution))
        })
        .collect()
}

/// Forces of the conditions of every block, and which are closed, from the clusters that know.
/// Collective.
fn conditions(
    factors: Factors<'_>,
    pairs: &BTreeMap<usize, ContactPair>,
) -> BTreeMap<usize, Vec<(f64, bool)>> {
    let of_clusters = pairs.iter().map(|(&p, pair)| {
        let (forces, closed) = pair.conditions();
        (p, forces.into_iter().zip(closed).collect())
    });
    factors.spread_conditions(of_clusters.collect())
}
