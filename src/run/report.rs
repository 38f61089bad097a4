//! What a run says of itself: on the terminal, in the report, in the result file.

use std::collections::BTreeSet;
use std::io::stdout;

use contact_dd_partition::model::PlaneState;
use contact_dd_partition::problem::Catalog;

use super::totals::{StepTotals, Totals};
use crate::checkpoint::Checkpoint;
use crate::comm::{self, Comm, Message};
use crate::error::Failure;
use crate::interface::operator::Interface;
use crate::output::build::Build;
use crate::output::memory::peak_memory_bytes;
use crate::output::report::{PhaseSeconds, RankReport, Report, ReportFile};
use crate::output::result::ConvergenceRow;
use crate::output::resultants::Resultants;
use crate::output::terminal::{self, Summary, SweepLine};
use crate::output::vtkhdf::ResultFile;
use crate::plan::Plan;
use crate::plan::demand::Demand;
use crate::rigid::survey::Survey;
use crate::settings::Settings;
use crate::sweep::{SweepRecord, SweepStatus};

/// Pivot relative to its diagonal entry that may as well be zero.
const SUSPICIOUS_PIVOT: f64 = 1e-13;

/// Condition number from which round-off is worth a warning.
const BAD_CONDITION: f64 = 1e10;

/// Prints on the root what a user wants to follow, and nothing elsewhere.
pub struct Narrator<'a> {
    comm: &'a Comm,
    settings: &'a Settings,
}

/// The files of a run, still under temporary names. On the root.
#[derive(Debug)]
pub struct Outputs {
    /// The results.
    pub result: ResultFile,
    /// The report, where one is asked for.
    pub report: Option<ReportFile>,
}

impl<'a> Narrator<'a> {
    /// Speaks on the root unless `settings` ask for quiet.
    pub fn new(comm: &'a Comm, settings: &'a Settings) -> Self {
        Self { comm, settings }
    }

    fn speaks(&self) -> bool {
        self.comm.is_root() && !self.settings.quiet
    }

    /// What is to be solved, and how.
    pub fn problem(&self, catalog: &Catalog, plan: &Plan) {
        if !self.speaks() {
            return;
        }
        let summary = Summary {
            problem: &self.settings.problem,
            title: &catalog.title,
            dofs: dofs(catalog),
            interface_dofs: catalog.dim * plan.sharing.iter().filter(|&&n| n > 1).count(),
            subdomains: catalog.subdomains.len(),
            contact_pairs: plan.pairs.len(),
            contact_conditions: conditions(catalog),
            ranks: self.comm.size(),
            threads: usize::from(self.settings.threads),
        };
        // A closed pipe is no reason to stop a run that writes its results to a file.
        let _ = terminal::summary(&mut stdout(), &summary);
        if !self.settings.check {
            let _ = terminal::settings(&mut stdout(), &self.settings.in_words());
        }
    }

    /// What validating found, and what solving would cost.
    pub fn check(&self, surveys: &[Survey], demands: &[Demand], available: f64) {
        let all = surveys.iter().flat_map(|survey| &survey.motions.warnings);
        let warnings: BTreeSet<&String> = all.collect();
        if self.comm.is_root() {
            for warning in warnings {
                eprintln!("warning: {warning}");
            }
        }
        if self.speaks() {
            let _ = terminal::demands(&mut stdout(), demands, available);
            println!("\nthe problem file is valid");
        }
    }

    /// Which load step comes, where there are any.
    pub fn step(&self, catalog: &Catalog, k: usize) {
        if let Some(step) = catalog.steps.get(k).filter(|_| self.speaks()) {
            let _ = terminal::step(&mut stdout(), step, k, catalog.steps.len());
        }
    }

    /// The head of the table of sweeps, if there are going to be any, and those of an `earlier` run.
    pub fn sweeps(&self, interface: &Interface, earlier: Option<&Checkpoint>) {
        if self.speaks() && !interface.pair_traces.is_empty() {
            let _ = terminal::sweep_header(&mut stdout());
        }
        let earlier = earlier.map(|checkpoint| &checkpoint.progress.records[..]);
        for record in earlier.unwrap_or_default() {
            self.sweep(interface, record);
        }
    }

    /// One sweep.
    pub fn sweep(&self, interface: &Interface, record: &SweepRecord) {
        if self.speaks() && !interface.pair_traces.is_empty() {
            let line = SweepLine {
                sweep: record.sweep,
                residual: record.residual,
                active: record.active,
                changed: (record.sweep > 0).then_some(record.changed),
                seconds: record.seconds,
            };
            let _ = terminal::sweep(&mut stdout(), &line);
        }
    }

