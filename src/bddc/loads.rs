//! Loads on clusters under a fixed active set, and what clusters and contact groups answer.

use std::collections::BTreeMap;

use contact_dd_partition::id::{OnGroups, OnTreeNodes};

use crate::bddc::local::Vectors;
use crate::contact::laws::Iterate;
use crate::contact::slip_law::SlipLaw;
use crate::schur::condensed::InterfaceDof;

/// The laws of slipping points between clusters, by contact group.
pub type SlipLaws = OnGroups<Vec<SlipLaw>>;

/// The loads on this rank under a fixed active set.
#[derive(Clone, Copy, Debug)]
pub struct ClusterLoads<'a> {
    /// Loads on the boundaries of clusters, by node.
    pub clusters: &'a OnTreeNodes<Vec<f64>>,
    /// The values of the closed jumps of every contact group, followed by those of its ties (m).
    pub prescribed: &'a OnGroups<Vec<f64>>,
    /// The forces on the open jumps of every group with friction (N/m); other groups have none.
    pub forces: &'a OnGroups<Vec<f64>>,
    /// The laws that the forces of slipping points follow if an iterative solver is to find them, starting from `forces`.
    pub laws: Option<&'a SlipLaws>,
}

/// The unknowns of this rank's clusters, and the jumps and forces of its contact groups.
#[derive(Debug, Default)]
pub(super) struct ClusterAnswer {
    /// The unknowns, by cluster.
    pub clusters: Vectors,
    /// The jumps and forces of every contact group between clusters; 0 force where open.
    pub groups: OnGroups<Iterate>,
    /// The forces at the jumps of their ties.
    pub tied: OnGroups<Vec<f64>>,
}

/// The constants of tied displacements (m).
pub(super) type Constants = BTreeMap<InterfaceDof, f64>;
