//! The tables of what contacts and supports carry.

use std::io::{Result, Write};

use crate::output::resultants::{Resultant, Resultants};

/// Most lines that are printed; the report has all.
const LINES: usize = 12;

/// Prints contacts and reactions.
///
/// # Errors
/// `out` can't be written.
pub(super) fn print(out: &mut dyn Write, resultants: &Resultants) -> Result<()> {
    let Resultants {
        contacts,
        reactions,
    } = resultants;
    let names = (contacts.iter().map(|c| c.name.as_str()))
        .chain(reactions.iter().map(|r| r.support.as_str()));
    let width = names.map(|name| name.chars().count()).max().unwrap_or(0);
    if !contacts.is_empty() {
        let title = pad("contact, on side a", width);
        writeln!(
            out,
            "{title}       closed      force x      force y     moment z     pressure"
        )?;
    }
    for contact in contacts.iter().take(LINES) {
        let closed = format!("{} of {}", contact.closed, contact.conditions);
        let name = pad(&contact.name, width);
        write!(out, "{name} {closed:>12}")?;
        forces(out, &contact.resultant)?;
        writeln!(out, " {:>12.4e}", contact.largest_pressure)?;
    }
    more(out, contacts.len())?;
    if !reactions.is_empty() {
        let title = pad("support", width);
        writeln!(
            out,
            "{title}                   force x      force y     moment z"
        )?;
    }
    for reaction in reactions.iter().take(LINES) {
        let name = pad(&reaction.support, width);
        write!(out, "{name} {:>12}", "")?;
        forces(out, &reaction.resultant)?;
        writeln!(out)?;
    }
    more(out, reactions.len())
}

fn pad(name: &str, width: usize) -> String {
    let width = width.max("contact, on side a".len());
    format!("{name:<width$}")
}

fn forces(out: &mut dyn Write, resultant: &Resultant) -> Result<()> {
    let [x, y, _] = resultant.force;
    let [.., z] = resultant.moment;
    write!(out, " {x:>12.4e} {y:>12.4e} {z:>12.4e}")
}

fn more(out: &mut dyn Write, count: usize) -> Result<()> {
    match count.checked_sub(LINES) {
        Some(rest @ 1..) => writeln!(out, "… and {rest} more in the report"),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::resultants::{ContactResultant, Reaction};

    #[test]
    fn long_lists_are_cut() {
        let resultants = Resultants {
            contacts: vec![ContactResultant::default(); 15],
            reactions: vec![Reaction::default(); 2],
        };
        let mut out = Vec::new();
        print(&mut out, &resultants).unwrap_or_default();
        let text = String::from_utf8_lossy(&out).into_owned();
        assert_eq!(text.lines().count(), 1 + 12 + 1 + 1 + 2);
        assert!(text.contains("… and 3 more"));
    }
}
