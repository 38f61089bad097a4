//! Notes on unsupported parts of a deck, which other programs read or ignore; they become warnings.

use std::collections::BTreeMap;

/// Largest number of items listed individually.
const NAMED: usize = 6;

/// Items of one kind.
#[derive(Clone, Default)]
struct Tally {
    first: Vec<String>,
    count: usize,
}

/// Kinds of ignored items, in words, with the items of each kind.
#[derive(Clone, Default)]
pub(crate) struct Notes(BTreeMap<String, Tally>);

impl Notes {
    /// Adds an item; repetitions count once.
    pub(crate) fn add(&mut self, what: &str, thing: String) {
        let tally = self.0.entry(what.to_owned()).or_default();
        if tally.first.contains(&thing) {
            return;
        }
        tally.count += 1;
        if tally.first.len() < NAMED {
            tally.first.push(thing);
        }
    }

    /// Adds other notes.
    pub(crate) fn join(&mut self, other: &Self) {
        for (what, more) in &other.0 {
            let tally = self.0.entry(what.clone()).or_default();
            tally.count += more.count;
            for thing in &more.first {
                match tally.first.contains(thing) {
                    true => tally.count -= 1,
                    false if tally.first.len() < NAMED => tally.first.push(thing.clone()),
                    false => {}
                }
            }
        }
    }

    /// The warnings, one for each kind.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|(what, tally)| {
            let more = match tally.count - tally.first.len() {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            format!("{what}: {}{more}", tally.first.join(", "))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_is_one_warning_however_many_are_of_it() {
        let mut notes = Notes::default();
        (0..1000).for_each(|tag| notes.add("nodes are left out", tag.to_string()));
        let mut other = Notes::default();
        other.add("nodes are left out", "1000".into());
        other.add("nodes are left out", "5".into());
        notes.join(&other);
        let warnings: Vec<String> = notes.warnings().collect();
        assert_eq!(
            warnings,
            ["nodes are left out: 0, 1, 2, 3, 4, 5 and 995 more"]
        );
    }
}
