//! Jumps whose force several conditions carry.

use serde::{Deserialize, Serialize};

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

/// The conditions that share jumps, jump by jump.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SharedJumps(pub Vec<Sharer>);

impl SharedJumps {
    /// All conditions but those that stand for bounds.
    pub fn iter(&self) -> impl Iterator<Item = &Sharer> {
        self.0.iter()
    }

    /// Those of a jump.
    pub fn of_jump(&self, jump: usize) -> impl Iterator<Item = &Sharer> {
        self.iter().filter(move |sharer| sharer.jump == jump)
    }

    /// The part that this condition has, if it is one of them.
    pub fn of_condition(&self, condition: usize) -> Option<&Sharer> {
        self.iter().find(|sharer| sharer.condition == condition)
    }

    /// The part of a jump's force that is left to the condition that stands for its bound.
    pub fn rest(&self, jump: usize) -> f64 {
        let others = self.of_jump(jump);
        1.0 - others
            .map(|sharer| sharer.factor * sharer.part)
            .sum::<f64>()
    }

    /// Appends those of another group, whose jumps and conditions follow after these numbers.
    pub fn append(&mut self, others: &Self, jumps: usize, conditions: usize) {
        self.0.extend(others.iter().map(|sharer| Sharer {
            jump: jumps + sharer.jump,
            condition: conditions + sharer.condition,
            ..*sharer
        }));
    }

    /// Makes the `gaps` of conditions that share a jump equal, which round-off keeps apart.
    pub fn equalize(&self, gaps: &mut [f64]) {
        for sharer in &self.0 {
            gaps[sharer.condition] += sharer.raise;
        }
    }
}
