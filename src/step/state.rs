//! State between load steps.

use std::collections::BTreeMap;
use std::ops::Range;

use contact_dd_partition::destination::unfinished;
use contact_dd_partition::id::{BlockId, GroupId, OnBlocks, OnGroups, OnPairs};

use crate::bytes::Reals;
use crate::certificate::energy::BlockEnergy;
use crate::certificate::scales::Scales;
use crate::contact::friction::Status;
use crate::contact::laws::Statuses;
use crate::contact::pair::{ContactPair, PairState};
use crate::context::{Context, LoadPoint, Loads};
use crate::error::Failure;
use crate::plan::Plan;
use crate::rigid::body_analysis::without_closing_motions;
use crate::rigid::body_analysis::{RigidBodyAnalysis, analyse_bodies};
use crate::rigid::infeasible_nodes;
use crate::settings::Settings;
use crate::sweep::{Method, Start, SweepOutcome, SweepStatus};

/// State at the end of a load step, from which the next one starts.
#[derive(Clone, Debug, Default)]
pub struct StepState {
    /// U, and the statuses of every cluster in contact; on the root.
    pub interface: Option<(Vec<f64>, Vec<Vec<Status>>)>,
    /// The clusters in contact of this rank, by their number among the pairs.
    pub pairs: OnPairs<PairState>,
    /// The statuses of the contact groups of this rank, if the tree solver is used; empty if unknown.
    pub statuses: OnGroups<Statuses>,
    /// The tangential jumps at the tangential constraints of every contact group of this rank, since the bodies were
    /// unloaded (m).
    pub slips: OnGroups<Vec<f64>>,
    /// Data of the blocks of this rank for the energy balance, if there is friction.
    pub energies: OnBlocks<BlockEnergy>,
    /// The scales of the converged load steps so far; on the root.
    pub scales: Scales,
}

impl StepState {
    /// The state after a step with these `slips` and `energies`, and on the root its `outcome` and `scales`. A diverged
    /// step leaves no start for the next one; nor do others with picard, whose relaxation is determined for the
    /// contacts closed in the bilateral solution.
    pub fn after(
        (pairs, statuses): (OnPairs<ContactPair>, OnGroups<Statuses>),
        slips: OnGroups<Vec<f64>>,
        energies: OnBlocks<BlockEnergy>,
        (outcome, scales): (Option<&SweepOutcome>, Scales),
        method: Method,
    ) -> Self {
        let pairs = pairs.into_iter();
        let starts = |outcome: &&SweepOutcome| {
            method != Method::Picard && outcome.status == SweepStatus::Converged
        };
        Self {
            interface: (outcome.filter(starts)).map(|o| (o.u.clone(), o.statuses.clone())),
            pairs: pairs.map(|(p, pair)| (p, pair.into_state())).collect(),
            statuses,
            slips,
            energies,
            scales,
        }
    }

    /// The loads at a point of the load path after this state, without the closing motions of `analysis`; sides stick
    /// at this state's tangential jumps, and friction opposes the slip from there.
    pub fn loads(
        &self,
        context: &Context<'_>,
        load_point: LoadPoint,
        analysis: &RigidBodyAnalysis,
    ) -> Loads {
        let mut loads = context.loads(load_point);
        for (g, loads) in &mut loads.groups {
            let slips = self.slips.get(g).map_or(&[][..], Vec::as_slice);
            let first = loads.gaps.len() - slips.len();
            loads.gaps[first..].copy_from_slice(slips);
        }
        without_closing_motions(context, loads, analysis)
    }

    /// The state redistributed from the owners of groups and blocks in the plan `before` to those in the present plan.
    /// Collective.
    #[must_use]
    pub fn handed_over(mut self, context: &Context<'_>, before: &Plan) -> Self {
        let Context { comm, plan, .. } = *context;
        let routes = |from: &[usize], to: &[usize]| -> Vec<(usize, usize)> {
            from.iter().copied().zip(to.iter().copied()).collect()
        };
        let (mut slips, mut energies) = (BTreeMap::new(), BTreeMap::new());
        comm.route(
            routes(before.group_owners().values(), plan.group_owners().values()),
            |i| self.slips.remove(&GroupId::new(i)).map(Reals),
            |i, of_group| {
                slips.extend(of_group.map(|Reals(of_group)| (GroupId::new(i), of_group)));
            },
        );
        comm.route(
            routes(before.owners().values(), plan.owners().values()),
            |i| self.energies.remove(&BlockId::new(i)),
            |i, energy| {
                energies.extend(energy.map(|energy| (BlockId::new(i), energy)));
            },
        );
        Self {
            slips,
            energies,
            // Another solver starts from the bilateral problem.
            statuses: BTreeMap::new(),
            ..self
        }
    }

    /// Start of the sweeps of the next step; on the root.
    pub fn start(&self) -> Start {
        match &self.interface {
            Some((u, statuses)) => Start::Before(u.clone(), statuses.clone()),
            None => Start::Bilateral,
        }
    }
}

/// Rigid-body analysis of the scene at the end of these load steps, starting from the closing motions `before`.
/// Collective.
///
/// # Errors
/// Prescribed displacements that contradict obstacles at a node, or a load that drives a free rigid-body motion.
pub fn analyse_steps(
    context: &Context<'_>,
    steps: Range<usize>,
    before: &[Vec<f64>],
) -> Result<Vec<RigidBodyAnalysis>, Failure> {
    let mut analyses: Vec<RigidBodyAnalysis> = Vec::new();
    for k in steps {
        let before = analyses.last().map_or(before, |last| &last.closing_motions);
        let analysis = analyse(context, LoadPoint::end_of(k), before)
            .map_err(|failure| context.in_step(failure, k))?;
        analyses.push(analysis);
    }
    Ok(analyses)
}

/// Rigid-body analysis of the scene at a point of the load path, starting from the closing motions `before`, which are
/// empty at first. Collective.
///
/// # Errors
/// Prescribed displacements that contradict obstacles at a node, or a load that drives a free rigid-body motion.
pub fn analyse(
    context: &Context<'_>,
    load_point: LoadPoint,
    before: &[Vec<f64>],
) -> Result<RigidBodyAnalysis, Failure> {
    let loads = context.loads(load_point);
    let mut groups = context.groups.values().zip(loads.groups.values());
    let checked = groups
        .try_for_each(|(group, loads)| infeasible_nodes::check(group, loads, context.catalog));
    context.comm.agree(checked)?;
    analyse_bodies(context, &loads, before)
}

/// A failure after k load steps; if it was a signal, the message states where their results are.
pub fn finished(failure: Failure, context: &Context<'_>, settings: &Settings, k: usize) -> Failure {
    failure.after(
        k,
        context.catalog.steps.len(),
        &unfinished(&settings.output),
    )
}

/// Ends the run before load step k if a signal has asked for that. Collective.
///
/// # Errors
/// A signal has asked the run to stop.
pub fn stop_if_asked(context: &Context<'_>, settings: &Settings, k: usize) -> Result<(), Failure> {
    check_interrupt(context).map_err(|failure| finished(failure, context, settings, k))
}

/// Returns an error if a signal has asked the run to stop. Collective.
///
/// # Errors
/// A signal has asked the run to stop.
pub fn check_interrupt(context: &Context<'_>) -> Result<(), Failure> {
    match context.comm.is_any_asked_to_stop() {
        false => Ok(()),
        true => Err(Failure::interrupted("interrupted")),
    }
}
