//! The condensed blocks and clusters of a rank.

use std::collections::BTreeMap;

use crate::contact::pair::ContactPair;
use crate::fem::assembly::Spring;
use crate::fem::dofs::Dofs;
use crate::schur::condensed::Condensed;
use crate::schur::local::LocalSchur;
use crate::schur::merge::Merge;

/// What this rank has of the condensed blocks and of what they were merged into.
#[derive(Debug, Default)]
pub struct CondensedBlocks {
    /// The unknowns of every block.
    pub dofs: BTreeMap<usize, Dofs>,
    /// The diagonal of every block's stiffness (Pa).
    pub diagonals: BTreeMap<usize, Vec<f64>>,
    /// The springs in it.
    pub springs: BTreeMap<usize, Vec<Spring>>,
    /// The factor of every block.
    pub factors: BTreeMap<usize, LocalSchur>,
    /// The merge at every inner node of the hierarchy.
    pub merges: BTreeMap<usize, Merge>,
    /// T: the clusters without contact, by their place among all.
    pub linear: BTreeMap<usize, Condensed>,
    /// ϑ: the clusters in contact, by their place among those.
    pub pairs: BTreeMap<usize, ContactPair>,
    /// Time for assembling and for factorizing (s).
    pub seconds: [f64; 2],
}
