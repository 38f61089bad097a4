//! Sweeps: how U is found on Γ, started from the bilateral problem (16)-(17).
//!
//! All methods share the residual r(U) = F − S_0 U − S_CON(U) and differ in what is inverted:
//! M δ = r with M = S_0 ([`picard`], the paper's (18)), S_0 + S_CON' of the bilateral problem
//! ([`anderson`]), or S_0 + S_CON(U + ·) as it is, the contact conditions included ([`newton`]).

pub mod anderson;
pub mod newton;
pub mod picard;

use std::time::Instant;

use crate::contact::s_con::{ConState, ConTotals, SCon};
use crate::interface::operator::Interface;
use crate::output::report::Certificate;

/// Residual that is round-off and nothing else.
const ROUND_OFF: f64 = 1e-15;

/// Equilibrium and penetration of a certificate that isn't one.
const NOT_BALANCED: f64 = 1e-10;
/// Equilibrium that may be round-off of a scene without load.
const ROUND_OFF_OF_TERMS: f64 = 1e-12;
/// Equilibrium relative to the load of an answer that says nothing.
const NOT_BALANCED_OF_LOAD: f64 = 1e-2;

/// How U is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Newton: S_0 + S_CON is inverted, contact conditions included.
    Newton,
    /// Accelerated chord: S_0 + S_CON' of the bilateral problem is inverted.
    Anderson,
    /// The paper's successive approximations (18): S_0 is inverted.
    Picard,
}

impl Method {
    /// Its name on the command line and in the report.
    pub fn name(self) -> &'static str {
        match self {
            Self::Newton => "newton",
            Self::Anderson => "anderson",
            Self::Picard => "picard",
        }
    }
}

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

/// One line of the convergence history; line 0 is the bilateral start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepRecord {
    /// Number of the sweep.
    pub sweep: usize,
    /// ‖r‖∞ relative to the terms that r is a sum of.
    pub residual: f64,
    /// Closed conditions.
    pub active: usize,
    /// Conditions that opened or closed in it.
    pub changed: usize,
    /// Since the sweeps began (s).
    pub seconds: f64,
}

/// Why sweeps ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SweepStatus {
    /// The residual is below the tolerance and no contact changes any more.
    Converged,
    /// They stopped short of that, for this reason.
    NotConverged(String),
}

/// What the sweeps found.
#[derive(Clone, Debug)]
pub struct SweepOutcome {
    /// U.
    pub u: Vec<f64>,
    /// Why they ended.
    pub status: SweepStatus,
    /// History.
    pub records: Vec<SweepRecord>,
    /// What a user should know.
    pub notes: Vec<String>,
    /// Linear systems solved in contact problems, those of single pairs and the coupled one.
    pub inner_steps: usize,
    /// Evaluations of pairs, and how many more weren't made because nothing had changed.
    pub evaluations: [usize; 2],
    /// Which other methods had to help, in words.
    pub fallbacks: Vec<String>,
    /// The residual that is left in the end.
    pub residual: f64,
    /// Totals of the last evaluation of S_CON.
    pub totals: ConTotals,
}

impl SweepOutcome {
    /// Takes back that the sweeps converged if the full discrete problem says otherwise: their
    /// residual is relative to terms that may be far larger than the load.
    pub fn accept(&mut self, certificate: &Certificate) {
        let Certificate {
            equilibrium,
            equilibrium_of_load,
            penetration,
            ..
        } = *certificate;
        let unbalanced = equilibrium > NOT_BALANCED
            || (equilibrium > ROUND_OFF_OF_TERMS && equilibrium_of_load > NOT_BALANCED_OF_LOAD);
        let failed = unbalanced || penetration > NOT_BALANCED || equilibrium.is_nan();
        if failed && self.status == SweepStatus::Converged {
            self.status = SweepStatus::NotConverged(format!(
                "the forces on the nodes are balanced to {equilibrium:.1e} of their terms and \
                 {equilibrium_of_load:.1e} of the largest load, and contacts penetrate by \
                 {penetration:.1e} of the largest displacement: the scene is too badly conditioned"
            ));
        }
    }
}

/// The state of the sweeps on the root.
pub struct Sweeps<'a, 'c> {
    interface: &'a Interface,
    s_con: &'a mut SCon<'c>,
    state: ConState,
    settings: SweepSettings,
    began: Instant,
    records: Vec<SweepRecord>,
    notes: Vec<String>,
    inner_steps: usize,
    evaluations: [usize; 2],
    fallbacks: Vec<String>,
    observer: &'a mut dyn FnMut(&SweepRecord),
}

/// r(U) = F − S_0 U − S_CON(U).
#[derive(Clone, Debug)]
struct Residual {
    r: Vec<f64>,
    relative: f64,
    totals: ConTotals,
}

