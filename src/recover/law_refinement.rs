//! Iterative refinement of the contact problem itself: the laws are solved anew for the change of jumps and forces that
//! balances the residual.
//!
//! ```text
//! λ + δλ = λ + r − H δt,    0 ≤ λ + δλ ⊥ g − t − δt ≥ 0,    friction likewise
//! ```
//!
//! r is the residual of the full discrete problem, condensed onto the jumps. Round-off is relative to the terms of the
//! change here, but relative to H t in the sweeps: forces far below those that deform the bodies, such as friction that
//! alone holds a stiff body on a soft one, become accurate to their last digits.

use std::cell::Cell;
use std::collections::BTreeMap;

use contact_dd_partition::id::{OnBlocks, OnPairs, PairId};

use crate::contact::status::LimitState;
use crate::interface::coupled::{CoupledContact, PairChange};
use crate::recover::DiscreteSolution;
use crate::recover::fixed_active_set::{FixedActiveSet, FixedStatuses, put_tied};

/// Vectors on all unknowns of every block of this rank.
type OnUnknowns = OnBlocks<Vec<f64>>;

impl FixedActiveSet<'_> {
    /// The solution with its contact laws solved anew from `before`, under these unbalanced `loads` on the blocks'
    /// unknowns; `None` if the laws have no solution there, or the root can't solve for all pairs at once. Collective.
    pub fn solve_laws(
        &self,
        before: &DiscreteSolution,
        loads: OnUnknowns,
    ) -> Option<DiscreteSolution> {
        let (context, factors) = (&self.context, self.factors());
        if !context.comm.decide(self.has_coupled_contact()) {
            return None;
        }
        let groups = before.groups.iter();
        let states = groups
            .map(|(&g, of_group)| (g, of_group.states(&context.groups[&g])))
            .collect();
        let mut limits = BTreeMap::new();
        for (p, of_cluster) in factors.collect_conditions(states) {
            if let Some(pair) = self.step.pairs.get(&p) {
                limits.insert(p, pair.limits().states(&of_cluster));
            }
        }
        let tied = self.missing_of_ties(&held(before));
        let condensed = factors.condense(loads, &tied);
        let converged = Cell::new(false);
        let (changes, boundaries) =
            self.solve_interface(&limits, &condensed, |coupled, (r, loads), states| {
                let (change, is_solution) = coupled.solve_laws(r, loads, states);
                converged.set(is_solution);
                change
            });
        if !context.comm.decide(converged.get()) {
            return None;
        }
        let (blocks, of_ties) = factors.recover(&condensed, boundaries);
        let mut solution = before.clone();
        solution.add(self.condensed, blocks);
        for (g, known) in factors.spread_conditions(self.conditions_of(changes)) {
            if let Some(of_group) = solution.groups.get_mut(&g) {
                of_group.take(&context.groups[&g], known);
            }
        }
        let mut of_ties_alone = self.no_forces();
        put_tied(&mut of_ties_alone, &of_ties, &tied);
        for (g, changes) in of_ties_alone {
            if let Some(of_group) = solution.groups.get_mut(&g) {
                let forces = of_group.forces.iter_mut().zip(changes);
                forces.for_each(|(force, change)| *force += change);
            }
        }
        solution.share(context, &self.step.loads);
        Some(solution)
    }

    /// True if this is the root, which can solve for all pairs at once.
    fn has_coupled_contact(&self) -> bool {
        let interface = self.root.and_then(|root| root.interface);
        interface.is_some_and(|(_, problem)| CoupledContact::new(problem).is_some())
    }

    /// The forces of all conditions of clusters in contact, and which are closed, from the states of their limits.
    fn conditions_of(&self, changes: OnPairs<PairChange<LimitState>>) -> OnPairs<Vec<(f64, bool)>> {
        let of_cluster = |(p, then): (PairId, PairChange<LimitState>)| {
            let limits = self.step.pairs.get(&p)?.limits();
            let closed = then.limits.iter().map(|then| then.status.is_closed());
            let forces: Vec<f64> = then.limits.iter().map(|then| then.force).collect();
            let forces = limits.forces(&forces).into_iter();
            Some((p, forces.zip(limits.closed(closed)).collect()))
        };
        changes.into_iter().filter_map(of_cluster).collect()
    }

    /// Undoes slips: closed points return to their positions of stick, with the forces that this takes, as the solution
    /// moves under these `loads`. Collective.
    pub fn undo_slips(&self, solution: &mut DiscreteSolution, loads: OnUnknowns) {
        for (&g, of_group) in &mut solution.groups {
            for point in self.context.groups[&g].point_laws() {
                let holds = !point.has_opened(&of_group.closed);
                point.limits().for_each(|j| of_group.closed[j] = holds);
            }
        }
        let change = self.solve(loads, held(solution), &BTreeMap::new(), 0.0);
        solution.add(self.condensed, change.blocks);
        for (g, changes) in change.forces {
            if let Some(of_group) = solution.groups.get_mut(&g) {
                let forces = of_group.forces.iter_mut().zip(&of_group.closed);
                for ((force, closed), change) in forces.zip(changes) {
                    *force = if *closed { *force + change } else { 0.0 };
                }
            }
        }
        solution.share(&self.context, &self.step.loads);
    }
}

/// The statuses of all conditions with the closed ones held at their bounds.
fn held(solution: &DiscreteSolution) -> FixedStatuses {
    let groups = solution.groups.iter();
    groups
        .map(|(&g, of_group)| (g, of_group.fixed_statuses()))
        .collect()
}
