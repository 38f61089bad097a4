//! Back-substitution: from U on Γ to displacements and contact forces everywhere.

pub mod adjoint;
pub mod against_law;
pub mod conditioning;
pub mod energy;
pub mod fixed_active_set;
mod fixed_conditions;
mod group_solution;
mod interface_solve;
mod law_refinement;
pub mod minimum_norm;
pub mod motions;
pub mod penetration;
mod reactions;
pub mod refine;
pub mod solution;
mod solution_check;
pub mod stress_intensity;
pub mod stresses;

use std::collections::BTreeMap;

use contact_dd_partition::element::geometry::padded;
use contact_dd_partition::id::{BlockId, GroupId, OnBlocks, OnGroups, OnPairs, OnTreeNodes};
use contact_dd_partition::problem::SubdomainNode;

use crate::bytes::Reals;
use crate::condense::blocks::CondensedBlocks;
use crate::condense::substitute::Factors;
use crate::contact::pair::ContactPair;
use crate::context::{Context, Loads};
use crate::step::StepProblem;
use crate::step::working_set::ClosestApproaches;

pub use group_solution::GroupSolution;

/// The solution on a block.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockSolution {
    /// Displacement, node by node (m).
    pub u: Vec<f64>,
    /// Bᵀλ by node: minus the contact force on the block (N/m).
    pub pushes: Vec<(u32, [f64; 3])>,
}

/// Slips and frictional work at the tangential constraints of the contact groups of this rank, by their number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slips {
    /// Tangential jumps since the bodies were unloaded (m).
    pub jumps: OnGroups<Vec<f64>>,
    /// Dissipated work in the load step: force times slip (J, per metre of thickness).
    pub work: OnGroups<Vec<f64>>,
}

impl Slips {
    /// Jumps and frictional work of a contact group.
    pub fn of(&self, g: GroupId) -> (&[f64], &[f64]) {
        let [jumps, work] = [&self.jumps, &self.work].map(|all| all.get(&g));
        (
            jumps.map_or(&[], Vec::as_slice),
            work.map_or(&[], Vec::as_slice),
        )
    }

    /// Adds the work of `earlier` increments of the same load step.
    pub fn add_work(&mut self, earlier: &OnGroups<Vec<f64>>) {
        for (g, work) in &mut self.work {
            for (work, earlier) in work.iter_mut().zip(earlier.get(g).into_iter().flatten()) {
                *work += earlier;
            }
        }
    }
}

/// u and λ on this rank.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscreteSolution {
    /// Solutions of its blocks, by their number.
    pub blocks: OnBlocks<BlockSolution>,
    /// Solutions of its contact groups, by their number.
    pub groups: OnGroups<GroupSolution>,
}

impl DiscreteSolution {
    /// Slips and frictional work from the tangential jumps `before` the increment (m).
    pub fn slips(&self, context: &Context<'_>, before: &OnGroups<Vec<f64>>) -> Slips {
        let mut slips = Slips::default();
        for (&g, solution) in &self.groups {
            let first = context.groups[&g].points.len();
            let tangential = first..solution.closed.len();
            let slip = |j: usize| match solution.closed[j] {
                true => 0.0,
                false => -solution.gaps[j],
            };
            let was = |j: usize| before.get(&g).map_or(0.0, |before| before[j - first]);
            let jumps = tangential.clone().map(|j| was(j) + slip(j)).collect();
            let work = tangential.map(|j| solution.forces[j] * slip(j)).collect();
            slips.jumps.insert(g, jumps);
            slips.work.insert(g, work);
        }
        slips
    }

    /// Updates the closest approaches of the contact points by this solution; on the root. Collective.
    pub fn add_approaches(&self, context: &Context<'_>, to: &mut ClosestApproaches) {
        let plan = context.plan;
        context.comm.gather(
            &plan.group_owners(),
            |g| {
                let of_group = &self.groups[&g];
                let points = 0..context.groups[&g].points.len();
                let of_points = points.map(|j| (of_group.closed[j], of_group.gaps[j]));
                of_points.collect::<Vec<(bool, f64)>>()
            },
            |g, of_points| {
                let places = &plan.tree.nodes[plan.groups[g].node].points;
                for (&j, (is_closed, gap)) in places.iter().zip(of_points) {
                    to.closed[j as usize] |= is_closed;
                    to.gaps[j as usize] = to.gaps[j as usize].min(gap);
                }
            },
        );
    }

    /// Adds changes of the unknowns of blocks of this rank to their displacements.
    pub fn add(&mut self, condensed: &CondensedBlocks, changes: OnBlocks<Vec<f64>>) {
        for (b, x) in changes {
            let block = condensed.blocks.get(&b);
            if let (Some(of_block), Some(block)) = (self.blocks.get_mut(&b), block) {
                block.dofs.add_change(&x, &mut of_block.u);
            }
        }
    }

