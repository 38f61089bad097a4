//! The data of the report, gathered on the root: of every load step, and combined.

use contact_dd_partition::problem::Catalog;
use serde::{Deserialize, Serialize};

use crate::certificate::Certificate;
use crate::certificate::energy::EnergyBalance;
use crate::certificate::scales::Scales;
use crate::comm::ranks::RankReport;
use crate::fem::estimate::CellError;
use crate::fem::resultants::{Friction, Resultants};
use crate::output::report::{ErrorEstimate, FrictionOfStep, Status, StepReport};
use crate::plan::Plan;
use crate::settings::command_line::InterfaceMethod;
use crate::sweep::{SweepOutcome, SweepStatus};

/// A whole run.
pub struct Totals<'a> {
    /// The problem.
    pub catalog: &'a Catalog,
    /// The owners of blocks and fronts.
    pub plan: &'a Plan,
    /// Reason for the choice of the operator for contact constraints, as text.
    pub why: &'a str,
    /// Every load step, one where the problem has none.
    pub steps: Vec<StepTotals>,
    /// The smallest pivot of all factorizations relative to its diagonal entry.
    pub smallest_pivot: f64,
    /// Every rank's times.
    pub ranks: Vec<RankReport>,
    /// Warnings from the ranks.
    pub warnings: Vec<String>,
}

/// A load step, or a run without any.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct StepTotals {
    /// The outcome of the sweeps.
    pub outcome: SweepOutcome,
    /// Number of linear problems solved for contact constraints, abandoned attempts included.
    pub linear_solves: usize,
    /// Number of closed constraints.
    pub active: usize,
    /// The certificate.
    pub certificate: Certificate,
    /// The condition number.
    pub condition: Option<f64>,
    /// Resultants of contacts and supports.
    pub resultants: Resultants,
    /// The balance of energy, where there is friction.
    pub energy: EnergyBalance,
    /// The estimate of the mesh's error, where there are stresses.
    pub estimate: Option<CellError>,
    /// True if friction is at its limit: bodies may slide under the same forces.
    pub at_limit: bool,
    /// The scales of its solution, if it converged.
    pub scales: Scales,
    /// Warnings of the load step.
    pub warnings: Vec<String>,
}

impl StepTotals {
    /// The status in which the step ended.
    pub fn status(&self) -> Status {
        match self.outcome.status {
            SweepStatus::Converged => Status::Converged,
            SweepStatus::NotConverged(_) => Status::NotConverged,
        }
    }

    /// The work and state of friction.
    pub fn friction(&self) -> Option<FrictionOfStep> {
        let friction = self.resultants.friction();
        friction.map(|friction| FrictionOfStep {
            friction,
            energy: self.energy,
            at_limit: self.at_limit,
            increments: self.outcome.increments,
            other_solution: self.outcome.other_solution,
        })
    }

    /// Number of sweeps after the start.
    pub fn sweeps(&self) -> usize {
        self.outcome.records.len().saturating_sub(1)
    }

    /// Iterations of an iterative interface solver.
    pub fn interface_iterations(&self) -> &[usize] {
        let iterative = self.outcome.iterative.as_ref();
        iterative.map_or(&[], |solves| &solves.iterations)
    }

    /// Coarse unknowns of an iterative interface solver.
    pub fn coarse_dofs(&self) -> usize {
        let iterative = self.outcome.iterative.as_ref();
        iterative.map_or(0, |solves| solves.coarse_dofs)
    }

    /// The estimate as the report has it.
    pub fn error_estimate(&self) -> Option<ErrorEstimate> {
        self.estimate.map(|estimate| ErrorEstimate {
            relative: estimate.relative(),
            error: estimate.error.sqrt(),
            energy_norm: estimate.energy.sqrt(),
        })
    }
}

