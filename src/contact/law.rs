//! The law of a pair, λ = c − S_tΓ U − H t ≥ 0, t ≤ g, λ (g − t) = 0: what S_kl(U) of (12) follows from.

use faer::Mat;

use super::dependent::DependentRows;
use super::pair::ContactPair;
use crate::comm::{Message, MessageReader};

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
    /// The largest displacement prescribed in the pair by the loads that there are now (m).
    pub scale: f64,
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

    /// Appends the law of `pair` to a message.
    pub fn pack(pair: &ContactPair, message: &mut Message) {
        let diagonal = pair.diagonal();
        message.integers.push(diagonal.len() as i64);
        let defining = &pair.limits().defining;
        message.integers.extend(defining.iter().map(|&j| j as i64));
        message.push_lower(pair.s_tt());
        message.push_matrix(pair.s_t_gamma());
        message.reals.extend(diagonal);
        pair.limits().rows.pack(message);
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
            scale: 0.0,
        }
    }
}
