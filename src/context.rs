//! What every phase of a run works on.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;
use faer::Par;

use crate::comm::Comm;
use crate::error::Failure;
use crate::fem::block::OwnedBlock;
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
    pub blocks: &'a BTreeMap<usize, OwnedBlock>,
    /// Threads.
    pub par: Par,
}

/// What acts on the blocks of this rank in a load step, by their number.
pub type Loads = BTreeMap<usize, BlockLoads>;

impl Context<'_> {
    /// What acts in load step k.
    pub fn loads(&self, k: usize) -> Loads {
        let blocks = self.blocks.iter();
        blocks
            .map(|(&b, owned)| (b, BlockLoads::new(owned, k)))
            .collect()
    }

    /// A failure that says in which load step it was.
    pub fn in_step(&self, mut failure: Failure, k: usize) -> Failure {
        if let Some(step) = self.catalog.steps.get(k) {
            failure.message = format!("step '{}': {}", step.name, failure.message);
        }
        failure
    }
}