impl Totals<'_> {
    /// The last load step, whose state the run ends in.
    pub fn last(&self) -> Option<&StepTotals> {
        self.steps.last()
    }

    /// Status of the run: converged where all load steps did.
    pub fn status(&self) -> Status {
        let mut steps = self.steps.iter();
        match steps.all(|step| step.status() == Status::Converged) {
            true => Status::Converged,
            false => Status::NotConverged,
        }
    }

    /// The worst value of every check over all steps.
    pub fn certificate(&self) -> Certificate {
        let certificates = self.steps.iter().map(|step| step.certificate);
        certificates.fold(Certificate::default(), Certificate::worse)
    }

    /// The largest condition number, where all steps have one.
    pub fn condition(&self) -> Option<f64> {
        let mut conditions = self.steps.iter().map(|step| step.condition);
        conditions.try_fold(0.0, |worst: f64, condition| Some(worst.max(condition?)))
    }

    /// Friction: the state in the end, the work of all steps.
    pub fn friction(&self) -> Option<FrictionOfStep> {
        let steps = self.steps.iter();
        let all = steps.filter_map(StepTotals::friction);
        all.reduce(|before, last| FrictionOfStep {
            friction: Friction {
                dissipated_work: before.friction.dissipated_work + last.friction.dissipated_work,
                ..last.friction
            },
            energy: last.energy.since(before.energy),
            at_limit: before.at_limit || last.at_limit,
            increments: before.increments.max(last.increments),
            other_solution: match before.other_solution {
                Some(true) => before.other_solution,
                _ => last.other_solution,
            },
        })
    }

    /// The solver of the linear interface problem.
    pub fn interface_solver(&self) -> InterfaceMethod {
        match self
            .steps
            .iter()
            .any(|step| step.outcome.iterative.is_some())
        {
            true => InterfaceMethod::Iterative,
            false => InterfaceMethod::Direct,
        }
    }

    /// The solver of the interface problem that didn't converge and was replaced, with the reason, as text.
    pub fn took_over(&self) -> Option<&str> {
        (self.steps.iter()).find_map(|step| step.outcome.took_over.as_deref())
    }

    /// Fallbacks that were used, as text.
    pub fn fallbacks(&self) -> Vec<String> {
        let all = self.steps.iter().flat_map(|step| &step.outcome.fallbacks);
        once_each(all.cloned())
    }

    /// The warnings of all steps, with the step where not all of several have it.
    pub fn step_warnings(&self) -> Vec<String> {
        let named = self.steps.iter().enumerate().flat_map(|(k, step)| {
            step.warnings.iter().map(move |warning| {
                let everywhere = self.steps.iter().all(|s| s.warnings.contains(warning));
                match self.catalog.steps.get(k) {
                    Some(step) if !everywhere => format!("step '{}': {warning}", step.name),
                    _ => warning.clone(),
                }
            })
        });
        once_each(named)
    }

    /// The load steps as the report has them; none where the problem has none.
    pub fn step_reports(&self) -> Vec<StepReport> {
        let steps = self.catalog.steps.iter().zip(&self.steps);
        steps
            .enumerate()
            .map(|(k, (step, totals))| StepReport {
                name: step.name.clone(),
                time: step.time,
                absent: self.catalog.absent_in(k),
                status: totals.status(),
                sweeps: totals.sweeps(),
                active_set_iterations: totals.outcome.active_set_iterations,
                linear_solves: totals.linear_solves,
                interface_residual: totals.outcome.residual,
                interface_iterations: totals.interface_iterations().to_vec(),
                active_contacts: totals.active,
                certificate: totals.certificate,
                condition_number: totals.condition,
                error_estimate: totals.error_estimate(),
                resultants: totals.resultants.clone(),
                friction: totals.friction(),
            })
            .collect()
    }
}

fn once_each(words: impl Iterator<Item = String>) -> Vec<String> {
    let mut kept: Vec<String> = Vec::new();
    for word in words {
        if !kept.contains(&word) {
            kept.push(word);
        }
    }
    kept
}
