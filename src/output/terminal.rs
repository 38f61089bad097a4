//! Text of the root rank: plain lines of fixed columns, the same on a terminal and in a log.
//!
//! The caller decides whether they are printed, and whether in colour.

mod resultants;
mod timing;

use std::fmt::Display;

use anstyle::{AnsiColor, Style};
use contact_dd_partition::message::{ERROR, WARNING};
use contact_dd_partition::model::PlaneState;
use contact_dd_partition::scene::units::Units;

use super::bar::in_words;
use super::event::{Costs, Event, Finished, Step, Summary};
use super::report::{FrictionOfStep, Status, StepReport};
use crate::certificate::Certificate;
use crate::sweep::SweepRecord;

/// Number of absent bodies and contacts up to which all are named.
const NAMED: usize = 6;
/// Remaining time of a run above which it is printed (s).
const LONG: f64 = 10.0;
/// Text for sweeps that converged.
const CONVERGED: Style = AnsiColor::Green.on_default();

/// The head of the table of sweeps.
pub const SWEEP_HEADER: &str = "\nsweep    residual    active   changed     seconds";

/// The text of an event, without the last line's end; `None` for events that aren't printed here.
pub fn text(event: &Event<'_>) -> Option<String> {
    Some(match event {
        Event::Problem(of) => summary(of),
        Event::Settings { settings, .. } => {
            let words = settings.in_words();
            let entries = words
                .iter()
                .map(|(name, value)| format!("\n{}", entry(name, value)));
            entries.collect()
        }
        Event::Step(of) => step(of),
        Event::Sweep(record) => sweep(record),
        Event::Check(of) => costs(of),
        Event::Finished(of) => closing(of),
        Event::Phase { .. }
        | Event::Progress { .. }
        | Event::Warning { .. }
        | Event::Error { .. } => return None,
    })
}

/// The cost of a solution, in total and for the largest rank.
fn costs(of: &Costs) -> String {
    let giga = |number: f64| number / 1e9;
    let coarse = of.coarse_dofs.map_or_else(String::new, |dofs| {
        format!("\n  coarse       {dofs} dofs between clusters")
    });
    format!(
        "\nsolving it would take about\n  \
         memory       {:.2} GB, {:.2} GB on the largest rank; {:.1} GB are available\n  \
         arithmetic   {:.3} Gflop, {:.3} Gflop on the busiest rank{coarse}\n\n\
         the problem file is valid",
        giga(of.memory_bytes),
        giga(of.largest_rank_memory_bytes),
        giga(of.available_bytes),
        giga(of.flops),
        giga(of.busiest_rank_flops)
    )
}

/// Description of the problem.
fn summary(of: &Summary) -> String {
    let mut lines = vec![format!("contact-dd-mpi {}\n", of.version)];
    if !of.title.is_empty() {
        lines.push(of.title.to_owned());
    }
    let pairs = counted(of.contact_pairs, "pair");
    let contact = match (of.contact_conditions, of.conditions_with_friction) {
        (0, _) => "none".to_owned(),
        (count, 0) => format!("{} in {pairs}", counted(count, "condition")),
        (count, rough) => format!(
            "{} in {pairs}, {rough} with friction",
            counted(count, "condition")
        ),
    };
    let threads = counted(of.threads, "thread");
    lines.extend([
        entry("problem", &of.problem),
        entry(
            "dofs",
            format!(
                "{}, {} of them on the interface",
                of.dofs, of.interface_dofs
            ),
        ),
        entry("subdomains", of.subdomains),
        entry("contact", contact),
        entry("ranks", format!("{} with {threads} each", of.ranks)),
        entry("solved by", of.interface_choice),
    ]);
    lines.join("\n")
}

/// The line of a load step: its name, the absent bodies and contacts, and the remaining time if that is long.
fn step(of: &Step) -> String {
    let absent = &of.absent;
    let first: Vec<String> = absent
        .iter()
        .take(NAMED)
        .map(|name| format!("'{name}'"))
        .collect();
    let without = match absent.len().checked_sub(NAMED) {
        _ if absent.is_empty() => String::new(),
        None | Some(0) => format!(", without {}", first.join(", ")),
        Some(more) => format!(", without {} and {more} more", first.join(", ")),
    };
    let left = match of.seconds_left {
        Some(seconds) if seconds > LONG => format!("; {}", in_words(seconds)),
        _ => String::new(),
    };
    format!(
        "\nstep {} of {}: '{}' at {}{without}{left}",
        of.step, of.steps, of.name, of.time
    )
}

/// A line of the table of sweeps.
fn sweep(line: &SweepRecord) -> String {
    let changed = line.changed.map_or("-".into(), |count| count.to_string());
    format!(
        "{:>5}  {:>10.3e}  {:>8}  {:>8}  {:>10.4}",
        line.sweep, line.residual, line.active, changed, line.seconds
    )
}

