//! Outcome of the sweeps: U, the reason for stopping, and the convergence history.

use crate::certificate::Certificate;
use crate::contact::friction::Status;
use crate::interface::s_con::ConTotals;
use serde::{Deserialize, Serialize};

/// Largest relative residual of equilibrium, and penetration, of an accepted solution.
const NOT_BALANCED: f64 = 1e-14;
/// Relative residual of equilibrium that may be round-off in a scene without load.
const ROUND_OFF_OF_TERMS: f64 = 1e-12;
/// Ratio of loads to the forces on nodes above which these aren't round-off of a scene without load.
const LOADED: f64 = 1e-2;
/// Ratio of displacements to the causes of motion above which forces aren't round-off of a scene without load.
const LARGE_DISPLACEMENT: f64 = 1e3;
/// Violation of the friction law above which there is no solution.
pub const AGAINST_FRICTION: f64 = 1e-9;
/// Slip of sticking points, over the largest displacement, above which there is no solution; like penetration it is an
/// error of displacements, which round-off of forces doesn't explain.
const STICKING_SLIP: f64 = 1e-13;
/// Tension, or product of force and gap, above which there is no solution.
const AGAINST_CONTACT: f64 = 1e-11;
/// Residual of equilibrium relative to the load above which the result is meaningless.
const NOT_BALANCED_OF_LOAD: f64 = 1e-3;

/// Residual of equilibrium relative to the load above which the result is meaningless if the unbalanced part may be a
/// body with a free motion.
const NOT_BALANCED_OF_MOTION: f64 = 1e-2;

/// Most contact points that are named.
const MOST_NAMES: usize = 5;

/// One line of the convergence history; line 0 is the bilateral start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRecord {
    /// Number of the sweep.
    pub sweep: usize,
    /// ‖r‖∞ relative to the terms that r is a sum of.
    pub residual: f64,
    /// Number of closed contact constraints.
    pub active: usize,
    /// Number of constraints that opened or closed in this sweep; the start has none.
    pub changed: Option<usize>,
    /// Time since the sweeps began (s).
    pub seconds: f64,
}

/// Reason why sweeps ended.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum SweepStatus {
    /// The residual is below the tolerance, and the active set doesn't change any more.
    Converged,
    /// The sweeps ended before convergence, for this reason.
    NotConverged(String),
}

/// Iterations of an iterative interface solver.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct IterativeSolves {
    /// Iterations of the start and of every sweep.
    pub iterations: Vec<usize>,
    /// Number of coarse unknowns at the end.
    pub coarse_dofs: usize,
}

/// Outcome of the sweeps.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SweepOutcome {
    /// U.
    pub u: Vec<f64>,
    /// Reason why they ended.
    pub status: SweepStatus,
    /// True if refinement may remove the residual: no status changes any more, or only those of friction cycle.
    pub is_settled: bool,
    /// History.
    pub records: Vec<SweepRecord>,
    /// Warnings.
    pub notes: Vec<String>,
    /// Linear systems solved in contact problems, of single pairs and of the coupled problem.
    pub active_set_iterations: usize,
    /// Number of evaluations of pairs, and of those skipped because nothing had changed.
    pub evaluations: [usize; 2],
    /// Fallback methods that were used, as text.
    pub fallbacks: Vec<String>,
    /// The final residual.
    pub residual: f64,
    /// Totals of the last evaluation of S_CON.
    pub totals: ConTotals,
    /// The statuses of every pair at the end.
    pub statuses: Vec<Vec<Status>>,
    /// Iterations of the iterative interface solver, if it was used.
    pub iterative: Option<IterativeSolves>,
    /// Number of increments of the load step.
    pub increments: usize,
    /// True if another solution with friction was found; `None` if none was sought.
    pub other_solution: Option<bool>,
    /// True if a body slides without end: contact forces satisfy their laws, and along an unrestrained motion loads do
    /// more work than these forces absorb.
    pub slides: bool,
    /// Solver that didn't converge before this one took over, and the reason, as text.
    pub took_over: Option<String>,
    /// The constraints of every pair with cycling status, if friction prevents convergence.
    pub unsettled: Vec<Vec<usize>>,
}

