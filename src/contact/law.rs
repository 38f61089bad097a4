//! The law of a pair, λ = c − S_tΓ U − H t ≥ 0, t ≤ g, λ (g − t) = 0: what S_kl(U) of (12) follows from.

use faer::Mat;

use super::dependent::DependentRows;
use super::limits::Limits;
use crate::comm::{Message, MessageReader};
use crate::schur::condensed::Condensed;

/// λ = c − S_tΓ U − H t ≥ 0, t ≤ g, λ (g − t) = 0, and D t ≤ d where there is such: the part of S_kl
/// that the root needs to solve for all pairs at once.
#[derive(Clone, Debug)]
pub struct PairLaw {
    /// H, on the approaches (Pa).
    pub h: Mat<f64>,
    /// S_tΓ, approaches against traces (Pa).
    pub s_t_gamma: Mat<f64>,
    /// The diagonal of the matrix that H is condensed from (Pa).
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

    /// Appends the law of a cluster in contact to a message.
    pub fn pack(condensed: &Condensed, limits: &Limits, message: &mut Message) {
        let diagonal = &condensed.diagonal[..condensed.approaches];
        message.integers.push(diagonal.len() as i64);
        let defining = limits.defining.iter();
        message.integers.extend(defining.map(|&j| j as i64));
        message.push_lower(condensed.s_tt());
        message.push_matrix(condensed.s_t_gamma());
        message.reals.extend(diagonal);
        limits.rows.pack(message);
    }

    /// The law of a pair with `traces` traces.
    pub fn unpack(reader: &mut MessageReader, traces: usize) -> Self {
        let m = reader.count();
        Self {
            defining: (reader.integers(m).iter()).map(|&j| j as usize).collect(),
            h: reader.symmetric(m),
            s_t_gamma: reader.matrix(m, traces),
            diagonal: reader.reals(m),
            rows: DependentRows::unpack(reader),
        }
    }
}
