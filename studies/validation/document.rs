//! docs/validation.md: what was compared with what, and how far apart they are.

use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::support::validation::{Case, Family, Gate, Measured};

/// Text before the cases.
const HEAD: &str = "\
# Validation

`scripts/validate` solves scenes with exact answers on successively refined meshes and writes this page.
The tables have the finest mesh of each kind, the curves the first error on all of them: grey of linear cells, red of
quadratic ones, dashed on uniform meshes. *As required* are cases whose errors and orders on the finest meshes are all within
the limits below their verdict, where a range is by the kind of cells; others name what misses its limit. A short form with
the same limits is among the tests.

*Energy* is ‖σ_h − σ‖ over ‖σ‖ in the norm of C⁻¹, with σ_h evaluated independently of the solver from the
displacements of the result file. *Backward error* is the certificate's equilibrium (at most 1e-14). All
figures are relative but for numbers of cells and nodes. *Order* is log₂ of the ratio of the errors on the
last two meshes. Contact pressure is the force of a node over its tributary area. `scripts/sketches` draws the sketches, of
built-in scenes from their results.

";

/// Figures of a case in its line.
const FIRST: usize = 2;

/// Text after the cases.
const TAIL: &str = "\
## Friction, exactly

Among the tests alone, as they need no finer meshes (`tests/scenes/friction`):

- A block on an incline stands and slides 1e-12 below and above the angle of friction; a block that is pushed up a wedge
  of tan α = 0.1 with μ = 0.3 slides from F/G = 0.412371 on, within 1e-12 (NAFEMS CGS-4).
- A joint that sticks is as good as glued: displacements agree to 1e-12 with those of a mesh without it.
- A joint that slips evenly, under uniform pressure and shear, is exact to 1e-10 in all cells and between nodes that
  don't match.
- Over a cycle of load the work from outside is what friction dissipates, to 1e-10.
- Increments of loads to and fro keep the law, and agree to 1e-11 in energy with a monolithic solve with the
  same contact status.
";

/// Built-in scenes that show what a case is, by its title.
const PICTURES: [(&str, &str); 8] = [
    ("Patch test: matching nodes", "patch"),
    ("Junction", "junction"),
    ("Hertz: a cylinder on a plane", "hertz"),
    ("Closed inclined crack", "crack"),
    ("Raous' plate", "raous"),
    (
        "Cattaneo and Mindlin: cylinders pushed to and fro",
        "mindlin",
    ),
    ("Plate with a hole", "plain"),
    ("Ball on a plate", "sphere"),
];

/// The sketch of a case, drawn by `scripts/sketches`, and the picture of a built-in scene that is like it.
fn pictures(title: &str) -> String {
    let sketch = format!(
        "![Bodies, supports, loads and contact](figures/validation/{}.svg)\n\n",
        anchor_of(title)
    );
    let found = PICTURES.iter().find(|(of, _)| *of == title);
    found.map_or(sketch.clone(), |(_, scene)| {
        let folder = format!("../partition/src/example/{scene}");
        format!(
            "{sketch}[![The built-in scene {scene}]({folder}/{scene}.png)]({folder}/README.md)\n\n"
        )
    })
}

/// The curve of a case, drawn by `scripts/validate`; none where all errors are round-off.
fn curve(title: &str, ran: &[Vec<Measured>]) -> String {
    let errors = ran.iter().flatten().map(|mesh| mesh.figures[0].value);
    if errors.fold(0.0, f64::max) <= ROUND_OFF {
        return String::new();
    }
    let anchor = anchor_of(title);
    format!(
        "![The first error over the degrees of freedom](figures/validation/{anchor}-errors.svg)\n\n"
    )
}

