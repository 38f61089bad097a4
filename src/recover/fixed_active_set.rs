//! The linear problem of the whole scene with the active set fixed: conditions stay open or closed.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use contact_dd_partition::id::{BlockId, GroupId, OnBlocks, OnGroups, OnPairs, PairId, TreeNodeId};
use contact_dd_partition::numbered::Numbered;

use crate::bddc::solution::Accuracy;
use crate::condense::blocks::CondensedBlocks;
use crate::condense::limits::TiedJumps;
use crate::condense::substitute::Factors;
use crate::contact::limits::Limits;
use crate::contact::slip_law::SlipLaw;
use crate::contact::status::FixedStatus;
use crate::context::Context;
use crate::error::Failure;
use crate::fem::balance::Balance;
use crate::interface::coupled::{CoupledContact, PairChange};
use crate::interface::numbering::Numbering;
use crate::interface::operator::Interface;
use crate::interface::problem::InterfaceProblem;
use crate::recover::BlockSolution;
use crate::recover::motions::{Field, Motions};
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::step::StepProblem;
use crate::sweep::{SweepOutcome, SweepStatus};
use crate::tree::fronts::ActiveSetFronts;
use crate::tree::slip_problem::{Laws, OnJumps, SlipProblem, fix};
use crate::tree::solution::ActiveSetSolution;

/// Best relative accuracy to which slip forces are adapted to the pressure, by solutions for such forces and by an
/// iterative solver.
const FOLLOWED: f64 = 1e-4;
const FOLLOWED_BY_ITERATIONS: f64 = 1e-2;

/// The part of the problem of the fixed active set that a rank holds.
#[derive(Clone, Copy)]
pub struct FixedActiveSet<'a> {
    /// The problem and the ranks of the run.
    pub context: Context<'a>,
    /// The factors of this rank.
    pub condensed: &'a CondensedBlocks,
    /// The problem of the load step.
    pub step: &'a StepProblem<'a>,
    /// The longest closing motion of a body (m).
    pub closing_motions: f64,
    /// Motions that are free even with all contacts closed; springs at pins constrain them.
    pub free: Motions<'a>,
    /// Parts that the root alone holds.
    pub root: Option<FixedActiveSetRoot<'a>>,
    /// The fronts above all contact, if they are eliminated anew for every active set.
    pub fronts: Option<ActiveSetOfStep<'a>>,
    /// The nodes of the hierarchy that carry loads or whose solutions are needed, as in [`Factors`].
    pub only: Option<&'a Numbered<TreeNodeId, bool>>,
}

/// The fronts of the last active set, and the limits of every contact group of this rank.
pub type ActiveSetOfStep<'a> = (&'a RefCell<ActiveSetFronts>, &'a OnGroups<Limits>);

/// Parts that the root alone holds.
#[derive(Clone, Copy)]
pub struct FixedActiveSetRoot<'a> {
    /// Numbering of Γ and the interface problem, if there is one.
    pub interface: Option<(&'a Numbering, &'a InterfaceProblem<'a>)>,
    /// True if the solution is refined: the active sets are right, or no longer change.
    pub is_refined: bool,
    /// True if statuses of contacts with friction cycle.
    pub cycles: bool,
    /// True if loads at round-off of the displacements move bodies without resistance.
    pub moves: bool,
}

/// The statuses of the conditions of every contact group of this rank.
pub type FixedStatuses = OnGroups<Vec<FixedStatus>>;

impl FixedActiveSetRoot<'_> {
    /// True if loads can be solved for: without an interface problem, or if the normal jumps of all pairs can be solved
    /// for at once.
    pub fn can_solve(&self) -> bool {
        (self.interface).is_none_or(|(_, problem)| CoupledContact::new(problem).is_some())
    }
}

/// Change of the solution by a load, on this rank.
#[derive(Clone, Debug, Default)]
pub struct Change {
    /// Change of the unknowns of every block.
    pub blocks: OnBlocks<Vec<f64>>,
    /// Change of the forces of every contact group, 0 where open.
    pub forces: OnGroups<Vec<f64>>,
}