    /// Finishes the result file and writes the report. On the root.
    ///
    /// # Errors
    /// One of them can't be written.
    pub fn finish(&self, totals: &Totals<'_>, outputs: Outputs) -> Result<(), Failure> {
        let Outputs {
            result: mut file,
            report: report_file,
        } = outputs;
        let report = report(totals, self.settings, self.comm);
        let sweeps = (totals.steps.iter().enumerate())
            .flat_map(|(k, step)| step.outcome.records.iter().map(move |r| (k, r)));
        let rows: Vec<ConvergenceRow> = sweeps
            .map(|(step, r)| ConvergenceRow {
                step,
                residual: r.residual,
                active: r.active,
                seconds: r.seconds,
            })
            .collect();
        file.write_convergence(&rows)?;
        file.finish(&report.to_json())?;
        if let Some(file) = report_file {
            file.write(&report)?;
        }
        if self.speaks() {
            let reason = reason(totals);
            let result = self.settings.result_path();
            let _ = terminal::closing(&mut stdout(), &reason, &report, &result);
        } else {
            for warning in &report.warnings {
                eprintln!("warning: {warning}");
            }
        }
        for why in failures(totals) {
            eprintln!("error: not converged: {why}");
        }
        Ok(())
    }
}

/// Brings every rank's times and memory to the root. Collective.
pub fn collect(
    comm: &Comm,
    seconds: &PhaseSeconds,
    plan: &Plan,
    repeated: usize,
) -> Vec<RankReport> {
    let owned = plan
        .blocks
        .iter()
        .filter(|b| b.owner == comm.rank())
        .map(|b| b.subdomains.len() as i64)
        .sum();
    let mut message = Message {
        integers: vec![
            peak_memory_bytes() as i64,
            comm.bytes_sent() as i64,
            owned,
            repeated as i64,
        ],
        reals: vec![seconds.total],
    };
    message
        .reals
        .extend(seconds.phases().iter().map(|(_, s)| s));
    comm.collect(message)
        .into_iter()
        .map(|message| {
            let mut reader = message.read();
            RankReport {
                peak_memory_bytes: reader.integer() as u64,
                bytes_sent: reader.integer() as u64,
                subdomains: reader.count(),
                repeated: reader.count(),
                seconds: PhaseSeconds {
                    total: reader.real(),
                    read: reader.real(),
                    assemble: reader.real(),
                    factorize: reader.real(),
                    interface: reader.real(),
                    sweeps: reader.real(),
                    recover: reader.real(),
                    write: reader.real(),
                },
            }
        })
        .collect()
}

fn report(totals: &Totals<'_>, settings: &Settings, comm: &Comm) -> Report {
    let Totals { catalog, plan, .. } = totals;
    let seconds: Vec<PhaseSeconds> = totals.ranks.iter().map(|r| r.seconds).collect();
    let mut warnings = catalog.warnings.clone();
    warnings.extend(unknown_stress(catalog));
    warnings.extend(totals.warnings.iter().cloned());
    warnings.extend(totals.step_warnings());
    let certificate = totals.certificate();
    let condition = totals.condition();
    if certificate.equilibrium > 1e-14 || certificate.penetration > 1e-14 {
        warnings.push(format!(
            "the certificate falls short of 1e-14: equilibrium {:.1e}, penetration {:.1e}",
            certificate.equilibrium, certificate.penetration
        ));
    }
    if certificate.equilibrium_of_load > 1e-6 {
        warnings.push(format!(
            "the forces on the nodes are balanced to {:.1e} of the largest load only: the scene is \
             badly conditioned, and stresses and contact forces are no better than that",
            certificate.equilibrium_of_load
        ));
    }
    if let Some(condition) = condition.filter(|&c| c > BAD_CONDITION) {
        warnings.push(format!(
            "the condition number is about {condition:.0e}: round-off alone makes an error of about \
             {:.0e} in the softest part's displacement",
            condition * f64::EPSILON
        ));
    }
    if totals.smallest_pivot < SUSPICIOUS_PIVOT {
        warnings.push(format!(
            "the smallest pivot is {:.1e} of its diagonal entry: the scene is so badly conditioned \
             that it may be a mechanism, and its displacement may be meaningless",
            totals.smallest_pivot
        ));
    }
    let last = totals.last();
    let sum = |of: fn(&StepTotals) -> usize| totals.steps.iter().map(of).sum();
    Report {
        status: totals.status(),
        method: settings.method.name().into(),
        sweeps: sum(StepTotals::sweeps),
        inner_steps: sum(|step| step.outcome.inner_steps),
        fallbacks: totals.fallbacks(),
        interface_residual: (totals.steps.iter())
            .fold(0.0, |worst: f64, step| worst.max(step.outcome.residual)),
        dofs: dofs(catalog),
        interface_dofs: totals.interface_dofs,
        contact_conditions: conditions(catalog),
        active_contacts: last.map_or(0, |step| step.active),
        subdomains: catalog.subdomains.len(),
        contact_pairs: plan.pairs.len(),
        ranks: comm.size(),
        hosts: comm.hosts(),
        threads: usize::from(settings.threads),
        certificate,
        condition,
        seconds: PhaseSeconds::slowest(&seconds),
        peak_memory_bytes: totals.ranks.iter().map(|r| r.peak_memory_bytes).sum(),
        per_rank: totals.ranks.clone(),
        error_estimate: last.and_then(StepTotals::error_estimate),
        resultants: last.map_or_else(Resultants::default, |step| step.resultants.clone()),
        steps: totals.step_reports(),
        skipped: skipped(totals),
        warnings,
        settings: settings.resolved(),
        version: env!("CARGO_PKG_VERSION").into(),
        build: Build::of_this_program(comm::library()),
    }
}