/// Everything after the sweeps: why they ended, the certificate, the timing table, skipped parts, warnings, and the
/// names of the result files.
fn closing(of: &Finished) -> String {
    let Finished {
        reason,
        report,
        catalog,
        result,
        ..
    } = of;
    let units = catalog.units;
    // Around an axis forces are those of the whole ring.
    let dim = match catalog.plane {
        Some(PlaneState::Axisymmetric) => 3,
        _ => catalog.dim,
    };
    let style = match report.status {
        Status::Converged => CONVERGED,
        Status::NotConverged => ERROR,
    };
    let mut lines = vec![
        format!("\n{style}{reason}{style:#}\n"),
        certificate(&report.certificate, report.friction.is_some()),
    ];
    let condition = report.condition_number;
    lines.extend(condition.map(|c| format!("             condition number about {c:.0e}")));
    if let Some(estimate) = report.error_estimate {
        let percent = 100.0 * estimate.relative;
        lines.push(format!(
            "mesh         stresses are off by about {percent:.1} % in the energy norm"
        ));
    }
    if let Some(FrictionOfStep { friction, .. }) = report.friction {
        lines.push(format!(
            "friction     {} conditions stick, {} slip; work {:.4e} {}",
            friction.sticking,
            friction.slipping,
            friction.dissipated_work,
            units.work(dim)
        ));
    }
    lines.push(String::new());
    lines.extend(steps(&report.steps, units));
    lines.extend(resultants::lines(&report.resultants, units, dim));
    lines.push(String::new());
    lines.extend(timing::lines(&report.per_rank));
    lines.push(String::new());
    lines.extend(report.skipped.iter().map(|what| format!("skipped: {what}")));
    let fallbacks = report.fallbacks.iter();
    lines.extend(fallbacks.map(|what| format!("fall-back: {what}")));
    let warnings = report.warnings.iter();
    lines.extend(warnings.map(|what| format!("{WARNING}warning:{WARNING:#} {what}")));
    lines.push(format!("results: {result}"));
    lines.join("\n")
}

/// A line for each load step; empty if there is none.
fn steps(steps: &[StepReport], units: Units) -> Vec<String> {
    if steps.is_empty() {
        return Vec::new();
    }
    let has_friction = steps[0].friction.is_some();
    let slipping = if has_friction { "  slipping" } else { "" };
    let pressure = format!("pressure {}", units.stress());
    let head = format!(
        " step        time    sweeps    active{slipping}  {pressure:>12}   equilibrium  name"
    );
    let line = |(k, step): (usize, &StepReport)| {
        let contacts = step.resultants.contacts.iter();
        let pressure = contacts.fold(0.0, |most: f64, contact| most.max(contact.largest_pressure));
        let slipping = step
            .friction
            .map(|sum| format!("  {:>8}", sum.friction.slipping));
        let slipping = slipping.unwrap_or_default();
        format!(
            "{:>5}  {:>10}  {:>8}  {:>8}{slipping}  {pressure:>12.4e}  {:>12.1e}  {}",
            k + 1,
            step.time,
            step.sweeps,
            step.active_contacts,
            step.certificate.equilibrium,
            step.name
        )
    };
    let mut lines = vec![head];
    lines.extend(steps.iter().enumerate().map(line));
    lines.push("\nin the last step:".to_owned());
    lines
}

fn certificate(of: &Certificate, has_friction: bool) -> String {
    let friction = match has_friction {
        true => format!("  friction {:.1e}", of.friction),
        false => String::new(),
    };
    format!(
        "certificate  equilibrium {:.1e} ({:.1e} of the load)  penetration {:.1e}  tension {:.1e}  \
         complementarity {:.1e}{friction}\n             \
         force balance {:.1e}  moment balance {:.1e}  interface jump {:.1e}",
        of.equilibrium,
        of.equilibrium_of_load,
        of.penetration,
        of.tension,
        of.complementarity,
        of.force_balance,
        of.moment_balance,
        of.interface_jump
    )
}

fn entry(name: &str, value: impl Display) -> String {
    format!("  {name:<12} {value}")
}

fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let header = ends(SWEEP_HEADER.trim_start());
        for (sweep_number, residual, active, changed) in [
            (0, 1.0, 48, None),
            (12, 3.2e-117, 1_234_567, Some(7)),
            (99_999, f64::NAN, 0, Some(12_345_678)),
        ] {
            let line = sweep(&SweepRecord {
                sweep: sweep_number,
                residual,
                active,
                changed,
                seconds: 1234.56789,
            });
            assert_eq!(ends(&line), header, "{line}");
        }
    }
}
