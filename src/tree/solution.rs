//! Response to a load with a fixed active set.

use std::collections::BTreeMap;

use contact_dd_partition::id::{OnGroups, OnTreeNodes, TreeNodeId};

use super::fronts::{ActiveSetFront, ActiveSetFronts};
use crate::bddc::loads::ClusterLoads;
use crate::bddc::solution::Accuracy;
use crate::comm::Comm;
use crate::contact::laws::Iterate;
use crate::context::Context;
use crate::context::hierarchy::{Direction, carry};
use crate::error::Failure;
use crate::schur::local::CondensedLoad;
use crate::vector::{axpy, dot};

/// The condensed loads of the fronts of this rank, and the values of their closed jumps.
type CondensedLoads = OnTreeNodes<(CondensedLoad, Vec<f64>)>;

/// The response to a load with a fixed active set, on this rank.
#[derive(Clone, Debug, Default)]
pub struct ActiveSetSolution {
    /// The jumps and forces of every contact group; 0 force where open.
    pub at: OnGroups<Iterate>,
    /// The forces at the jumps of the ties of every contact group above clusters.
    pub tied: OnGroups<Vec<f64>>,
    /// The forces on open jumps: those of the load, or of slipping points that follow their laws.
    pub open_forces: OnGroups<Vec<f64>>,
    /// The unknowns on the boundary of every cluster.
    pub boundaries: OnTreeNodes<Vec<f64>>,
    /// The unknowns of the roots between which an iterative solver works.
    pub merge_roots: OnTreeNodes<Vec<f64>>,
    /// The iterations.
    pub iterations: usize,
    /// True if the preconditioner was insufficient, and can be improved.
    pub is_too_far: bool,
}

impl ActiveSetSolution {
    /// True if all values are finite, on all ranks. Collective.
    pub fn is_finite(&self, comm: &Comm) -> bool {
        let of_groups = self
            .at
            .values()
            .flat_map(|at| at.jumps.iter().chain(&at.forces));
        let mut values = of_groups.chain(self.boundaries.values().flatten());
        let is_finite = values.all(|x| x.is_finite());
        comm.decide(!comm.collect(&is_finite).contains(&false))
    }

    /// Replaces unknowns that aren't finite by zeros.
    pub fn cut(&mut self) {
        for x in self.boundaries.values_mut().flatten() {
            *x = if x.is_finite() { *x } else { 0.0 };
        }
    }
}