/// The anchor of a heading.
fn anchor_of(title: &str) -> String {
    let kept = (title.chars())
        .filter(|c| c.is_alphanumeric() || "-_ ".contains(*c))
        .flat_map(char::to_lowercase);
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// The whole document, of the lines on all cases and their chapters.
pub fn whole(lines: &str, chapters: &str) -> String {
    format!(
        "{HEAD}{}.\n\n## In short\n\nOf each case the kind of cells with the smallest error, on its finest mesh.\n\n\
         | case | cells, dofs | errors | verdict |\n|---|---|---|---|\n{lines}\n{chapters}{TAIL}",
        crate::measured()
    )
}

/// The first figure of a case on all of its meshes, by the kinds of cells.
pub fn errors(case: &Case, ran: &[Vec<Measured>]) -> Value {
    let kinds = case
        .families
        .iter()
        .zip(ran)
        .filter(|(_, all)| !all.is_empty());
    let kinds: Vec<Value> = kinds
        .map(|(family, all)| {
            let dofs: Vec<usize> = all.iter().map(|mesh| mesh.dofs).collect();
            let values: Vec<f64> = all.iter().map(|mesh| mesh.figures[0].value).collect();
            json!({ "cells": family.name, "figure": all[0].figures[0].name, "dofs": dofs, "values": values })
        })
        .collect();
    json!({ "title": case.title, "name": anchor_of(case.title), "kinds": kinds })
}

/// A case in a line: the best of its kinds of cells, its first figures, and whether all gates are kept.
pub fn line(case: &Case, ran: &[Vec<Measured>], faults: &[String]) -> String {
    let finest = (case.families.iter().zip(ran)).filter_map(|(of, all)| Some((of, all.last()?)));
    let first = |mesh: &Measured| mesh.figures[0].value;
    let best = finest.min_by(|(_, a), (_, b)| first(a).total_cmp(&first(b)));
    let Some((family, mesh)) = best else {
        return String::new();
    };
    let figures = mesh.figures.iter().take(FIRST);
    let figures: Vec<String> = figures
        .map(|figure| {
            let limits = limits_of(family, figure.name);
            format!("{} {}{limits}", figure.name, shown(figure.value))
        })
        .collect();
    let kept = verdict(ran, faults);
    let anchor = anchor_of(case.title);
    format!(
        "| [{}](#{anchor}) | {}, {} | {} | {kept} |\n",
        case.title,
        family.name,
        mesh.dofs,
        figures.join(", ")
    )
}

/// Verdict on a case: are its errors and orders what they have to be?
fn verdict(ran: &[Vec<Measured>], faults: &[String]) -> String {
    match faults.len() {
        0 if ran.len() == 2 => "as required, with both kinds of cells".to_owned(),
        0 => format!("as required, with all {} kinds of cells", ran.len()),
        n => format!("{n} not as required"),
    }
}

/// The limits of a figure on cells of a kind, in parentheses; empty if it has none.
fn limits_of(family: &Family, figure: &str) -> String {
    let limit = |gate: &Gate| match *gate {
        Gate::Order(name, least) => {
            (name == figure).then(|| format!("order at least {}", plain(least)))
        }
        Gate::AtMost(name, most) => (name == figure).then(|| format!("at most {}", plain(most))),
    };
    let limits: Vec<String> = family.gates.iter().filter_map(limit).collect();
    match limits.is_empty() {
        true => String::new(),
        false => format!(" ({})", limits.join(", ")),
    }
}

/// All limits of a case, a range where they depend on the kind of cells, with the kinds where not all have one.
fn limits(case: &Case) -> String {
    let mut limits: Vec<(String, Vec<(f64, &str)>)> = Vec::new();
    for family in &case.families {
        for gate in &family.gates {
            let (words, limit) = match *gate {
                Gate::Order(name, least) => (format!("order of {name} at least"), least),
                Gate::AtMost(name, most) => (format!("{name} at most"), most),
            };
            let of_kind = (limit, family.name.as_str());
            match limits.iter_mut().find(|(found, _)| *found == words) {
                Some((_, all)) => all.push(of_kind),
                None => limits.push((words, vec![of_kind])),
            }
        }
    }
    let shown = |(words, all): &(String, Vec<(f64, &str)>)| {
        let least = all.iter().map(|(limit, _)| *limit).fold(f64::MAX, f64::min);
        let most = all.iter().map(|(limit, _)| *limit).fold(f64::MIN, f64::max);
        let mut text = format!("{words} {}", plain(least));
        if least < most {
            let _ = write!(text, " to {}", plain(most));
        }
        if all.len() < case.families.len() {
            let kinds: Vec<&str> = all.iter().map(|(_, kind)| *kind).collect();
            let _ = write!(text, " ({})", kinds.join(" / "));
        }
        text
    };
    limits.iter().map(shown).collect::<Vec<_>>().join("; ")
}

/// A limit, without its allowance for round-off.
fn plain(limit: f64) -> String {
    match limit {
        0.0 => "0".to_owned(),
        _ if limit >= 0.1 => format!("{}", (1e3 * limit).round() / 1e3),
        _ => format!("{limit:e}"),
    }
}

/// A case with its curve, verdict, limits and table, and the gates that it doesn't keep.
pub fn chapter(case: &Case, ran: &[Vec<Measured>], faults: &[String]) -> String {
    let mut text = format!(
        "## {}\n\n{}{}\n{}Verdict: {}.\n\nLimits: {}.\n\n",
        case.title,
        pictures(case.title),
        case.text,
        curve(case.title, ran),
        verdict(ran, faults),
        limits(case)
    );
    let finest: Vec<&Measured> = ran.iter().filter_map(|meshes| meshes.last()).collect();
    let figures = &finest[0].figures;
    // A figure that is round-off everywhere has no column of orders.
    let has_order: Vec<bool> = (0..figures.len())
        .map(|i| {
            let is_large = |mesh: &&Measured| mesh.figures[i].value > ROUND_OFF;
            figures[i].has_order && finest.iter().any(is_large)
        })
        .collect();
    text += "| cells | dofs |";
    for (figure, has_order) in figures.iter().zip(&has_order) {
        let _ = write!(text, " {} |", figure.name);
        text += if *has_order { " order |" } else { "" };
    }
    text += "\n|---|--:|";
    for has_order in &has_order {
        text += if *has_order { "--:|--:|" } else { "--:|" };
    }
    text.push('\n');
    let (mixed, alone): (Vec<_>, Vec<_>) =
        (case.families.iter().zip(ran)).partition(|(family, _)| family.name.contains(" on "));
    for (family, meshes) in alone {
        let Some((mesh, before)) = meshes.split_last() else {
            continue;
        };
        let _ = write!(text, "| {} | {} |", family.name, mesh.dofs);
        for (i, figure) in mesh.figures.iter().enumerate() {
            let _ = write!(text, " {} |", shown(figure.value));
            if has_order[i] {
                let order = (before.last())
                    .filter(|_| figure.value > ROUND_OFF)
                    .map(|before| (before.figures[i].value / figure.value).log2());
                text += &order.map_or(" |".to_owned(), |order| format!(" {order:.2} |"));
            }
        }
        text.push('\n');
    }
    if !mixed.is_empty() {
        let _ = write!(text, "| {} mixed pairs, largest | |", mixed.len());
        for (i, &has_order) in has_order.iter().enumerate() {
            let values = mixed.iter().flat_map(|(_, meshes)| meshes.last());
            let largest = values.map(|mesh| mesh.figures[i].value).fold(0.0, f64::max);
            let _ = write!(text, " {} |", shown(largest));
            text += if has_order { " |" } else { "" };
        }
        text.push('\n');
    }
    text.push('\n');
    if !faults.is_empty() {
        let _ = writeln!(text, "Not as required:\n\n- {}\n", faults.join("\n- "));
    }
    text
}

/// Errors below it have no order.
const ROUND_OFF: f64 = 1e-9;

fn shown(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        _ if value > 0.5 && (value - value.round()).abs() < ROUND_OFF => {
            format!("{}", value.round())
        }
        _ => format!("{value:.1e}"),
    }
}