impl<'a> FixedActiveSet<'a> {
    /// The problem of a load step, solved with this `outcome`; `interface` and `outcome` are the root's.
    pub fn new(
        context: Context<'a>,
        condensed: &'a CondensedBlocks,
        step: &'a StepProblem<'a>,
        analysis: &'a RigidBodyAnalysis,
        interface: Option<&'a (Numbering, Interface)>,
        fronts: Option<ActiveSetOfStep<'a>>,
        outcome: Option<&SweepOutcome>,
    ) -> Self {
        let interface = interface.zip(step.interface.as_ref());
        let interface = interface.map(|((numbering, _), problem)| (numbering, problem));
        let on_root = outcome.filter(|_| context.comm.is_root());
        Self {
            context,
            condensed,
            step,
            closing_motions: analysis.longest_closing_motion(),
            free: Motions {
                list: &analysis.motions.free,
                frames: &analysis.frames,
            },
            root: on_root.map(|outcome| FixedActiveSetRoot {
                interface,
                is_refined: outcome.status == SweepStatus::Converged || outcome.is_settled,
                cycles: !outcome.unsettled.is_empty(),
                moves: false,
            }),
            fronts,
            only: None,
        }
    }

    /// The factors.
    pub fn factors(&self) -> Factors<'a> {
        Factors {
            context: self.context,
            condensed: self.condensed,
            only: self.only,
        }
    }

    /// Balance of forces at the nodes of block b of this rank; `None` for another rank's.
    pub fn balance(&self, b: BlockId, solution: &BlockSolution) -> Option<Rc<Balance>> {
        let block = self.context.blocks.get(&b)?;
        let loads = self.step.loads.blocks.get(&b)?;
        let materials = &self.context.catalog.materials;
        let BlockSolution { u, pushes } = solution;
        let compute = || Balance::new(block, loads, materials, u, pushes);
        Some(self.step.balances.of(b, (u, pushes), compute))
    }

    /// Forces at the nodes of this rank's blocks as loads on their unknowns, without the part along free motions.
    /// Collective.
    pub fn on_unknowns(&self, mut forces: OnBlocks<Vec<f64>>) -> OnBlocks<Vec<f64>> {
        let fields = forces.iter_mut().map(|(&b, r)| (b, r)).collect();
        self.free.project(&self.context, Field::Summed, fields);
        let of_block = |(b, forces): (BlockId, Vec<f64>)| {
            let dofs = &self.condensed.blocks.get(&b)?.dofs;
            let mut load = vec![0.0; dofs.len()];
            dofs.add_load(&forces, &mut load);
            Some((b, load))
        };
        forces.into_iter().filter_map(of_block).collect()
    }

    /// The change due to `loads` on the unknowns of this rank's blocks, and of the others', if `conditions` keep their
    /// statuses; friction of points that slip under these `forces` of conditions, by contact group, follows the
    /// pressure in its direction; `tolerance` is that of an iterative solver. Collective.
    pub fn solve(
        &self,
        loads: OnBlocks<Vec<f64>>,
        conditions: FixedStatuses,
        forces: &OnGroups<Vec<f64>>,
        tolerance: f64,
    ) -> Change {
        let factors = self.factors();
        if let Some(fronts) = self.fronts {
            return self.solve_by_fronts(fronts, loads, conditions, forces, tolerance);
        }
        let tied = self.missing_of_ties(&conditions);
        let limits = self.limits(factors.collect_conditions(conditions));
        let condensed = factors.condense(loads, &tied);
        let moves = self.root.is_some_and(|root| root.moves);
        let (changes, boundaries) =
            self.solve_interface(&limits, &condensed, |coupled, (r, loads), fixed| {
                coupled.solve_fixed(r, loads, fixed, moves)
            });
        let of_cluster = |(p, change): (PairId, PairChange<f64>)| {
            let limits = self.step.pairs.get(&p)?.limits();
            Some((p, limits.forces(&change.limits)))
        };
        let forces_of_clusters = changes.into_iter().filter_map(of_cluster).collect();
        let (blocks, of_ties) = factors.recover(&condensed, boundaries);
        let mut forces = self.no_forces();
        forces.extend(factors.spread_conditions(forces_of_clusters));
        put_tied(&mut forces, &of_ties, &tied);
        Change { blocks, forces }
    }

    /// No force at any condition of the contact groups of this rank.
    pub fn no_forces(&self) -> OnGroups<Vec<f64>> {
        let groups = self.context.groups.iter();
        let none = groups.map(|(&g, group)| (g, vec![0.0; group.conditions().count()]));
        none.collect()
    }

    /// Missing jumps of ties, where their conditions have these statuses.
    pub fn missing_of_ties(&self, conditions: &FixedStatuses) -> TiedJumps {
        let of_group = |(&g, tied): (&GroupId, &Vec<(usize, f64)>)| {
            let distance = |&(j, _): &(usize, f64)| (j, conditions[&g][j].distance_to_bound());
            (g, tied.iter().map(distance).collect())
        };
        self.step.tied.iter().map(of_group).collect()
    }

    /// The change by the fronts of a fixed active set. Collective.
    fn solve_by_fronts(
        &self,
        (fronts, limits): ActiveSetOfStep<'_>,
        loads: OnBlocks<Vec<f64>>,
        conditions: FixedStatuses,
        forces: &OnGroups<Vec<f64>>,
        tolerance: f64,
    ) -> Change {
        let factors = self.factors();
        let tied = self.missing_of_ties(&conditions);
        let (mut open, mut missing): (OnGroups<Vec<bool>>, OnJumps) = Default::default();
        let mut laws = Laws::new();
        for (g, of_group) in conditions {
            let fixed = limits[&g].fixed(&of_group);
            if let Some(forces) = forces.get(&g) {
                let group = &self.context.groups[&g];
                let points: Vec<usize> = group.conditions().map(|one| one.point).collect();
                let stiffness = |condition: usize| group.stiffness_at(points[condition]);
                let of_slipping = SlipLaw::of_slipping(&limits[&g], stiffness, &fixed, forces);
                laws.insert(g, of_slipping);
            }
            let distances = fixed.iter().map(FixedStatus::distance_to_bound);
            let of_ties = tied[&g].iter().map(|&(_, jump)| jump);
            missing.insert(g, distances.chain(of_ties).collect());
            open.insert(g, fixed.iter().map(|s| !s.is_closed()).collect());
        }
        let mut fronts = fronts.borrow_mut();
        let Ok(is_held) = fix(&self.context, &mut fronts, &mut open, &laws, false) else {
            // The remaining contacts restrain nothing: zero is the best change.
            return Change::default();
        };
        let condensed = factors.condense(loads, &tied);
        let on_clusters = condensed
            .iter()
            .map(|(&v, load)| (v, load.boundary().to_vec()));
        let problem = SlipProblem {
            context: &self.context,
            open: &open,
            clusters: &on_clusters.collect(),
            prescribed: &missing,
            laws: &laws,
            is_held,
        };
        let Ok(solution) = follow(&mut fronts, &problem, tolerance) else {
            return Change::default();
        };
        let forces = solution.at.iter();
        let mut forces = forces
            .map(|(&g, at)| (g, limits[&g].forces(&at.forces)))
            .collect();
        put_tied(&mut forces, &solution.tied, &tied);
        let (blocks, of_ties) = factors.recover(&condensed, solution.boundaries);
        put_tied(&mut forces, &of_ties, &tied);
        Change { blocks, forces }
    }

    /// The statuses of the limits of every cluster in contact of this rank from those of its conditions.
    fn limits(&self, conditions: OnPairs<Vec<FixedStatus>>) -> OnPairs<Vec<FixedStatus>> {
        let mut limits = BTreeMap::new();
        for (p, of_cluster) in conditions {
            if let Some(pair) = self.step.pairs.get(&p) {
                limits.insert(p, pair.limits().fixed(&of_cluster));
            }
        }
        limits
    }
}

