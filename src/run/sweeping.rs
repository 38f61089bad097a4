//! The sweeps of a load step: the root solves for U, the other ranks serve S_CON.

use std::collections::BTreeMap;

use super::narrator::Narrator;
use crate::comm::Comm;
use crate::contact::pair::ContactPair;
use crate::error::Failure;
use crate::interface::operator::Interface;
use crate::interface::s_con::SCon;
use crate::settings::Settings;
use crate::sweep::{Method, Start, SweepOutcome, SweepRecord, SweepStatus, Sweeps};

/// What sweeps of any step need.
#[derive(Clone, Copy)]
pub struct Sweeping<'a> {
    /// All ranks.
    pub comm: &'a Comm,
    /// Method and tolerance.
    pub settings: &'a Settings,
    /// Tells of every sweep.
    pub narrator: &'a Narrator<'a>,
    /// The owner of every cluster in contact.
    pub contact_owners: &'a [usize],
}

impl Sweeping<'_> {
    /// Solves S_0 U + S_CON(U) = F, (14), from the solution of the step `before` or from the bilateral
    /// start. Collective; the outcome is the root's.
    ///
    /// # Errors
    /// A signal stopped the sweeps.
    pub fn sweep(
        &self,
        interface: Option<&Interface>,
        pairs: &mut BTreeMap<usize, ContactPair>,
        before: Option<&SweepOutcome>,
    ) -> Result<Option<SweepOutcome>, Failure> {
        let mut s_con = SCon::new(self.comm, self.contact_owners, pairs);
        let Some(interface) = interface else {
            s_con.serve();
            return self.comm.agree(Ok(None));
        };
        let solved = self.solve(interface, &mut s_con, before);
        s_con.stop();
        self.comm.agree(solved.map(Some))
    }

    fn solve(
        &self,
        interface: &Interface,
        s_con: &mut SCon<'_>,
        before: Option<&SweepOutcome>,
    ) -> Result<SweepOutcome, Failure> {
        self.narrator.sweeps(interface);
        // Picard's relaxation is that of the contacts that the bilateral solution leaves closed, and a step
        // that went nowhere is no place to start from.
        let before = before.filter(|before| {
            self.settings.method != Method::Picard && before.status == SweepStatus::Converged
        });
        let start = match before {
            Some(before) => Start::Before(before.u.clone(), before.open.clone()),
            None => Start::Bilateral,
        };
        let mut observer = |record: &SweepRecord| self.narrator.sweep(interface, record);
        let settings = self.settings.sweeps();
        Sweeps::solve(interface, s_con, settings, start, &mut observer)
    }
}