impl ActiveSetFronts {
    /// Solves for `loads` with the fixed normal jumps that are `open`, an iterative solver to its `accuracy`.
    /// Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn solve(
        &mut self,
        context: &Context<'_>,
        open: &OnGroups<Vec<bool>>,
        loads: ClusterLoads<'_>,
        accuracy: Accuracy<'_>,
    ) -> Result<ActiveSetSolution, Failure> {
        self.solves += 1;
        let mut solution = self.solve_as_it_is(context, loads, accuracy);
        // The first repetition renews the classes known to need it, the second one examines all classes.
        for _ in 0..2 {
            if !solution.is_too_far {
                break;
            }
            self.improve_preconditioner(context, open)?;
            let from_there = Accuracy {
                start: Some(&solution.merge_roots),
                ..accuracy
            };
            let loads = ClusterLoads {
                forces: &solution.open_forces,
                ..loads
            };
            let mut nearer = self.solve_as_it_is(context, loads, from_there);
            nearer.iterations += solution.iterations;
            solution = nearer;
        }
        Ok(solution)
    }

    fn solve_as_it_is(
        &self,
        context: &Context<'_>,
        loads: ClusterLoads<'_>,
        accuracy: Accuracy<'_>,
    ) -> ActiveSetSolution {
        let (condensed, arrived) = self.condense(context, loads);
        let mut solution = ActiveSetSolution::default();
        // Groups of ties only are below clusters.
        let all = context.groups.keys().map(|&g| (g, Iterate::default()));
        solution.at.extend(all);
        let below = match &self.bddc {
            // Roots keep nothing.
            None => {
                solution.open_forces = loads.forces.clone();
                let roots = context.plan.merge_roots.iter();
                roots.map(|&v| (v, Vec::new())).collect()
            }
            Some(bddc) => {
                let on_roots = ClusterLoads {
                    clusters: &arrived,
                    ..loads
                };
                let between = bddc.solve(context, &self.merge_roots, on_roots, accuracy);
                let is_rough = bddc.is_stale() || bddc.is_provisional();
                solution.is_too_far = is_rough && !between.is_solved;
                solution.merge_roots = between.clusters.clone();
                solution.iterations = between.iterations;
                solution.at.extend(between.groups);
                solution.tied = between.tied;
                solution.open_forces = between.forces;
                between.clusters
            }
        };
        self.recover(context, &condensed, (below, loads), &mut solution);
        solution
    }

    /// Condenses loads up the hierarchy: those of the fronts, and those received at the nodes above. Collective.
    fn condense(
        &self,
        context: &Context<'_>,
        loads: ClusterLoads<'_>,
    ) -> (CondensedLoads, OnTreeNodes<Vec<f64>>) {
        let plan = context.plan;
        let (mut condensed, mut arrived) = (CondensedLoads::new(), BTreeMap::new());
        let pass_up = |v: TreeNodeId, load, arrived: &mut OnTreeNodes<Vec<f64>>| {
            let above = plan.merged_into(v);
            carry(context, v, above, load, arrived, Direction::Up);
        };
        for cluster in &plan.clusters {
            let load = loads.clusters.get(&cluster.node).cloned();
            pass_up(cluster.node, load, &mut arrived);
        }
        for &v in &self.nodes {
            let passed = self.fronts.get(&v).map(|front| {
                let children = plan.tree.nodes[v].children.iter();
                let of_children: Vec<&[f64]> = children.map(|child| &arrived[child][..]).collect();
                let group = plan.group_of(v);
                let forces = group.and_then(|g| loads.forces.get(&g));
                let forces = forces.map_or_else(Vec::new, |of| front.jumps.open_forces(of));
                let prescribed = group.map_or(&[][..], |g| &loads.prescribed[&g]);
                let (of_limits, known) = prescribed.split_at(front.jumps.open.len());
                let load = front.merge.condense(&of_children, &forces, known);
                let values = front.jumps.closed_values(of_limits);
                let closed = values.len();
                let mut kept = load.boundary()[closed..].to_vec();
                for (j, value) in values.iter().enumerate() {
                    let column = &front.held.col_as_slice(j)[closed..];
                    axpy(-value, column, &mut kept);
                }
                condensed.insert(v, (load, values));
                kept
            });
            pass_up(v, passed, &mut arrived);
        }
        (condensed, arrived)
    }

    /// Recovers the eliminated unknowns of the fronts under these `loads`, from those `below` the roots on. Collective.
    fn recover(
        &self,
        context: &Context<'_>,
        condensed: &CondensedLoads,
        (mut below, loads): (OnTreeNodes<Vec<f64>>, ClusterLoads<'_>),
        solution: &mut ActiveSetSolution,
    ) {
        let plan = context.plan;
        for &v in self.nodes.iter().rev() {
            let mut of_children: OnTreeNodes<Vec<f64>> = BTreeMap::new();
            if let (Some(front), Some((load, values)), Some(x)) =
                (self.fronts.get(&v), condensed.get(&v), below.remove(&v))
            {
                let mut boundary = values.clone();
                boundary.extend(x);
                let recovered = front.merge.recover(load, &boundary);
                let children = plan.tree.nodes[v].children.iter().copied();
                of_children.extend(children.zip(recovered.children));
                if let Some(g) = plan.group_of(v) {
                    let balance = front.balance(load, &boundary);
                    let given = loads.forces.get(&g).map_or(&[][..], Vec::as_slice);
                    let at = front.jumps.answer(recovered.jumps, balance, given);
                    solution.at.insert(g, at);
                    solution.tied.insert(g, recovered.forces);
                }
            }
            for &child in &plan.tree.nodes[v].children {
                let x = of_children.remove(&child);
                carry(context, child, Some(v), x, &mut below, Direction::Down);
            }
        }
        below.retain(|&v, _| plan.node_owners[v] == context.comm.rank());
        solution.boundaries = below;
    }
}

impl ActiveSetFront {
    /// The forces on its own normal jumps, 0 where open: the load's imbalance at the unknowns `boundary`, closed normal
    /// jumps and kept unknowns.
    fn balance(&self, load: &CondensedLoad, boundary: &[f64]) -> Vec<f64> {
        let closed = self.held.ncols();
        let mut of_closed = load.boundary()[..closed].to_vec();
        for j in 0..closed {
            let column = &self.held.col_as_slice(j)[j..];
            of_closed[j] -= dot(column, &boundary[j..]);
            for (force, s) in of_closed[j..].iter_mut().zip(column).skip(1) {
                *force -= s * boundary[j];
            }
        }
        let mut of_closed = of_closed.into_iter();
        let of_jump = |open: &bool| match open {
            true => 0.0,
            false => of_closed.next().unwrap_or_default(),
        };
        self.jumps.open_in_front().iter().map(of_jump).collect()
    }
}
