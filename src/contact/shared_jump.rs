//! Conditions that bound one jump alike, as those of two nodes that a tie or an equation joins: all carry force, in
//! proportion to their areas, so that their pressures are equal.

use serde::{Deserialize, Serialize};

use super::jumps::JumpOf;
use super::tangent::TangentialCondition;

/// Relative difference of factors and of friction laws below which they are equal.
const SAME: f64 = 1e-9;

/// A condition beside the one that stands for the bound of a jump.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sharer {
    /// Number of the jump.
    pub jump: usize,
    /// Number of the condition.
    pub condition: usize,
    /// The condition's jump is this multiple of the jump.
    pub factor: f64,
    /// Its force is this part of the jump's.
    pub part: f64,
    /// Round-off by which its own bound is too small (m).
    pub raise: f64,
}

/// Conditions of a group as data for shared jumps.
#[derive(Clone, Copy, Debug)]
pub struct Conditions<'a> {
    /// The jump of each.
    pub of: &'a [JumpOf],
    /// The bound of each (m).
    pub gaps: &'a [f64],
    /// The area of the point of each (m, in space m²).
    pub areas: &'a [f64],
    /// The tangential ones.
    pub friction: &'a [TangentialCondition],
    /// The largest prescribed displacement (m).
    pub scale: f64,
    /// Difference of bounds below which they are equal (m).
    pub round_off: f64,
}

impl Conditions<'_> {
    /// The conditions that share the jump of the one that defines it.
    pub fn sharers(&self, defining: &[usize]) -> Vec<Sharer> {
        let mut of_jumps: Vec<Vec<(usize, f64)>> = vec![Vec::new(); defining.len()];
        for (j, of) in self.of.iter().enumerate() {
            if let JumpOf::Unknown { number, factor } = *of
                && j != defining[number]
            {
                of_jumps[number].push((j, factor));
            }
        }
        let mut sharers = Vec::new();
        for (jump, (&first, mut alike)) in defining.iter().zip(of_jumps).enumerate() {
            if alike.is_empty() || self.is_tangential(first) {
                continue;
            }
            alike.retain(|&(j, factor)| self.is_alike(first, j, factor));
            let weight = |&(j, factor): &(usize, f64)| factor * self.areas[j];
            let total = self.areas[first] + alike.iter().map(weight).sum::<f64>();
            for (j, factor) in alike {
                let part = self.areas[j] / total;
                sharers.push(Sharer {
                    jump,
                    condition: j,
                    factor,
                    part,
                    raise: factor * self.gaps[first] - self.gaps[j],
                });
                for (own, other) in self.tangential(first).zip(self.tangential(j)) {
                    if let JumpOf::Unknown { number, factor } = self.of[own.number] {
                        sharers.push(Sharer {
                            jump: number,
                            condition: other.number,
                            factor,
                            part,
                            raise: factor * self.gaps[own.number] - self.gaps[other.number],
                        });
                    }
                }
            }
        }
        sharers
    }

    fn is_tangential(&self, j: usize) -> bool {
        self.friction
            .binary_search_by_key(&j, |tangential| tangential.number)
            .is_ok()
    }

    /// The tangential conditions of a normal one's point.
    fn tangential(&self, normal: usize) -> impl Iterator<Item = &TangentialCondition> {
        self.friction.iter().filter(move |one| one.normal == normal)
    }

    /// True if the normal condition j has the bound of the `first` one, and the same friction along the same tangents.
    fn is_alike(&self, first: usize, j: usize, factor: f64) -> bool {
        let equal = |a: f64, b: f64| (a - b).abs() <= self.round_off;
        if self.is_tangential(j) || !equal(self.gaps[j] / factor, self.gaps[first]) {
            return false;
        }
        let (mut own, mut others) = (self.tangential(first), self.tangential(j));
        loop {
            let (own, other) = match (own.next(), others.next()) {
                (None, None) => return true,
                (Some(own), Some(other)) => (own, other),
                _ => return false,
            };
            let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
            let one_law = same(own.bound.coefficient, other.bound.coefficient)
                && own.bound.only_closed == other.bound.only_closed
                && same(
                    own.bound.cohesion * self.areas[j],
                    other.bound.cohesion * self.areas[first],
                );
            let one_jump = match (&self.of[own.number], &self.of[other.number]) {
                (
                    JumpOf::Unknown {
                        number,
                        factor: 1.0,
                    },
                    JumpOf::Unknown {
                        number: of_other,
                        factor,
                    },
                ) => number == of_other && same(*factor, 1.0),
                (JumpOf::Prescribed, JumpOf::Prescribed) => true,
                _ => false,
            };
            let one_bound = equal(self.gaps[own.number], self.gaps[other.number]);
            if !(one_law && one_jump && one_bound && same(factor, 1.0)) {
                return false;
            }
        }
    }
}
