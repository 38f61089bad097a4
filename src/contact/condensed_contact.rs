//! The contact laws of a pair, condensed onto its jumps.

use faer::Mat;
use serde::{Deserialize, Serialize};

use super::dependent::DependentConstraints;
use super::limits::{Limits, TangentialLimit};
use crate::schur::condensed::Condensed;

/// λ = c − S_tΓ U − H t ≥ 0, t ≤ g, λ (g − t) = 0, and D t ≤ d if there are dependent rows: the part of S_kl that the
/// root needs to solve for all pairs at once.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CondensedContact {
    /// H, on the normal jumps (Pa).
    #[serde(with = "crate::bytes::symmetric")]
    pub h: Mat<f64>,
    /// S_tΓ, normal jumps against traces (Pa).
    #[serde(with = "crate::bytes::matrix")]
    pub s_t_gamma: Mat<f64>,
    /// The diagonal of the matrix that H is condensed from (Pa).
    #[serde(with = "crate::bytes")]
    pub diagonal: Vec<f64>,
    /// D.
    pub rows: DependentConstraints,
    /// The condition that defines each normal jump as an unknown.
    pub defining: Vec<usize>,
    /// The limits of tangential jumps.
    pub tangents: Vec<TangentialLimit>,
    /// The condition of each limit.
    pub conditions: Vec<usize>,
}

impl CondensedContact {
    /// Number of normal jumps.
    pub fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// The law of a cluster in contact.
    pub fn new(condensed: &Condensed, limits: &Limits) -> Self {
        Self {
            h: condensed.s_tt().to_owned(),
            s_t_gamma: condensed.s_t_gamma().to_owned(),
            diagonal: condensed.diagonal[..condensed.jumps].to_vec(),
            rows: limits.rows.clone(),
            defining: limits.defining.clone(),
            tangents: limits.tangents.clone(),
            conditions: limits.conditions_of_limits(),
        }
    }
}
