//! Iterative refinement with the available factors: the full discrete problem's residual is solved for with the active
//! set fixed, wherever the certificate falls short.

use contact_dd_partition::id::{GroupId, OnBlocks, OnGroups};

use crate::certificate::Certificate;
use crate::contact::jumps::JumpOf;
use crate::context::Context;
use crate::context::hierarchy::jumps;
use crate::recover::DiscreteSolution;
use crate::recover::fixed_active_set::{FixedActiveSet, FixedStatuses};
use crate::recover::fixed_conditions::{change_forces, conditions};
use crate::recover::solution_check::check;
use crate::sweep::AGAINST_FRICTION;

/// Equilibrium and penetration above which a solution is refined.
const LIMIT: f64 = 4e-15;
/// Equilibrium relative to the load above which a solution is refined: forces in bodies that move much farther than
/// they deform are smaller than their displacements suggest.
const LIMIT_OF_LOAD: f64 = 1e-11;
/// Violation of the law of friction above which a solution is refined.
const LIMIT_OF_FRICTION: f64 = 1e-14;
/// Violation of the law of friction above which sticking and slipping are corrected: well above round-off, well below
/// the error that is rejected.
const CORRECTED_ABOVE: f64 = 1e-12;
/// Equilibrium and penetration that are good enough.
const GOOD: f64 = 1e-14;
/// Accuracy of a correction by an iterative solver.
const CORRECTION: f64 = 1e-3;
/// Most refinements.
const MAX_REFINEMENTS: usize = 3;
/// Most refinements with friction, whose forces follow the pressure, and turn in space.
const MAX_REFINEMENTS_OF_SLIPS: usize = 8;
/// Most refinements in which the laws of contact are solved anew.
const MAX_REFINEMENTS_OF_LAWS: usize = 5;
/// Most corrections of sticking and slipping.
const MAX_CORRECTIONS: usize = 20;

/// Refines `solution` until the certificate holds or no longer improves, and returns it; on the root for the whole
/// solution. Collective.
pub fn refine(fixed: &FixedActiveSet<'_>, solution: &mut DiscreteSolution) -> Certificate {
    let mut best = check(fixed, solution);
    let most = match fixed.context.catalog.has_friction() {
        true => MAX_REFINEMENTS_OF_SLIPS,
        false => MAX_REFINEMENTS,
    };
    for _ in 0..most {
        let slips_astray = best.friction > LIMIT_OF_FRICTION;
        let falls_short = worst(&best) > LIMIT || best.equilibrium_of_load > LIMIT_OF_LOAD;
        let falls_short = falls_short || slips_astray;
        if !decide(fixed, falls_short) {
            break;
        }
        let mut refined = solution.clone();
        correct(fixed, &mut refined);
        let after = check(fixed, &refined);
        let is_nearer = worst(&after) < 0.5 * worst(&best)
            || worst(&after) < LIMIT && after.equilibrium_of_load < 0.5 * best.equilibrium_of_load
            || worst(&after) < LIMIT.max(worst(&best))
                && slips_astray
                && after.friction < 0.5 * best.friction;
        if !decide(fixed, is_nearer && keeps_law(&after, &best)) {
            break;
        }
        *solution = refined;
        best = after;
    }
    best
}

/// Solves the laws of contact anew for a solution's unbalanced forces, as long as its certificate falls short and
/// improves, and returns it; if that fails with friction, it starts again from a state without slip. Collective.
pub fn refine_laws(
    fixed: &FixedActiveSet<'_>,
    solution: &mut DiscreteSolution,
    certificate: Certificate,
) -> Certificate {
    let mut best = certificate;
    if !decide(fixed, violates_laws(&best)) {
        return best;
    }
    laws_from(fixed, solution, &mut best);
    // A cycle from the present state recurs from other ones, too.
    let tries_again = fixed.root.is_some_and(|root| !root.cycles) && violates_laws(&best);
    if fixed.context.catalog.has_friction() && decide(fixed, tries_again) {
        let mut stuck = solution.clone();
        for _ in 0..MAX_REFINEMENTS {
            let loads = unbalanced(fixed, &stuck);
            fixed.undo_slips(&mut stuck, loads);
        }
        let mut of_stuck = Certificate {
            equilibrium: f64::INFINITY,
            ..best
        };
        laws_from(fixed, &mut stuck, &mut of_stuck);
        if decide(fixed, law_violation(&of_stuck) < law_violation(&best)) {
            *solution = stuck;
            best = of_stuck;
        }
    }
    best
}

