//! What the root rank prints: plain lines of fixed columns, the same on a terminal and in a log.
//!
//! Every function writes whole lines to `out`; whether to print at all, and whether to show colours, is
//! the caller's business.

mod resultants;
mod timing;

use std::io::{Result, Write};
use std::path::Path;

use anstyle::{AnsiColor, Style};
use contact_dd_partition::message::{ERROR, WARNING};
use contact_dd_partition::problem::LoadStep;
use serde::Serialize;

use super::report::{Report, Status, StepReport};
use crate::certificate::Certificate;
use crate::plan::cost::CostEstimate;
use crate::sweep::SweepRecord;

/// How the reason is shown for which sweeps ended well.
const CONVERGED: Style = AnsiColor::Green.on_default();

/// What is to be solved, and on what.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary<'a> {
    /// Version of the program.
    pub version: &'static str,
    /// The problem file.
    pub problem: String,
    /// Title of the scene.
    pub title: &'a str,
    /// Number of degrees of freedom.
    pub dofs: usize,
    /// Number of those on Γ.
    pub interface_dofs: usize,
    /// Number of subdomains.
    pub subdomains: usize,
    /// Number of pairs, or groups, in contact.
    pub contact_pairs: usize,
    /// Number of contact conditions.
    pub contact_conditions: usize,
    /// Number of ranks.
    pub ranks: usize,
    /// Number of threads of each rank.
    pub threads: usize,
}

/// Prints what solving would cost `all` ranks together and one of them at `most`, against the memory that is
/// `available` on the hosts together (bytes).
///
/// # Errors
/// `out` can't be written.
pub fn costs(
    out: &mut dyn Write,
    all: CostEstimate,
    most: CostEstimate,
    available: f64,
) -> Result<()> {
    writeln!(out, "\nsolving it would take about")?;
    writeln!(
        out,
        "  memory       {:.2} GB, {:.2} GB on the largest rank; {:.1} GB are available",
        all.bytes / 1e9,
        most.bytes / 1e9,
        available / 1e9
    )?;
    writeln!(
        out,
        "  arithmetic   {:.3} Gflop, {:.3} Gflop on the busiest rank",
        all.flops / 1e9,
        most.flops / 1e9
    )
}

/// Prints the problem.
///
/// # Errors
/// `out` can't be written.
pub fn summary(out: &mut dyn Write, summary: &Summary) -> Result<()> {
    let Summary {
        version,
        problem,
        title,
        dofs,
        interface_dofs,
        subdomains,
        contact_pairs,
        contact_conditions,
        ranks,
        threads,
    } = summary;
    writeln!(out, "contact-dd-mpi {version}")?;
    writeln!(out)?;
    if !title.is_empty() {
        writeln!(out, "{title}")?;
    }
    entry(out, "problem", problem)?;
    entry(
        out,
        "dofs",
        format!("{dofs}, {interface_dofs} of them on the interface"),
    )?;
    entry(out, "subdomains", subdomains)?;
    if *contact_conditions == 0 {
        entry(out, "contact", "none")?;
    } else {
        let pairs = counted(*contact_pairs, "pair");
        let conditions = counted(*contact_conditions, "condition");
        entry(out, "contact", format!("{conditions} in {pairs}"))?;
    }
    let threads = counted(*threads, "thread");
    entry(out, "ranks", format!("{ranks} with {threads} each"))
}

/// Prints the settings as they were resolved, by name.
///
/// # Errors
/// `out` can't be written.
pub fn settings(out: &mut dyn Write, settings: &[(&str, String)]) -> Result<()> {
    writeln!(out)?;
    for (name, value) in settings {
        entry(out, name, value)?;
    }
    Ok(())
}

/// Prints which load step comes, number k of `count`.
///
/// # Errors
/// `out` can't be written.
pub fn step(out: &mut dyn Write, step: &LoadStep, k: usize, count: usize) -> Result<()> {
    writeln!(out)?;
    writeln!(
        out,
        "step {} of {count}: '{}' at {}",
        k + 1,
        step.name,
        step.time
    )
}

/// Prints the head of the table of sweeps.
///
/// # Errors
/// `out` can't be written.
pub fn sweep_header(out: &mut dyn Write) -> Result<()> {
    writeln!(out)?;
    writeln!(
        out,
        "{:>5}  {:>10}  {:>8}  {:>8}  {:>10}",
        "sweep", "residual", "active", "changed", "seconds"
    )
}

/// Prints one line of the table of sweeps.
///
/// # Errors
/// `out` can't be written.
pub fn sweep(out: &mut dyn Write, line: &SweepRecord) -> Result<()> {
    let changed = line.changed.map_or("-".into(), |count| count.to_string());
    writeln!(
        out,
        "{:>5}  {:>10.3e}  {:>8}  {:>8}  {:>10.4}",
        line.sweep, line.residual, line.active, changed, line.seconds
    )
}

