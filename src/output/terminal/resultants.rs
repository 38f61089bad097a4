//! Tables of the resultants of contacts and supports.

use contact_dd_partition::scene::units::Units;

use crate::fem::quantity::{QuantityValue, ToldError};
use crate::fem::resultants::{ContactResultant, Reaction, Resultant, Resultants};
use crate::fem::stress_intensity::StressIntensity;
use crate::fem::tightened_bolt::TightenedBolt;

/// Most lines printed of a table; the report has all of them.
const LINES: usize = 12;

/// Contacts and reactions of a problem with forces in `dim` dimensions.
pub(super) fn lines(resultants: &Resultants, units: Units, dim: usize) -> Vec<String> {
    let Resultants {
        contacts,
        reactions,
        quantities,
        ..
    } = resultants;
    let title = "contact, on side a";
    let names = (contacts.iter().map(|c| c.name.as_str()))
        .chain(reactions.iter().map(|r| r.support.as_str()))
        .chain([title]);
    let width = names.map(|name| name.chars().count()).max().unwrap_or(0);
    let in_space = (contacts.iter().map(|c| &c.resultant))
        .chain(reactions.iter().map(|r| &r.resultant))
        .any(Resultant::is_spatial);
    let columns = match in_space {
        true => "force x      force y      force z",
        false => "force x      force y     moment z",
    };
    let force = units.force(dim);
    let last = if in_space { force } else { units.moment(dim) };
    let of_forces = format!(
        "{:width$} {:>12} {force:>12} {force:>12} {last:>12}",
        "", ""
    );
    let forces = |resultant: &Resultant| {
        let [x, y, z] = resultant.force;
        let last = if in_space { z } else { resultant.moment[2] };
        format!(" {x:>12.4e} {y:>12.4e} {last:>12.4e}")
    };
    let has_friction = resultants.friction().is_some();
    let contact = |contact: &ContactResultant| {
        let closed = format!("{} of {}", contact.closed, contact.conditions);
        let (name, pressure) = (&contact.name, contact.largest_pressure);
        let slipping = match contact.friction {
            Some(friction) => format!(" {:>10}", friction.slipping),
            None if has_friction => format!(" {:>10}", "-"),
            None => String::new(),
        };
        format!(
            "{name:<width$} {closed:>12}{} {pressure:>12.4e}{slipping}",
            forces(&contact.resultant)
        )
    };
    let support = |Reaction { support, resultant }: &Reaction| {
        format!("{support:<width$} {:>12}{}", "", forces(resultant))
    };
    let slipping = if has_friction { "   slipping" } else { "" };
    let head = format!("{title:<width$}       closed      {columns}     pressure{slipping}");
    let head = format!("{head}\n{of_forces} {:>12}", units.stress());
    let mut lines = table(head, contacts, contact);
    let head = format!(
        "{:<width$}                   {columns}\n{of_forces}",
        "support"
    );
    lines.extend(table(head, reactions, support));
    lines.extend(places(resultants, units, dim));
    lines.extend(of_quantities(quantities, units, dim));
    lines
}

/// Tables of bolts and crack tips.
fn places(resultants: &Resultants, units: Units, dim: usize) -> Vec<String> {
    let mut lines = bolts(&resultants.pretensions, units, dim);
    lines.extend(tips(&resultants.crack_tips, units));
    lines
}

/// Table of the force and shortening of bolts.
fn bolts(bolts: &[TightenedBolt], units: Units, dim: usize) -> Vec<String> {
    let title = "pretension";
    let names = bolts.iter().map(|bolt| bolt.name.chars().count());
    let width = names.max().unwrap_or(0).max(title.len());
    let (force, length) = (units.force(dim), units.length());
    let head = format!(
        "{title:<width$} {:>14} {:>14}\n{:width$} {force:>14} {length:>14}",
        "force", "shortening", ""
    );
    table(head, bolts, |bolt| {
        let held = if bolt.held { " held" } else { "" };
        format!(
            "{:<width$} {:>14.6e} {:>14.6e}{held}",
            bolt.name, bolt.force, bolt.shortening
        )
    })
}

/// Table of the stress intensity factors of crack tips, and their dependence on the radius of the evaluated disc.
fn tips(tips: &[StressIntensity], units: Units) -> Vec<String> {
    let title = "crack tip";
    let names = tips.iter().map(|tip| tip.tip.chars().count());
    let width = names.max().unwrap_or(0).max(title.len());
    let unit = format!("{} √{}", units.stress(), units.length());
    let (rate, none) = (units.force(2), "");
    let head = format!(
        "{title:<width$} {:>12} {:>12} {:>12} {:>9}\n{none:width$} {unit:>12} {unit:>12} {rate:>12} {:>9}",
        "K_I", "K_II", "J", "by disc", "%"
    );
    table(head, tips, |tip| {
        format!(
            "{:<width$} {:>12.4e} {:>12.4e} {:>12.4e} {:>9.3}",
            tip.tip,
            tip.opening,
            tip.sliding,
            tip.energy_release_rate,
            100.0 * tip.dependence_on_radius
        )
    })
}

