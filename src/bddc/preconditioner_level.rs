//! Levels of the preconditioner: from cheap ones to those that are good, or that can be made at all.

/// Classes that are made coarse, and whether the preconditioner is held where round-off keeps it from being definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PreconditionerLevel {
    /// The rigid motions of classes, of which clusters have shares as their diagonals say, in single precision.
    Diagonals,
    /// The rigid motions of classes.
    Motions,
    /// Coarse unknowns chosen by their energies.
    Energies,
    /// Rigid motions, and all is held by a little.
    Held,
}

impl PreconditionerLevel {
    /// The first level. In the plane clusters share so little that all of it can be looked at.
    pub fn first(dim: usize) -> Self {
        match dim {
            3 => Self::Diagonals,
            _ => Self::Motions,
        }
    }

    /// Shares of diagonal entries of which the first is added that leaves something definite.
    pub fn holds(self) -> &'static [f64] {
        match self {
            Self::Held => &[0.0, 1e-13, 1e-11, 1e-9, 1e-7],
            _ => &[0.0],
        }
    }

    /// The next one to be tried.
    pub fn next(self) -> Option<Self> {
        match self {
            Self::Diagonals | Self::Motions => Some(Self::Energies),
            Self::Energies => Some(Self::Held),
            Self::Held => None,
        }
    }
}
