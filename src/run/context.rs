//! What every phase of a run works on.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;
use faer::Par;

use crate::comm::Comm;
use crate::fem::owned::OwnedBlock;
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
