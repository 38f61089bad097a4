//! The linear problem of the whole scene with every contact frozen as it is, open or closed.

use std::collections::BTreeMap;

use super::condensed_blocks::CondensedBlocks;
use super::context::Context;
use super::load::StepProblem;
use super::motions::Motions;
use super::recover::BlockSolution;
use super::substitute::Factors;
use crate::comm::Message;
use crate::fem::balance::Balance;
use crate::interface::coupled::CoupledContact;
use crate::interface::numbering::Numbering;
use crate::interface::operator::Interface;
use crate::interface::problem::InterfaceProblem;
use crate::plan::Plan;
use crate::rigid::survey::Survey;
use crate::schur::local::CondensedLoad;
use crate::sweep::{SweepOutcome, SweepStatus};

/// What a rank holds of the frozen problem.
#[derive(Clone, Copy)]
pub struct Frozen<'a> {
    /// What the run works on.
    pub context: Context<'a>,
    /// The factors of this rank.
    pub condensed: &'a CondensedBlocks,
    /// The problem of the load step.
    pub step: &'a StepProblem<'a>,
    /// The longest way of a body to rest (m).
    pub descent: f64,
    /// Motions that are free whatever the contacts do; springs at pins hold them.
    pub free: Motions<'a>,
    /// What the root holds besides.
    pub root: Option<FrozenRoot<'a>>,
}

/// What the root holds besides.
#[derive(Clone, Copy)]
pub struct FrozenRoot<'a> {
    /// Numbering of Γ.
    pub numbering: &'a Numbering,
    /// The interface problem.
    pub problem: &'a InterfaceProblem<'a>,
    /// Whether the active sets are right.
    pub converged: bool,
}

/// Which limits of a cluster are open, and what the others still have to approach (m).
type FrozenLimits = (Vec<bool>, Vec<f64>);

impl FrozenRoot<'_> {
    /// Whether the pairs' approaches can be solved for at once.
    pub fn can_solve(&self) -> bool {
        CoupledContact::new(self.problem).is_some()
    }
}

/// A load on a block.
#[derive(Clone, Debug, Default)]
pub struct BlockLoad {
    /// Force on every unknown (N/m).
    pub load: Vec<f64>,
    /// Which of its conditions are closed.
    pub closed: Vec<bool>,
    /// What the sides of every condition still have to approach where it is closed (m).
    pub missing: Vec<f64>,
}

/// What a load does to a block.
#[derive(Clone, Debug, Default)]
pub struct BlockChange {
    /// Change of every unknown.
    pub x: Vec<f64>,
    /// Change of the force of every condition, 0 where open.
    pub forces: Vec<f64>,
}

