//! Output of a run: the log while it runs, and the report.

pub mod log;
pub mod totals;

use contact_dd_partition::model::PlaneState;
use contact_dd_partition::problem::Catalog;

use crate::comm::ranks::{PhaseSeconds, RankReport, RankSeconds};
use crate::comm::{self, Comm};
use crate::fem::resultants::Resultants;
use crate::output::report::{Build, ContactOperator, Report, Status};
use crate::plan::Plan;
use crate::plan::cluster::Merging;
use crate::plan::memory::peak_memory_bytes;
use crate::report::totals::{StepTotals, Totals};
use crate::settings::Settings;
use crate::settings::command_line::InterfaceMethod;
use crate::sweep::{Method, SweepStatus};

/// Pivot, relative to its diagonal entry, below which it may be zero.
const SUSPICIOUS_PIVOT: f64 = 1e-13;

/// Condition number above which a warning of round-off is given.
const BAD_CONDITION: f64 = 1e10;

/// Collects every rank's times and memory on the root. Collective.
pub fn collect(comm: &Comm, seconds: &RankSeconds, plan: &Plan) -> Vec<RankReport> {
    let owners = plan.owners();
    let subdomains = owners.iter().filter(|&&owner| owner == comm.rank()).count();
    let sent = (
        comm.bytes_sent(),
        comm.messages_sent(),
        comm.longest_chain(),
    );
    let mine = (*seconds, peak_memory_bytes(), sent, subdomains);
    let all = comm.collect(&mine).into_iter();
    all.map(
        |(seconds, peak_memory_bytes, sent, subdomains)| RankReport {
            seconds: seconds.elapsed,
            work: seconds.work,
            modelled: seconds.modelled,
            peak_memory_bytes,
            bytes_sent: sent.0,
            messages_sent: sent.1,
            longest_chain: sent.2,
            subdomains,
        },
    )
    .collect()
}

/// Makes the report. On the root.
pub fn report(totals: &Totals<'_>, settings: &Settings, comm: &Comm) -> Report {
    let Totals { catalog, plan, .. } = totals;
    let seconds: Vec<PhaseSeconds> = totals.ranks.iter().map(|r| r.seconds).collect();
    let (certificate, condition) = (totals.certificate(), totals.condition());
    let last = totals.last();
    let sum = |of: fn(&StepTotals) -> usize| totals.steps.iter().map(of).sum();
    Report {
        status: totals.status(),
        method: settings.method.name().into(),
        sweeps: sum(StepTotals::sweeps),
        active_set_iterations: sum(|step| step.outcome.active_set_iterations),
        linear_solves: sum(|step| step.linear_solves),
        fallbacks: totals.fallbacks(),
        interface_residual: (totals.steps.iter())
            .fold(0.0, |worst: f64, step| worst.max(step.outcome.residual)),
        interface_solver: totals.interface_solver(),
        interface_choice: totals.took_over().unwrap_or(totals.why).into(),
        contact_operator: contact_operator(plan),
        interface_iterations: (totals.steps.iter())
            .flat_map(|step| step.interface_iterations().iter().copied())
            .collect(),
        coarse_dofs: last.map_or(0, |step| step.coarse_dofs()),
        dofs: catalog.dofs(),
        interface_dofs: catalog.dim * catalog.interface_nodes,
        contact_conditions: catalog.conditions(),
        active_contacts: last.map_or(0, |step| step.active),
        subdomains: catalog.subdomains.len(),
        contact_pairs: plan.contact_groups(),
        ranks: comm.size(),
        hosts: comm.hosts(),
        threads: usize::from(settings.threads),
        certificate,
        condition_number: condition,
        seconds: PhaseSeconds::slowest(&seconds),
        peak_memory_bytes: totals.ranks.iter().map(|r| r.peak_memory_bytes).sum(),
        per_rank: totals.ranks.clone(),
        error_estimate: last.and_then(StepTotals::error_estimate),
        resultants: last.map_or_else(Resultants::default, |step| step.resultants.clone()),
        friction: totals.friction(),
        steps: totals.step_reports(),
        skipped: skipped(comm, totals),
        warnings: warnings(totals, settings),
        settings: settings.clone(),
        settings_from: settings.from.clone(),
        version: env!("CARGO_PKG_VERSION").into(),
        build: Build::of_this_program(comm::library()),
    }
}

