//! The transposed problem of a quantity, solved with the available factors.
//!
//! The symmetric part is solved like a change of the solution. At slipping points the conditions z depend on the slips
//! of w: z = G w(z), which generalized conjugate residuals solve (Eisenstat, Elman and Schultz, SIAM J. Numer. Anal.
//! 20, 1983). Their directions serve all quantities, as (I − G) is the same for all.

use std::cell::RefCell;
use std::collections::BTreeMap;

use contact_dd_partition::element::geometry::padded;
use contact_dd_partition::id::{BlockId, OnBlocks, OnGroups, TreeNodeId};
use contact_dd_partition::model::Support;
use contact_dd_partition::numbered::Numbered;

use super::functional::Functional;
use super::slipping::{Direction, OnConditions, SlippingPoints};
use super::solved::Solved;
use crate::context::Loads;
use crate::fem::balance::Balance;
use crate::fem::block::Block;
use crate::fem::contact_group::GroupLoads;
use crate::fem::load::BlockLoads;
use crate::fem::prescribed::Prescribed;
use crate::recover::fixed_active_set::{FixedActiveSet, FixedStatuses};
use crate::recover::{BlockSolution, DiscreteSolution, GroupSolution};
use crate::vector::{add_multiple, axpy, dot};

/// Accuracy of a correction by an iterative solver.
const ACCURACY: f64 = 1e-10;
/// Most rounds in which the conditions of slipping points are solved for.
const ROUNDS: usize = 3;
/// Residual to which the conditions of slipping points are solved.
const SLIP_TOLERANCE: f64 = 1e-9;

/// The transposed problem of a quantity, on this rank.
pub struct TransposedProblem<'a> {
    pub(super) solved: Solved<'a>,
    /// The slipping points.
    pub slipping: &'a OnGroups<SlippingPoints>,
    /// The directions of earlier products with slip conditions.
    pub(super) directions: &'a RefCell<Vec<Direction>>,
    /// The nodes of the hierarchy that contain contact points, and all above them.
    pub(super) around_contact: Numbered<TreeNodeId, bool>,
    /// a, −r as prescribed displacements, and b at conditions.
    pub(super) loads: Loads,
}

/// The solution of a transposed problem.
pub struct Transposed {
    /// w, ν and the forces at slipping tangents, and the residual jumps of conditions.
    pub discrete: DiscreteSolution,
    /// Residuals on the nodes of every block of this rank: a − K w − Bᵀν.
    pub residuals: OnBlocks<Vec<f64>>,
    /// a, r and b, and the right-hand sides at slipping points.
    loads: Loads,
}

impl<'a> TransposedProblem<'a> {
    /// The problem of a functional.
    pub fn new(
        solved: Solved<'a>,
        functional: &Functional,
        (slipping, directions): (&'a OnGroups<SlippingPoints>, &'a RefCell<Vec<Direction>>),
    ) -> Self {
        let context = &solved.fixed.context;
        let mut loads = Loads::default();
        for (&b, block) in context.blocks {
            let of_step = solved.fixed.step.loads.blocks.get(&b);
            let supports = of_step.map_or(&[][..], |loads| &loads.supports);
            let values = functional.of_supports.get(&b);
            let supports = supports.iter().enumerate().map(|(i, support)| Support {
                value: values.map_or(0.0, |values| -values[i]),
                ..*support
            });
            let of_nodes = functional.of_nodes.get(&b);
            let nodes = of_nodes
                .map_or(&[][..], Vec::as_slice)
                .chunks_exact(block.dim);
            let forces = (0..)
                .zip(nodes)
                .filter(|(_, part)| part.iter().any(|&x| x != 0.0));
            loads.blocks.insert(
                b,
                BlockLoads {
                    supports: supports.collect(),
                    forces: forces.map(|(node, part)| (node, padded(part))).collect(),
                },
            );
        }
        for (&g, group) in context.groups {
            let none = || vec![0.0; group.conditions().count()];
            let mut gaps = functional.of_forces.get(&g).cloned().unwrap_or_else(none);
            if let Some(limits) = solved.fixed.step.limits.get(&g) {
                limits.share_jumps(&mut gaps);
            }
            let held = Vec::new();
            loads.groups.insert(g, GroupLoads { gaps, held });
        }
        Self {
            solved,
            slipping,
            directions,
            around_contact: match solved.fixed.free.list.is_empty() {
                true => context.plan.around_contact(),
                // A projected load acts everywhere.
                false => context.plan.tree.nodes.like(true),
            },
            loads,
        }
    }

    /// The solution of the transposed problem. Collective.
    pub fn solve(&self) -> Transposed {
        let context = &self.solved.fixed.context;
        let blocks = self.loads.blocks.iter().filter_map(|(&b, loads)| {
            let lift = Prescribed::new(context.blocks.get(&b)?, loads);
            let (u, pushes) = (lift.constants().to_vec(), Vec::new());
            Some((b, BlockSolution { u, pushes }))
        });
        let mut state = self.at_rest(blocks.collect());
        let mut loads = self.loads.clone();
        state.share(context, &loads);
        for (g, points) in self.slipping {
            if let Some(of_group) = state.groups.get_mut(g) {
                points.start_forces(of_group);
            }
        }
        state.share(context, &loads);
        self.correct(&loads, &mut state);
        let slips = self.slipping.values().any(|points| !points.0.is_empty());
        if !context
            .comm
            .decide(context.comm.collect(&slips).contains(&true))
        {
            return self.ended(state, loads);
        }
        let mut z: OnConditions = self.zeros();
        for _ in 0..ROUNDS {
            let mut missing = self.wanted(&state);
            let size = self.norm(&self.weighted(missing.clone()));
            add_multiple(-1.0, &z, &mut missing);
            missing = self.weighted(missing);
            let off = self.norm(&missing);
            if context
                .comm
                .decide(off <= SLIP_TOLERANCE * size || off.is_nan())
            {
                break;
            }
            let change = self.conditions_of_slips(
                &missing,
                0.1 * SLIP_TOLERANCE * size.max(f64::MIN_POSITIVE) / off,
            );
            add_multiple(1.0, &change, &mut z);
            for (g, points) in self.slipping {
                let (jumps, forces) = points.split(&z[g]);
                if let (Some(of_group), Some(to), Some(from)) = (
                    state.groups.get_mut(g),
                    loads.groups.get_mut(g),
                    self.loads.groups.get(g),
                ) {
                    to.gaps.clone_from(&from.gaps);
                    axpy(1.0, &jumps, &mut to.gaps);
                    points.set_forces(&forces, of_group);
                }
            }
            state.share(context, &loads);
            self.correct(&loads, &mut state);
        }
        self.ended(state, loads)
    }

