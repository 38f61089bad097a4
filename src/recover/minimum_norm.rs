//! Settling rigid motions that nothing resists: the solution's part along them is taken out.

use std::collections::BTreeMap;

use crate::certificate::Certificate;
use crate::recover::fixed_active_set::FixedActiveSet;
use crate::recover::motions::{Field, Motions};
use crate::recover::refine::replace_if_as_good;
use crate::recover::{BlockSolution, displacements};
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::rigid::closing_motion::with_closing_motions;
use crate::rigid::free_motion::FreeMotion;
use crate::rigid::released_modes::ReleasedModes;

/// A contact force, relative to the terms of the equilibrium at its nodes, that is round-off.
const ROUND_OFF: f64 = 1e-14;
/// A gap, relative to the largest displacement of its block, that is open.
const OPENED: f64 = 1e-13;

/// Makes the displacement of all blocks, node by node, orthogonal to every motion that is free
/// whatever the contacts do, in the Euclidean sense over the nodes of the bodies that take part.
/// Collective.
pub fn remove_free_modes(
    fixed: &FixedActiveSet<'_>,
    solutions: &mut BTreeMap<usize, BlockSolution>,
) {
    let displacement = solutions.iter_mut().map(|(&b, s)| (b, &mut s.u)).collect();
    fixed.free.project(fixed, Field::Shared, displacement);
}

/// What settling released modes came to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MinimumNorm {
    /// Whether there were more than those that are free whatever the contacts do; on all ranks.
    pub has_released_modes: bool,
    /// Conditions that opened by it; on the root.
    pub opened: usize,
    /// What a user should know; on the root.
    pub warnings: Vec<String>,
}

impl MinimumNorm {
    /// Says what became of it: whether the nearer position is `taken`.
    fn conclude(&mut self, taken: bool) {
        let end = match taken {
            true => "of all positions that this leaves, the one of least displacement is taken",
            false => "its position is one of many",
        };
        for warning in &mut self.warnings {
            warning.push_str("; ");
            warning.push_str(end);
        }
        if !taken {
            self.opened = 0;
        }
    }
}

/// Of all positions that contact forces leave the bodies, gives them the one of least displacement,
/// the closing motion included, unless its `certificate` is a worse one; conditions that open by it are
/// open. Collective.
pub fn take_minimum_norm(
    fixed: &FixedActiveSet<'_>,
    analysis: &RigidBodyAnalysis,
    solutions: &mut BTreeMap<usize, BlockSolution>,
    certificate: &mut Certificate,
) -> MinimumNorm {
    if !analysis.movable {
        return MinimumNorm::default();
    }
    let mut nearer = solutions.clone();
    let mut minimum_norm = move_nearer(fixed, analysis, &mut nearer);
    if minimum_norm.has_released_modes {
        let (after, taken) = replace_if_as_good(fixed, solutions, nearer, *certificate);
        *certificate = after;
        minimum_norm.conclude(taken);
    } else {
        *solutions = nearer;
    }
    minimum_norm
}

/// Gives the bodies the position of least displacement, whatever its certificate. Collective.
fn move_nearer(
    fixed: &FixedActiveSet<'_>,
    analysis: &RigidBodyAnalysis,
    solutions: &mut BTreeMap<usize, BlockSolution>,
) -> MinimumNorm {
    let mut displacement = with_closing_motions(&fixed.context, displacements(solutions), analysis);
    let released = released_modes(fixed, analysis, solutions);
    let mut list: Vec<FreeMotion> =
        (released.as_ref()).map_or_else(Vec::new, |l| l.motions.clone());
    fixed.context.comm.broadcast(&mut list);
    if list.is_empty() {
        return MinimumNorm::default();
    }
    let motions = Motions {
        list: &list,
        frames: &analysis.frames,
    };
    let products = motions.products(
        fixed,
        Field::Shared,
        &displacement.iter_mut().map(|(&b, u)| (b, u)).collect(),
    );
    let found = released
        .as_ref()
        .map(|released| released.coefficients(&products));
    let mut coefficients = found.unwrap_or_default();
    fixed.context.comm.broadcast(&mut coefficients);
    let all = solutions.iter_mut().map(|(&b, s)| (b, &mut s.u)).collect();
    motions.take_out(fixed, Field::Shared, &coefficients, all);
    let mut minimum_norm = MinimumNorm {
        has_released_modes: list.len() > fixed.free.list.len(),
        ..MinimumNorm::default()
    };
    fixed.context.comm.gather(
        &fixed.context.plan.group_owners(),
        |g| {
            let b = fixed.context.plan.groups[g];
            let opened = solutions.get_mut(&b).map(|s| open(fixed, b, s));
            opened.unwrap_or(0)
        },
        |_, opened| minimum_norm.opened += opened,
    );
    minimum_norm.warnings = released.map_or_else(Vec::new, |released| released.warnings);
    minimum_norm
}

/// Opens the conditions of block b that have a gap, and counts them.
fn open(fixed: &FixedActiveSet<'_>, b: usize, solution: &mut BlockSolution) -> usize {
    let Some(owned) = fixed.context.blocks.get(&b) else {
        return 0;
    };
    let largest = solution.u.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    let mut opened = 0;
    let Some(loads) = fixed.step.loads.get(&b) else {
        return 0;
    };
    for (j, gap) in loads.gaps_left(owned, &solution.u).into_iter().enumerate() {
        if solution.closed[j] && gap > OPENED * largest {
            solution.closed[j] = false;
            solution.forces[j] = 0.0;
            opened += 1;
        }
    }
    opened
}

/// The released modes of `solutions`, on the root. Collective.
fn released_modes(
    fixed: &FixedActiveSet<'_>,
    analysis: &RigidBodyAnalysis,
    solutions: &BTreeMap<usize, BlockSolution>,
) -> Option<ReleasedModes> {
    let mut carrying = Vec::new();
    let mut gaps = Vec::new();
    fixed.context.comm.gather(
        &fixed.context.plan.group_owners(),
        |g| {
            let b = fixed.context.plan.groups[g];
            solutions
                .get(&b)
                .and_then(|solution| conditions(fixed, b, solution))
                .unwrap_or_default()
        },
        |_, (of_block, left)| {
            carrying.extend(of_block);
            gaps.extend(left);
        },
    );
    let scene = analysis.scene.as_ref()?;
    Some(scene.released_modes(&analysis.motions.free, &carrying, &gaps))
}

/// For every condition of block b whether it carries force, and what gap it has left.
fn conditions(
    fixed: &FixedActiveSet<'_>,
    b: usize,
    solution: &BlockSolution,
) -> Option<(Vec<bool>, Vec<f64>)> {
    let owned = fixed.context.blocks.get(&b)?;
    let dim = owned.block.dim;
    let scale = fixed.balance(b, solution)?.scale;
    let mut carrying = Vec::new();
    for (point, &force) in owned.points.iter().zip(&solution.forces) {
        let nodes = point.entries.iter();
        let around = nodes.flat_map(|&(node, _)| &scale[node as usize * dim..][..dim]);
        let largest = around.fold(0.0, |m: f64, s| m.max(*s));
        carrying.push(force > ROUND_OFF * largest);
    }
    let gaps = fixed.step.loads.get(&b)?.gaps_left(owned, &solution.u);
    Some((carrying, gaps))
}
