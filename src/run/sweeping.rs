//! The sweeps of a load step: the root solves for U, the other ranks serve S_CON.

use std::collections::BTreeMap;

use crate::contact::pair::ContactPair;
use crate::context::Context;
use crate::error::Failure;
use crate::interface::problem::InterfaceProblem;
use crate::interface::s_con::SCon;
use crate::report::log::RunLog;
use crate::settings::Settings;
use crate::sweep::{Start, SweepOutcome, SweepRecord, Sweeps};

/// Solves S_0 U + S_CON(U) = F, (14), from the `start` and tells of every sweep. Collective; problem and
/// outcome are the root's.
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
    log.sweeps(problem.interface);
    let mut observer = |record: &SweepRecord| log.sweep(problem.interface, record);
    let solved = Sweeps::solve(problem, &mut s_con, settings.sweeps(), start, &mut observer);
    s_con.stop();
    context.comm.agree(solved.map(Some))
}