impl SweepOutcome {
    /// Outcome at U before the first sweep.
    pub fn before(u: Vec<f64>) -> Self {
        Self {
            u,
            status: SweepStatus::NotConverged("the sweeps haven't ended".into()),
            is_settled: false,
            records: Vec::new(),
            notes: Vec::new(),
            active_set_iterations: 0,
            evaluations: [0; 2],
            fallbacks: Vec::new(),
            residual: f64::INFINITY,
            totals: ConTotals::default(),
            statuses: Vec::new(),
            iterative: None,
            increments: 1,
            other_solution: None,
            slides: false,
            took_over: None,
            unsettled: Vec::new(),
        }
    }

    /// Counts an evaluation of `pairs` pairs.
    pub(super) fn count(&mut self, totals: &ConTotals, pairs: usize) {
        self.totals = *totals;
        self.active_set_iterations += totals.steps;
        self.evaluations[0] += pairs - totals.unmoved_pairs;
        self.evaluations[1] += totals.unmoved_pairs;
        if totals.fallen_back_pairs > 0 {
            self.fell_back(
                "pairs: active set taken from an interior-point or dual active-set method, or from Lemke's path",
            );
        }
    }

    /// Records that a fallback method was used.
    pub(super) fn fell_back(&mut self, what: &str) {
        if !self.fallbacks.iter().any(|known| known == what) {
            self.fallbacks.push(what.into());
        }
    }

    /// Adds the names of contact points that prevent convergence, the worst first.
    pub fn name_points(&mut self, names: &[String]) {
        if let (SweepStatus::NotConverged(why), false) = (&mut self.status, names.is_empty()) {
            let (shown, more) = names.split_at(names.len().min(MOST_NAMES));
            let more = match more.len() {
                0 => String::new(),
                n => format!(" and {n} more"),
            };
            why.push_str(&format!(", at {}{more}", shown.join(", ")));
        }
    }

    /// Records that another solver didn't converge in the same load step, for this reason.
    pub fn take_over(&mut self, why: String) {
        self.notes.push(why.clone());
        self.fell_back(&why);
        self.took_over = Some(why);
    }

    /// Records that a load step took several increments.
    pub fn count_increments(&mut self, increments: usize) {
        self.increments = increments;
        self.notes.push(format!(
            "a load step with friction didn't converge at once: split into {increments} increments; slip status is that \
             of the last"
        ));
    }

    /// Corrects the status of the sweeps by the certificate of the full discrete problem, which alone includes the
    /// refined solution. The sweeps' residual is relative to terms that may be far larger than the load, and without
    /// progress it may be round-off, which refinement has removed. Results that aren't all `finite` are rejected.
    pub fn accept(&mut self, certificate: &Certificate, finite: bool) {
        let fault = fault_of(certificate, finite);
        let keeps_signs = certificate.tension.max(certificate.complementarity) <= AGAINST_CONTACT;
        self.status = match (self.status.clone(), fault) {
            (SweepStatus::Converged, Some(why)) => SweepStatus::NotConverged(why),
            (SweepStatus::NotConverged(why), None) if self.is_settled && keeps_signs => {
                self.fell_back(&format!("{why}; refinement found the solution"));
                SweepStatus::Converged
            }
            (as_it_is, _) => as_it_is,
        };
    }
}