/// Table of the quantities of interest, the estimated mesh error in each, and the parameter with the largest relative
/// derivative.
fn of_quantities(quantities: &[QuantityValue], units: Units, dim: usize) -> Vec<String> {
    let title = "quantity";
    let names = quantities.iter().map(|of| of.name.chars().count());
    let width = names.max().unwrap_or(0).max(title.len());
    let head = format!(
        "{title:<width$} {:>14} {:<6} {:>12} largest derivative, % per % of",
        "", "", "mesh error"
    );
    table(head, quantities, |of| {
        let unit = match &of.kind[..] {
            "displacement" | "opening" => units.length().to_owned(),
            "reaction" | "contact_force" => units.force(dim).to_owned(),
            "contact_moment" => units.moment(dim).to_owned(),
            "energy_release_rate" => units.force(2).to_owned(),
            "k_i" | "k_ii" => format!("{} √{}", units.stress(), units.length()),
            "energy" => units.work(dim).to_owned(),
            _ => units.stress().to_owned(),
        };
        // Only parameters with a nonzero value have a relative derivative.
        let shares = of.derivatives.iter().filter_map(|one| {
            let share = one.derivative * one.at? / of.value;
            (share.is_finite() && share != 0.0).then_some((share, &one.parameter))
        });
        let most = shares.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        let most = most.map_or(String::new(), |(share, name)| {
            format!(" {share:+.3} {name}")
        });
        let error = match of.told_error() {
            Some(ToldError::Signed(error)) => format!("{error:+.2e}"),
            Some(ToldError::Within(bar)) => format!("±{bar:.2e}"),
            None => "-".into(),
        };
        let (name, value) = (&of.name, of.value);
        format!("{name:<width$} {value:>14.6e} {unit:<6} {error:>12}{most}")
    })
}

/// The header and a line for each of `all`; empty if there is none.
fn table<T>(head: String, all: &[T], line: impl Fn(&T) -> String) -> Vec<String> {
    if all.is_empty() {
        return Vec::new();
    }
    let mut lines: Vec<String> = head.lines().map(str::to_owned).collect();
    lines.extend(all.iter().take(LINES).map(line));
    if let Some(rest @ 1..) = all.len().checked_sub(LINES) {
        lines.push(format!("… and {rest} more in the report"));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::resultants::Friction;

    #[test]
    fn long_lists_are_cut() {
        let resultants = Resultants {
            contacts: vec![ContactResultant::default(); 15],
            reactions: vec![Reaction::default(); 2],
            ..Resultants::default()
        };
        let lines = lines(&resultants, Units::Metre, 2);
        assert_eq!(lines.len(), 2 + 12 + 1 + 2 + 2);
        assert!(lines[14].contains("… and 3 more"));
    }

    #[test]
    fn contacts_that_slip_are_told_where_there_is_friction() {
        let mut resultants = Resultants {
            contacts: vec![ContactResultant::default(); 2],
            ..Resultants::default()
        };
        let lines = |resultants: &Resultants| lines(resultants, Units::Metre, 2);
        assert!(lines(&resultants)[0].ends_with("pressure"));
        let slips = Friction {
            slipping: 7,
            ..Friction::default()
        };
        resultants.contacts[1].friction = Some(slips);
        let [head, _, without, with] = &lines(&resultants)[..] else {
            panic!("four lines");
        };
        assert!(head.ends_with("slipping") && without.ends_with('-') && with.ends_with(" 7"));
        assert!([without, with].iter().all(|line| line.len() == head.len()));
    }

    #[test]
    fn every_number_has_its_unit_above_it() {
        let resultants = Resultants {
            contacts: vec![ContactResultant::default()],
            reactions: vec![Reaction::default()],
            ..Resultants::default()
        };
        for (units, dim, expected) in [
            (Units::Metre, 2, ["N/m", "N/m", "N", "Pa"]),
            (Units::Millimetre, 2, ["N/mm", "N/mm", "N", "MPa"]),
            (Units::Millimetre, 3, ["N", "N", "N mm", "MPa"]),
        ] {
            let lines = lines(&resultants, units, dim);
            let ends = |line: &str, word: &str| {
                line.match_indices(word)
                    .last()
                    .map(|(at, _)| at + word.len())
            };
            assert!(lines[1].ends_with(expected[3]) && lines[1].len() == lines[2].len());
            for [units, numbers] in [[&lines[1], &lines[2]], [&lines[4], &lines[5]]] {
                let words: Vec<&str> = units
                    .split("  ")
                    .map(str::trim)
                    .filter(|w| !w.is_empty())
                    .collect();
                assert_eq!(words, expected[..words.len()]);
                // The moment, or the third component, ends at the same column as its unit.
                let end = ends(units, expected[2]).unwrap();
                assert!(
                    numbers[..end].ends_with("e0") && end <= numbers.len(),
                    "{units}\n{numbers}"
                );
            }
        }
    }
}
