//! The error of the mesh in a quantity, by the solution w of its transposed problem (dual-weighted residuals; Becker
//! and Rannacher, Acta Numerica 10, 2001).
//!
//! ```text
//! J(u) − J(u_h) = a(u − u_h, w − w_h) ≈ ∫ (σ*(u_h) − σ(u_h)) C⁻¹ (σ*(w_h) − σ(w_h)) dx
//! ```
//!
//! with σ* the stress recovered from σ, as in the estimate of the energy's error (Ródenas, González-Estrada and others,
//! Int. J. Numer. Methods Engrg 101, 2015). As recovery is linear, it follows from the errors E of two states: 4 α a =
//! E(u + α w) − E(u − α w).
//!
//! The estimate lacks the violation of constraints between nodes, and the change of the quantity's own weights with the
//! mesh. Weights of stresses that vary from cell to cell, as those around a crack tip, make σ(w) as rough as they are:
//! recovery can't estimate its error there.

use contact_dd_partition::id::{BlockId, OnBlocks};
use contact_dd_partition::quantity::{Quantity, QuantityKind};

use super::solved::Solved;
use super::transposed::Transposed;
use crate::context::Context;
use crate::recover::BlockSolution;
use crate::recover::stresses::{Stress, stresses};

/// Share of the first-order change in an energy, which is ½ a(u, u): half of it comes from w, which is u itself.
const OF_ENERGY: f64 = 0.5;

/// The estimated error of a quantity: its value less the exact one.
#[derive(Debug, Default)]
pub struct MeshError {
    /// The total error; on the root.
    pub error: f64,
    /// The contributions of the cells of every block of this rank.
    pub of_cells: OnBlocks<Vec<f64>>,
}

impl MeshError {
    /// The error of a quantity whose transposed problem is solved; `None` without stresses, and for the pressure of a
    /// single point or a quantity of a crack tip. Collective.
    pub fn new(solved: Solved<'_>, quantity: &Quantity, of: &Transposed) -> Option<Self> {
        let has_estimate = match quantity.kind {
            QuantityKind::LargestPressure => quantity.length > 0.0,
            QuantityKind::OpeningIntensity
            | QuantityKind::SlidingIntensity
            | QuantityKind::EnergyReleaseRate => false,
            _ => true,
        };
        if solved.solution.stress.is_none() || !has_estimate {
            return None;
        }
        let context = &solved.fixed.context;
        let (u, w) = (&solved.solution.discrete.blocks, &of.discrete.blocks);
        let size = |of: &OnBlocks<BlockSolution>| {
            let all = of.values().flat_map(|of_block| &of_block.u);
            context.comm.largest(all)
        };
        let scale = size(u) / size(w);
        if !scale.is_normal() {
            return Some(Self::default());
        }
        let (ahead, back) = (both(solved, (u, w), scale), both(solved, (u, w), -scale));
        let part = match quantity.kind {
            QuantityKind::Energy => OF_ENERGY,
            _ => 1.0,
        };
        let factor = -part / (4.0 * scale);
        let of_block = |(&b, ahead): (&BlockId, &Stress)| {
            let cells = ahead.errors.iter().zip(&back.get(&b)?.errors);
            let errors = cells.map(|(ahead, back)| factor * (ahead.error - back.error));
            Some((b, errors.collect()))
        };
        let of_cells: OnBlocks<Vec<f64>> = ahead.iter().filter_map(of_block).collect();
        let sum = |b: BlockId| of_cells.get(&b).map_or(0.0, |errors| errors.iter().sum());
        Some(Self {
            error: context.sum_of_blocks(sum),
            of_cells,
        })
    }
}

/// The stresses of u + factor w. Collective.
fn both(
    solved: Solved<'_>,
    (u, w): (&OnBlocks<BlockSolution>, &OnBlocks<BlockSolution>),
    factor: f64,
) -> OnBlocks<Stress> {
    let of_block = |(&b, of_block): (&BlockId, &BlockSolution)| {
        let all = of_block.u.iter().zip(&w.get(&b)?.u);
        let u = all.map(|(u, w)| u + factor * w).collect();
        let pushes = Vec::new();
        Some((b, BlockSolution { u, pushes }))
    };
    let both = u.iter().filter_map(of_block).collect();
    let Context {
        comm,
        blocks,
        catalog,
        plan,
        ..
    } = solved.fixed.context;
    stresses(comm, blocks, &both, catalog, plan, solved.step)
}
