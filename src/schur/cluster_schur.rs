//! The Schur complement of a cluster.

use faer::Mat;

use super::condensed::{Condensed, InterfaceDof};
use super::symmetric::PackedSymmetric;

/// The packed Schur complement of a cluster, or of a whole tree of the hierarchy.
#[derive(Debug)]
pub struct ClusterSchur {
    /// The unknowns on Γ, ascending.
    pub dofs: Vec<InterfaceDof>,
    /// S (Pa).
    pub s: PackedSymmetric,
    /// The diagonal of the matrix that S is condensed from (Pa).
    pub diagonal: Vec<f64>,
}

impl ClusterSchur {
    /// The packed form of a node of the hierarchy, and the memory of its S for reuse.
    pub fn packed(condensed: Condensed) -> (Self, Mat<f64>) {
        let cluster = Self {
            s: PackedSymmetric::new(&condensed.s),
            dofs: condensed.interface_dofs,
            diagonal: condensed.diagonal,
        };
        (cluster, condensed.s)
    }
}
