//! Iterative refinement with the factors at hand: the full discrete problem's residual is solved
//! for with the active set fixed, wherever the certificate falls short.

use std::collections::BTreeMap;

use crate::certificate::check::BlockCheck;
use crate::certificate::{Certificate, certificate};
use crate::recover::BlockSolution;
use crate::recover::fixed_active_set::{BlockLoad, FixedActiveSet};
use crate::recover::motions::Field;

/// Equilibrium and penetration above which a solution is refined.
const LIMIT: f64 = 4e-15;
/// Equilibrium and penetration that are good enough.
const GOOD: f64 = 1e-14;
/// Most refinements.
const MAX_REFINEMENTS: usize = 3;

/// Refines `solutions` until the certificate holds or gets no better, and returns it; on the root
/// it is that of the whole solution. Collective.
pub fn refine(
    fixed: &FixedActiveSet<'_>,
    solutions: &mut BTreeMap<usize, BlockSolution>,
) -> Certificate {
    let mut best = check(fixed, solutions);
    for _ in 0..MAX_REFINEMENTS {
        if !decide(fixed, worst(&best) > LIMIT) {
            break;
        }
        let mut refined = solutions.clone();
        correct(fixed, &mut refined);
        let after = check(fixed, &refined);
        if !decide(fixed, worst(&after) < 0.5 * worst(&best)) {
            break;
        }
        *solutions = refined;
        best = after;
    }
    best
}

/// Puts `nearer` solutions, refined, in the place of `solutions` unless their certificate is a worse one,
/// and returns the certificate and whether it did. Collective.
pub fn replace_if_as_good(
    fixed: &FixedActiveSet<'_>,
    solutions: &mut BTreeMap<usize, BlockSolution>,
    mut nearer: BTreeMap<usize, BlockSolution>,
    certificate: Certificate,
) -> (Certificate, bool) {
    let after = refine(fixed, &mut nearer);
    let as_good = worst(&after) <= worst(&certificate).max(GOOD);
    if decide(fixed, as_good) {
        *solutions = nearer;
        (after, true)
    } else {
        (certificate, false)
    }
}

fn worst(certificate: &Certificate) -> f64 {
    certificate.equilibrium.max(certificate.penetration)
}

/// The root's decision, on all ranks. Collective.
fn decide(fixed: &FixedActiveSet<'_>, decision: bool) -> bool {
    let able = fixed
        .root
        .is_some_and(|root| root.converged && root.can_solve());
    fixed.context.comm.decide(able && decision)
}

/// The certificate, on the root. Collective.
fn check(fixed: &FixedActiveSet<'_>, solutions: &BTreeMap<usize, BlockSolution>) -> Certificate {
    let of_block = |b: usize| {
        let (owned, solution) = (fixed.context.blocks.get(&b)?, solutions.get(&b)?);
        let mut check = BlockCheck::new(
            owned,
            fixed.step.loads.get(&b)?,
            &fixed.balance(b, solution)?,
            &solution.u,
            &solution.forces,
        );
        let stiffness = fixed.condensed.blocks.get(&b)?.diagonal.iter().copied();
        check.most.rest = fixed.closing_motions * stiffness.fold(0.0, f64::max);
        Some(check)
    };
    let mut checks = Vec::new();
    fixed.context.comm.gather(
        &fixed.context.plan.owners(),
        |b| of_block(b).unwrap_or_default(),
        |_, check| checks.push(check),
    );
    match fixed.root {
        Some(_) => certificate(
            &checks,
            fixed.context.catalog.interface_nodes,
            fixed.context.catalog.dim,
        ),
        None => Certificate::default(),
    }
}

/// Adds the solution of the linear problem whose load is what `solutions` leave unbalanced. What of it
/// drives a free motion no displacement can balance: it is round-off, of loads and of stiffnesses that
/// are 0 along the motion but for theirs. It is left on all nodes that move, where it is least; the
/// springs at the motions' pins would bear it each at one node.
fn correct(fixed: &FixedActiveSet<'_>, solutions: &mut BTreeMap<usize, BlockSolution>) {
    let residual =
        |(&b, solution): (&usize, &BlockSolution)| Some((b, fixed.balance(b, solution)?.residual));
    let mut residuals: BTreeMap<usize, Vec<f64>> = solutions.iter().filter_map(residual).collect();
    let fields = residuals.iter_mut().map(|(&b, r)| (b, r)).collect();
    fixed.free.project(fixed, Field::Summed, fields);
    let unbalanced = |(&b, solution): (&usize, &BlockSolution)| {
        let dofs = &fixed.condensed.blocks.get(&b)?.dofs;
        let owned = fixed.context.blocks.get(&b)?;
        let mut load = vec![0.0; dofs.len()];
        dofs.add_load(residuals.get(&b)?, &mut load);
        let missing = fixed.step.loads.get(&b)?.gaps_left(owned, &solution.u);
        let closed = solution.closed.clone();
        Some((
            b,
            BlockLoad {
                load,
                closed,
                missing,
            },
        ))
    };
    let loads = solutions.iter().filter_map(unbalanced).collect();
    for (b, change) in fixed.solve(loads) {
        let block = fixed.condensed.blocks.get(&b);
        let (Some(solution), Some(block)) = (solutions.get_mut(&b), block) else {
            continue;
        };
        block.dofs.add_change(&change.x, &mut solution.u);
        for (force, change) in solution.forces.iter_mut().zip(change.forces) {
            *force = (*force + change).max(0.0);
        }
    }
}
