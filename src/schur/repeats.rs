//! Equal subdomains: one factorization for all of them.

use std::collections::BTreeMap;
use std::sync::Arc;

use faer::{Mat, Par};

use super::factor::FactorError;
use super::local::LocalSchur;
use super::pattern::SparseSymmetric;

/// What equal blocks have in common, known before anything is assembled, so that no other block is
/// kept for comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct BlockShape {
    /// Number of nodes on Γ.
    pub interface: usize,
    /// Number of contact conditions.
    pub conditions: usize,
    /// Hash of where the nodes lie from the first one, and of the cells' nodes.
    pub mesh: u64,
}

/// Factorizes blocks, those whose stiffness is the same bit for bit once.
///
/// Such are translations of one mesh with one material and supports at the same nodes, where the
/// differences of coordinates are free of round-off.
#[derive(Debug, Default)]
pub struct Repeats {
    to_come: BTreeMap<BlockShape, usize>,
    known: BTreeMap<BlockShape, Vec<Known>>,
    /// Blocks that needed no factorization.
    pub found: usize,
}

/// A block that was factorized.
#[derive(Debug)]
struct Known {
    stiffness: SparseSymmetric,
    interior: usize,
    schur: Arc<LocalSchur>,
    s: Mat<f64>,
}

impl Repeats {
    /// Expects blocks of these shapes.
    pub fn new(shapes: impl Iterator<Item = BlockShape>) -> Self {
        let mut to_come = BTreeMap::new();
        for shape in shapes {
            *to_come.entry(shape).or_default() += 1;
        }
        Self {
            to_come,
            ..Self::default()
        }
    }

    /// The factor and S of a block of this shape, whose first `interior` unknowns are I.
    ///
    /// # Errors
    /// K_II isn't positive definite: the block can move with its boundary held.
    pub fn factorize(
        &mut self,
        shape: BlockShape,
        stiffness: &SparseSymmetric,
        interior: usize,
        par: Par,
    ) -> Result<(Arc<LocalSchur>, Mat<f64>), FactorError> {
        let to_come = self.to_come.entry(shape).or_insert(1);
        *to_come = to_come.saturating_sub(1);
        let is_last = *to_come == 0;
        let known = self.known.entry(shape).or_default();
        let same = (known.iter()).find(|k| k.interior == interior && k.stiffness == *stiffness);
        let result = match same {
            Some(same) => {
                self.found += 1;
                (Arc::clone(&same.schur), same.s.clone())
            }
            None => {
                let (schur, s) = LocalSchur::new(stiffness, interior, par)?;
                let schur = Arc::new(schur);
                if !is_last {
                    known.push(Known {
                        stiffness: stiffness.clone(),
                        interior,
                        schur: Arc::clone(&schur),
                        s: s.clone(),
                    });
                }
                (schur, s)
            }
        };
        if is_last {
            self.known.remove(&shape);
        }
        Ok(result)
    }
}