/// The warnings of a run.
fn warnings(totals: &Totals<'_>, settings: &Settings) -> Vec<String> {
    let mut warnings = totals.catalog.warnings.clone();
    warnings.extend(unknown_stress(totals.catalog));
    warnings.extend(totals.warnings.iter().cloned());
    warnings.extend(totals.step_warnings());
    warnings.extend(solved_directly(totals, settings));
    warnings.extend(advice_on_solver(totals, settings));
    let certificate = totals.certificate();
    let condition = totals.condition();
    if certificate.equilibrium > 1e-14 || certificate.penetration > 1e-14 {
        warnings.push(format!(
            "the certificate falls short of 1e-14: equilibrium {:.1e}, penetration {:.1e}",
            certificate.equilibrium, certificate.penetration
        ));
    }
    if certificate.equilibrium_of_load > 1e-6 {
        let why = match totals.status() {
            Status::Converged => "the scene is badly conditioned",
            Status::NotConverged => "the sweeps haven't converged",
        };
        warnings.push(format!(
            "the forces on the nodes are balanced to {:.1e} of the largest load only: {why}, and stresses and contact \
             forces are no more accurate",
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
    warnings
}

/// The operator with which contact constraints were solved in the last stage.
fn contact_operator(plan: &Plan) -> ContactOperator {
    match plan.merging {
        Merging::All | Merging::Linear | Merging::Groups => ContactOperator::Dense,
        Merging::Clusters if !plan.has_one_cluster() => ContactOperator::Bddc,
        Merging::ActiveSet | Merging::Clusters => ContactOperator::Tree,
    }
}

/// Advice where the iterative solver didn't converge.
fn advice_on_solver(totals: &Totals<'_>, settings: &Settings) -> Option<String> {
    let is_iterative = totals.interface_solver() == InterfaceMethod::Iterative;
    let is_direct = !is_iterative || totals.took_over().is_some();
    if is_direct || totals.status() == Status::Converged {
        return None;
    }
    if settings.interface.is_none() {
        let why = "the iterative interface solver was chosen because it takes less time; --interface direct is more robust";
        return Some(why.into());
    }
    let why = "--interface direct finds more solutions with friction than --interface iterative";
    totals.catalog.has_friction().then(|| why.into())
}

/// Reason why the interface problem was solved directly although the iterative solver was requested.
fn solved_directly(totals: &Totals<'_>, settings: &Settings) -> Option<String> {
    let is_asked_for = settings.interface == Some(InterfaceMethod::Iterative);
    if !is_asked_for
        || totals.took_over().is_some()
        || totals.interface_solver() == InterfaceMethod::Iterative
    {
        return None;
    }
    let why = if settings.method != Method::Newton {
        "it goes with --method newton"
    } else if totals.catalog.has_friction() && settings.second_start {
        "--second-start solves for all conditions at once"
    } else {
        "the problem file has one cluster"
    };
    Some(format!(
        "--interface iterative: {why}; the interface problem was solved directly"
    ))
}

/// A warning for every material whose σ_zz is unknown.
fn unknown_stress(catalog: &Catalog) -> Vec<String> {
    catalog
        .materials
        .iter()
        .filter(|m| catalog.plane == Some(PlaneState::Strain) && m.out_of_plane.is_none())
        .map(|m| {
            format!(
                "material '{}' has no out_of_plane stiffness: its stress ZZ is reported as 0",
                m.name
            )
        })
        .collect()
}

/// The parts of a run that the scene didn't need.
fn skipped(comm: &Comm, totals: &Totals<'_>) -> Vec<String> {
    let mut skipped = Vec::new();
    if !comm.has_mpi() {
        skipped.push("MPI: not started, as there is one rank".into());
    }
    if totals.plan.contact_groups() == 0 {
        skipped.push("sweeps: no contact, the interface problem is linear".into());
    }
    if totals.catalog.interface_nodes == 0 {
        skipped.push("interface solve: no subdomain shares a node with another".into());
    }
    let idle = totals.ranks.iter().filter(|r| r.subdomains == 0).count();
    if idle > 0 {
        skipped.push(format!(
            "ranks without work: {idle} of {}, there are more ranks than blocks",
            totals.ranks.len()
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

/// Reason why the sweeps ended, as text.
pub fn reason(totals: &Totals<'_>) -> String {
    let sweeps: usize = totals.steps.iter().map(StepTotals::sweeps).sum();
    let in_the_end = match totals.catalog.steps.is_empty() {
        true => "",
        false => " in the end",
    };
    match failures(totals).first() {
        Some(why) => format!("not converged: {why}"),
        None if totals.plan.contact_groups() == 0 => "solved: the scene is linear".into(),
        None => format!(
            "converged after {sweeps} sweep{}: the residual is below the tolerance and no contact \
             changes any more; {} of {} conditions are closed{in_the_end}",
            if sweeps == 1 { "" } else { "s" },
            totals.last().map_or(0, |step| step.active),
            totals.catalog.conditions()
        ),
    }
}

/// Reasons why load steps didn't converge.
pub fn failures(totals: &Totals<'_>) -> Vec<String> {
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
