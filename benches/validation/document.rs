//! docs/validation.md: what was compared with what, and how far apart they are.

use std::fmt::Write as _;

use crate::support::validation::{Case, Gate, Measured};

/// What stands before the cases.
pub const HEAD: &str = "\
# Validation

`scripts/validate` solves scenes with exact answers on finer and finer meshes and writes this page. The
first meshes of most tables are among the tests, with the same gates.

*Energy* is ‖σ_h − σ‖ over ‖σ‖ in the norm of C⁻¹, σ_h from the displacements of the result file by
shape functions and quadrature that are none of the solver's. *Backward error* is the certificate's
equilibrium, promised to be at most 1e-14. The other figures are explained where they appear; all are
relative but for numbers of cells and nodes. *Order* is log₂ of the error on the mesh before, whose cells
are twice as large, over this one. Contact pressures are those of the result file: the force of a node
over the integral of its weight.

";

/// A case with its table, its gates and what doesn't keep them.
pub fn chapter(case: &Case, ran: &[Vec<Measured>], faults: &[String]) -> String {
    let mut text = format!("## {}\n\n{}\n", case.title, case.text);
    let figures = &ran[0][0].figures;
    text += "| cells | dofs |";
    for figure in figures {
        let _ = write!(text, " {} |", figure.name);
        if figure.has_order {
            text += " order |";
        }
    }
    text += "\n|---|--:|";
    for figure in figures {
        text += if figure.has_order { "--:|--:|" } else { "--:|" };
    }
    text.push('\n');
    for (family, all) in case.families.iter().zip(ran) {
        for (level, measured) in all.iter().enumerate() {
            let _ = write!(text, "| {} | {} |", family.name, measured.dofs);
            for (i, figure) in measured.figures.iter().enumerate() {
                let _ = write!(text, " {} |", shown(figure.value));
                if figure.has_order {
                    let before = level.checked_sub(1).map(|before| &all[before].figures[i]);
                    let order = before.map(|before| (before.value / figure.value).log2());
                    let _ = match order.filter(|_| figure.value > ROUND_OFF) {
                        Some(order) => write!(text, " {order:.2} |"),
                        None => write!(text, " |"),
                    };
                }
            }
            text.push('\n');
        }
    }
    text.push('\n');
    text += &gates(case);
    if !faults.is_empty() {
        let _ = writeln!(text, "Not kept:\n\n- {}\n", faults.join("\n- "));
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

/// The gates, families with the same ones together.
fn gates(case: &Case) -> String {
    let mut groups: Vec<(String, Vec<&str>)> = Vec::new();
    for family in &case.families {
        let words: Vec<String> = (family.gates.iter())
            .map(|gate| match gate {
                Gate::Order(name, least) => format!("order of {name} ≥ {least}"),
                Gate::AtMost(name, most) if *most < 0.1 && *most > 0.0 => {
                    format!("{name} ≤ {most:.0e}")
                }
                Gate::AtMost(name, most) => format!("{name} ≤ {most:.1}"),
            })
            .collect();
        let words = words.join(", ");
        match groups.iter_mut().find(|(known, _)| *known == words) {
            Some((_, names)) => names.push(&family.name),
            None => groups.push((words, vec![&family.name])),
        }
    }
    let is_one = groups.len() == 1;
    let mut text = "Gates on the finest mesh:\n\n".to_owned();
    for (words, names) in groups {
        let _ = match is_one {
            true => writeln!(text, "- {words}"),
            false => writeln!(text, "- {}: {words}", names.join("; ")),
        };
    }
    text.push('\n');
    text
}
