//! Sweeps: outer iterations for S_0 U + S_CON(U) = F, (14), from the bilateral start (16)-(17) or from the solution of
//! the load step before.
//!
//! A signal to any rank that asks the run to stop takes effect between two sweeps.
//!
//! All methods use the residual r(U) = F − S_0 U − S_CON(U) and differ in the operator M of the correction M δ = r: S_0
//! ([`picard`], the paper's (18)), S_0 + S_CON' of the bilateral problem ([`anderson`]), or S_0 + S_CON(U + ·) itself,
//! contact constraints included ([`newton`]).

pub mod anderson;
pub mod newton;
mod outcome;
pub mod picard;

use std::time::Instant;

pub use contact_dd_partition::solver::Method;

pub use self::outcome::{
    AGAINST_FRICTION, IterativeSolves, SweepOutcome, SweepRecord, SweepStatus,
};
use crate::contact::friction::Status;
use crate::error::Failure;
use crate::interface::coupled::CoupledContact;
use crate::interface::problem::InterfaceProblem;
use crate::interface::s_con::{ConState, ConTotals, Expected, SCon};
use crate::settings::SweepSettings;
use crate::vector::largest;

/// Relative residual that is round-off only.
const ROUND_OFF: f64 = 1e-15;

/// Relative residual required of a method that took over from newton: there may be no factor for refinement afterwards.
const FALL_BACK_TOLERANCE: f64 = 1e-13;

/// The sweeps on the root.
pub struct Sweeps<'a, 'c> {
    problem: &'a InterfaceProblem<'a>,
    s_con: &'a mut SCon<'c>,
    state: ConState,
    settings: SweepSettings,
    /// Progress of the sweeps.
    outcome: SweepOutcome,
    /// True if another method took over from newton: then there may be no factor for refinement.
    has_fallen_back: bool,
    began: Instant,
    observer: &'a mut dyn FnMut(&SweepRecord),
}

/// r(U) = F − S_0 U − S_CON(U).
#[derive(Clone, Debug)]
pub struct Residual {
    /// r (N/m).
    pub r: Vec<f64>,
    /// ‖r‖∞ relative to the terms that r is a sum of.
    pub relative: f64,
    /// Totals over the evaluations of all pairs at U.
    pub totals: ConTotals,
}

/// Start of the sweeps.
#[derive(Debug)]
pub enum Start {
    /// Start at the solution of the bilateral problem, (16)-(17).
    Bilateral,
    /// Start at the solution of the load step before: U, and the statuses of every pair.
    Before(Vec<f64>, Vec<Vec<Status>>),
}

impl<'a, 'c> Sweeps<'a, 'c> {
    /// Solves S_0 U + S_CON(U) = F, (14), from the `start`. On the root, while the other ranks evaluate S_CON on
    /// request; `observer` receives the record of every sweep.
    ///
    /// # Errors
    /// A signal has asked the run to stop.
    pub fn solve(
        problem: &'a InterfaceProblem<'a>,
        s_con: &'a mut SCon<'c>,
        settings: SweepSettings,
        start: Start,
        observer: &'a mut dyn FnMut(&SweepRecord),
    ) -> Result<SweepOutcome, Failure> {
        let (mut sweeps, residual) = Self::begin(problem, s_con, settings, start, observer);
        let status = match settings.method {
            Method::Newton => sweeps.newton(residual)?,
            Method::Anderson => sweeps.anderson(residual)?,
            Method::Picard => sweeps.picard(residual)?,
        };
        if settings.second_start && status == SweepStatus::Converged {
            sweeps.find_second_solution();
        }
        Ok(sweeps.end(status))
    }

    /// The state before the first sweep, and its residual: at the bilateral start (16)-(17), or at the solution of the
    /// load step before, which newton leaves as it is until it has solved the coupled problem.
    pub fn begin(
        problem: &'a InterfaceProblem<'a>,
        s_con: &'a mut SCon<'c>,
        settings: SweepSettings,
        start: Start,
        observer: &'a mut dyn FnMut(&SweepRecord),
    ) -> (Self, Residual) {
        let solves_coupled =
            settings.method == Method::Newton && CoupledContact::new(problem).is_some();
        let (u, before) = match start {
            Start::Bilateral => (problem.bilateral_start(), None),
            Start::Before(u, statuses) => (u, Some(statuses)),
        };
        let mut sweeps = Self {
            problem,
            s_con,
            state: ConState::default(),
            settings,
            began: Instant::now(),
            outcome: SweepOutcome::before(u),
            has_fallen_back: false,
            observer,
        };
        let residual = match before {
            Some(_) if solves_coupled => {
                let interface = sweeps.problem.interface;
                let u = &sweeps.outcome.u;
                let totals = (sweeps.s_con).at_last_jumps(interface, u, &mut sweeps.state);
                let residual = sweeps.residual_after(totals);
                match residual.relative <= sweeps.tolerance() {
                    true => sweeps.residual(None),
                    false => residual,
                }
            }
            Some(statuses) => {
                let expected = statuses.into_iter().map(|of_pair| (of_pair, Vec::new()));
                sweeps.residual(Some(&expected.collect::<Vec<Expected>>()))
            }
            None => sweeps.residual(None),
        };
        sweeps.record(&residual);
        (sweeps, residual)
    }

