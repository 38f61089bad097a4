//! The operators of a stage, made of matrices once for all of its load steps: factors, S_0 and the bilateral operator, or
//! the fronts above all contact.

use std::cell::RefCell;

use crate::comm::clock::Times;
use crate::comm::ranks::RankSeconds;
use crate::condense::Condensation;
use crate::condense::blocks::CondensedBlocks;
use crate::condense::interface::assemble_interface;
use crate::condense::limits::{limits_of_clusters, limits_of_groups};
use crate::condense::tree::condense_clusters;
use crate::contact::tangent::TangentialLimit;
use crate::context::{Context, Loads};
use crate::error::Failure;
use crate::interface::numbering::Numbering;
use crate::interface::operator::Interface;
use crate::report::log::RunLog;
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::step::Loading;
use crate::tree::fronts::ActiveSetFronts;

/// The operators of a stage, as this rank has them.
pub struct Operators {
    /// The factors of this rank.
    pub condensed: CondensedBlocks,
    /// Γ and the operators on it; on the root, where they are assembled.
    pub interface: Option<(Numbering, Interface)>,
    /// The fronts above all contact, where active sets are fixed one after the other.
    pub fronts: Option<RefCell<ActiveSetFronts>>,
}

impl Operators {
    /// S_i of the linear subdomains, (11), and S_kl of the pairs, (12), merged up the hierarchy; then S_0, (15), and the
    /// bilateral operator at the root. `loads` are those of the stage's first load step, whose rigid motions `analysis`
    /// knows. Collective.
    ///
    /// # Errors
    /// A part that can move although its boundary is held, or a signal that asked the run to stop.
    pub fn new(
        context: Context<'_>,
        log: &RunLog<'_>,
        loads: &Loads,
        analysis: &RigidBodyAnalysis,
        seconds: &mut RankSeconds,
    ) -> Result<Self, Failure> {
        let comm = context.comm;
        log.phase("factorizing", Some(context.blocks.len()));
        let lap = comm.times();
        let condensation = Condensation {
            context,
            loads,
            fixing_dofs: &analysis.motions.fixing_dofs,
        };
        let mut condensed = condense_clusters(&condensation, &analysis.cluster_modes)
            .map_err(|failure| context.of_pivot(failure))?;
        let [assembling, factorizing] = condensed.seconds;
        let condensing = Times {
            // Waiting is nobody's time on the wall.
            elapsed: factorizing.elapsed,
            ..comm.times() - lap - assembling
        };
        seconds.add(|s| &mut s.assemble, assembling);
        seconds.add(|s| &mut s.factorize, condensing);

        log.phase("assembling the interface problem", None);
        let lap = comm.times();
        let fronts = match context.plan.merging.has_active_set() {
            true => Some(RefCell::new(ActiveSetFronts::new(
                &condensation,
                std::mem::take(&mut condensed.linear),
            )?)),
            false => None,
        };
        let interface = match fronts {
            Some(_) => None,
            None => assemble_interface(&context, &condensed)
                .map_err(|failure| context.of_pivot(failure))?,
        };
        seconds.add(|s| &mut s.interface, comm.times() - lap);
        Ok(Self {
            condensed,
            interface,
            fronts,
        })
    }

    /// The parts of the problem of a load step that don't depend on its loads, but for the rigid motions.
    pub fn loading<'a>(
        &'a self,
        context: Context<'a>,
        analysis: &'a RigidBodyAnalysis,
    ) -> Loading<'a> {
        Loading {
            context,
            factors: &self.condensed,
            interface: self.interface.as_ref(),
            analysis,
        }
    }

    /// Takes the laws of friction under other `loads` on the same bodies, and forgets what the last solution has left to begin
    /// with: the next one has the bits of the first one of a run. Collective.
    ///
    /// # Errors
    /// Supports that make two sides penetrate.
    pub fn begin_anew(&mut self, context: &Context<'_>, loads: &Loads) -> Result<(), Failure> {
        let limits = limits_of_clusters(context, &limits_of_groups(context, loads)?);
        let mut all: Vec<Vec<TangentialLimit>> = Vec::new();
        context.comm.gather(
            &context.plan.pair_owners(),
            |p| {
                limits
                    .get(&p)
                    .map_or_else(Vec::new, |of| of.tangents.clone())
            },
            |_, tangents| all.push(tangents),
        );
        if let Some((_, interface)) = &mut self.interface {
            for (law, tangents) in interface.laws.iter_mut().zip(all) {
                law.tangents = tangents;
            }
            interface.last_patch.forget();
        }
        Ok(())
    }

    /// The smallest pivot relative to its diagonal entry; on the root.
    pub fn smallest_pivot(&self) -> f64 {
        match (&self.interface, &self.fronts) {
            (Some((_, interface)), _) => interface.smallest_pivot(),
            (None, Some(fronts)) => fronts.borrow().smallest_pivot,
            (None, None) => 1.0,
        }
    }
}
