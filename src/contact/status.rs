//! The statuses of limits.

use serde::{Deserialize, Serialize};

/// The status of a limit in the linear problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// Nothing acts: a normal jump below its bound, a tangential one of an open contact.
    Open,
    /// At its bound: closed, or sticking.
    #[default]
    Closed,
    /// Slipping in the direction of its tangent, under λ_t = b.
    Forward,
    /// Slipping against it, under λ_t = −b.
    Backward,
    /// Slipping along a direction in space.
    Slipping,
    /// Slipping while its contact is about to open: without pressure, under what is left of the cohesion.
    Parting,
}

impl Status {
    /// Open or closed.
    pub fn new(open: bool) -> Self {
        match open {
            true => Self::Open,
            false => Self::Closed,
        }
    }

    /// That of a tangential limit that slips by so much.
    pub(super) fn of_slip(slip: f64) -> Self {
        match slip {
            ahead if ahead > 0.0 => Self::Forward,
            back if back < 0.0 => Self::Backward,
            _ => Self::Closed,
        }
    }

    /// Whether its jump is known.
    pub fn is_closed(self) -> bool {
        self == Self::Closed
    }

    /// The sign of the force under which it slips, 0 where it doesn't.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Forward => 1.0,
            Self::Backward => -1.0,
            Self::Open | Self::Closed | Self::Slipping | Self::Parting => 0.0,
        }
    }
}
