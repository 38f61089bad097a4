//! What sweeps remember from one to the next.

use super::method::{Memory, Method};
use super::outcome::{SweepOutcome, SweepRecord, SweepStatus};
use crate::interface::s_con::ConTotals;

/// How far sweeps have come: all that the next one depends on beside the pairs' answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// U.
    pub u: Vec<f64>,
    /// History.
    pub records: Vec<SweepRecord>,
    pub(super) memory: Memory,
    /// Whether another method took over from newton: then nothing may refine afterwards.
    pub(super) has_fallen_back: bool,
    pub(super) totals: ConTotals,
    pub(super) notes: Vec<String>,
    pub(super) active_set_iterations: usize,
    evaluations: [usize; 2],
    fallbacks: Vec<String>,
}

impl Progress {
    /// Before the first sweep.
    pub(super) fn new(u: Vec<f64>, method: Method) -> Self {
        Self {
            u,
            records: Vec::new(),
            memory: Memory::before(method),
            has_fallen_back: false,
            totals: ConTotals::default(),
            notes: Vec::new(),
            active_set_iterations: 0,
            evaluations: [0; 2],
            fallbacks: Vec::new(),
        }
    }

    /// Counts an evaluation of `pairs` pairs.
    pub(super) fn count(&mut self, totals: &ConTotals, pairs: usize) {
        self.totals = *totals;
        self.active_set_iterations += totals.steps;
        self.evaluations[0] += pairs - totals.unmoved_pairs;
        self.evaluations[1] += totals.unmoved_pairs;
        if totals.fallen_back_pairs > 0 {
            self.fell_back("pairs: the interior-point method named the closed contacts");
        }
    }

    /// Remembers that another method had to help.
    pub(super) fn fell_back(&mut self, what: &str) {
        if !self.fallbacks.iter().any(|known| known == what) {
            self.fallbacks.push(what.into());
        }
    }

    pub(super) fn outcome(
        self,
        status: SweepStatus,
        residual: f64,
        open: Vec<Vec<bool>>,
    ) -> SweepOutcome {
        SweepOutcome {
            u: self.u,
            status,
            records: self.records,
            notes: self.notes,
            active_set_iterations: self.active_set_iterations,
            evaluations: self.evaluations,
            fallbacks: self.fallbacks,
            residual,
            totals: self.totals,
            open,
        }
    }
}
