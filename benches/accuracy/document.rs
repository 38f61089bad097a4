//! docs/accuracy.md: what was measured, and what follows from it.

use std::fmt::Write as _;

use crate::Measurements;
use crate::conclusions::{Conclusions, MOVED, RATIO};
use crate::reached::GOAL;
use crate::series::SCENES;
use crate::timed::Timed;
use crate::tolerance::{Asked, METHODS, TOLERANCES};

const HEAD: &str = "\
# Run time against error

`scripts/accuracy` measures how long which error takes and writes this page, figures and sentences
included; `scripts/accuracy --quick` runs every mesh once and writes nothing here.

";

const HOW: &str = "\
## How it is measured

- **Scenes**: the cylinder on a plane and the manufactured solution of [validation.md](validation.md), on
  the same meshes. Hertz's pressure ends like a root: graded meshes have their finest cells there and at
  the surface. The chosen solution of Signorini's problem is smooth, so that there is nothing to grade
  towards; its cells are irregular, squares for `quad8`.
- **Energy** is the error of the stress in the norm of the energy, **pressure** that of p₀ for Hertz and
  the largest one, over the largest pressure, for Signorini's problem. **Contact** is the number of cells
  between the end of the contact and the last closed node for Hertz, and of nodes that are wrongly open
  or closed, more than a cell from that end, for Signorini's problem.
- **Time** is the report's total: all phases, from the problem file to the result file, stresses and
  certificate included; the launcher and `contact-dd-partition`, which chooses the number of subdomains,
  are not. One thread a rank. *Solve* is the part from `assemble` to `recover` on one rank; the rest is
  reading and writing.
- Where an error is reached between two meshes, dofs and times are interpolated by straight lines between
  logarithms.

";

/// The whole document.
pub fn document(all: &Measurements, conclusions: &Conclusions, faults: &[String]) -> String {
    let mut text = HEAD.to_owned();
    text += &conclusions.text();
    if !faults.is_empty() {
        let _ = writeln!(text, "Not kept:\n\n- {}\n", faults.join("\n- "));
    }
    text += "![Error in the energy over run time](figures/accuracy.svg)\n\n";
    text += HOW;
    let _ = writeln!(
        text,
        "{}. Medians of {} runs.\n",
        all.machine, all.repetitions
    );
    text += &at_goal(conclusions);
    text += &tolerances(all, conclusions);
    text += &meshes(&all.timed);
    text
}

fn at_goal(conclusions: &Conclusions) -> String {
    let mut text = format!(
        "## Time at an error of {} %\n\n\
         *Of linear*: the time over that of linear cells of the same shape on meshes of the same kind. \
         ≤: the coarsest mesh has a smaller error already.\n",
        100.0 * GOAL
    );
    for scene in SCENES {
        let _ = write!(
            text,
            "\n| {scene} | dofs | ms, 1 rank | of linear | solve | of linear | ms, 2 ranks | of linear |\n\
             |---|--:|--:|--:|--:|--:|--:|--:|\n"
        );
        for place in conclusions.places.iter().filter(|p| p.scene == scene) {
            let _ = write!(text, "| {}, {} |", place.element, place.mesh);
            let Some(reached) = place.reached else {
                text += " never | | | | | | |\n";
                continue;
            };
            let sign = if reached.is_coarsest { "≤ " } else { "" };
            let _ = write!(text, " {sign}{:.0} |", reached.dofs);
            for (i, seconds) in reached.seconds.into_iter().enumerate() {
                let _ = write!(text, " {sign}{:.1} |", 1e3 * seconds);
                let _ = match conclusions.of_linear(place) {
                    Some(ratios) => write!(text, " {:.3} |", ratios[i]),
                    None => write!(text, " |"),
                };
            }
            text.push('\n');
        }
    }
    let _ = writeln!(
        text,
        "\nHas to hold: the solve phases of quadratic cells take at most {RATIO} of those of linear ones of \
         the same shape. Whole runs of a few hundred dofs are mostly opening and creating files.\n"
    );
    text
}

