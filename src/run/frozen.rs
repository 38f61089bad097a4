//! The linear problem of the whole scene with every contact frozen as it is, open or closed.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;

use super::condense::CondensedBlocks;
use super::read::OwnedBlock;
use crate::comm::{Comm, Message};
use crate::contact::s_con::ConState;
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
    /// The pairs' active sets.
    pub state: &'a ConState,
    /// Whether those are right.
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

impl Frozen<'_> {
    /// The change that `loads` on the blocks of this rank, and those on the others', make to them.
    /// Collective.
    pub fn solve(&self, loads: BTreeMap<usize, BlockLoad>) -> BTreeMap<usize, BlockChange> {
        let condensed: BTreeMap<usize, (CondensedLoad, Vec<f64>)> = loads
            .into_iter()
            .filter_map(|(b, load)| {
                let missing = self.pair(b).map(|pair| pair.missing(&load.missing));
                let condensed = self.schur(b)?.condense(load.load);
                Some((b, (condensed, missing.unwrap_or_default())))
            })
            .collect();
        let owners = self.plan.owners();
        let mut gathered: Vec<Message> = Vec::new();
        self.comm.gather(
            &owners,
            |b| {
                condensed
                    .get(&b)
                    .map_or_else(Message::default, |(load, missing)| Message {
                        integers: vec![missing.len() as i64, load.boundary().len() as i64],
                        reals: [missing, load.boundary()].concat(),
                    })
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
                let (load, missing) = condensed.get(&b)?;
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

    fn pair(&self, b: usize) -> Option<&crate::contact::pair::ContactPair> {
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
        for (b, message) in gathered.into_iter().enumerate() {
            let traces = &self.numbering.traces[b];
            let mut reader = message.read();
            if plan.pair_of(b).is_some() {
                let (limits, boundary) = (reader.count(), reader.count());
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
        let step = coupled.solve_frozen(&r, &loads, &missing, &self.state.open());
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
