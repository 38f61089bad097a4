//! The law of a pair, λ = c − S_tΓ U − H t ≥ 0, t ≤ g, λ (g − t) = 0: what S_kl(U) of (12) follows from.

use faer::Mat;
use serde::{Deserialize, Serialize};

use super::dependent::DependentRows;
use super::limits::Limits;
use crate::schur::condensed::Condensed;

/// λ = c − S_tΓ U − H t ≥ 0, t ≤ g, λ (g − t) = 0, and D t ≤ d where there is such: the part of S_kl
/// that the root needs to solve for all pairs at once.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PairLaw {
    /// H, on the approaches (Pa).
    #[serde(with = "crate::bytes::symmetric")]
    pub h: Mat<f64>,
    /// S_tΓ, approaches against traces (Pa).
    #[serde(with = "crate::bytes::matrix")]
    pub s_t_gamma: Mat<f64>,
    /// The diagonal of the matrix that H is condensed from (Pa).
    #[serde(with = "crate::bytes")]
    pub diagonal: Vec<f64>,
    /// D.
    pub rows: DependentRows,
    /// The condition that each approach is the unknown of.
    pub defining: Vec<usize>,
}

impl PairLaw {
    /// Number of approaches.
    pub fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.diagonal.is_empty()
    }

    /// The law of a cluster in contact.
    pub fn new(condensed: &Condensed, limits: &Limits) -> Self {
        Self {
            h: condensed.s_tt().to_owned(),
            s_t_gamma: condensed.s_t_gamma().to_owned(),
            diagonal: condensed.diagonal[..condensed.approaches].to_vec(),
            rows: limits.rows.clone(),
            defining: limits.defining.clone(),
        }
    }
}
