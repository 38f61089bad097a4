//! The statuses of limits and conditions.

use serde::{Deserialize, Serialize};

/// The status of a limit in the linear problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// No force: a normal jump below its bound, or a tangential one of an open contact.
    Open,
    /// A jump at its bound: closed, or sticking.
    #[default]
    Closed,
    /// Slipping in the direction of its tangent, under λ_t = b.
    Forward,
    /// Slipping against the direction of its tangent, under λ_t = −b.
    Backward,
    /// Slipping along a direction in space.
    Slipping,
    /// Slipping while its contact is about to open: without pressure, under the rest of the cohesion.
    Parting,
}

impl Status {
    /// Open or closed, by this flag.
    pub fn new(open: bool) -> Self {
        match open {
            true => Self::Open,
            false => Self::Closed,
        }
    }

    /// Status of a tangential limit that slips by `slip`.
    pub fn of_slip(slip: f64) -> Self {
        match slip {
            ahead if ahead > 0.0 => Self::Forward,
            back if back < 0.0 => Self::Backward,
            _ => Self::Closed,
        }
    }

    /// True if its jump is known.
    pub fn is_closed(self) -> bool {
        self == Self::Closed
    }

    /// The sign of the force under which it slips, 0 if it doesn't.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Forward => 1.0,
            Self::Backward => -1.0,
            Self::Open | Self::Closed | Self::Slipping | Self::Parting => 0.0,
        }
    }
}

/// The status of a limit or a condition in the linear problem of a change in which all keep their statuses.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum FixedStatus {
    /// No force.
    Open,
    /// Closed: the jump changes by its distance to the bound.
    Closed {
        /// The distance to the bound (m).
        distance: f64,
    },
    /// Slipping: the force changes with the bound of its point and turns with the slip.
    Slips {
        /// Ratio of the force to the bound.
        share: f64,
        /// κ (N/m), force per slip across the direction.
        turning: f64,
    },
    /// Slipping under a force that turns with the slip, whatever the bound of its point.
    Turns {
        /// Ratio of the force to the bound.
        share: f64,
        /// κ (N/m), force per slip across the direction.
        turning: f64,
    },
    /// Slipping along a line while its contact is about to open, without pressure.
    Parts,
}

impl FixedStatus {
    /// Open, or closed without a change of its jump, by this flag.
    pub fn new(open: bool) -> Self {
        match open {
            true => Self::Open,
            false => Self::Closed { distance: 0.0 },
        }
    }

    /// True if its jump is known.
    pub fn is_closed(&self) -> bool {
        matches!(self, Self::Closed { .. })
    }

    /// Distance to the bound if it is closed (m), else 0.
    pub fn distance_to_bound(&self) -> f64 {
        match *self {
            Self::Closed { distance } => distance,
            _ => 0.0,
        }
    }

    /// Adds the κ of a condition that shares its jump (N/m).
    pub fn add_turning(&mut self, of_sharer: f64) {
        if let Self::Slips { turning, .. } | Self::Turns { turning, .. } = self {
            *turning += of_sharer;
        }
    }

    /// Ratio of the force to the bound of its point, and κ (N/m), if it slips.
    pub fn slip(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Slips { share, turning } | Self::Turns { share, turning } => {
                Some([share, turning])
            }
            _ => None,
        }
    }
}

/// State of a limit or a condition, before its law is solved anew or after that.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LimitState {
    /// The force (N/m).
    pub force: f64,
    /// The remaining gap, g − t, or for a tangential one the slip with its sign reversed (m).
    pub gap: f64,
    /// The status.
    pub status: Status,
}
