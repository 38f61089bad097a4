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
    /// What acts in load step k.
    pub fn loads(&self, k: usize) -> Loads {
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
