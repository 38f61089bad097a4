//! Tangential conditions of contact points, and the bounds of their forces.

use serde::{Deserialize, Serialize};

/// The bound of a tangential force: |λ_t| ≤ cohesion + coefficient·λ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceBound {
    /// Coefficient of friction.
    pub coefficient: f64,
    /// The bound without normal force (N/m).
    pub cohesion: f64,
    /// True if the bound is 0 where the contact is open.
    pub only_closed: bool,
}

impl ForceBound {
    /// The bound under this normal force (N/m).
    pub fn at(&self, normal: f64, is_closed: bool) -> f64 {
        match self.only_closed && !is_closed {
            true => 0.0,
            false => self.cohesion + self.coefficient * normal.max(0.0),
        }
    }

    /// The bound in the scale of energies: the forces of its point are divided by these scales, the normal one first.
    pub fn scaled(&self, normal: Option<f64>, tangential: f64) -> Self {
        Self {
            coefficient: normal.map_or(0.0, |normal| self.coefficient * normal / tangential),
            cohesion: self.cohesion / tangential,
            only_closed: self.only_closed,
        }
    }

    /// The bound as a linear function of the normal force: its value at none (N/m), and its slope.
    pub fn line(&self, is_closed: bool) -> [f64; 2] {
        match is_closed {
            true => [self.cohesion, self.coefficient],
            false => [self.at(0.0, false), 0.0],
        }
    }
}

/// A tangential condition: its number, that of its point's normal condition, and the bound of its force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentialCondition {
    /// The number among the conditions.
    pub number: usize,
    /// Number of the normal condition.
    pub normal: usize,
    /// Bound of its force.
    pub bound: ForceBound,
}

/// Friction condition: the tangential jump sticks at the bound of `limit` while |λ_t| is within the bound of its force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TangentialLimit {
    /// Number among the limits.
    pub limit: usize,
    /// The limit on the normal jump of its point, if that carries force.
    pub normal: Option<usize>,
    /// Bound of its force.
    pub bound: ForceBound,
    /// Slip of its point along the other tangent.
    pub other: OtherTangent,
}

/// Slip of a point along its other tangent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum OtherTangent {
    /// No slip: the plane has only one tangent, or supports restrain the other.
    #[default]
    Nothing,
    /// The slip of this limit.
    Limit(usize),
    /// A slip in the load step that supports prescribe (m).
    Prescribed(f64),
}

impl TangentialLimit {
    /// The tangential limits of its point, the second of which may be missing, and the slip that supports prescribe
    /// along the second tangent (m); `None` if this is the second limit.
    pub fn of_point(&self) -> Option<([Option<usize>; 2], f64)> {
        let (second, prescribed) = match self.other {
            OtherTangent::Limit(other) if other < self.limit => return None,
            OtherTangent::Limit(other) => (Some(other), 0.0),
            OtherTangent::Prescribed(slip) => (None, slip),
            OtherTangent::Nothing => (None, 0.0),
        };
        Some(([Some(self.limit), second], prescribed))
    }

    /// The condition with limits renumbered.
    #[must_use]
    pub fn renamed(&self, number: impl Fn(usize) -> usize) -> Self {
        Self {
            limit: number(self.limit),
            normal: self.normal.map(&number),
            bound: self.bound,
            other: match self.other {
                OtherTangent::Limit(limit) => OtherTangent::Limit(number(limit)),
                known => known,
            },
        }
    }
}

/// Tangential conditions, each with the number of its point's other tangential condition.
pub fn with_other(
    friction: &[TangentialCondition],
) -> impl Iterator<Item = (&TangentialCondition, Option<usize>)> {
    friction.iter().enumerate().map(|(k, own)| {
        let neighbours = [k.checked_sub(1), Some(k + 1)].into_iter().flatten();
        let mut others = neighbours.filter_map(|k| friction.get(k));
        let other = others.find(|other| other.normal == own.normal);
        (own, other.map(|other| other.number))
    })
}
