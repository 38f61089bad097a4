//! The tables of what contacts and supports carry.

use crate::output::resultants::{ContactResultant, Reaction, Resultant, Resultants};

/// Most lines that are printed of a table; the report has all.
const LINES: usize = 12;

/// Contacts and reactions.
pub(super) fn lines(resultants: &Resultants) -> Vec<String> {
    let Resultants {
        contacts,
        reactions,
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
    let mut lines = table(head, contacts, contact);
    let head = format!("{:<width$}                   {columns}", "support");
    lines.extend(table(head, reactions, support));
    lines
}

/// The head and a line for each of `all`; nothing where there is none.
fn table<T>(head: String, all: &[T], line: impl Fn(&T) -> String) -> Vec<String> {
    if all.is_empty() {
        return Vec::new();
    }
    let mut lines = vec![head];
    lines.extend(all.iter().take(LINES).map(line));
    if let Some(rest @ 1..) = all.len().checked_sub(LINES) {
        lines.push(format!("… and {rest} more in the report"));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::resultants::Friction;

    #[test]
    fn long_lists_are_cut() {
        let resultants = Resultants {
            contacts: vec![ContactResultant::default(); 15],
            reactions: vec![Reaction::default(); 2],
        };
        let lines = lines(&resultants);
        assert_eq!(lines.len(), 1 + 12 + 1 + 1 + 2);
        assert!(lines[13].contains("… and 3 more"));
    }

    #[test]
    fn contacts_that_slip_are_told_where_there_is_friction() {
        let mut resultants = Resultants {
            contacts: vec![ContactResultant::default(); 2],
            reactions: Vec::new(),
        };
        assert!(lines(&resultants)[0].ends_with("pressure"));
        let slips = Friction {
            slipping: 7,
            ..Friction::default()
        };
        resultants.contacts[1].friction = Some(slips);
        let [head, without, with] = &lines(&resultants)[..] else {
            panic!("three lines");
        };
        assert!(head.ends_with("slipping") && without.ends_with('-') && with.ends_with(" 7"));
        assert!([without, with].iter().all(|line| line.len() == head.len()));
    }
}
