//! The contact problem of a load step, and the steps towards its solution.

use std::time::Instant;

use contact_dd_partition::id::{OnGroups, OnTreeNodes};

use crate::contact::laws::ContactLaws;
use crate::contact::limits::Limits;
use crate::context::Context;
use crate::error::Failure;
use crate::fem::contact_group::ContactGroup;
use crate::sweep::{SweepOutcome, SweepRecord};
use crate::tree::fronts::ActiveSetFronts;

/// The contact problem of a load step on this rank.
pub(super) struct TreeProblem<'a> {
    /// The context of the run.
    pub context: &'a Context<'a>,
    /// The limits of every contact group.
    pub limits: &'a OnGroups<Limits>,
    /// The laws of these limits.
    pub laws: OnGroups<ContactLaws<'a>>,
    /// The stiffness to which the round-off of every limit's force is relative (N/m).
    pub stiffest: OnGroups<Vec<f64>>,
    /// Prescribed values of closed jumps and of ties (m).
    pub bounds: OnGroups<Vec<f64>>,
    /// Loads on the boundaries of clusters, by node.
    pub loads: &'a OnTreeNodes<Vec<f64>>,
}

impl<'a> TreeProblem<'a> {
    /// The problem of these `loads` within `limits`.
    pub fn new(
        context: &'a Context<'a>,
        limits: &'a OnGroups<Limits>,
        loads: &'a OnTreeNodes<Vec<f64>>,
    ) -> Self {
        let mut problem = Self {
            context,
            limits,
            laws: OnGroups::new(),
            stiffest: OnGroups::new(),
            bounds: OnGroups::new(),
            loads,
        };
        for (&g, limits) in limits {
            let group = &context.groups[&g];
            let of_points = |stiffness: fn(&ContactGroup, usize) -> f64| -> Vec<f64> {
                let points = points_of_limits(group, limits).into_iter();
                points.map(|point| stiffness(group, point)).collect()
            };
            let r = of_points(ContactGroup::stiffness_at);
            let of_group = ContactLaws::new(&limits.bounds, &limits.rows, &limits.tangents, r);
            let stiffest = of_points(ContactGroup::largest_stiffness_at);
            problem.laws.insert(g, of_group);
            problem.stiffest.insert(g, stiffest);
            // The bounds of ties follow those of limits.
            let bounds = limits.bounds.iter().copied();
            let of_ties = limits.tied.iter().map(|&(_, jump)| jump);
            problem.bounds.insert(g, bounds.chain(of_ties).collect());
        }
        problem
    }

    /// Flags of no open limit.
    pub fn all_closed(&self) -> OnGroups<Vec<bool>> {
        let all = self.limits.iter();
        all.map(|(&g, limits)| (g, vec![false; limits.bounds.len()]))
            .collect()
    }
}

/// The number of the point of every limit of a group.
fn points_of_limits(group: &ContactGroup, limits: &Limits) -> Vec<usize> {
    let conditions: Vec<usize> = group.conditions().map(|one| one.point).collect();
    let of_limits = limits.conditions_of_limits().into_iter();
    of_limits.map(|j| conditions[j]).collect()
}

/// The steps towards a solution.
pub(super) struct Steps<'o> {
    began: Instant,
    /// Their outcome so far.
    pub outcome: SweepOutcome,
    observer: &'o mut dyn FnMut(&SweepRecord),
}

impl<'o> Steps<'o> {
    /// No steps yet; the `observer` receives a record of each.
    pub fn new(observer: &'o mut dyn FnMut(&SweepRecord)) -> Self {
        Self {
            began: Instant::now(),
            outcome: SweepOutcome::before(Vec::new()),
            observer,
        }
    }

    /// Number of steps.
    pub fn count(&self) -> usize {
        self.outcome.records.len()
    }

    /// Records a step with the `residual` after it, the number of `active` limits, the number that `changed` before it,
    /// and the `iterations` of an iterative solver.
    pub fn record(
        &mut self,
        (residual, active, changed): (f64, usize, Option<usize>),
        fronts: &ActiveSetFronts,
        iterations: usize,
    ) {
        let record = SweepRecord {
            sweep: self.count(),
            residual,
            active,
            changed,
            seconds: self.began.elapsed().as_secs_f64(),
        };
        self.outcome.records.push(record);
        if let Some(coarse_dofs) = fronts.coarse_dofs() {
            let solves = self.outcome.iterative.get_or_insert_default();
            solves.iterations.push(iterations);
            solves.coarse_dofs = coarse_dofs;
        }
        (self.observer)(&record);
    }

    /// Continues unless a signal has asked the run to stop. Collective.
    ///
    /// # Errors
    /// A signal has.
    pub fn check_interrupt(&self, context: &Context<'_>) -> Result<(), Failure> {
        match context.comm.is_any_asked_to_stop() {
            false => Ok(()),
            true => Err(Failure::interrupted(format!(
                "interrupted after {} sweeps",
                self.count()
            ))),
        }
    }
}
