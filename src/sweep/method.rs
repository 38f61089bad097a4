//! The methods, M δ = r(U) with an M each: name, memory, and what a sweep of it does.

use super::anderson::Chords;
use super::newton::Stalls;
use super::picard::Relaxation;
use super::{Next, Residual, Sweeps};
use crate::plan::cluster::Merging;
pub use contact_dd_partition::solver::Method;

/// What the method that has its turn remembers from one sweep to the next.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Memory {
    Newton(Stalls),
    Anderson(Chords),
    /// `None` before ρ(S_0⁻¹ S_CON') is known.
    Picard(Option<Relaxation>),
}

/// What becomes of contact when Schur complements are merged: picard inverts S_0 alone, which has to
/// be that of all linear subdomains.
pub fn merging(method: Method) -> Merging {
    match method {
        Method::Picard => Merging::Linear,
        Method::Newton | Method::Anderson => Merging::All,
    }
}

impl Memory {
    /// What a method remembers before its first sweep.
    pub(super) fn before(method: Method) -> Self {
        match method {
            Method::Newton => Self::Newton(Stalls::default()),
            Method::Anderson => Self::Anderson(Chords::default()),
            Method::Picard => Self::Picard(None),
        }
    }

    /// One sweep of the method, from where the residual is `before`.
    pub(super) fn sweep(self, sweeps: &mut Sweeps<'_, '_>, before: Residual) -> Next {
        match self {
            Self::Newton(stalls) => sweeps.newton(stalls, before),
            Self::Anderson(chords) => sweeps.anderson(chords, before),
            Self::Picard(relaxation) => sweeps.picard(relaxation, before),
        }
    }
}

impl Default for Memory {
    fn default() -> Self {
        Self::before(Method::Newton)
    }
}
