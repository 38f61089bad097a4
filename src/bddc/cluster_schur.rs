//! The Schur complement of a cluster.

use crate::schur::condensed::{Condensed, InterfaceDof};
use crate::schur::symmetric::PackedSymmetric;

/// The Schur complement of a cluster.
#[derive(Debug)]
pub struct ClusterSchur {
    /// The unknowns on Γ, ascending.
    pub dofs: Vec<InterfaceDof>,
    /// S (Pa).
    pub s: PackedSymmetric,
    /// The diagonal of the matrix that S is condensed from (Pa).
    pub diagonal: Vec<f64>,
}

impl From<Condensed> for ClusterSchur {
    fn from(condensed: Condensed) -> Self {
        Self {
            s: PackedSymmetric::new(&condensed.s),
            dofs: condensed.interface_dofs,
            diagonal: condensed.diagonal,
        }
    }
}
