//! Operators of a stage, computed once for all of its load steps: the factors, and S_0 with the bilateral operator or
//! the fronts of the tree solver.

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

/// The operators of a stage on this rank.
pub struct Operators {
    /// The factors of this rank.
    pub condensed: CondensedBlocks,
    /// Γ and the operators on it, if they are assembled; on the root.
    pub interface: Option<(Numbering, Interface)>,
    /// The fronts above all contacts, if active sets are fixed.
    pub fronts: Option<RefCell<ActiveSetFronts>>,
}

impl Operators {
    /// S_i of the linear subdomains, (11), and S_kl of the pairs, (12), merged up the hierarchy; then S_0, (15), and
    /// the bilateral operator at the root. `loads` are those of the stage's first load step, `analysis` is its
    /// rigid-body analysis. Collective.
    ///
    /// # Errors
    /// A part with a free motion although its boundary is held, or a signal that stopped the run.
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
            // Elapsed time is the rank's own, without the waiting for others.
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
                std::mem::take(&mut condensed.merge_roots),
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

    /// The parts of a load step's problem that don't depend on its loads, but on the rigid-body analysis.
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

    /// Sets the friction laws for other `loads` on the same bodies, and clears the state of the last solution, so that
    /// the next one is bitwise equal to the first one of a run. Collective.
    ///
    /// # Errors
    /// Prescribed displacements by which two sides penetrate.
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

    /// The smallest pivot, relative to its diagonal entry; on the root.
    pub fn smallest_pivot(&self) -> f64 {
        match (&self.interface, &self.fronts) {
            (Some((_, interface)), _) => interface.smallest_pivot(),
            (None, Some(fronts)) => fronts.borrow().smallest_pivot,
            (None, None) => 1.0,
        }
    }
}