    /// Sends remaining gaps to contact groups and nodal contact forces to blocks. Collective.
    pub fn share(&mut self, context: &Context<'_>, loads: &Loads) {
        let &Context { comm, plan, .. } = context;
        let dim = context.catalog.dim;
        let u = plan.nodes_to_groups(comm, |b, nodes| {
            let u = self.blocks.get(&b).map_or(&[][..], |solution| &solution.u);
            let of_node =
                |&(at, _): &(SubdomainNode, u32)| padded(&u[at.node as usize * dim..][..dim]);
            nodes.iter().map(of_node).collect()
        });
        for (g, solution) in &mut self.groups {
            let u: Vec<f64> = u[g]
                .iter()
                .flat_map(|u: &[f64; 3]| u[..dim].to_vec())
                .collect();
            solution.gaps = context.groups[g].gaps_left(&loads.groups[g], &u);
        }
        let pushes = self.groups.iter();
        let pushes = pushes.map(|(&g, solution)| (g, context.groups[&g].pushes(&solution.forces)));
        let mut arrived = plan.nodes_to_blocks(comm, &pushes.collect());
        for (b, solution) in &mut self.blocks {
            let of_block = arrived.remove(b).unwrap_or_default().into_iter();
            let each = |(node, pushes): (u32, Vec<[f64; 3]>)| {
                pushes.into_iter().map(move |push| (node, push))
            };
            solution.pushes = of_block.flat_map(each).collect();
        }
    }
}

/// The displacement of every block, node by node.
pub fn displacements(
    solutions: &OnBlocks<BlockSolution>,
) -> impl Iterator<Item = (BlockId, &[f64])> {
    solutions.iter().map(|(&b, solution)| (b, &solution.u[..]))
}

/// Sends every cluster its part of U and recovers its interior. Collective; `root` holds U and the numbers of every
/// cluster's traces.
pub fn recover(
    factors: Factors<'_>,
    step: &StepProblem<'_>,
    root: Option<(&[f64], &[Vec<u32>])>,
) -> DiscreteSolution {
    let Context { comm, plan, .. } = factors.context;
    let mut boundaries: OnTreeNodes<Vec<f64>> = BTreeMap::new();
    comm.scatter(
        &plan.cluster_owners(),
        |c| {
            Reals(root.map_or_else(Vec::new, |(u, numbers)| {
                numbers[c.index()].iter().map(|&i| u[i as usize]).collect()
            }))
        },
        |c, Reals(interface_dofs)| {
            let pair = plan.pair_of(c).and_then(|p| step.pairs.get(&p));
            let mut x = pair.map_or_else(Vec::new, |pair| pair.jumps().to_vec());
            x.extend(interface_dofs);
            boundaries.insert(plan.clusters[c].node, x);
        },
    );
    let conditions = conditions(factors, &step.pairs);
    substitute_back(factors, step, boundaries, conditions)
}

/// The solution of all blocks and groups from the unknowns on the `boundaries` of all clusters and from the force and
/// the status, closed or not, of every contact constraint. Collective.
pub fn substitute_back(
    factors: Factors<'_>,
    step: &StepProblem<'_>,
    boundaries: OnTreeNodes<Vec<f64>>,
    conditions: OnGroups<Vec<(f64, bool)>>,
) -> DiscreteSolution {
    // Groups that contain ties only belong to no cluster in contact.
    let all = factors.context.groups.iter();
    let none = all.map(|(&g, group)| (g, vec![(0.0, false); group.conditions().count()]));
    let mut known: OnGroups<Vec<(f64, bool)>> = none.collect();
    known.extend(conditions);
    let groups = known.into_iter();
    let of_group = |(g, conditions): (GroupId, Vec<(f64, bool)>)| {
        let (forces, closed) = conditions.into_iter().unzip();
        let gaps = Vec::new();
        (
            g,
            GroupSolution {
                forces,
                closed,
                gaps,
            },
        )
    };
    let (blocks, of_ties) = factors.recover(&step.condensed, boundaries);
    let of_block = |(b, x): (BlockId, Vec<f64>)| {
        let dofs = &factors.condensed.blocks.get(&b)?.dofs;
        let u = step.prescribed.get(&b)?.displacement(dofs, &x);
        let pushes = Vec::new();
        Some((b, BlockSolution { u, pushes }))
    };
    let mut solution = DiscreteSolution {
        blocks: blocks.into_iter().filter_map(of_block).collect(),
        groups: groups.map(of_group).collect(),
    };
    for (g, of_group) in &mut solution.groups {
        let of_jumps = of_ties.get(g).into_iter().flatten();
        for (force, (condition, _)) in of_jumps.zip(&step.tied[g]) {
            of_group.forces[*condition] = *force;
        }
        let conditions = factors.context.groups[g].conditions();
        for (closed, condition) in of_group.closed.iter_mut().zip(conditions) {
            *closed |= condition.is_tied;
        }
    }
    solution.share(&factors.context, &step.loads);
    solution
}

/// Force and status, closed or not, of every contact constraint, sent from the clusters that solved for them to the
/// owners of groups. Collective.
fn conditions(factors: Factors<'_>, pairs: &OnPairs<ContactPair>) -> OnGroups<Vec<(f64, bool)>> {
    let of_clusters = pairs.iter().map(|(&p, pair)| {
        let (forces, closed) = pair.conditions();
        (p, forces.into_iter().zip(closed).collect())
    });
    factors.spread_conditions(of_clusters.collect())
}
