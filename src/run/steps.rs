//! Load steps: what blocks are told of one before it is solved for.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;

use super::descend::take_out_descent;
use super::squeezed;
use crate::comm::Comm;
use crate::error::Failure;
use crate::fem::owned::OwnedBlock;
use crate::plan::Plan;
use crate::rigid::survey::{Survey, survey};

/// Looks at the rigid motions of the scene in every load step, one where it has none. Collective.
///
/// # Errors
/// What a step prescribes leaves no place for a node, or its load drives a motion that nothing holds.
pub fn survey_steps(
    comm: &Comm,
    blocks: &mut BTreeMap<usize, OwnedBlock>,
    catalog: &Catalog,
    plan: &Plan,
) -> Result<Vec<Survey>, Failure> {
    (0..catalog.steps.len().max(1))
        .map(|k| {
            set_loads(blocks, k);
            comm.agree(
                blocks
                    .values()
                    .try_for_each(|owned| squeezed::check(owned, catalog)),
            )
            .and_then(|()| survey(comm, blocks, catalog, plan))
            .map_err(|failure| in_step(failure, catalog, k))
        })
        .collect()
}

/// Gives the blocks of this rank the supports and forces of load step k, and gaps and supports what its
/// bodies' way to rest leaves of them.
pub fn take_step(blocks: &mut BTreeMap<usize, OwnedBlock>, k: usize, of_step: &Survey, dim: usize) {
    set_loads(blocks, k);
    take_out_descent(blocks, of_step, dim);
}

fn set_loads(blocks: &mut BTreeMap<usize, OwnedBlock>, k: usize) {
    for owned in blocks.values_mut() {
        for member in &mut owned.block.members {
            member.take_step(k);
        }
        owned.gaps = owned.points.iter().map(|point| point.gap).collect();
    }
}

/// Ends the run before load step k if a signal asked for that, which sweeps that take long hear by themselves.
/// Collective.
///
/// # Errors
/// A signal did.
pub fn stop_if_asked(comm: &Comm, catalog: &Catalog, k: usize) -> Result<(), Failure> {
    match comm.is_any_asked_to_stop() {
        false => Ok(()),
        true => Err(Failure::interrupted(format!(
            "interrupted after {k} of {} load steps, before a result was written",
            catalog.steps.len()
        ))),
    }
}

/// A failure that says in which load step it was.
pub fn in_step(mut failure: Failure, catalog: &Catalog, k: usize) -> Failure {
    if let Some(step) = catalog.steps.get(k) {
        failure.message = format!("step '{}': {}", step.name, failure.message);
    }
    failure
}
