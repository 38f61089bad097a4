//! Minimum-norm solution: the component of the solution along unresisted rigid motions is removed.

use std::ops::Range;

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::id::GroupId;
use contact_dd_partition::numbered::Numbered;

use crate::certificate::Certificate;
use crate::context::Context;
use crate::fem::contact_group::{Condition, ContactGroup};
use crate::recover::fixed_active_set::{FixedActiveSet, FixedActiveSetRoot};
use crate::recover::motions::{Field, Motions};
use crate::recover::refine::{correct_once, replace_if_as_good};
use crate::recover::{DiscreteSolution, GroupSolution, displacements};
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::rigid::body_analysis::with_closing_motions;
use crate::rigid::free_motion::FreeMotion;
use crate::rigid::released_modes::{ConditionState, ReleasedModes};
use crate::vector::largest as largest_entry;

/// Contact force, relative to the terms of the equilibrium at its nodes, below which it is round-off.
const ROUND_OFF: f64 = 1e-14;
/// Gap, relative to the largest displacement before and after the move of bodies, above which it is open.
const OPEN_GAP: f64 = 1e-13;

/// Most corrections of the round-off that a move leaves unbalanced; each moves bodies again, by less.
const CORRECTIONS: usize = 2;

/// Makes the displacement of all blocks, node by node, orthogonal to every motion that is free even with all contacts
/// closed, in the Euclidean sense over the nodes of the moving bodies. Collective.
pub fn remove_free_modes(fixed: &FixedActiveSet<'_>, solution: &mut DiscreteSolution) {
    let blocks = solution.blocks.iter_mut();
    let displacement = blocks.map(|(&b, s)| (b, &mut s.u)).collect();
    fixed
        .free
        .project(&fixed.context, Field::Shared, displacement);
    solution.share(&fixed.context, &fixed.step.loads);
}

/// Outcome of the minimum-norm solution for released modes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MinimumNorm {
    /// True if there were modes beyond those that are free even with all contacts closed; on all ranks.
    pub has_released_modes: bool,
    /// True if loads do work along motions without resistance in the solution; on the root.
    pub is_driven: bool,
    /// Warnings to the user; on the root.
    pub warnings: Vec<String>,
}

impl MinimumNorm {
    /// Adds to the warnings whether the minimum-norm solution is `taken`.
    fn conclude(&mut self, taken: bool) {
        let end = match taken {
            true => "the minimum-norm solution is returned",
            false => "one of its solutions is returned",
        };
        for warning in &mut self.warnings {
            warning.push_str("; ");
            warning.push_str(end);
        }
    }
}

/// Moves the bodies to the position of least displacement, including the closing motion, among all positions that the
/// contact forces allow, unless the `certificate` gets worse; opens the conditions that open in it. Collective.
pub fn take_minimum_norm(
    fixed: &FixedActiveSet<'_>,
    analysis: &RigidBodyAnalysis,
    solution: &mut DiscreteSolution,
    certificate: &mut Certificate,
) -> MinimumNorm {
    if !analysis.movable {
        return MinimumNorm::default();
    }
    let mut nearer = solution.clone();
    let (mut released, mut minimum_norm) = move_to_least_displacement(fixed, analysis, &mut nearer);
    certificate.is_driven = minimum_norm.is_driven;
    if !minimum_norm.has_released_modes {
        *solution = nearer;
        return minimum_norm;
    }
    for _ in 0..CORRECTIONS {
        // No displacement can balance loads along these motions, so that corrections leave them out; the length of
        // these motions makes no difference.
        let of_released = FixedActiveSet {
            root: fixed.root.map(|root| FixedActiveSetRoot {
                moves: true,
                ..root
            }),
            free: Motions {
                list: &released,
                ..fixed.free
            },
            ..*fixed
        };
        correct_once(&of_released, &mut nearer);
        let moved;
        (released, moved) = move_to_least_displacement(fixed, analysis, &mut nearer);
        minimum_norm.is_driven |= moved.is_driven;
    }
    let is_driven = minimum_norm.is_driven;
    let (after, taken) = replace_if_as_good(fixed, solution, nearer, *certificate);
    *certificate = Certificate { is_driven, ..after };
    minimum_norm.conclude(taken);
    minimum_norm
}

