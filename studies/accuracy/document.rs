//! docs/accuracy.md: what was measured, and what follows from it.

use std::fmt::Write as _;

use super::Measurements;
use super::conclusions::{Conclusions, MOVED, RATIO};
use super::reached::GOAL;
use super::series::SCENES;
use super::tolerance::{Asked, METHODS};

const HEAD: &str = "\
# Run time against error

Which cells reach an error of 1 % in the least time, and which tolerance the sweeps need. Measured and written
by `scripts/accuracy`. [Adaptive refinement](adapting.md) finds the cells by itself. How far the
stated errors of quantities can be trusted is on [another page](trust.md#the-stated-error-of-a-quantity).

";

const HOW: &str = "\
The sections that follow are for developers of the solver.

## How it is measured

- **Scenes**: Hertz's cylinder on a plane and the manufactured solution of Signorini's problem, on the meshes
  of [validation.md](validation.md). The error is that of the stress in the energy norm.
- **Time** is the report's total, from the problem file to the result file, with one thread a rank; the
  launcher and `contact-dd-partition` aren't counted. *Solve* is `assemble` to `recover` on one rank.
- Between two meshes, dofs and times are interpolated linearly in their logarithms.

";

/// The tolerances that the page shows; all are in the figure's data.
const SHOWN: [f64; 3] = [1e-2, 1e-10, 1e-14];

/// The whole document.
pub fn document(all: &Measurements, conclusions: &Conclusions, faults: &[String]) -> String {
    let mut text = format!(
        "{HEAD}{}: {}. Medians of {} runs.\n\n",
        crate::measured(),
        all.machine,
        all.repetitions
    );
    text += &conclusions.text();
    if !faults.is_empty() {
        let _ = writeln!(text, "Not kept:\n\n- {}\n", faults.join("\n- "));
    }
    text += "![Error in the energy over run time](figures/accuracy.svg)\n\n";
    text += HOW;
    text += &at_goal(conclusions);
    text += &tolerances(all, conclusions);
    text
}

fn at_goal(conclusions: &Conclusions) -> String {
    let mut text = format!(
        "## Time at an error of {} %\n\n\
         *Of linear*: the time over that of linear cells of the same shape on the same kind of mesh.\n",
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
        "\nGate: the solve phases of quadratic cells take at most {RATIO} of those of linear ones of the same \
         shape.\n"
    );
    text
}

fn tolerances(all: &Measurements, conclusions: &Conclusions) -> String {
    let mut text = format!(
        "## The tolerance of the sweeps\n\n\
         Sweeps stop when the residual of the interface problem, relative to its terms, is below `--tolerance` \
         and no contact changes. Up to three Newton steps then refine the solution to round-off. Both on {} meshes in 8 \
         subdomains.\n\n\
         **Without refinement** (`anderson`): relative change of the error in the energy.\n\n\
         | residual | largest change | changed by more than {} % |\n|--:|--:|--:|\n",
        all.tried.len(),
        100.0 * MOVED,
    );
    for row in conclusions.stopped.iter().step_by(2) {
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
             **With refinement**; times are sums over the meshes that converged.\n\n\
             | method | tolerance | not converged | sweeps, median | most | sweeps, s | whole run, s | \
             largest change |\n|---|--:|--:|--:|--:|--:|--:|--:|\n";
    for method in METHODS {
        for tolerance in SHOWN {
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
    let ended: Vec<u64> = ended.collect();
    format!(
        "\nWhere only contact supports the body in one direction, S_0 is singular: `picard` adds 5 % of the pairs' stiffness \
         to it. On {} meshes it doesn't converge in {} sweeps.\n",
        ended.len(),
        ended.iter().max().copied().unwrap_or_default(),
    )
}

/// A figure of two digits.
pub fn shown(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        _ => format!("{value:.1e}"),
    }
}