/// Copies the forces at the jumps of ties to those of all conditions, by contact group.
pub fn put_tied(forces: &mut OnGroups<Vec<f64>>, of_jumps: &OnGroups<Vec<f64>>, tied: &TiedJumps) {
    for (g, of_jumps) in of_jumps {
        if let Some(forces) = forces.get_mut(g) {
            for (force, (condition, _)) in of_jumps.iter().zip(&tied[g]) {
                forces[*condition] = *force;
            }
        }
    }
}

/// Solves for the loads, and for slip forces where any follow laws. Collective.
fn follow(
    fronts: &mut ActiveSetFronts,
    problem: &SlipProblem<'_>,
    tolerance: f64,
) -> Result<ActiveSetSolution, Failure> {
    let at_rest = |(&g, prescribed): (&GroupId, &Vec<f64>)| (g, vec![0.0; prescribed.len()]);
    let forces: OnJumps = problem.prescribed.iter().map(at_rest).collect();
    let is_coupled = problem.is_coupled(fronts);
    let (tolerance, accuracy) = match (is_coupled, problem.has_laws()) {
        (true, _) => (FOLLOWED_BY_ITERATIONS, FOLLOWED_BY_ITERATIONS),
        (false, true) => (Accuracy::FULL.tolerance, FOLLOWED),
        (false, false) => (tolerance, FOLLOWED),
    };
    problem.solve(fronts, forces, (tolerance, None), accuracy)
}
