//! The sweeps of a load step.

use std::collections::BTreeMap;

use crate::contact::laws::Statuses;
use crate::contact::limits::Limits;
use crate::contact::pair::ContactPair;
use crate::context::Context;
use crate::error::Failure;
use crate::interface::problem::InterfaceProblem;
use crate::interface::s_con::SCon;
use crate::report::log::RunLog;
use crate::schur::local::CondensedLoad;
use crate::settings::Settings;
use crate::sweep::{Start, SweepOutcome, SweepRecord, Sweeps};
use crate::tree::contact::{self, TreeContact};
use crate::tree::fronts::ActiveSetFronts;

/// Solves S_0 U + S_CON(U) = F, (14), from the `start` and tells of every sweep: the root solves for U, the other
/// ranks serve S_CON. Collective; problem and outcome are the root's.
///
/// # Errors
/// A signal stopped the sweeps.
pub fn sweep(
    context: &Context<'_>,
    settings: &Settings,
    log: &RunLog<'_>,
    problem: Option<&InterfaceProblem<'_>>,
    pairs: &mut BTreeMap<usize, ContactPair>,
    start: Start,
) -> Result<Option<SweepOutcome>, Failure> {
    let owners = context.plan.contact_owners();
    let mut s_con = SCon::new(context.comm, &owners, pairs);
    let Some(problem) = problem else {
        s_con.serve();
        return context.comm.agree(Ok(None));
    };
    let in_contact = !problem.interface.pair_interface_dofs.is_empty();
    log.sweeps(in_contact);
    let mut observer = |record: &SweepRecord| {
        if in_contact {
            log.sweep(record);
        }
    };
    let solved = Sweeps::solve(problem, &mut s_con, settings.sweeps(), start, &mut observer);
    s_con.stop();
    context.comm.agree(solved.map(Some))
}

/// Finds which of many conditions are closed in a load step, one fixed active set after the other, and tells of
/// every one; the first has the statuses of the load step `before`. Collective.
///
/// # Errors
/// Some part of the scene moves freely.
pub fn sweep_active_sets(
    context: &Context<'_>,
    settings: &Settings,
    log: &RunLog<'_>,
    fronts: &mut ActiveSetFronts,
    condensed: &BTreeMap<usize, CondensedLoad>,
    (limits, before): (&BTreeMap<usize, Limits>, &BTreeMap<usize, Statuses>),
) -> Result<TreeContact, Failure> {
    log.sweeps(true);
    let loads = condensed
        .iter()
        .map(|(&v, load)| (v, load.boundary().to_vec()));
    let mut observer = |record: &SweepRecord| log.sweep(record);
    contact::solve(
        context,
        fronts,
        limits,
        (&loads.collect(), before),
        settings.max_sweeps,
        &mut observer,
    )
}
