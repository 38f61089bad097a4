//! The linear problem of the whole scene with the active set fixed as it is, open or closed.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::bytes::Reals;
use crate::condense::blocks::CondensedBlocks;
use crate::condense::substitute::Factors;
use crate::context::Context;
use crate::fem::balance::Balance;
use crate::interface::coupled::CoupledContact;
use crate::interface::numbering::Numbering;
use crate::interface::operator::Interface;
use crate::interface::problem::InterfaceProblem;
use crate::plan::Plan;
use crate::recover::motions::Motions;
use crate::recover::{BlockSolution, DiscreteSolution};
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::schur::local::CondensedLoad;
use crate::step::StepProblem;
use crate::sweep::{SweepOutcome, SweepStatus};

/// What a rank holds of the problem of the fixed active set.
#[derive(Clone, Copy)]
pub struct FixedActiveSet<'a> {
    /// What the run works on.
    pub context: Context<'a>,
    /// The factors of this rank.
    pub condensed: &'a CondensedBlocks,
    /// The problem of the load step.
    pub step: &'a StepProblem<'a>,
    /// The longest closing motion of a body (m).
    pub closing_motions: f64,
    /// Motions that are free whatever the contacts do; springs at pins hold them.
    pub free: Motions<'a>,
    /// What the root holds besides.
    pub root: Option<FixedActiveSetRoot<'a>>,
}

/// What the root holds besides.
#[derive(Clone, Copy)]
pub struct FixedActiveSetRoot<'a> {
    /// Numbering of Γ.
    pub numbering: &'a Numbering,
    /// The interface problem.
    pub problem: &'a InterfaceProblem<'a>,
    /// Whether the active sets are right.
    pub converged: bool,
}

/// Which limits of a cluster are open, and what the others still have to close (m).
type FixedLimits = (Vec<bool>, Vec<f64>);

impl FixedActiveSetRoot<'_> {
    /// Whether the pairs' normal jumps can be solved for at once.
    pub fn can_solve(&self) -> bool {
        CoupledContact::new(self.problem).is_some()
    }
}

/// What a load does, on this rank.
#[derive(Clone, Debug, Default)]
pub struct Change {
    /// Change of the unknowns of every block.
    pub blocks: BTreeMap<usize, Vec<f64>>,
    /// Change of the forces of every contact group, 0 where open.
    pub forces: BTreeMap<usize, Vec<f64>>,
}

impl<'a> FixedActiveSet<'a> {
    /// The problem of a load step, solved with this `outcome`; `interface` and `outcome` are the root's.
    pub fn new(
        context: Context<'a>,
        condensed: &'a CondensedBlocks,
        step: &'a StepProblem<'a>,
        analysis: &'a RigidBodyAnalysis,
        interface: Option<&'a (Numbering, Interface)>,
        outcome: Option<&SweepOutcome>,
    ) -> Self {
        let on_root = interface.zip(step.interface.as_ref()).zip(outcome);
        Self {
            context,
            condensed,
            step,
            closing_motions: analysis.longest_closing_motion(),
            free: Motions {
                list: &analysis.motions.free,
                frames: &analysis.frames,
            },
            root: on_root.map(|(((numbering, _), problem), outcome)| FixedActiveSetRoot {
                numbering,
                problem,
                converged: outcome.status == SweepStatus::Converged,
            }),
        }
    }

