//! The linear problem of the whole scene with every contact frozen as it is, open or closed.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;

use super::condense::CondensedBlocks;
use super::read::OwnedBlock;
use crate::comm::{Comm, Message};
use crate::contact::pair::ContactPair;
use crate::interface::coupled::CoupledContact;
use crate::interface::numbering::Numbering;
use crate::interface::operator::Interface;
use crate::plan::Plan;
use crate::schur::local::{CondensedLoad, LocalSchur};

/// What a rank holds of the frozen problem.
#[derive(Clone, Copy)]
pub struct Frozen<'a> {
    /// All ranks.
    pub comm: &'a Comm,
    /// Blocks of this rank.
    pub blocks: &'a BTreeMap<usize, OwnedBlock>,
    /// Their factors.
    pub condensed: &'a CondensedBlocks,
    /// The problem.
    pub catalog: &'a Catalog,
    /// Who owns what.
    pub plan: &'a Plan,
    /// What the root holds besides.
    pub root: Option<FrozenRoot<'a>>,
}

/// What the root holds besides.
#[derive(Clone, Copy)]
pub struct FrozenRoot<'a> {
    /// Numbering of Γ.
    pub numbering: &'a Numbering,
    /// The interface problem.
    pub interface: &'a Interface,
    /// Whether the active sets are right.
    pub converged: bool,
}

impl FrozenRoot<'_> {
    /// Whether the pairs' approaches can be solved for at once.
    pub fn can_solve(&self) -> bool {
        CoupledContact::new(self.interface).is_some()
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

/// A load on a block, condensed, and its limits.
struct FrozenLoad {
    load: CondensedLoad,
    open: Vec<bool>,
    missing: Vec<f64>,
}

impl FrozenLoad {
    fn pack(&self) -> Message {
        let boundary = self.load.boundary();
        let mut integers = vec![self.open.len() as i64, boundary.len() as i64];
        integers.extend(self.open.iter().map(|&open| i64::from(open)));
        Message {
            integers,
            reals: [&self.missing, boundary].concat(),
        }
    }
}

impl Frozen<'_> {
    /// The change that `loads` on the blocks of this rank, and those on the others', make to them.
    /// Collective.
    pub fn solve(&self, loads: BTreeMap<usize, BlockLoad>) -> BTreeMap<usize, BlockChange> {
        let condensed: BTreeMap<usize, FrozenLoad> = loads
            .into_iter()
            .filter_map(|(b, load)| {
                let limits =
                    (self.pair(b)).map(|pair| pair.frozen_limits(&load.closed, &load.missing));
                let (open, missing) = limits.unwrap_or_default();
                let load = self.schur(b)?.condense(load.load);
                Some((
                    b,
                    FrozenLoad {
                        load,
                        open,
                        missing,
                    },
                ))
            })
            .collect();
        let owners = self.plan.owners();
        let mut gathered: Vec<Message> = Vec::new();
        self.comm.gather(
            &owners,
            |b| {
                condensed
                    .get(&b)
                    .map_or_else(Message::default, FrozenLoad::pack)
            },
            |_, message| gathered.push(message),
        );
        let mut answers = self
            .root
            .map_or_else(Vec::new, |root| root.solve(self.plan, gathered));
        let mut received: BTreeMap<usize, Message> = BTreeMap::new();
        self.comm.scatter(
            &owners,
            |b| std::mem::take(&mut answers[b]),
            |b, message| {
                received.insert(b, message);
            },
        );
        received
            .into_iter()
            .filter_map(|(b, message)| {
                let FrozenLoad { load, missing, .. } = condensed.get(&b)?;
                let mut reader = message.read();
                let of_limits = reader.reals(missing.len());
                let x_b = reader.reals(load.boundary().len());
                let change = BlockChange {
                    x: self.schur(b)?.recover(load, &x_b),
                    forces: (self.pair(b)).map_or_else(Vec::new, |pair| pair.forces(&of_limits)),
                };
                Some((b, change))
            })
            .collect()
    }

    fn pair(&self, b: usize) -> Option<&ContactPair> {
        self.condensed.pairs.get(&self.plan.pair_of(b)?)
    }

    fn schur(&self, b: usize) -> Option<&LocalSchur> {
        let linear = self.condensed.linear.get(&b).map(|linear| &linear.schur);
        linear.or_else(|| self.pair(b).map(|pair| pair.schur()))
    }
}

impl FrozenRoot<'_> {
    /// What each block is answered: forces of its limits, approaches, traces.
    fn solve(&self, plan: &Plan, gathered: Vec<Message>) -> Vec<Message> {
        let mut r = vec![0.0; self.interface.len];
        let mut loads = Vec::new();
        let mut missing = Vec::new();
        let mut open: Vec<Vec<bool>> = Vec::new();
        for (b, message) in gathered.into_iter().enumerate() {
            let traces = &self.numbering.traces[b];
            let mut reader = message.read();
            if plan.pair_of(b).is_some() {
                let (limits, boundary) = (reader.count(), reader.count());
                open.push(reader.integers(limits).iter().map(|&o| o != 0).collect());
                missing.push(reader.reals(limits));
                loads.push(reader.reals(boundary - traces.len()));
            }
            for (&i, part) in traces.iter().zip(reader.reals(traces.len())) {
                r[i as usize] += part;
            }
        }
        let Some(coupled) = CoupledContact::new(self.interface) else {
            return vec![Message::default(); self.numbering.traces.len()];
        };
        let step = coupled.solve_frozen(&r, &loads, &missing, &open);
        let mut pairs = step.forces.into_iter().zip(step.approaches);
        let answer = |b: usize| {
            let mut message = Message::default();
            if plan.pair_of(b).is_some()
                && let Some((forces, approaches)) = pairs.next()
            {
                message.reals.extend(forces);
                message.reals.extend(approaches);
            }
            let traces = self.numbering.traces[b].iter();
            message.reals.extend(traces.map(|&i| step.u[i as usize]));
            message
        };
        (0..self.numbering.traces.len()).map(answer).collect()
    }
}
