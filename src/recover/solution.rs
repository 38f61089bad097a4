//! The solution of a load step on the blocks of this rank, with its checks and derived results.

use contact_dd_partition::id::{BlockId, OnBlocks};

use crate::certificate::Certificate;
use crate::fem::estimate::CellError;
use crate::fem::quantity::Quantities;
use crate::fem::resultants::Reaction;
use crate::fem::strain::LargestStrain;
use crate::fem::stress_intensity::StressIntensity;
use crate::recover::conditioning::condition_number;
use crate::recover::fixed_active_set::FixedActiveSet;
use crate::recover::minimum_norm::{
    MinimumNorm, friction_limit, remove_free_modes, take_minimum_norm,
};
use crate::recover::reactions::reactions;
use crate::recover::refine::{correct_statuses, refine, refine_laws};
use crate::recover::stress_intensity::stress_intensities;
use crate::recover::stresses::{Stress, error_estimate, largest_strain, stresses};
use crate::recover::{DiscreteSolution, displacements};
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::rigid::body_analysis::with_closing_motions;

/// Solution that follows from U.
#[derive(Debug)]
pub struct Solution {
    /// Displacement without the bodies' closing motions, contact forces and closed points.
    pub discrete: DiscreteSolution,
    /// Displacement with the closing motions, node by node (m).
    pub displacement: OnBlocks<Vec<f64>>,
    /// Stresses, unless they are left out.
    pub stress: Option<OnBlocks<Stress>>,
    /// The check of the full discrete problem; on the root.
    pub certificate: Certificate,
    /// The condition number; on the root, if it can be estimated.
    pub condition: Option<f64>,
    /// Outcome of released modes.
    pub minimum_norm: MinimumNorm,
    /// The motions along which friction at its bounds lets bodies slide under the same forces, as text; on the root.
    pub friction_limit: Vec<String>,
    /// Reactions of supports; on the root.
    pub reactions: Vec<Reaction>,
    /// Stress intensity of crack tips, where there are stresses; on the root.
    pub stress_intensities: Vec<StressIntensity>,
    /// The quantities that the scene requests, once they are evaluated; on the root.
    pub quantities: Quantities,
    /// The estimate of the mesh's error, where there are stresses; on the root.
    pub estimate: Option<CellError>,
    /// The largest strain of a cell, where there are stresses, and the block that has it; on the root.
    pub largest_strain: Option<(BlockId, LargestStrain)>,
}

impl Solution {
    /// True if displacements and stresses are finite everywhere, as far as sums over all of them tell. On the root.
    pub fn is_finite(&self) -> bool {
        let estimate = self.estimate.unwrap_or_default();
        self.certificate.is_a_number() && estimate.error.is_finite() && estimate.energy.is_finite()
    }

    /// Refines a `discrete` solution against the full discrete problem, and recovers stresses if they are requested,
    /// those of load step `stress_of`. Collective.
    pub fn new(
        fixed: &FixedActiveSet<'_>,
        analysis: &RigidBodyAnalysis,
        mut discrete: DiscreteSolution,
        stress_of: Option<usize>,
    ) -> Self {
        let (comm, plan, catalog) = (
            fixed.context.comm,
            fixed.context.plan,
            fixed.context.catalog,
        );
        remove_free_modes(fixed, &mut discrete);
        let certificate = refine(fixed, &mut discrete);
        let mut certificate = match fixed.fronts {
            None => refine_laws(fixed, &mut discrete, certificate),
            Some(_) => correct_statuses(fixed, &mut discrete, certificate),
        };
        let minimum_norm = take_minimum_norm(fixed, analysis, &mut discrete, &mut certificate);
        // A released mode has no stiffness, so that there is no condition number.
        let condition = match minimum_norm.has_released_modes {
            true => None,
            false => condition_number(fixed, &discrete),
        };
        let blocks = &discrete.blocks;
        let stress =
            stress_of.map(|step| stresses(comm, fixed.context.blocks, blocks, catalog, plan, step));
        Self {
            displacement: with_closing_motions(&fixed.context, displacements(blocks), analysis),
            friction_limit: friction_limit(fixed, analysis, &discrete),
            reactions: reactions(fixed, blocks),
            stress_intensities: stress_of.map_or_else(Vec::new, |step| {
                stress_intensities(&fixed.context, blocks, step)
            }),
            quantities: Quantities::default(),
            estimate: (stress.as_ref()).map(|stress| error_estimate(comm, stress, plan)),
            largest_strain: (stress.as_ref()).map(|stress| largest_strain(comm, stress, plan)),
            discrete,
            stress,
            certificate,
            condition,
            minimum_norm,
        }
    }
}
