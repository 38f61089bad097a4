//! The contacts of a scene in the catalog.

use crate::contact_point::ContactPoint;

/// A contact of the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ContactSummary {
    /// Name.
    pub name: String,
    /// Number of its constraints.
    pub conditions: usize,
    /// True if one of its points has friction.
    pub has_friction: bool,
    /// The kind of its constraints.
    pub kind: ContactKind,
    /// True if one of its points is compliant.
    pub is_compliant: bool,
}

/// Kind of the constraints of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactKind {
    /// Sides that press on each other and open.
    #[default]
    Unilateral,
    /// Sides that are tied to each other.
    Tie,
    /// A linear equation between displacements.
    Equation,
    /// A spring between points.
    Spring,
    /// Nodes that follow a reference point.
    Coupling,
    /// The sides of a cut through a bolt, which the bolt pulls together.
    Pretension,
    /// The prescribed or locked shortening at that cut.
    Held,
}

impl ContactKind {
    /// The kind of the contact of a point.
    pub fn of<N: Copy>(point: &ContactPoint<N>) -> Self {
        match (point.law.is_tied(), point.axes.is_empty()) {
            (false, _) => Self::Unilateral,
            (true, true) => Self::Tie,
            (true, false) if point.is_compliant() => Self::Spring,
            (true, false) => match (point.tag_a, point.tag_b) {
                (-1, -1) => Self::Coupling,
                (-1, _) => Self::Held,
                (_, -1) => Self::Equation,
                _ => Self::Pretension,
            },
        }
    }

    /// The name in messages.
    pub fn word(self) -> &'static str {
        match self {
            Self::Unilateral => "contact",
            Self::Tie => "tie",
            Self::Equation => "equation",
            Self::Spring => "spring",
            Self::Coupling => "coupling",
            Self::Pretension => "pretension",
            Self::Held => "held pretension",
        }
    }
}