impl<'a, 'c> Sweeps<'a, 'c> {
    /// Solves S_0 U + S_CON(U) = F, (14), from the bilateral start. On the root, while the other
    /// ranks serve S_CON; `observer` sees every sweep.
    pub fn solve(
        interface: &'a Interface,
        s_con: &'a mut SCon<'c>,
        settings: SweepSettings,
        observer: &'a mut dyn FnMut(&SweepRecord),
    ) -> SweepOutcome {
        let mut sweeps = Self {
            interface,
            s_con,
            state: ConState::default(),
            settings,
            began: Instant::now(),
            records: Vec::new(),
            notes: Vec::new(),
            inner_steps: 0,
            evaluations: [0; 2],
            fallbacks: Vec::new(),
            observer,
        };
        let mut u = interface.bilateral_start();
        let residual = sweeps.residual(&u, None);
        sweeps.record(&residual);
        let status = match settings.method {
            Method::Newton => sweeps.newton(&mut u, residual),
            Method::Anderson => sweeps.anderson(&mut u, residual),
            Method::Picard => sweeps.picard(&mut u, residual),
        };
        if status == SweepStatus::Converged {
            sweeps.refine(&mut u);
        }
        // The pairs keep the approaches and forces of their last evaluation: it has to be S_CON(U).
        let last = sweeps.residual(&u, None);
        SweepOutcome {
            u,
            status,
            records: sweeps.records,
            notes: sweeps.notes,
            inner_steps: sweeps.inner_steps,
            evaluations: sweeps.evaluations,
            fallbacks: sweeps.fallbacks,
            residual: last.relative,
            totals: last.totals,
        }
    }

    /// r(U), where the pairs' approaches are `expected` to be open; else as they were last.
    fn residual(&mut self, u: &[f64], expected: Option<&[Vec<bool>]>) -> Residual {
        let totals = (self.s_con).evaluate(self.interface, u, expected, &mut self.state);
        self.inner_steps += totals.steps;
        self.evaluations[0] += self.s_con.len() - totals.unmoved_pairs;
        self.evaluations[1] += totals.unmoved_pairs;
        if totals.fallen_back_pairs > 0 {
            self.fell_back("pairs: the interior-point method named the closed contacts");
        }
        let (mut r, mut scale) = self.interface.linear_residual(u);
        self.state.subtract(self.interface, &mut r, &mut scale);
        let (r_max, scale_max) = (maximum(&r), maximum(&scale));
        Residual {
            r,
            relative: if r_max == 0.0 { 0.0 } else { r_max / scale_max },
            totals,
        }
    }

    /// Remembers that another method had to help.
    fn fell_back(&mut self, what: &str) {
        if !self.fallbacks.iter().any(|known| known == what) {
            self.fallbacks.push(what.into());
        }
    }

    fn record(&mut self, residual: &Residual) {
        let record = SweepRecord {
            sweep: self.records.len(),
            residual: residual.relative,
            active: residual.totals.active,
            changed: residual.totals.changed,
            seconds: self.began.elapsed().as_secs_f64(),
        };
        self.records.push(record);
        (self.observer)(&record);
    }

    /// Whether the residual is small and the active set settled, or the residual is round-off: S_CON
    /// is evaluated exactly, so that then nothing is left that could change.
    fn is_converged(&self, residual: &Residual) -> bool {
        let small = residual.relative <= self.settings.tolerance && residual.totals.changed == 0;
        residual.totals.failed_pairs == 0 && (small || residual.relative <= ROUND_OFF)
    }

    fn sweeps_done(&self) -> usize {
        self.records.len() - 1
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

#[cfg(test)]
mod tests {
    use super::*;

    fn status(equilibrium: f64, equilibrium_of_load: f64, penetration: f64) -> SweepStatus {
        let mut outcome = SweepOutcome {
            u: Vec::new(),
            status: SweepStatus::Converged,
            records: Vec::new(),
            notes: Vec::new(),
            inner_steps: 0,
            evaluations: [0; 2],
            fallbacks: Vec::new(),
            residual: 0.0,
            totals: ConTotals::default(),
        };
        outcome.accept(&Certificate {
            equilibrium,
            equilibrium_of_load,
            penetration,
            ..Certificate::default()
        });
        outcome.status
    }

    #[test]
    fn an_answer_that_does_not_balance_is_not_accepted() {
        assert_eq!(status(3e-16, 1e-13, 1e-16), SweepStatus::Converged);
        // A stiffness ratio of 1e8, and a scene without load.
        assert_eq!(status(2e-15, 3e-6, 1e-16), SweepStatus::Converged);
        assert_eq!(status(1e-16, 0.8, 0.0), SweepStatus::Converged);
        for bad in [
            (1e-9, 1e-8, 0.0),
            (4e-11, 0.8, 0.0),
            (1e-16, 1e-13, 1e-9),
            (f64::NAN, 0.0, 0.0),
        ] {
            assert_ne!(status(bad.0, bad.1, bad.2), SweepStatus::Converged);
        }
    }
}
