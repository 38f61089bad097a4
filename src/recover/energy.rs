//! The balance of energy of an increment, where there is friction.

use contact_dd_partition::id::OnBlocks;

use crate::certificate::energy::{BlockEnergy, EnergyBalance};
use crate::recover::fixed_active_set::FixedActiveSet;
use crate::recover::solution::Solution;

/// Energies of the blocks of this rank for the next increment, by their number, and on the root the balance of this one
/// after `before`; empty without friction. Collective.
pub fn energies(
    fixed: &FixedActiveSet<'_>,
    solution: &Solution,
    before: &OnBlocks<BlockEnergy>,
) -> (OnBlocks<BlockEnergy>, EnergyBalance) {
    let context = fixed.context;
    if !context.catalog.has_friction() {
        return Default::default();
    }
    let of_block = |(&b, of_block)| {
        let balance = fixed.balance(b, of_block)?;
        let loads = fixed.step.loads.blocks.get(&b)?;
        let displacement = solution.displacement.get(&b)?;
        let block = context.blocks.get(&b)?;
        let energy = BlockEnergy::new(block, loads, &balance, &of_block.u, displacement);
        Some((b, energy))
    };
    let after: OnBlocks<BlockEnergy> = solution
        .discrete
        .blocks
        .iter()
        .filter_map(of_block)
        .collect();
    let mut works = Vec::new();
    context.comm.gather(
        &context.plan.owners(),
        |b| {
            after
                .get(&b)
                .map_or([0.0; 6], |energy| energy.work(before.get(&b)))
        },
        |_, work| works.push(work),
    );
    (after, EnergyBalance::new(&works))
}
