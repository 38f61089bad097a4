//! The methods, M δ = r(U) with an M each: name, memory, and what a sweep of it does.

use serde::{Deserialize, Serialize};

use super::anderson::Chords;
use super::newton::Stalls;
use super::picard::Relaxation;
use super::{Next, Residual, Sweeps};
use crate::plan::cluster::Merging;

/// How U is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Newton: S_0 + S_CON is inverted, contact conditions included.
    Newton,
    /// Accelerated chord: S_0 + S_CON' of the bilateral problem is inverted.
    Anderson,
    /// The paper's successive approximations (18): S_0 is inverted.
    Picard,
}

/// What the method that has its turn remembers from one sweep to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Memory {
    Newton(Stalls),
    Anderson(Chords),
    /// `None` before ρ(S_0⁻¹ S_CON') is known.
    Picard(Option<Relaxation>),
}

impl Method {
    /// Its name on the command line and in the report.
    pub fn name(self) -> &'static str {
        match self {
            Self::Newton => "newton",
            Self::Anderson => "anderson",
            Self::Picard => "picard",
        }
    }

    /// What it remembers before its first sweep.
    pub(super) fn memory(self) -> Memory {
        match self {
            Self::Newton => Memory::Newton(Stalls::default()),
            Self::Anderson => Memory::Anderson(Chords::default()),
            Self::Picard => Memory::Picard(None),
        }
    }

    /// What becomes of contact when Schur complements are merged: picard inverts S_0 alone, which has
    /// to be that of all linear subdomains.
    pub fn merging(self) -> Merging {
        match self {
            Self::Picard => Merging::Linear,
            Self::Newton | Self::Anderson => Merging::All,
        }
    }
}

impl Memory {
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
        Method::Newton.memory()
    }
}