fn tolerances(all: &Measurements, conclusions: &Conclusions) -> String {
    let mut text = format!(
        "## The tolerance of the sweeps\n\n\
         Sweeps end where the largest entry of the interface problem's residual, relative to the largest \
         sum of the absolute values of the terms of an entry, is below `--tolerance` and no contact changes. \
         Then up to three steps of Newton's refine the answer to round-off, whatever the method; \
         problems of more than 6000 contact conditions have to do without. Both are looked at here, on {} \
         meshes in 8 subdomains.\n\n\
         **Without the refinement**: `anderson`, stopped where it would end. *Moved*: the change of the \
         error in the energy, over that error.\n\n\
         | residual at most | largest change | meshes moved by more than {} % |\n|--:|--:|--:|\n",
        all.tried.len(),
        100.0 * MOVED,
    );
    for row in &conclusions.stopped {
        let _ = writeln!(
            text,
            "| {:.0e} | {} | {} of {} |",
            row.residual,
            shown(row.largest),
            row.moved,
            row.meshes
        );
    }
    text += "\n![Change of the error over the residual at the end](figures/accuracy-tolerance.svg)\n\n\
             **As a user runs it**, refinement included; times are sums over all meshes that converged, one \
             run each.\n\n\
             | method | tolerance | not converged | sweeps, median | most | sweeps, s | whole run, s | \
             largest change |\n|---|--:|--:|--:|--:|--:|--:|--:|\n";
    for method in METHODS {
        for tolerance in TOLERANCES {
            let runs = || {
                (all.tried.iter())
                    .filter_map(move |tried| Some((tried, tried.run(method, tolerance)?)))
            };
            let (good, bad): (Vec<_>, Vec<_>) = runs().partition(|(_, run)| run.converged);
            let mut sweeps: Vec<u64> = good.iter().map(|(_, run)| run.sweeps).collect();
            sweeps.sort_unstable();
            let of = |i: usize| sweeps.get(i).map_or(String::new(), u64::to_string);
            let sum = |of: fn(&Asked) -> f64| good.iter().map(|(_, run)| of(run)).sum::<f64>();
            let change = good.iter().map(|(tried, run)| tried.shift(run.error));
            let _ = writeln!(
                text,
                "| {method} | {tolerance:.0e} | {} of {} | {} | {} | {:.2} | {:.2} | {} |",
                bad.len(),
                all.tried.len(),
                of(sweeps.len() / 2),
                of(sweeps.len().saturating_sub(1)),
                sum(|run| run.seconds[0]),
                sum(|run| run.seconds[1]),
                shown(change.fold(0.0, f64::max)),
            );
        }
    }
    text += &without_picard(all);
    text
}

/// Why `picard` doesn't converge everywhere.
fn without_picard(all: &Measurements) -> String {
    let runs = (all.tried.iter()).filter_map(|tried| tried.run("picard", all.default_tolerance));
    let ended = runs.filter(|run| !run.converged).map(|run| run.sweeps);
    let (undefined, slow): (Vec<u64>, Vec<u64>) = ended.partition(|&sweeps| sweeps == 0);
    format!(
        "\n`picard` needs a regular S_0. On {} meshes, where nothing but contact holds the body in one \
         direction, S_0 is singular, and it ends before its first sweep; on {} it gives up after {} \
         sweeps, at the default tolerance.\n\n",
        undefined.len(),
        slow.len(),
        slow.iter().max().copied().unwrap_or_default(),
    )
}

fn meshes(timed: &[Timed]) -> String {
    let mut text = "## All meshes\n\n`newton`, tolerance as by default.\n".to_owned();
    for scene in SCENES {
        let _ = write!(
            text,
            "\n| {scene} | dofs | subdomains | energy | pressure | contact | sweeps | ms, 1 rank | \
             solve | ms, 2 ranks |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n"
        );
        for mesh in timed.iter().filter(|mesh| mesh.scene == scene) {
            let [energy, pressure, extent] = mesh.errors;
            let _ = writeln!(
                text,
                "| {}, {} | {} | {} | {} | {} | {:.0} | {} | {:.1} | {:.1} | {:.1} |",
                mesh.element,
                mesh.mesh,
                mesh.dofs,
                mesh.subdomains,
                shown(energy),
                shown(pressure),
                extent,
                mesh.sweeps,
                1e3 * mesh.total(1),
                1e3 * mesh.solve(),
                1e3 * mesh.total(2),
            );
        }
    }
    text
}

/// A figure of two digits.
pub fn shown(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        _ => format!("{value:.1e}"),
    }
}
