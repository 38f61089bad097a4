//! The condensed blocks and clusters of a rank.

use std::rc::Rc;

use contact_dd_partition::id::{OnBlocks, OnClusters, OnPairs, OnTreeNodes};

use crate::comm::clock::Times;
use crate::contact::limits::Limits;
use crate::fem::assembly::Spring;
use crate::fem::dofs::Dofs;
use crate::schur::cluster_schur::ClusterSchur;
use crate::schur::condensed::Condensed;
use crate::schur::local::LocalSchur;
use crate::schur::merge::Merge;

/// Condensed block.
#[derive(Debug)]
pub struct CondensedBlock {
    /// Unknowns of the block.
    pub dofs: Dofs,
    /// The diagonal of its stiffness (Pa).
    pub diagonal: Vec<f64>,
    /// Springs added to its stiffness.
    pub springs: Vec<Spring>,
    /// Factor of K_II.
    pub factor: LocalSchur,
}

/// A cluster in contact.
#[derive(Debug)]
pub struct ContactCluster {
    /// Schur complement, both triangles.
    pub condensed: Rc<Condensed>,
    /// The bounds on its normal jumps in the first load step; the constraints that they belong to are the same in all
    /// steps.
    pub limits: Limits,
}

/// The condensed blocks of this rank and the clusters that they were merged into.
#[derive(Debug, Default)]
pub struct CondensedBlocks {
    /// Blocks, by their number.
    pub blocks: OnBlocks<CondensedBlock>,
    /// The merge at every inner node of the hierarchy.
    pub merges: OnTreeNodes<Merge>,
    /// T: the clusters without contact that are merged or assembled, by their number among all.
    pub linear: OnClusters<Condensed>,
    /// The clusters without contact that are merged no further, by their node, where active sets are fixed.
    pub merge_roots: OnTreeNodes<ClusterSchur>,
    /// ϑ: the clusters in contact, by their number among the pairs.
    pub contact: OnPairs<ContactCluster>,
    /// Time of assembly and of factorization (s).
    pub seconds: [Times; 2],
}