    /// The factors.
    pub fn factors(&self) -> Factors<'a> {
        Factors {
            context: self.context,
            condensed: self.condensed,
        }
    }

    /// What balances at the nodes of block b of this rank; `None` for another rank's.
    pub fn balance(&self, b: usize, solution: &BlockSolution) -> Option<Balance> {
        Some(Balance::new(
            self.context.blocks.get(&b)?,
            self.step.loads.blocks.get(&b)?,
            &self.context.catalog.materials,
            &solution.u,
            &solution.pushes,
        ))
    }

    /// The change that `loads` on the unknowns of the blocks of this rank, and those on the others', make where
    /// the points of `solution` stay open or closed and the closed ones still have to close by `missing`, nothing
    /// where a group isn't named. Collective.
    pub fn solve(
        &self,
        loads: BTreeMap<usize, Vec<f64>>,
        solution: &DiscreteSolution,
        missing: &BTreeMap<usize, Vec<f64>>,
    ) -> Change {
        let factors = self.factors();
        let conditions = solution.groups.iter().map(|(g, of_group)| {
            let none = vec![0.0; of_group.closed.len()];
            let missing = missing.get(g).unwrap_or(&none).iter().copied();
            (*g, of_group.closed.iter().copied().zip(missing).collect())
        });
        let limits = self.limits(factors.collect_conditions(conditions.collect()));
        let condensed = factors.condense(loads);
        let (forces, boundaries) = self.solve_interface(&limits, &condensed);
        Change {
            forces: factors.spread_conditions(forces),
            blocks: factors.recover(&condensed, boundaries),
        }
    }

    /// For every cluster in contact of this rank, which limits are open and what the others lack.
    fn limits(
        &self,
        conditions: BTreeMap<usize, Vec<(bool, f64)>>,
    ) -> BTreeMap<usize, FixedLimits> {
        let mut limits = BTreeMap::new();
        for (p, of_cluster) in conditions {
            let (closed, missing): (Vec<bool>, Vec<f64>) = of_cluster.into_iter().unzip();
            if let Some(pair) = self.step.pairs.get(&p) {
                limits.insert(p, pair.limits().fixed(&closed, &missing));
            }
        }
        limits
    }

    /// Brings the clusters' loads and limits to the root, and what it answers back: forces of the
    /// conditions of clusters in contact, and unknowns on the boundary of every cluster's node. Collective.
    fn solve_interface(
        &self,
        limits: &BTreeMap<usize, FixedLimits>,
        condensed: &BTreeMap<usize, CondensedLoad>,
    ) -> (BTreeMap<usize, Vec<f64>>, BTreeMap<usize, Vec<f64>>) {
        let plan = self.context.plan;
        let owners = plan.cluster_owners();
        let of_cluster = |c: usize| {
            plan.contact_place(c)
                .and_then(|p| Some((p, limits.get(&p)?)))
        };
        let boundary = |c: usize| {
            let load = condensed.get(&plan.clusters[c].node);
            load.map_or(&[][..], CondensedLoad::boundary)
        };
        let mut gathered: Vec<ClusterQuestion> = Vec::new();
        self.context.comm.gather(
            &owners,
            |c| ClusterQuestion {
                limits: of_cluster(c).map(|(_, limits)| limits.clone()),
                load: boundary(c).to_vec(),
            },
            |_, question| gathered.push(question),
        );
        let mut answers = self
            .root
            .map_or_else(Vec::new, |root| root.solve(plan, gathered));
        let mut forces = BTreeMap::new();
        let mut boundaries = BTreeMap::new();
        self.context.comm.scatter(
            &owners,
            |c| std::mem::take(&mut answers[c]),
            |c, (Reals(of_limits), Reals(x))| {
                if let Some((p, _)) = of_cluster(c)
                    && let Some(pair) = self.step.pairs.get(&p)
                {
                    forces.insert(p, pair.limits().forces(&of_limits));
                }
                boundaries.insert(plan.clusters[c].node, x);
            },
        );
        (forces, boundaries)
    }
}

/// What the owner of a cluster tells the root.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct ClusterQuestion {
    /// Its limits, where it is in contact.
    limits: Option<FixedLimits>,
    /// Its load, on normal jumps and traces.
    #[serde(with = "crate::bytes")]
    load: Vec<f64>,
}

/// Forces of the limits of a cluster, and its normal jumps and traces.
type ClusterAnswer = (Reals, Reals);

impl FixedActiveSetRoot<'_> {
    /// What each cluster is answered.
    fn solve(&self, plan: &Plan, gathered: Vec<ClusterQuestion>) -> Vec<ClusterAnswer> {
        let mut r = vec![0.0; self.problem.interface.len];
        let mut loads = Vec::new();
        let mut missing = Vec::new();
        let mut open: Vec<Vec<bool>> = Vec::new();
        for (question, interface_dofs) in gathered.into_iter().zip(&self.numbering.interface_dofs) {
            let mut on_jumps = question.load;
            let on_traces = on_jumps.split_off(on_jumps.len() - interface_dofs.len());
            if let Some((of_cluster, lacking)) = question.limits {
                open.push(of_cluster);
                missing.push(lacking);
                loads.push(on_jumps);
            }
            for (&i, part) in interface_dofs.iter().zip(on_traces) {
                r[i as usize] += part;
            }
        }
        let Some(coupled) = CoupledContact::new(self.problem) else {
            return vec![ClusterAnswer::default(); self.numbering.interface_dofs.len()];
        };
        let step = coupled.solve_fixed(&r, &loads, &missing, &open);
        let mut pairs = step.forces.into_iter().zip(step.jumps);
        let answer = |c: usize| {
            let of_pair = match plan.contact_place(c) {
                Some(_) => pairs.next(),
                None => None,
            };
            let (forces, mut x) = of_pair.unwrap_or_default();
            let interface_dofs = self.numbering.interface_dofs[c].iter();
            x.extend(interface_dofs.map(|&i| step.u[i as usize]));
            (Reals(forces), Reals(x))
        };
        (0..self.numbering.interface_dofs.len())
            .map(answer)
            .collect()
    }
}
