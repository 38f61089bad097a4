//! The solution of a load step on the blocks of this rank, and what it says of itself.

use std::collections::BTreeMap;

use crate::certificate::Certificate;
use crate::fem::estimate::CellError;
use crate::output::resultants::Reaction;
use crate::recover::conditioning::condition_number;
use crate::recover::frozen::Frozen;
use crate::recover::reactions::reactions;
use crate::recover::refine::refine;
use crate::recover::settle::{Settled, settle_free_motions, settle_loose_motions};
use crate::recover::stresses::{Stress, error_estimate, stresses};
use crate::recover::{BlockSolution, displacements, recover};
use crate::rigid::descent::with_descent;
use crate::rigid::survey::Survey;

/// What is known once U is.
#[derive(Debug)]
pub struct Solution {
    /// Displacement without the bodies' way to rest, forces and closed conditions of every block.
    pub blocks: BTreeMap<usize, BlockSolution>,
    /// Displacement with it, node by node (m).
    pub displacement: BTreeMap<usize, Vec<f64>>,
    /// Stresses, unless they are left out.
    pub stress: Option<BTreeMap<usize, Stress>>,
    /// The check of the full discrete problem; on the root.
    pub certificate: Certificate,
    /// The condition number; on the root, where it can be made.
    pub condition: Option<f64>,
    /// What became of loose motions.
    pub settled: Settled,
    /// What supports carry; on the root.
    pub reactions: Vec<Reaction>,
    /// The estimate of the mesh's error, where there are stresses; on the root.
    pub estimate: Option<CellError>,
}

impl Solution {
    /// Substitutes U back, of which the root has `u`, refines what comes of it against the full discrete problem, and recovers stresses if they are asked for.
    /// Collective.
    pub fn new(frozen: &Frozen<'_>, survey: &Survey, u: Option<&[f64]>, with_stress: bool) -> Self {
        let (comm, plan, catalog) = (
            frozen.context.comm,
            frozen.context.plan,
            frozen.context.catalog,
        );
        let numbers = frozen.root.map(|root| &root.numbering.traces[..]);
        let mut blocks = recover(frozen.factors(), frozen.step, u.zip(numbers));
        settle_free_motions(frozen, &mut blocks);
        let mut certificate = refine(frozen, &mut blocks);
        let settled = settle_loose_motions(frozen, survey, &mut blocks, &mut certificate);
        // What is loose has no stiffness that could be compared.
        let condition = match settled.is_loose {
            true => None,
            false => condition_number(frozen, &blocks),
        };
        let stress =
            with_stress.then(|| stresses(comm, frozen.context.blocks, &blocks, catalog, plan));
        Self {
            displacement: with_descent(&frozen.context, displacements(&blocks), survey),
            reactions: reactions(frozen, &blocks),
            estimate: (stress.as_ref()).map(|stress| error_estimate(comm, stress, plan)),
            blocks,
            stress,
            certificate,
            condition,
            settled,
        }
    }
}