    fn ended(&self, discrete: DiscreteSolution, loads: Loads) -> Transposed {
        Transposed {
            residuals: self.left(&loads, &discrete),
            discrete,
            loads,
        }
    }

    /// Removes round-off from a solution. Collective.
    pub fn refine(&self, of: Transposed) -> Transposed {
        let (mut discrete, loads) = (of.discrete, of.loads);
        self.correct(&loads, &mut discrete);
        self.ended(discrete, loads)
    }

    /// A state with these displacements and no force at any condition.
    pub(super) fn at_rest(&self, blocks: OnBlocks<BlockSolution>) -> DiscreteSolution {
        let groups = self.solved.solution.discrete.groups.iter();
        let groups = groups.map(|(&g, of_group)| {
            let (forces, gaps) = (vec![0.0; of_group.forces.len()], Vec::new());
            let closed = of_group.closed.clone();
            (
                g,
                GroupSolution {
                    forces,
                    closed,
                    gaps,
                },
            )
        });
        DiscreteSolution {
            blocks,
            groups: groups.collect(),
        }
    }

    /// Residuals of `loads` on the nodes of every block of this rank.
    fn left(&self, loads: &Loads, state: &DiscreteSolution) -> OnBlocks<Vec<f64>> {
        let context = &self.solved.fixed.context;
        let of_block = |(&b, of_block): (&BlockId, &BlockSolution)| {
            let (block, loads) = (context.blocks.get(&b)?, loads.blocks.get(&b)?);
            if of_block.u.iter().all(|&w| w == 0.0) {
                return Some((b, without_displacement(block, loads, &of_block.pushes)));
            }
            let balance = Balance::new(
                block,
                loads,
                &context.catalog.materials,
                &of_block.u,
                &of_block.pushes,
            );
            Some((b, balance.residual))
        };
        state.blocks.iter().filter_map(of_block).collect()
    }

    /// Adds the solution of the symmetric problem for a state's residual of `loads`. Collective.
    fn correct(&self, loads: &Loads, state: &mut DiscreteSolution) {
        self.correct_by(self.solved.fixed, loads, state);
    }

    /// Adds that solution for the problem `fixed`. Collective.
    pub(super) fn correct_by(
        &self,
        fixed: &FixedActiveSet<'_>,
        loads: &Loads,
        state: &mut DiscreteSolution,
    ) {
        let on_unknowns = fixed.on_unknowns(self.left(loads, state));
        let conditions = state.groups.iter().map(|(&g, of_group)| {
            let mut statuses = of_group.fixed_statuses();
            self.slipping[&g].set_turning(&mut statuses);
            (g, statuses)
        });
        let conditions: FixedStatuses = conditions.collect();
        let change = fixed.solve(on_unknowns, conditions, &BTreeMap::new(), ACCURACY);
        for (b, x) in change.blocks {
            let block = fixed.condensed.blocks.get(&b);
            if let (Some(of_block), Some(block)) = (state.blocks.get_mut(&b), block) {
                block.dofs.add_change(&x, &mut of_block.u);
            }
        }
        for (g, changes) in change.forces {
            if let Some(of_group) = state.groups.get_mut(&g) {
                axpy(1.0, &changes, &mut of_group.forces);
            }
        }
        state.share(&fixed.context, loads);
    }

    /// Right-hand sides at the conditions of slipping points.
    pub(super) fn wanted(&self, state: &DiscreteSolution) -> OnConditions {
        let groups = state.groups.iter();
        let groups = groups.map(|(&g, of_group)| {
            // The required jump of a slipping tangent is b_s.
            (g, self.slipping[&g].wanted(&of_group.gaps))
        });
        groups.collect()
    }

    pub(super) fn zeros(&self) -> OnConditions {
        let groups = self.loads.groups.iter();
        groups
            .map(|(&g, of)| (g, vec![0.0; of.gaps.len()]))
            .collect()
    }

    /// The dot product, equal on all ranks however groups are distributed. Collective.
    pub(super) fn dot(&self, a: &OnConditions, b: &OnConditions) -> f64 {
        let context = &self.solved.fixed.context;
        let mut sum = context.sum_of_groups(|g| dot(&a[&g], &b[&g]));
        context.comm.broadcast(&mut sum);
        sum
    }

    pub(super) fn norm(&self, a: &OnConditions) -> f64 {
        self.dot(a, a).sqrt()
    }
}

/// Residual of loads without displacement: f − Bᵀλ.
fn without_displacement(block: &Block, loads: &BlockLoads, pushes: &[(u32, [f64; 3])]) -> Vec<f64> {
    let mut left = loads.nodal_forces(block);
    for (node, push) in pushes {
        let of_node = &mut left[*node as usize * block.dim..][..block.dim];
        axpy(-1.0, &push[..block.dim], of_node);
    }
    left
}