    /// U, for a method to update; [`evaluate`](Self::evaluate) then completes the sweep.
    pub fn u(&mut self) -> &mut [f64] {
        &mut self.outcome.u
    }

    /// r(U), added to the history; the pairs' active-set iterations start from the `expected` statuses, else from those
    /// of their last evaluation.
    pub fn evaluate(&mut self, expected: Option<&[Expected]>) -> Residual {
        let residual = self.residual(expected);
        self.record(&residual);
        residual
    }

    /// Ends the sweeps; a converged solution is refined.
    pub fn end(mut self, status: SweepStatus) -> SweepOutcome {
        if status == SweepStatus::Converged {
            self.refine();
        }
        // The pairs keep the normal jumps and forces of their last evaluation, which must therefore be at this U.
        let last = self.residual(None);
        SweepOutcome {
            status,
            residual: last.relative,
            statuses: self.state.statuses(),
            ..self.outcome
        }
    }

    /// True if another sweep is needed.
    ///
    /// # Errors
    /// A signal has asked the run to stop.
    fn needs_sweep(&self, residual: &Residual) -> Result<bool, Failure> {
        if self.is_converged(residual) {
            return Ok(false);
        }
        if self.s_con.is_any_asked_to_stop() {
            let done = self.sweeps_done();
            let message = format!("interrupted after {done} sweeps");
            return Err(Failure::interrupted(message));
        }
        Ok(true)
    }

    /// r(U); the pairs' active-set iterations start from the `expected` statuses, else from those of their last
    /// evaluation.
    fn residual(&mut self, expected: Option<&[Expected]>) -> Residual {
        let u = &self.outcome.u;
        let totals = (self.s_con).evaluate(self.problem.interface, u, expected, &mut self.state);
        self.residual_after(totals)
    }

    /// r(U) after an evaluation of S_CON with these totals.
    fn residual_after(&mut self, totals: ConTotals) -> Residual {
        self.outcome.count(&totals, self.s_con.len());
        let (mut r, mut scale) = self.problem.linear_residual(&self.outcome.u);
        self.state
            .subtract(self.problem.interface, &mut r, &mut scale);
        let (r_max, scale_max) = (largest(&r), largest(&scale));
        Residual {
            r,
            relative: match r_max {
                0.0 => 0.0,
                r_max => r_max / self.problem.residual_scale(scale_max),
            },
            totals,
        }
    }

    fn record(&mut self, residual: &Residual) {
        let sweep = self.outcome.records.len();
        let record = SweepRecord {
            sweep,
            residual: residual.relative,
            active: residual.totals.active,
            changed: (sweep > 0).then_some(residual.totals.changed),
            seconds: self.began.elapsed().as_secs_f64(),
        };
        self.outcome.records.push(record);
        (self.observer)(&record);
    }

    /// True if the residual is small and the active set unchanged, or the residual is round-off: as S_CON is evaluated
    /// exactly, nothing can change then.
    pub fn is_converged(&self, residual: &Residual) -> bool {
        let small = residual.relative <= self.tolerance() && residual.totals.changed == 0;
        residual.totals.failed_pairs == 0 && (small || residual.relative <= ROUND_OFF)
    }

    /// Residual at which the sweeps end.
    fn tolerance(&self) -> f64 {
        match self.has_fallen_back {
            true => self.settings.tolerance.min(FALL_BACK_TOLERANCE),
            false => self.settings.tolerance,
        }
    }

    /// Number of sweeps so far.
    pub fn sweeps_done(&self) -> usize {
        self.outcome.records.len() - 1
    }

    fn gave_up(&self, residual: &Residual, why: &str) -> SweepStatus {
        let failed = match residual.totals.failed_pairs {
            0 => String::new(),
            n => format!("; the small problem of {n} pairs didn't converge"),
        };
        SweepStatus::NotConverged(format!(
            "{why} after {} sweeps at a residual of {:.1e}{failed}",
            self.sweeps_done(),
            residual.relative
        ))
    }
}
