//! What every phase of a run works on.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;
use faer::Par;

use crate::comm::Comm;
use crate::error::Failure;
use crate::fem::block::Block;
use crate::fem::contact_group::{ContactGroup, GroupLoads};
use crate::fem::load::BlockLoads;
use crate::plan::Plan;

/// Who hears how far a phase has come.
pub trait Listener {
    /// So much of the phase, or of a part of it such as a linear system, is done: 0, with which a part begins, to 1.
    fn done(&self, share: f64);
}

/// What every phase of a run works on.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// All ranks.
    pub comm: &'a Comm,
    /// The problem.
    pub catalog: &'a Catalog,
    /// Who owns what.
    pub plan: &'a Plan,
    /// The blocks of this rank, by their number.
    pub blocks: &'a BTreeMap<usize, Block>,
    /// The contact groups of this rank, by their number.
    pub groups: &'a BTreeMap<usize, ContactGroup>,
    /// Threads.
    pub par: Par,
    /// Who hears how far a phase has come.
    pub listener: &'a dyn Listener,
}

/// A place on the way through the load steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The load step.
    pub step: usize,
    /// How much of the way is gone from the loads of the step before, none before the first, to those of the step.
    pub part: f64,
}

impl Moment {
    /// The end of a load step.
    pub fn end_of(step: usize) -> Self {
        Self { step, part: 1.0 }
    }
}

/// What acts in a load step on what this rank has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loads {
    /// On its blocks, by their number.
    pub blocks: BTreeMap<usize, BlockLoads>,
    /// On its contact groups, by their number.
    pub groups: BTreeMap<usize, GroupLoads>,
}

impl Context<'_> {
    /// What acts at a moment.
    pub fn loads(&self, moment: Moment) -> Loads {
        let mut loads = self.loads_of_step(moment.step);
        if moment.part < 1.0 {
            let before = (moment.step.checked_sub(1)).map(|step| self.loads_of_step(step));
            for (b, loads) in &mut loads.blocks {
                // Nothing acts on what isn't there, whatever did before.
                if self.catalog.bodies[self.catalog.subdomains[*b].body].is_absent {
                    continue;
                }
                let before = before.as_ref().map(|before| &before.blocks[b]);
                loads.go_back(before, moment.part);
            }
            for (g, loads) in &mut loads.groups {
                let before = before.as_ref().map(|before| &before.groups[g]);
                loads.go_back(before, moment.part);
            }
        }
        loads
    }

    /// What acts at the end of load step k.
    fn loads_of_step(&self, k: usize) -> Loads {
        let (blocks, groups) = (self.blocks.iter(), self.groups.iter());
        Loads {
            blocks: blocks
                .map(|(&b, block)| (b, BlockLoads::new(block, k)))
                .collect(),
            groups: groups
                .map(|(&g, group)| (g, GroupLoads::new(group, k)))
                .collect(),
        }
    }

    /// A failure that says in which load step it was.
    pub fn in_step(&self, mut failure: Failure, k: usize) -> Failure {
        if let Some(step) = self.catalog.steps.get(k) {
            failure.message = format!("step '{}': {}", step.name, failure.message);
        }
        failure
    }
}
