//! The forces of points that slip, λ_t = b e, while what every point does stays what it is.
//!
//! Newton's method; its linear problems are those of [`super::slip_problem`].

use std::collections::BTreeMap;

use super::points::{GroupFriction, Law};
use super::slip_problem::{Forces, Laws, SlipProblem};
use crate::context::Context;
use crate::error::Failure;
use crate::frozen::fronts::FrozenFronts;
use crate::frozen::solution::FrozenSolution;
use crate::vector::axpy;

/// Most steps of Newton's method where every point is to do what it does.
pub(super) const STEPS: usize = 15;
/// How far GMRES goes, relative to what is missed before, at least and at most.
const REDUCTION: [f64; 2] = [1e-1, 1e-3];
/// What is missed of the law, relative to the largest force, where a step that doesn't lessen it is round-off.
const NEAR: f64 = 1e-9;

/// Jumps and forces of every contact group of this rank, and the largest of all ranks.
#[derive(Clone, Debug, Default)]
pub(super) struct Solved {
    pub solution: FrozenSolution,
    pub groups: BTreeMap<usize, [Vec<f64>; 2]>,
    /// The largest force (N/m) and jump (m).
    pub scales: [f64; 2],
}

impl Solved {
    /// Nothing in the place of what is no finite number.
    pub fn cut(&mut self) {
        self.solution.cut();
        for x in self.groups.values_mut().flatten().flatten() {
            *x = if x.is_finite() { *x } else { 0.0 };
        }
    }

    /// What a `solution` says, where these `groups` have their slip forces. Collective.
    pub fn new(
        context: &Context<'_>,
        groups: &BTreeMap<usize, GroupFriction>,
        solution: FrozenSolution,
    ) -> Self {
        let comm = context.comm;
        let of_group = |(&g, friction): (&usize, &GroupFriction)| {
            let mut forces = solution.forces[&g].clone();
            for (force, slip) in forces.iter_mut().zip(&friction.forces) {
                *force += slip;
            }
            (g, [solution.jumps[&g].clone(), forces])
        };
        let of_groups: BTreeMap<usize, [Vec<f64>; 2]> = groups.iter().map(of_group).collect();
        let largest =
            |own: &dyn Fn(&[Vec<f64>; 2]) -> f64| of_groups.values().map(own).fold(0.0, f64::max);
        let most = |all: &[f64]| all.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let bounds = groups.values().flat_map(|friction| friction.bounds.iter());
        let bounds = bounds.filter(|bound| bound.is_finite());
        let own = [
            largest(&|[_, forces]| most(forces)),
            largest(&|[jumps, _]| most(jumps)).max(bounds.fold(0.0, |m: f64, x| m.max(x.abs()))),
        ];
        let mut scales = [0.0_f64; 2];
        for of_rank in comm.collect(&own) {
            scales = [0, 1].map(|k| f64::max(scales[k], of_rank[k]));
        }
        comm.broadcast(&mut scales);
        Self {
            solution,
            groups: of_groups,
            scales,
        }
    }
}

/// What slip forces are found with.
pub(super) struct SlipForces<'a> {
    pub problem: SlipProblem<'a>,
    pub groups: &'a mut BTreeMap<usize, GroupFriction>,
}

impl SlipForces<'_> {
    /// Finds them so that they miss no more of their law than `goal` of the largest force, with an iterative solver as
    /// far as the `tolerance`, from what an earlier solution was; returns the solution and what is missed. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely.
    pub fn solve(
        &mut self,
        fronts: &mut FrozenFronts,
        tolerance: f64,
        (goal, steps): (f64, usize),
        start: Option<&FrozenSolution>,
    ) -> Result<(Solved, f64), Failure> {
        let mut solved = self.respond(fronts, tolerance, start)?;
        let (mut residual, mut missed) = self.missed(&solved);
        for _ in 0..steps {
            if missed <= goal {
                break;
            }
            let before = self.forces();
            let reduction = (0.3 * goal / missed).clamp(REDUCTION[1], REDUCTION[0]);
            let laws = self.laws(&solved);
            let (change, iterations) = (self.problem).gmres(fronts, &laws, residual, reduction)?;
            solved.solution.iterations += iterations;
            for (g, friction) in self.groups.iter_mut() {
                axpy(1.0, &change[g], &mut friction.forces);
            }
            let next = self.respond(fronts, tolerance, Some(&solved.solution))?;
            let (left, is_missed) = self.missed(&next);
            if is_missed >= missed && missed < NEAR {
                for (g, friction) in self.groups.iter_mut() {
                    friction.forces.clone_from(&before[g]);
                }
                break;
            }
            (solved, residual, missed) = (next, left, is_missed);
        }
        Ok((solved, missed))
    }

    fn forces(&self) -> Forces {
        let all = self.groups.iter();
        all.map(|(&g, friction)| (g, friction.forces.clone()))
            .collect()
    }

    /// The solution for the slip forces as they are. Collective.
    fn respond(
        &self,
        fronts: &mut FrozenFronts,
        tolerance: f64,
        start: Option<&FrozenSolution>,
    ) -> Result<Solved, Failure> {
        let solution = (self.problem).respond(fronts, &self.forces(), tolerance, start)?;
        Ok(Solved::new(self.problem.context, self.groups, solution))
    }

    /// The laws of what slips where it is.
    fn laws(&self, solved: &Solved) -> Laws {
        let of_group = |(&g, friction): (&usize, &GroupFriction)| {
            let slipping = friction.slipping();
            let laws = slipping.map(|point| point.law(friction, &solved.groups[&g]));
            (g, laws.collect::<Vec<Law>>())
        };
        self.groups.iter().map(of_group).collect()
    }

    /// λ_t − b e of every point that slips, and the largest of all, relative to the largest force. Collective.
    fn missed(&self, solved: &Solved) -> (Forces, f64) {
        let comm = self.problem.context.comm;
        let laws = self.laws(solved);
        let of_group = |(&g, friction): (&usize, &GroupFriction)| {
            let mut missed = vec![0.0; friction.forces.len()];
            for law in &laws[&g] {
                for (&t, e) in law.tangents.iter().zip(law.direction) {
                    missed[t] = friction.forces[t] - law.bound * e;
                }
            }
            (g, missed)
        };
        let missed: Forces = self.groups.iter().map(of_group).collect();
        let all = missed.values().flatten();
        let mut largest = all.fold(0.0, |m: f64, x| m.max(x.abs()));
        largest = comm.collect(&largest).into_iter().fold(0.0, f64::max);
        comm.broadcast(&mut largest);
        (missed, largest / solved.scales[0].max(f64::MIN_POSITIVE))
    }
}