/// Solves the laws of contact anew, and refines, as long as the certificate falls short and improves. Collective.
fn laws_from(fixed: &FixedActiveSet<'_>, solution: &mut DiscreteSolution, best: &mut Certificate) {
    for _ in 0..MAX_REFINEMENTS_OF_LAWS {
        if !decide(fixed, violates_laws(best)) {
            break;
        }
        let residuals = unbalanced(fixed, solution);
        let Some(mut refined) = fixed.solve_laws(solution, residuals) else {
            break;
        };
        let after = refine(fixed, &mut refined);
        if !decide(fixed, law_violation(&after) < law_violation(best)) {
            break;
        }
        *solution = refined;
        *best = after;
    }
}

/// True if a solution violates balance or the laws of contact by more than is good enough.
fn violates_laws(certificate: &Certificate) -> bool {
    law_violation(certificate) > GOOD
}

/// Violation of balance and of the laws of contact by a solution, on the scale of equilibrium.
fn law_violation(certificate: &Certificate) -> f64 {
    worst(certificate).max(certificate.friction * (GOOD / CORRECTED_ABOVE))
}

/// Corrects statuses against the laws of contact, as forces are more accurate after refinement than in the sweeps, and
/// refines anew, until the laws are fulfilled; if they never are, nothing changes. Corrected are sticking and slipping
/// against friction and, if the certificate falls short, limits closed without a force or open with an overlap, both
/// too small for the sweeps. Collective.
pub fn correct_statuses(
    fixed: &FixedActiveSet<'_>,
    solution: &mut DiscreteSolution,
    certificate: Certificate,
) -> Certificate {
    let (mut corrected, mut after) = (None, certificate);
    for _ in 0..MAX_CORRECTIONS {
        let is_violated = decide(fixed, after.friction > CORRECTED_ABOVE);
        let is_short = decide(fixed, worst(&after) > GOOD);
        let next: &mut DiscreteSolution = corrected.get_or_insert_with(|| solution.clone());
        let mut changed = decide(fixed, after.friction > AGAINST_FRICTION);
        for (g, of_group) in &mut next.groups {
            let group = &fixed.context.groups[g];
            if is_short {
                changed |= of_group.open_or_close(group);
            }
            if is_violated {
                changed |= of_group.correct_statuses(group);
            }
        }
        let changed = fixed.context.comm.collect(&changed).contains(&true);
        if !decide(fixed, changed) {
            break;
        }
        next.share(&fixed.context, &fixed.step.loads);
        after = refine(fixed, next);
    }
    if let Some(next) = &mut corrected
        && decide(fixed, after.friction > AGAINST_FRICTION)
    {
        // Forces keep to their bounds where the round-off of balance exceeds the law's tolerance.
        for (g, of_group) in &mut next.groups {
            of_group.keep_to_bounds(&fixed.context.groups[g]);
        }
        next.share(&fixed.context, &fixed.step.loads);
        after = check(fixed, next);
    }
    let is_right = after.friction
        <= certificate
            .friction
            .clamp(CORRECTED_ABOVE, AGAINST_FRICTION);
    let as_good = worst(&after) <= worst(&certificate).max(GOOD);
    match corrected {
        Some(corrected) if decide(fixed, is_right && as_good) => {
            *solution = corrected;
            after
        }
        _ => certificate,
    }
}