/// Moves the bodies to the position of least displacement, even if that worsens the certificate, and returns the
/// motions free in it. Collective.
fn move_to_least_displacement(
    fixed: &FixedActiveSet<'_>,
    analysis: &RigidBodyAnalysis,
    solution: &mut DiscreteSolution,
) -> (Vec<FreeMotion>, MinimumNorm) {
    let blocks = displacements(&solution.blocks);
    let mut displacement = with_closing_motions(&fixed.context, blocks, analysis);
    let released = released_modes(fixed, analysis, solution);
    let mut list: Vec<FreeMotion> =
        (released.as_ref()).map_or_else(Vec::new, |l| l.motions.clone());
    fixed.context.comm.broadcast(&mut list);
    let is_driven = released.as_ref().is_some_and(|released| released.is_driven);
    if list.is_empty() {
        let nothing = MinimumNorm {
            is_driven,
            ..MinimumNorm::default()
        };
        return (list, nothing);
    }
    let motions = Motions {
        list: &list,
        frames: &analysis.frames,
    };
    let products = motions.products(
        &fixed.context,
        Field::Shared,
        &displacement.iter_mut().map(|(&b, u)| (b, u)).collect(),
    );
    let found = released
        .as_ref()
        .map(|released| released.coefficients(&products));
    let mut coefficients = found.unwrap_or_default();
    fixed.context.comm.broadcast(&mut coefficients);
    let unneeded = (released.as_ref()).map_or(&[][..], |released| &released.unneeded);
    if list.len() > fixed.free.list.len() {
        drop_forces(fixed, unneeded, solution);
    }
    let before = largest_displacement(fixed, solution);
    let blocks = solution.blocks.iter_mut();
    let all = blocks.map(|(&b, s)| (b, &mut s.u)).collect();
    motions.take_out(&fixed.context, Field::Shared, &coefficients, all);
    solution.share(&fixed.context, &fixed.step.loads);
    let mut minimum_norm = MinimumNorm {
        has_released_modes: list.len() > fixed.free.list.len(),
        is_driven,
        ..MinimumNorm::default()
    };
    let largest = before.max(largest_displacement(fixed, solution));
    open_all(fixed, solution, OPEN_GAP * largest);
    solution.share(&fixed.context, &fixed.step.loads);
    minimum_norm.warnings = released.map_or_else(Vec::new, |released| released.warnings);
    (list, minimum_norm)
}

/// Zeroes the forces of conditions, by their number among those of all groups, which the root knows. Collective.
fn drop_forces(fixed: &FixedActiveSet<'_>, numbers: &[usize], solution: &mut DiscreteSolution) {
    let (comm, plan) = (fixed.context.comm, fixed.context.plan);
    let mut ranges: Numbered<GroupId, Range<usize>> = Numbered::default();
    let mut next = 0;
    comm.gather(
        &plan.group_owners(),
        |g| solution.groups[&g].forces.len(),
        |_, conditions| {
            ranges.push(next..next + conditions);
            next += conditions;
        },
    );
    comm.scatter(
        &plan.group_owners(),
        |g| -> Vec<usize> {
            let of_group = &ranges[g];
            let own = numbers.iter().filter(|j| of_group.contains(j));
            own.map(|j| j - of_group.start).collect()
        },
        |g, of_group| {
            if let Some(solution) = solution.groups.get_mut(&g) {
                (of_group.into_iter()).for_each(|j| solution.forces[j] = 0.0);
            }
        },
    );
}