/// The reason why the result with a `certificate` isn't a solution; `None` if it is one, to round-off.
fn fault_of(certificate: &Certificate, finite: bool) -> Option<String> {
    let Certificate {
        equilibrium,
        equilibrium_of_load,
        load_share,
        farther,
        penetration,
        friction,
        drift,
        is_driven,
        ..
    } = *certificate;
    if friction > AGAINST_FRICTION || drift > STICKING_SLIP {
        return Some(format!(
            "contacts break the law of friction by {friction:.1e} of the largest force or displacement"
        ));
    }
    let not_round_off =
        equilibrium > ROUND_OFF_OF_TERMS || load_share > LOADED || farther > LARGE_DISPLACEMENT;
    let unbalanced =
        equilibrium > NOT_BALANCED || (not_round_off && equilibrium_of_load > NOT_BALANCED_OF_LOAD);
    if unbalanced || is_driven || penetration > NOT_BALANCED || !certificate.is_a_number() {
        let moves = match is_driven || equilibrium_of_load > NOT_BALANCED_OF_MOTION {
            true => ", or a body slides or separates without limit",
            false => "",
        };
        return Some(format!(
            "the forces on the nodes are balanced to {equilibrium:.1e} of their terms and \
             {equilibrium_of_load:.1e} of the largest load, and contacts penetrate by \
             {penetration:.1e} of the largest displacement: the scene is too badly conditioned{moves}"
        ));
    }
    (!finite).then(|| {
        "some displacements, stresses, forces or energies aren't finite: loads or stiffnesses are too large or too small, \
         or a body moves without limit"
            .into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn status(certificate: &Certificate, finite: bool) -> SweepStatus {
        let mut outcome = SweepOutcome {
            status: SweepStatus::Converged,
            ..SweepOutcome::before(Vec::new())
        };
        outcome.accept(certificate, finite);
        outcome.status
    }

    fn certificate(
        [equilibrium, equilibrium_of_load, load_share, penetration]: [f64; 4],
    ) -> Certificate {
        Certificate {
            equilibrium,
            equilibrium_of_load,
            load_share,
            penetration,
            ..Certificate::default()
        }
    }

    #[test]
    fn an_answer_that_does_not_balance_is_not_accepted() {
        for good in [
            [3e-16, 1e-13, 0.9, 1e-16],
            // A stiffness ratio of 1e8.
            [2e-15, 3e-6, 0.9, 1e-16],
            // A scene without load, where reactions are round-off.
            [1e-16, 0.8, 0.0, 0.0],
        ] {
            let certificate = certificate(good);
            assert_eq!(
                status(&certificate, true),
                SweepStatus::Converged,
                "{good:?}"
            );
            assert_ne!(
                status(&certificate, false),
                SweepStatus::Converged,
                "{good:?}"
            );
        }
        for bad in [
            [1e-9, 1e-8, 0.9, 0.0],
            [4e-11, 0.8, 0.0, 0.0],
            [1e-16, 0.08, 0.3, 0.0],
            [1e-16, 1e-13, 0.9, 1e-9],
            // The certificate of a random scene with grossly wrong displacements.
            [7.9e-14, 1e-9, 0.9, 0.0],
            [6e-12, 9e-5, 0.5, 0.0],
            [f64::NAN, 0.0, 0.9, 0.0],
        ] {
            assert_ne!(
                status(&certificate(bad), true),
                SweepStatus::Converged,
                "{bad:?}"
            );
        }
    }

    #[test]
    fn points_that_stick_stay_where_they_are_more_exactly_than_forces_keep_their_bounds() {
        let friction = 7e-10;
        for (drift, accepted) in [(1e-16, true), (3e-11, false)] {
            let certificate = Certificate {
                friction,
                drift,
                ..Certificate::default()
            };
            let status = status(&certificate, true);
            assert_eq!(status == SweepStatus::Converged, accepted, "{drift:e}");
        }
    }

    #[test]
    fn what_went_farther_than_anything_moved_it_is_no_scene_without_load() {
        let round_off = certificate([1e-16, 1.0, 1e-230, 0.0]);
        for (farther, accepted) in [(1.0, true), (300.0, true), (1e7, false), (1e245, false)] {
            let went = Certificate {
                farther,
                ..round_off
            };
            let status = status(&went, true);
            assert_eq!(status == SweepStatus::Converged, accepted, "{farther:e}");
        }
        let no_number = Certificate {
            force_balance: f64::NAN,
            ..Certificate::default()
        };
        assert_ne!(status(&no_number, true), SweepStatus::Converged);
    }
}