/// A warning for every material whose σ_zz isn't known.
fn unknown_stress(catalog: &Catalog) -> Vec<String> {
    catalog
        .materials
        .iter()
        .filter(|m| catalog.plane == PlaneState::Strain && m.out_of_plane.is_none())
        .map(|m| {
            format!(
                "material '{}' has no out_of_plane stiffness: its stress ZZ is reported as 0",
                m.name
            )
        })
        .collect()
}

/// What the scene didn't need.
fn skipped(totals: &Totals<'_>) -> Vec<String> {
    let mut skipped = Vec::new();
    if totals.plan.pairs.is_empty() {
        skipped.push("sweeps: no contact, the interface problem is linear".into());
    }
    if totals.interface_dofs == 0 {
        skipped.push("interface solve: no subdomain shares a node with another".into());
    }
    let idle = totals.ranks.iter().filter(|r| r.subdomains == 0).count();
    if idle > 0 {
        skipped.push(format!(
            "ranks without work: {idle} of {}, there are more ranks than blocks",
            totals.ranks.len()
        ));
    }
    let repeated: usize = totals.ranks.iter().map(|r| r.repeated).sum();
    if repeated > 0 {
        skipped.push(format!(
            "factorizations: {repeated} of {}, equal to others of the same rank",
            totals.plan.blocks.len()
        ));
    }
    let evaluations = totals.steps.iter().map(|step| step.outcome.evaluations);
    let [made, unmade] = evaluations.fold([0; 2], |[a, b], [made, unmade]| [a + made, b + unmade]);
    if unmade > 0 {
        skipped.push(format!(
            "updates of pairs: {unmade} of {}, their traces hadn't changed",
            made + unmade
        ));
    }
    if totals.steps.iter().any(|step| step.estimate.is_none()) {
        skipped.push("stresses: left out by --no-stress".into());
    }
    skipped
}

fn reason(totals: &Totals<'_>) -> String {
    let sweeps: usize = totals.steps.iter().map(StepTotals::sweeps).sum();
    let in_the_end = match totals.catalog.steps.is_empty() {
        true => "",
        false => " in the end",
    };
    match failures(totals).first() {
        Some(why) => format!("not converged: {why}"),
        None if totals.plan.pairs.is_empty() => "solved: the scene is linear".into(),
        None => format!(
            "converged after {sweeps} sweeps: the residual is below the tolerance and no contact \
             changes any more; {} of {} conditions are closed{in_the_end}",
            totals.last().map_or(0, |step| step.active),
            conditions(totals.catalog)
        ),
    }
}

/// Why load steps didn't converge.
fn failures(totals: &Totals<'_>) -> Vec<String> {
    let of_step = |(k, step): (usize, &StepTotals)| {
        let SweepStatus::NotConverged(why) = &step.outcome.status else {
            return None;
        };
        Some(match totals.catalog.steps.get(k) {
            Some(step) => format!("step '{}': {why}", step.name),
            None => why.clone(),
        })
    };
    totals
        .steps
        .iter()
        .enumerate()
        .filter_map(of_step)
        .collect()
}

/// Number of dofs, those of shared nodes counted once.
fn dofs(catalog: &Catalog) -> usize {
    let nodes: usize = catalog.subdomains.iter().map(|s| s.nodes).sum();
    let copies: usize = catalog.interface.iter().map(Vec::len).sum();
    catalog.dim * (nodes - copies + catalog.interface_nodes)
}

fn conditions(catalog: &Catalog) -> usize {
    catalog.contacts.iter().map(|c| c.conditions).sum()
}