impl<'a> Frozen<'a> {
    /// The problem of a load step, solved with this `outcome`; `interface` and `outcome` are the root's.
    pub fn new(
        context: Context<'a>,
        condensed: &'a CondensedBlocks,
        step: &'a StepProblem<'a>,
        survey: &'a Survey,
        interface: Option<&'a (Numbering, Interface)>,
        outcome: Option<&SweepOutcome>,
    ) -> Self {
        let on_root = interface.zip(step.interface.as_ref()).zip(outcome);
        Self {
            context,
            condensed,
            step,
            descent: survey.longest_descent(),
            free: Motions {
                list: &survey.motions.free,
                frames: &survey.frames,
            },
            root: on_root.map(|(((numbering, _), problem), outcome)| FrozenRoot {
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
        let owned = self.context.blocks.get(&b)?;
        Some(Balance::new(
            owned,
            self.step.loads.get(&b)?,
            &self.context.catalog.materials,
            &solution.u,
            &solution.forces,
        ))
    }

    /// The change that `loads` on the blocks of this rank, and those on the others', make to them.
    /// Collective.
    pub fn solve(&self, loads: BTreeMap<usize, BlockLoad>) -> BTreeMap<usize, BlockChange> {
        let factors = self.factors();
        let mut conditions: BTreeMap<usize, Message> = BTreeMap::new();
        let mut on_blocks: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for (b, load) in loads {
            on_blocks.insert(b, load.load);
            let message = Message {
                integers: load
                    .closed
                    .iter()
                    .map(|&closed| i64::from(closed))
                    .collect(),
                reals: load.missing,
            };
            conditions.insert(b, message);
        }
        let limits = self.limits(factors.collect_conditions(conditions));
        let condensed = factors.condense(on_blocks);
        let (forces, boundaries) = self.solve_interface(&limits, &condensed);
        let mut forces = factors.spread_conditions(forces);
        let recovered = factors.recover(&condensed, boundaries);
        (recovered.into_iter())
            .map(|(b, x)| {
                let forces = forces.remove(&b).unwrap_or_default().reals;
                (b, BlockChange { x, forces })
            })
            .collect()
    }

    /// For every cluster in contact of this rank, which limits are open and what the others lack.
    fn limits(&self, conditions: BTreeMap<usize, Vec<Message>>) -> BTreeMap<usize, FrozenLimits> {
        let mut limits = BTreeMap::new();
        for (p, messages) in conditions {
            let closed = messages.iter().flat_map(|m| &m.integers);
            let closed: Vec<bool> = closed.map(|&closed| closed != 0).collect();
            let missing: Vec<f64> = messages.iter().flat_map(|m| m.reals.clone()).collect();
            if let Some(pair) = self.step.pairs.get(&p) {
                limits.insert(p, pair.limits().frozen(&closed, &missing));
            }
        }
        limits
    }

    /// Brings the clusters' loads and limits to the root, and what it answers back: forces of the
    /// conditions of clusters in contact, and unknowns on the boundary of every cluster's node. Collective.
    fn solve_interface(
        &self,
        limits: &BTreeMap<usize, FrozenLimits>,
        condensed: &BTreeMap<usize, CondensedLoad>,
    ) -> (BTreeMap<usize, Message>, BTreeMap<usize, Vec<f64>>) {
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
        let mut gathered: Vec<Message> = Vec::new();
        self.context.comm.gather(
            &owners,
            |c| {
                let mut message = Message::default();
                let boundary = boundary(c);
                if let Some((_, (open, missing))) = of_cluster(c) {
                    message.integers = vec![open.len() as i64, boundary.len() as i64];
                    message
                        .integers
                        .extend(open.iter().map(|&open| i64::from(open)));
                    message.reals.extend(missing);
                }
                message.reals.extend(boundary);
                message
            },
            |_, message| gathered.push(message),
        );
        let mut answers = self
            .root
            .map_or_else(Vec::new, |root| root.solve(plan, gathered));
        let mut forces = BTreeMap::new();
        let mut boundaries = BTreeMap::new();
        self.context.comm.scatter(
            &owners,
            |c| std::mem::take(&mut answers[c]),
            |c, message| {
                let mut reader = message.read();
                if let Some((p, (_, missing))) = of_cluster(c)
                    && let Some(pair) = self.step.pairs.get(&p)
                {
                    let of_limits = reader.reals(missing.len());
                    let reals = pair.limits().forces(&of_limits);
                    let integers = vec![0; reals.len()];
                    forces.insert(p, Message { integers, reals });
                }
                let x = reader.reals(boundary(c).len());
                boundaries.insert(plan.clusters[c].node, x);
            },
        );
        (forces, boundaries)
    }
}

impl FrozenRoot<'_> {
    /// What each cluster is answered: forces of its limits, approaches, traces.
    fn solve(&self, plan: &Plan, gathered: Vec<Message>) -> Vec<Message> {
        let mut r = vec![0.0; self.problem.interface.len];
        let mut loads = Vec::new();
        let mut missing = Vec::new();
        let mut open: Vec<Vec<bool>> = Vec::new();
        for (c, message) in gathered.into_iter().enumerate() {
            let traces = &self.numbering.traces[c];
            let mut reader = message.read();
            if plan.contact_place(c).is_some() {
                let (limits, boundary) = (reader.count(), reader.count());
                open.push(reader.integers(limits).iter().map(|&o| o != 0).collect());
                missing.push(reader.reals(limits));
                loads.push(reader.reals(boundary - traces.len()));
            }
            for (&i, part) in traces.iter().zip(reader.reals(traces.len())) {
                r[i as usize] += part;
            }
        }
        let Some(coupled) = CoupledContact::new(self.problem) else {
            return vec![Message::default(); self.numbering.traces.len()];
        };
        let step = coupled.solve_frozen(&r, &loads, &missing, &open);
        let mut pairs = step.forces.into_iter().zip(step.approaches);
        let answer = |c: usize| {
            let mut message = Message::default();
            if plan.contact_place(c).is_some()
                && let Some((forces, approaches)) = pairs.next()
            {
                message.reals.extend(forces);
                message.reals.extend(approaches);
            }
            let traces = self.numbering.traces[c].iter();
            message.reals.extend(traces.map(|&i| step.u[i as usize]));
            message
        };
        (0..self.numbering.traces.len()).map(answer).collect()
    }
}
