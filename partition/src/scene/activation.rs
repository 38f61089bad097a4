//! Activation of bodies and contacts in a load step: the keys `add` and `remove`.

use std::collections::BTreeSet;

use super::condition::Names;
use super::fault::{Fault, entry};
use super::step::LoadStep;
use super::{Scene, suggest};

impl LoadStep {
    /// Names that are added in this step, then names that are removed, with the key of each.
    fn changes(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let all = [("add", &self.add), ("remove", &self.remove)];
        let named = all.into_iter();
        named.flat_map(|(key, names)| names.iter().flat_map(Names::iter).map(move |n| (key, n)))
    }
}

impl Scene {
    /// The absent bodies and contacts, by name and step by step. A name whose first change adds it is absent from the
    /// start.
    pub fn absent(&self) -> Vec<BTreeSet<&str>> {
        let mut absent = self.absent_at_first();
        let mut all = Vec::new();
        for step in &self.step {
            for (key, name) in step.changes() {
                match key {
                    "add" => absent.remove(name),
                    _ => absent.insert(name),
                };
            }
            all.push(absent.clone());
        }
        all
    }

    /// Names whose first change adds them.
    fn absent_at_first(&self) -> BTreeSet<&str> {
        let (mut seen, mut absent) = (BTreeSet::new(), BTreeSet::new());
        for (key, name) in self.step.iter().flat_map(LoadStep::changes) {
            if seen.insert(name) && key == "add" {
                absent.insert(name);
            }
        }
        absent
    }

    /// The first name with an invalid `add` or `remove`, and the reason.
    pub(super) fn wrong_change(&self) -> Option<Fault> {
        let contacts = || self.connections().map(|(_, _, name)| name);
        let bodies = || self.bodies.keys().map(String::as_str);
        let mut absent = self.absent_at_first();
        for (index, step) in self.step.iter().enumerate() {
            let mut seen = BTreeSet::new();
            for (key, name) in step.changes() {
                let found = [bodies().any(|n| n == name), contacts().any(|n| n == name)];
                let was_absent = absent.contains(name);
                let fault = match (found, key, was_absent) {
                    ([false, false], ..) => {
                        let hint = suggest::hint_and_known(name, bodies().chain(contacts()));
                        Some(format!("there is no body or contact '{name}'{hint}"))
                    }
                    ([true, true], ..) => Some(format!(
                        "'{name}' is a body and a contact; expected another name of the contact"
                    )),
                    _ if !seen.insert(name) => Some(format!("'{name}' is added and removed")),
                    (_, "add", false) => Some(format!("'{name}' is there already")),
                    (_, "remove", true) => Some(format!("'{name}' isn't there")),
                    _ => None,
                };
                if let Some(fault) = fault {
                    return Some((entry("step", index, key), fault));
                }
                match key {
                    "add" => absent.remove(name),
                    _ => absent.insert(name),
                };
            }
            if bodies().all(|name| absent.contains(name)) {
                return Some((entry("step", index, "remove"), "no body is left".into()));
            }
        }
        None
    }
}
