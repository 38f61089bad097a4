//! Settling rigid motions that nothing resists: the solution's part along them is taken out.

use std::collections::BTreeMap;

use crate::certificate::Certificate;
use crate::recover::frozen::Frozen;
use crate::recover::motions::{Field, Motions};
use crate::recover::refine::replace_if_as_good;
use crate::recover::{BlockSolution, displacements};
use crate::rigid::descent::with_descent;
use crate::rigid::free_motion::FreeMotion;
use crate::rigid::loose::LooseMotions;
use crate::rigid::survey::Survey;

/// A contact force, relative to the terms of the equilibrium at its nodes, that is round-off.
const ROUND_OFF: f64 = 1e-14;
/// A gap, relative to the largest displacement of its block, that is open.
const OPENED: f64 = 1e-13;

/// Makes the displacement of all blocks, node by node, orthogonal to every motion that is free
/// whatever the contacts do, in the Euclidean sense over the nodes of the bodies that take part.
/// Collective.
pub fn settle_free_motions(frozen: &Frozen<'_>, solutions: &mut BTreeMap<usize, BlockSolution>) {
    let displacement = solutions.iter_mut().map(|(&b, s)| (b, &mut s.u)).collect();
    frozen.free.project(frozen, Field::Shared, displacement);
}

/// What settling loose motions came to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Settled {
    /// Whether there were more than those that are free whatever the contacts do; on all ranks.
    pub is_loose: bool,
    /// Conditions that opened by it; on the root.
    pub opened: usize,
    /// What a user should know; on the root.
    pub warnings: Vec<String>,
}

impl Settled {
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
/// the way to rest included, unless its `certificate` is a worse one; conditions that open by it are
/// open. Collective.
pub fn settle_loose_motions(
    frozen: &Frozen<'_>,
    survey: &Survey,
    solutions: &mut BTreeMap<usize, BlockSolution>,
    certificate: &mut Certificate,
) -> Settled {
    if !survey.movable {
        return Settled::default();
    }
    let mut nearer = solutions.clone();
    let mut settled = move_nearer(frozen, survey, &mut nearer);
    if settled.is_loose {
        let (after, taken) = replace_if_as_good(frozen, solutions, nearer, *certificate);
        *certificate = after;
        settled.conclude(taken);
    } else {
        *solutions = nearer;
    }
    settled
}

/// Gives the bodies the position of least displacement, whatever its certificate. Collective.
fn move_nearer(
    frozen: &Frozen<'_>,
    survey: &Survey,
    solutions: &mut BTreeMap<usize, BlockSolution>,
) -> Settled {
    let mut displacement = with_descent(&frozen.context, displacements(solutions), survey);
    let loose = loose_motions(frozen, survey, solutions);
    let mut list: Vec<FreeMotion> = (loose.as_ref()).map_or_else(Vec::new, |l| l.motions.clone());
    frozen.context.comm.broadcast(&mut list);
    if list.is_empty() {
        return Settled::default();
    }
    let motions = Motions {
        list: &list,
        frames: &survey.frames,
    };
    let products = motions.products(
        frozen,
        Field::Shared,
        &displacement.iter_mut().map(|(&b, u)| (b, u)).collect(),
    );
    let found = loose.as_ref().map(|loose| loose.coefficients(&products));
    let mut coefficients = found.unwrap_or_default();
    frozen.context.comm.broadcast(&mut coefficients);
    let all = solutions.iter_mut().map(|(&b, s)| (b, &mut s.u)).collect();
    motions.take_out(frozen, Field::Shared, &coefficients, all);
    let mut settled = Settled {
        is_loose: list.len() > frozen.free.list.len(),
        ..Settled::default()
    };
    frozen.context.comm.gather(
        &frozen.context.plan.group_owners(),
        |g| {
            let b = frozen.context.plan.groups[g];
            let opened = solutions.get_mut(&b).map(|s| open(frozen, b, s));
            opened.unwrap_or(0)
        },
        |_, opened| settled.opened += opened,
    );
    settled.warnings = loose.map_or_else(Vec::new, |loose| loose.warnings);
    settled
}

/// Opens the conditions of block b that have a gap, and counts them.
fn open(frozen: &Frozen<'_>, b: usize, solution: &mut BlockSolution) -> usize {
    let Some(owned) = frozen.context.blocks.get(&b) else {
        return 0;
    };
    let largest = solution.u.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    let mut opened = 0;
    let Some(loads) = frozen.step.loads.get(&b) else {
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

/// The loose motions of `solutions`, on the root. Collective.
fn loose_motions(
    frozen: &Frozen<'_>,
    survey: &Survey,
    solutions: &BTreeMap<usize, BlockSolution>,
) -> Option<LooseMotions> {
    let mut carrying = Vec::new();
    let mut gaps = Vec::new();
    frozen.context.comm.gather(
        &frozen.context.plan.group_owners(),
        |g| {
            let b = frozen.context.plan.groups[g];
            solutions
                .get(&b)
                .and_then(|solution| conditions(frozen, b, solution))
                .unwrap_or_default()
        },
        |_, (of_block, left)| {
            carrying.extend(of_block);
            gaps.extend(left);
        },
    );
    let scene = survey.scene.as_ref()?;
    Some(scene.loose_motions(&survey.motions.free, &carrying, &gaps))
}

/// For every condition of block b whether it carries force, and what gap it has left.
fn conditions(
    frozen: &Frozen<'_>,
    b: usize,
    solution: &BlockSolution,
) -> Option<(Vec<bool>, Vec<f64>)> {
    let owned = frozen.context.blocks.get(&b)?;
    let dim = owned.block.dim;
    let scale = frozen.balance(b, solution)?.scale;
    let mut carrying = Vec::new();
    for (point, &force) in owned.points.iter().zip(&solution.forces) {
        let nodes = point.entries.iter();
        let around = nodes.flat_map(|&(node, _)| &scale[node as usize * dim..][..dim]);
        let largest = around.fold(0.0, |m: f64, s| m.max(*s));
        carrying.push(force > ROUND_OFF * largest);
    }
    let gaps = frozen.step.loads.get(&b)?.gaps_left(owned, &solution.u);
    Some((carrying, gaps))
}
