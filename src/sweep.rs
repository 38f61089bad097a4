//! Sweeps: how U is found on Γ, started from the bilateral problem (16)-(17).
//!
//! All methods share the residual r(U) = F − S_0 U − S_CON(U) and differ in what is inverted:
//! M δ = r with M = S_0 ([`picard`], the paper's (18)), S_0 + S_CON' of the bilateral problem
//! ([`anderson`]), or S_0 + S_CON(U + ·) as it is, the contact conditions included ([`newton`]).

pub mod anderson;
pub mod newton;
mod outcome;
pub mod picard;
pub mod progress;

use std::time::Instant;

pub use contact_dd_partition::solver::Method;

pub use self::outcome::{SweepOutcome, SweepRecord, SweepStatus};
use self::progress::{Memory, Progress};
use crate::contact::s_con::{ConState, ConTotals, SCon};
use crate::interface::operator::Interface;
use crate::schur::factor::BoundaryLastCholesky;

/// Residual that is round-off and nothing else.
const ROUND_OFF: f64 = 1e-15;

/// Residual to which a method goes that took over: there may be nothing to refine with afterwards.
const FALL_BACK_TOLERANCE: f64 = 1e-13;

/// What a user sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepSettings {
    /// Method.
    pub method: Method,
    /// Residual, relative to the terms that it is a sum of, at which sweeps end.
    pub tolerance: f64,
    /// Most sweeps; `None` for the method's own limit.
    pub max_sweeps: Option<usize>,
    /// θ of `picard`; `None` to find one.
    pub relaxation: Option<f64>,
}

/// The sweeps on the root.
pub struct Sweeps<'a, 'c> {
    interface: &'a Interface,
    s_con: &'a mut SCon<'c>,
    state: ConState,
    settings: SweepSettings,
    progress: Progress,
    /// The factor of S_0, where the method inverts it.
    s_0: Option<BoundaryLastCholesky>,
    began: Instant,
    /// What earlier runs took (s).
    earlier: f64,
    observer: &'a mut dyn FnMut(&SweepRecord),
}

/// r(U) = F − S_0 U − S_CON(U).
#[derive(Clone, Debug)]
struct Residual {
    r: Vec<f64>,
    relative: f64,
    totals: ConTotals,
}

/// What a sweep leads to.
enum Next {
    /// More sweeps, of this method or another one.
    Sweep(Memory, Residual),
    /// The end.
    End(SweepStatus),
}

/// What sweeps are asked for between two of them.
pub trait Pause {
    /// Sees what has been found so far; tells whether the sweeps stop here and are to go on in
    /// another run. On the root; `s_con` reaches the other ranks.
    fn pause(&mut self, progress: &Progress, state: &ConState, s_con: &mut SCon<'_>) -> bool;
}

impl<'a, 'c> Sweeps<'a, 'c> {
    /// Solves S_0 U + S_CON(U) = F, (14), from the bilateral start, or from where a run before had
    /// come. On the root, while the other ranks serve S_CON; `observer` sees every sweep. `None`
    /// where `pause` stops them.
    pub fn solve(
        interface: &'a Interface,
        s_con: &'a mut SCon<'c>,
        settings: SweepSettings,
        earlier: Option<(Progress, ConState)>,
        pause: &mut dyn Pause,
        observer: &'a mut dyn FnMut(&SweepRecord),
    ) -> Option<SweepOutcome> {
        let goes_on = earlier.is_some();
        let (progress, state) = earlier.unwrap_or_else(|| {
            let start = Progress::new(interface.bilateral_start(), settings.method);
            (start, ConState::default())
        });
        let mut sweeps = Self {
            interface,
            s_con,
            state,
            settings,
            s_0: None,
            began: Instant::now(),
            earlier: progress.records.last().map_or(0.0, |last| last.seconds),
            progress,
            observer,
        };
        let residual = match goes_on {
            true => sweeps.unbalanced(sweeps.progress.totals),
            false => {
                let residual = sweeps.residual(None);
                sweeps.record(&residual);
                residual
            }
        };
        let status = sweeps.sweep(residual, pause)?;
        if status == SweepStatus::Converged {
            sweeps.refine();
        }
        // The pairs keep the approaches and forces of their last evaluation: it has to be S_CON(U).
        let last = sweeps.residual(None);
        Some(sweeps.progress.outcome(status, last.relative))
    }

    /// Sweeps until that ends; `None` where `pause` stops it.
    fn sweep(&mut self, mut residual: Residual, pause: &mut dyn Pause) -> Option<SweepStatus> {
        while !self.is_converged(&residual) {
            if pause.pause(&self.progress, &self.state, self.s_con) {
                return None;
            }
            let next = match std::mem::take(&mut self.progress.memory) {
                Memory::Newton(memory) => self.newton(memory, residual),
                Memory::Anderson(memory) => self.anderson(memory, residual),
                Memory::Picard(memory) => self.picard(memory, residual),
            };
            match next {
                Next::Sweep(memory, after) => {
                    self.progress.memory = memory;
                    residual = after;
                }
                Next::End(status) => return Some(status),
            }
        }
        Some(SweepStatus::Converged)
    }

    /// r(U), where the pairs' approaches are `expected` to be open; else as they were last.
    fn residual(&mut self, expected: Option<&[Vec<bool>]>) -> Residual {
        let u = &self.progress.u;
        let totals = (self.s_con).evaluate(self.interface, u, expected, &mut self.state);
        self.progress.count(&totals, self.s_con.len());
        self.unbalanced(totals)
    }

    /// r(U) with the answers that the pairs have given.
    fn unbalanced(&self, totals: ConTotals) -> Residual {
        let (mut r, mut scale) = self.interface.linear_residual(&self.progress.u);
        self.state.subtract(self.interface, &mut r, &mut scale);
        let (r_max, scale_max) = (maximum(&r), maximum(&scale));
        Residual {
            r,
            relative: if r_max == 0.0 { 0.0 } else { r_max / scale_max },
            totals,
        }
    }

    fn record(&mut self, residual: &Residual) {
        let record = SweepRecord {
            sweep: self.progress.records.len(),
            residual: residual.relative,
            active: residual.totals.active,
            changed: residual.totals.changed,
            seconds: self.earlier + self.began.elapsed().as_secs_f64(),
        };
        self.progress.records.push(record);
        (self.observer)(&record);
    }

    /// Whether the residual is small and the active set settled, or the residual is round-off: S_CON
    /// is evaluated exactly, so that then nothing is left that could change.
    fn is_converged(&self, residual: &Residual) -> bool {
        let small = residual.relative <= self.tolerance() && residual.totals.changed == 0;
        residual.totals.failed_pairs == 0 && (small || residual.relative <= ROUND_OFF)
    }

    /// Residual at which the sweeps end.
    fn tolerance(&self) -> f64 {
        match self.progress.has_fallen_back {
            true => self.settings.tolerance.min(FALL_BACK_TOLERANCE),
            false => self.settings.tolerance,
        }
    }

    fn sweeps_done(&self) -> usize {
        self.progress.records.len() - 1
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

/// ‖x‖∞; not a number where x has one.
fn maximum(x: &[f64]) -> f64 {
    x.iter().fold(
        0.0,
        |m: f64, x| {
            if x.is_nan() { f64::NAN } else { m.max(x.abs()) }
        },
    )
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// y ← y + a x.
fn axpy(a: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}