/// The largest displacement on all ranks (m). Collective.
fn largest_displacement(fixed: &FixedActiveSet<'_>, solution: &DiscreteSolution) -> f64 {
    let (comm, plan) = (fixed.context.comm, fixed.context.plan);
    let mut largest: f64 = 0.0;
    comm.gather(
        &plan.owners(),
        |b| largest_entry(&solution.blocks[&b].u),
        |_, of_block| largest = largest.max(of_block),
    );
    comm.broadcast(&mut largest);
    largest
}

/// Opens the points of all groups of this rank that have a gap of more than `closed_up_to` (m).
fn open_all(fixed: &FixedActiveSet<'_>, solution: &mut DiscreteSolution, closed_up_to: f64) {
    for (g, of_group) in &mut solution.groups {
        open(&fixed.context.groups[g], of_group, closed_up_to);
    }
}

/// Opens the points of a group that have a gap. A point without force that has left its position of stick no longer
/// sticks, and an open contact has no friction from pressure.
fn open(group: &ContactGroup, solution: &mut GroupSolution, closed_up_to: f64) {
    let may_open = |(_, condition): &(usize, Condition)| !condition.is_tied;
    for (j, Condition { is_tangential, .. }) in group.conditions().enumerate().filter(may_open) {
        let gap = solution.gaps[j];
        let gap = if is_tangential { gap.abs() } else { gap };
        if solution.closed[j] && gap > closed_up_to {
            solution.closed[j] = false;
            solution.forces[j] = 0.0;
        }
    }
    solution.release_opened(group);
}

/// The released modes of a `solution`, on the root. Collective.
fn released_modes(
    fixed: &FixedActiveSet<'_>,
    analysis: &RigidBodyAnalysis,
    solution: &DiscreteSolution,
) -> Option<ReleasedModes> {
    let conditions = condition_states(fixed, solution);
    let scene = analysis.scene.as_ref()?;
    Some(scene.released_modes(&analysis.motions.free, &conditions))
}

/// The motions along which a `solution` may slide under the same forces, as text; on the root. Collective.
pub fn friction_limit(
    fixed: &FixedActiveSet<'_>,
    analysis: &RigidBodyAnalysis,
    solution: &DiscreteSolution,
) -> Vec<String> {
    if !analysis.movable || !fixed.context.catalog.has_friction() {
        return Vec::new();
    }
    let conditions = condition_states(fixed, solution);
    let scene = analysis.scene.as_ref();
    scene.map_or_else(Vec::new, |scene| scene.friction_limit(&conditions))
}

/// The states of all conditions in a `solution`, on the root. Collective.
fn condition_states(
    fixed: &FixedActiveSet<'_>,
    solution: &DiscreteSolution,
) -> Vec<ConditionState> {
    let Context {
        comm, plan, groups, ..
    } = fixed.context;
    let dim = fixed.context.catalog.dim;
    let scales = plan.nodes_to_groups(comm, |b, nodes| {
        let balance = fixed.balance(b, &solution.blocks[&b]);
        let scale = balance.as_ref().map_or(&[][..], |balance| &balance.scale);
        let largest = |at: u32| largest_entry(&scale[at as usize * dim..][..dim]);
        nodes.iter().map(|(at, _)| largest(at.node)).collect()
    });
    let mut conditions = Vec::new();
    comm.gather(
        &plan.group_owners(),
        |g| {
            let of_group = &solution.groups[&g];
            let scale = |point: &ContactPoint<u32>| {
                let nodes = point.entries.iter();
                nodes.fold(0.0, |m: f64, (node, _)| m.max(scales[&g][*node as usize]))
            };
            let state = |(j, condition): (usize, Condition)| {
                let force = of_group.forces[j];
                let size = if condition.is_tangential {
                    force.abs()
                } else {
                    force
                };
                ConditionState {
                    carrying: condition.is_tied
                        || size > ROUND_OFF * scale(&groups[&g].points[condition.point]),
                    closed: of_group.closed[j],
                    gap: of_group.gaps[j],
                    force,
                }
            };
            let conditions = groups[&g].conditions().enumerate();
            conditions.map(state).collect::<Vec<_>>()
        },
        |_, of_group| conditions.extend(of_group),
    );
    conditions
}
