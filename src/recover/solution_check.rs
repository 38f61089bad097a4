//! The check of a solution: its certificate, from the checks of ranks on blocks, at contact points and at shared nodes.

use std::collections::BTreeMap;

use contact_dd_partition::id::{BlockId, GroupId, OnBlocks};

use crate::certificate::check::{BlockCheck, not_opposed};
use crate::certificate::most::Most;
use crate::certificate::scales::SlipScales;
use crate::certificate::shared::at_shared_nodes;
use crate::certificate::{Certificate, certificate};
use crate::recover::fixed_active_set::FixedActiveSet;
use crate::recover::{DiscreteSolution, GroupSolution};
use crate::vector::larger;

/// The certificate of a solution, on the root. Collective.
pub fn check(fixed: &FixedActiveSet<'_>, solution: &DiscreteSolution) -> Certificate {
    let (comm, plan) = (fixed.context.comm, fixed.context.plan);
    let of_block = |b: BlockId| {
        let (block, of_block) = (fixed.context.blocks.get(&b)?, solution.blocks.get(&b)?);
        let balance = fixed.balance(b, of_block)?;
        let loads = fixed.step.loads.blocks.get(&b)?;
        let (mut check, shared) = BlockCheck::new(block, loads, &balance, &of_block.u);
        let stiffness = fixed.condensed.blocks.get(&b)?.diagonal.iter().copied();
        check.most.rest = fixed.closing_motions * stiffness.fold(0.0, f64::max);
        check.most.driven = check.most.driven.max(fixed.closing_motions);
        Some((check, shared))
    };
    let mut own: OnBlocks<BlockCheck> = BTreeMap::new();
    let mut parts = vec![Vec::new(); comm.size()];
    for &b in fixed.context.blocks.keys() {
        let (check, shared) = of_block(b).unwrap_or_default();
        own.insert(b, check);
        for (part, to) in shared.parts(comm.size()).into_iter().zip(&mut parts) {
            to.push((b, part));
        }
    }
    // Ranks check the shared nodes in turn, in the order of blocks.
    let mut shared = comm.exchange(parts).concat();
    shared.sort_by_key(|&(b, _)| b);
    let shared = at_shared_nodes(shared.iter().map(|(_, check)| check));
    let mut elsewhere = at_contact_points(fixed, solution, shared);
    let mut checks = Vec::new();
    comm.gather(
        &plan.owners(),
        |b| own.remove(&b).unwrap_or_default(),
        |_, check| checks.push(check),
    );
    for of_rank in comm.collect(&elsewhere) {
        elsewhere.include(of_rank);
    }
    let mut certificate = match fixed.root {
        Some(_) => certificate(
            &checks,
            elsewhere,
            fixed.step.earlier,
            fixed.context.catalog.plane,
        ),
        None => Certificate::default(),
    };
    if fixed.context.catalog.has_friction() {
        let unopposed = unopposed_slip(fixed, solution, certificate.of_slips);
        certificate.friction = larger(certificate.friction, unopposed);
    }
    certificate
}

/// The largest values in the checks of this rank at contact points and elsewhere.
fn at_contact_points(
    fixed: &FixedActiveSet<'_>,
    solution: &DiscreteSolution,
    mut most: Most,
) -> Most {
    for (g, group) in fixed.context.groups {
        let of_group = &solution.groups[g];
        let (gaps, forces) = (&of_group.gaps, &of_group.forces);
        most.include(Most::at_points(group, gaps, forces, &of_group.closed));
        let before = fixed.step.loads.groups[g].gaps.iter().copied();
        most.driven = (before.filter(|gap| gap.is_finite())).fold(most.driven, larger);
    }
    most
}

/// The largest slip not opposed by friction, relative to these `scales`, which the root knows; on the root. Collective.
fn unopposed_slip(
    fixed: &FixedActiveSet<'_>,
    solution: &DiscreteSolution,
    mut scales: SlipScales,
) -> f64 {
    let comm = fixed.context.comm;
    comm.broadcast(&mut scales);
    let of_group = |(g, of_group): (&GroupId, &GroupSolution)| {
        let numbers = [&of_group.gaps[..], &of_group.forces];
        not_opposed(&fixed.context.groups[g], numbers, &of_group.closed, scales)
    };
    let own = solution.groups.iter().map(of_group).fold(0.0, larger);
    comm.collect(&own).into_iter().fold(0.0, larger)
}
