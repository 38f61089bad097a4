//! Where reference coordinates lie.

/// What a reference element fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// The origin.
    Point,
    /// −1 ≤ ξ ≤ 1.
    Line,
    /// The triangle with the corners (0, 0), (1, 0), (0, 1).
    Triangle,
    /// −1 ≤ ξ, η ≤ 1.
    Square,
}

impl Domain {
    /// Its dimension.
    pub fn dim(self) -> usize {
        match self {
            Self::Point => 0,
            Self::Line => 1,
            Self::Triangle | Self::Square => 2,
        }
    }

    /// Number of its corners.
    pub fn corners(self) -> usize {
        match self {
            Self::Point => 1,
            Self::Line => 2,
            Self::Triangle => 3,
            Self::Square => 4,
        }
    }

    /// Its measure.
    pub fn measure(self) -> f64 {
        match self {
            Self::Point => 1.0,
            Self::Line => 2.0,
            Self::Triangle => 0.5,
            Self::Square => 4.0,
        }
    }

    /// The point that a point of the unit square stands for; a triangle is the square with one of
    /// its edges collapsed, (s, t) → (s, t(1 − s)).
    pub(super) fn of_unit_square(self, [s, t]: [f64; 2]) -> [f64; 3] {
        match self {
            Self::Triangle => [s, t * (1.0 - s), 0.0],
            _ => [2.0 * s - 1.0, 2.0 * t - 1.0, 0.0],
        }
    }
}