/// Prints all that follows the sweeps: why they ended (`reason`, in words), the certificate, the
/// timing table, what was skipped, warnings, and where the results are.
///
/// # Errors
/// `out` can't be written.
pub fn closing(out: &mut dyn Write, reason: &str, report: &Report, result: &Path) -> Result<()> {
    let style = match report.status {
        Status::Converged => CONVERGED,
        Status::NotConverged => ERROR,
    };
    writeln!(out)?;
    writeln!(out, "{style}{reason}{style:#}")?;
    writeln!(out)?;
    certificate(out, &report.certificate)?;
    if let Some(condition) = report.condition_number {
        writeln!(out, "             condition number about {condition:.0e}")?;
    }
    if let Some(estimate) = report.error_estimate {
        writeln!(
            out,
            "mesh         stresses are off by about {:.1} % in the energy norm",
            100.0 * estimate.relative
        )?;
    }
    writeln!(out)?;
    steps(out, &report.steps)?;
    resultants::print(out, &report.resultants)?;
    writeln!(out)?;
    timing::print(out, &report.per_rank)?;
    writeln!(out)?;
    for skipped in &report.skipped {
        writeln!(out, "skipped: {skipped}")?;
    }
    for fallback in &report.fallbacks {
        writeln!(out, "fall-back: {fallback}")?;
    }
    for warning in &report.warnings {
        writeln!(out, "{WARNING}warning:{WARNING:#} {warning}")?;
    }
    writeln!(out, "results: {}", result.display())
}

/// Prints a line a load step; nothing where there is none.
fn steps(out: &mut dyn Write, steps: &[StepReport]) -> Result<()> {
    if steps.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "{:>5}  {:>10}  {:>8}  {:>8}  {:>12}  {:>12}  name",
        "step", "time", "sweeps", "active", "pressure", "equilibrium"
    )?;
    for (k, step) in steps.iter().enumerate() {
        let contacts = step.resultants.contacts.iter();
        let pressure = contacts.fold(0.0, |most: f64, contact| most.max(contact.largest_pressure));
        writeln!(
            out,
            "{:>5}  {:>10}  {:>8}  {:>8}  {pressure:>12.4e}  {:>12.1e}  {}",
            k + 1,
            step.time,
            step.sweeps,
            step.active_contacts,
            step.certificate.equilibrium,
            step.name
        )?;
    }
    writeln!(out, "\nin the last step:")
}

/// Prints the certificate.
fn certificate(out: &mut dyn Write, certificate: &Certificate) -> Result<()> {
    let Certificate {
        equilibrium,
        equilibrium_of_load,
        load_share: _,
        penetration,
        tension,
        complementarity,
        force_balance,
        moment_balance,
        interface_jump,
    } = certificate;
    writeln!(
        out,
        "certificate  equilibrium {equilibrium:.1e} ({equilibrium_of_load:.1e} of the load)  \
         penetration {penetration:.1e}  tension {tension:.1e}  complementarity {complementarity:.1e}"
    )?;
    writeln!(
        out,
        "             force balance {force_balance:.1e}  moment balance {moment_balance:.1e}  \
         interface jump {interface_jump:.1e}"
    )
}

fn entry(out: &mut dyn Write, name: &str, value: impl std::fmt::Display) -> Result<()> {
    writeln!(out, "  {name:<12} {value}")
}

fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(print: impl FnOnce(&mut dyn Write) -> Result<()>) -> String {
        let mut out = Vec::new();
        print(&mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn sweeps_stand_in_the_columns_of_their_header() {
        let ends = |line: &str| {
            let mut ends = Vec::new();
            for (i, c) in line.char_indices() {
                let next = line[i + c.len_utf8()..].chars().next().unwrap_or(' ');
                if c != ' ' && next == ' ' {
                    ends.push(i);
                }
            }
            ends
        };
        let header = printed(sweep_header);
        let header = ends(header.trim_end_matches('\n').lines().last().unwrap());
        for (sweep_number, residual, active, changed) in [
            (0, 1.0, 48, None),
            (12, 3.2e-117, 1_234_567, Some(7)),
            (99_999, f64::NAN, 0, Some(12_345_678)),
        ] {
            let line = SweepRecord {
                sweep: sweep_number,
                residual,
                active,
                changed,
                seconds: 1234.56789,
            };
            let line = printed(|out| sweep(out, &line));
            assert_eq!(ends(line.trim_end_matches('\n')), header, "{line}");
        }
    }

    #[test]
    fn one_of_a_thing_is_singular() {
        assert_eq!(counted(1, "pair"), "1 pair");
        assert_eq!(counted(2, "pair"), "2 pairs");
    }
}