/// Replaces `solution` by a `nearer` one, refined, unless its certificate is worse; returns the certificate and whether
/// it did. Collective.
pub fn replace_if_as_good(
    fixed: &FixedActiveSet<'_>,
    solution: &mut DiscreteSolution,
    mut nearer: DiscreteSolution,
    certificate: Certificate,
) -> (Certificate, bool) {
    let after = refine(fixed, &mut nearer);
    let as_good = worst(&after) <= worst(&certificate).max(GOOD);
    if decide(fixed, as_good && keeps_law(&after, &certificate)) {
        *solution = nearer;
        (after, true)
    } else {
        (certificate, false)
    }
}

/// True if a solution fulfils the law of friction as well as another one, or well enough.
fn keeps_law(after: &Certificate, before: &Certificate) -> bool {
    after.friction <= before.friction.max(AGAINST_FRICTION)
}

fn worst(certificate: &Certificate) -> f64 {
    certificate.equilibrium.max(certificate.penetration)
}

/// The root's decision, on all ranks. Collective.
fn decide(fixed: &FixedActiveSet<'_>, decision: bool) -> bool {
    let able = fixed
        .root
        .is_some_and(|root| root.is_refined && root.can_solve());
    fixed.context.comm.decide(able && decision)
}

/// Corrects a solution by its unbalanced forces, if possible, even if that worsens the certificate. Collective.
pub fn correct_once(fixed: &FixedActiveSet<'_>, solution: &mut DiscreteSolution) {
    if decide(fixed, true) {
        correct(fixed, solution);
    }
}

/// Adds the solution of the linear problem under the unbalanced forces of `solution`. No displacement can balance their
/// part along a free motion: it is round-off, of loads and of stiffnesses that are 0 along the motion but for theirs.
/// It is left spread over all nodes that move, where it is least; the springs at the motions' pins would concentrate it
/// at single nodes.
fn correct(fixed: &FixedActiveSet<'_>, solution: &mut DiscreteSolution) {
    let context = &fixed.context;
    let prescribed: OnGroups<Vec<bool>> = (solution.groups.keys())
        .map(|&g| (g, prescribed(context, g)))
        .collect();
    let conditions: FixedStatuses = (solution.groups.iter_mut())
        .map(|(&g, of_group)| {
            let of_group = conditions(&context.groups[&g], of_group, &prescribed[&g]);
            (g, of_group)
        })
        .collect();
    if context.catalog.dim == 3 && context.catalog.has_friction() {
        solution.share(context, &fixed.step.loads);
    }
    let loads = unbalanced(fixed, solution);
    let forces = solution.groups.iter();
    let forces = forces.map(|(&g, of_group)| (g, of_group.forces.clone()));
    let change = fixed.solve(loads, conditions.clone(), &forces.collect(), CORRECTION);
    solution.add(fixed.condensed, change.blocks);
    for (g, changes) in change.forces {
        if let Some(of_group) = solution.groups.get_mut(&g) {
            change_forces(
                &fixed.context.groups[&g],
                of_group,
                &conditions[&g],
                &prescribed[&g],
                &changes,
            );
        }
    }
    solution.share(&fixed.context, &fixed.step.loads);
}

/// The unbalanced forces of a solution on this rank's unknowns, without those along free motions. Collective.
fn unbalanced(fixed: &FixedActiveSet<'_>, solution: &DiscreteSolution) -> OnBlocks<Vec<f64>> {
    let residual = |(&b, of_block)| Some((b, fixed.balance(b, of_block)?.residual.clone()));
    fixed.on_unknowns(solution.blocks.iter().filter_map(residual).collect())
}

/// Flags of contact group g's conditions whose jumps supports prescribe; in the plane friction doesn't need them.
pub(super) fn prescribed(context: &Context<'_>, g: GroupId) -> Vec<bool> {
    let group = &context.groups[&g];
    let of = match context.catalog.dim == 3 && !group.friction().is_empty() {
        true => jumps(context, g, group).map(|jumps| jumps.of),
        false => Ok(Vec::new()),
    };
    let of = of.unwrap_or_default().into_iter();
    let mut prescribed: Vec<bool> = of.map(|of| of == JumpOf::Prescribed).collect();
    prescribed.resize(group.conditions().count(), false);
    prescribed
}
