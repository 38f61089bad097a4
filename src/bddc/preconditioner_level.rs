//! Levels of the preconditioner, from cheap to good, with springs as a last resort.

/// Choice of coarse unknowns, and whether springs hold the preconditioner where round-off keeps it from being definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PreconditionerLevel {
    /// The rigid motions of classes, with the clusters' shares by their diagonals, in single precision.
    Diagonals,
    /// The rigid motions of classes.
    Motions,
    /// Coarse unknowns chosen by their energies.
    Energies,
    /// Rigid motions, with weak springs on all unknowns.
    Held,
}

impl PreconditionerLevel {
    /// The first level. In the plane clusters share so few unknowns that their full stiffness is affordable.
    pub fn first(dim: usize) -> Self {
        match dim {
            3 => Self::Diagonals,
            _ => Self::Motions,
        }
    }

    /// Shares of diagonal entries, the first of which that makes the matrix definite is added.
    pub fn shifts(self) -> &'static [f64] {
        match self {
            Self::Held => &[0.0, 1e-13, 1e-11, 1e-9, 1e-7],
            _ => &[0.0],
        }
    }

    /// The next level to be tried.
    pub fn next(self) -> Option<Self> {
        match self {
            Self::Diagonals | Self::Motions => Some(Self::Energies),
            Self::Energies => Some(Self::Held),
            Self::Held => None,
        }
    }
}
