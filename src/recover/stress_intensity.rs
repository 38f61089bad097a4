//! Stress intensity factors of crack tips.

use contact_dd_partition::id::{BlockId, OnBlocks};
use contact_dd_partition::problem::Catalog;
use contact_dd_partition::quantity::QuantityKind;
use nalgebra::Vector2;

use crate::context::Context;
use crate::error::Failure;
use crate::fem::interaction_integral::{Integrals, TipDisc};
use crate::fem::stress_intensity::StressIntensity;
use crate::recover::BlockSolution;

/// Checks that the near fields are known for every crack tip of a quantity.
///
/// # Errors
/// A material without known near fields.
pub fn check_quantities(catalog: &Catalog) -> Result<(), Failure> {
    for quantity in &catalog.quantities {
        let is_of_tip = matches!(
            quantity.kind,
            QuantityKind::OpeningIntensity
                | QuantityKind::SlidingIntensity
                | QuantityKind::EnergyReleaseRate
        );
        let Some(tip) = quantity.of.first().filter(|_| is_of_tip) else {
            continue;
        };
        let tip = &catalog.tips[*tip as usize];
        let material = &catalog.materials[tip.material as usize];
        if TipDisc::new(tip, material).is_none() {
            return Err(Failure::input(format!(
                "quantity '{}': the near fields of crack tip '{}' aren't known in material '{}', as its stiffness is almost \
                 that of one with twofold roots; expected 'young' and 'poisson', or another stiffness",
                quantity.name, tip.name, material.name
            )));
        }
    }
    Ok(())
}

/// The stress intensity factors of all crack tips in load step `step`, on the root; tips of absent bodies and in
/// materials without near fields have none. Collective.
pub fn stress_intensities(
    context: &Context<'_>,
    solutions: &OnBlocks<BlockSolution>,
    step: usize,
) -> Vec<StressIntensity> {
    let catalog = context.catalog;
    let is_there = |body: u32| !catalog.bodies[body as usize].is_absent;
    let discs: Vec<TipDisc<'_>> = (catalog.tips.iter())
        .filter(|tip| is_there(tip.body))
        .filter_map(|tip| TipDisc::new(tip, &catalog.materials[tip.material as usize]))
        .collect();
    if discs.is_empty() {
        return Vec::new();
    }
    let sums = sums(context, &discs, solutions, step);
    let both = discs.iter().zip(&sums);
    both.map(|(disc, integrals)| factors(disc, integrals))
        .collect()
}

/// M of all tips, on the root. Collective.
fn sums(
    context: &Context<'_>,
    discs: &[TipDisc<'_>],
    solutions: &OnBlocks<BlockSolution>,
    step: usize,
) -> Vec<Integrals> {
    let mut sums = vec![Integrals::default(); discs.len()];
    let of_block = |b: BlockId| -> Vec<(usize, Integrals)> {
        let (Some(block), Some(solution)) = (context.blocks.get(&b), solutions.get(&b)) else {
            return Vec::new();
        };
        let initial = block.subdomain.initial_stress_in(step);
        let integrals = |disc: &TipDisc<'_>| disc.integrals(block, &solution.u, initial);
        let all = discs.iter().enumerate();
        all.filter_map(|(d, disc)| Some((d, integrals(disc)?)))
            .collect()
    };
    (context.comm).gather(&context.plan.owners(), of_block, |_, of_block| {
        for (d, integrals) in of_block {
            for (sum, part) in sums[d].iter_mut().zip(integrals) {
                *sum = [sum[0] + part[0], sum[1] + part[1]];
            }
        }
    });
    sums
}

/// K from M = 2 H K, and G = Kᵀ H K.
fn factors(disc: &TipDisc<'_>, integrals: &Integrals) -> StressIntensity {
    let h = disc.field.compliance();
    // H is positive definite, as C is.
    let half_inverse = 0.5 * h.try_inverse().unwrap_or_default();
    let factors = integrals.map(|m| half_inverse * Vector2::from(m));
    let [whole, smaller @ ..] = factors;
    let off = smaller
        .iter()
        .map(|k| (k - whole).norm())
        .fold(0.0, f64::max);
    let size = whole.norm();
    StressIntensity {
        tip: disc.tip().name.clone(),
        node: disc.tip().tag,
        position: disc.tip().position,
        direction: disc.tip().direction,
        opening: whole[0],
        sliding: whole[1],
        energy_release_rate: whole.dot(&(h * whole)),
        radius: disc.tip().radius,
        dependence_on_radius: if size > 0.0 { off / size } else { 0.0 },
    }
}
