//! One cut of a set of blocks into two.

use super::blocks::Blocks;
use crate::flops::{Front, condensation};

/// Some of the blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct Set {
    /// Its blocks.
    pub blocks: Vec<u32>,
    /// Their seams, with each other or with blocks outside, each once.
    pub seams: Vec<u32>,
}

/// Where a block is while a cut is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Left,
    Right,
    Outside,
}

/// Judges cuts.
pub(super) struct Judge<'b> {
    blocks: &'b Blocks,
    side: Vec<Side>,
}

/// A cut, the better the lower its score.
pub(super) struct Cut {
    /// Whether each block of the set is on the left.
    pub left: Vec<bool>,
    /// The front that merges both sides.
    pub front: Front,
    /// Estimated flops of all that is under it and of itself, and a price for imbalance.
    pub score: f64,
}

impl<'b> Judge<'b> {
    /// Gets ready for cuts of sets of these blocks.
    pub fn new(blocks: &'b Blocks) -> Self {
        Self {
            blocks,
            side: vec![Side::Outside; blocks.len()],
        }
    }

    /// Judges a cut. `price` of the flops that an even cut would save where two work in parallel
    /// counts as cost; `weights` tell what the blocks cost with their part of the fronts.
    pub fn judge(&mut self, set: &Set, left: Vec<bool>, weights: &[f64], price: f64) -> Cut {
        let mut interior = [0.0; 2];
        let mut weight = [0.0; 2];
        let mut kept = [0; 2];
        for (&block, &left) in set.blocks.iter().zip(&left) {
            self.side[block as usize] = if left { Side::Left } else { Side::Right };
            let side = usize::from(!left);
            interior[side] += self.blocks.dofs[block as usize];
            weight[side] += weights[block as usize];
            kept[side] += self.blocks.conditions[block as usize];
        }
        let mut front = Front {
            eliminated: 0,
            kept: kept[0] + kept[1],
        };
        for &seam in &set.seams {
            let dofs = self.blocks.seam_dofs[seam as usize];
            let [on_left, on_right, outside] = self.sides(seam);
            match (on_left && on_right, outside) {
                (true, false) => front.eliminated += dofs,
                (_, true) => front.kept += dofs,
                (false, false) => continue,
            }
            kept[0] += if on_left { dofs } else { 0 };
            kept[1] += if on_right { dofs } else { 0 };
        }
        for &block in &set.blocks {
            self.side[block as usize] = Side::Outside;
        }
        let half = |side: usize| condensation(interior[side], kept[side] as f64);
        let below = half(0) + half(1);
        let uneven = (weight[0] - weight[1]).abs() / (weight[0] + weight[1]);
        Cut {
            left,
            front,
            score: front.flops() + below * (1.0 + price * uneven),
        }
    }

    fn sides(&self, seam: u32) -> [bool; 3] {
        let mut found = [false; 3];
        for &block in self.blocks.sharing.of(seam as usize) {
            found[self.side[block as usize] as usize] = true;
        }
        found
    }

    /// The two sets of a cut.
    pub fn halves(&mut self, set: &Set, left: &[bool]) -> [Set; 2] {
        let mut halves = [Set::default(), Set::default()];
        for (&block, &left) in set.blocks.iter().zip(left) {
            self.side[block as usize] = if left { Side::Left } else { Side::Right };
            halves[usize::from(!left)].blocks.push(block);
        }
        for &seam in &set.seams {
            let [on_left, on_right, _] = self.sides(seam);
            if on_left {
                halves[0].seams.push(seam);
            }
            if on_right {
                halves[1].seams.push(seam);
            }
        }
        for &block in &set.blocks {
            self.side[block as usize] = Side::Outside;
        }
        halves
    }
}
