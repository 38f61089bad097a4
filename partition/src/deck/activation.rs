//! Activation of bodies and contacts in each step, in the syntax of the scene.

use std::collections::BTreeSet;

use super::document::{Document, quoted};

/// A body, contact or equation that isn't active in all steps.
pub(super) struct Activation {
    pub(super) name: String,
    pub(super) steps: Vec<bool>,
}

/// Writes the activations and deactivations of a step.
pub(super) fn write(all: &[Activation], step: usize, document: &mut Document) {
    for (key, comes) in [("add", true), ("remove", false)] {
        let changes = |of: &&Activation| match step.checked_sub(1) {
            Some(before) => of.steps[before] != comes && of.steps[step] == comes,
            // Bodies that are added later are absent at first.
            None => !comes && !of.steps.contains(&true),
        };
        // Equations share names.
        let names: BTreeSet<String> = all
            .iter()
            .filter(changes)
            .map(|of| quoted(&of.name))
            .collect();
        if !names.is_empty() {
            let names: Vec<String> = names.into_iter().collect();
            document.key(key, format!("[{}]", names.join(", ")));
        }
    }
}
