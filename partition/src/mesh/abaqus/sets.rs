//! Sets by names that are compared without regard to case.

use std::collections::BTreeMap;

/// A set.
#[derive(Clone, Default)]
pub(super) struct Set<T> {
    /// Name as the deck first writes it.
    pub(super) name: String,
    /// In the order of the deck, perhaps repeated.
    pub(super) members: Vec<T>,
    /// Made by a program for itself, not by its user.
    pub(super) internal: bool,
}

/// Sets by name.
#[derive(Clone)]
pub(super) struct Sets<T>(BTreeMap<String, Set<T>>);

impl<T> Default for Sets<T> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<T> Sets<T> {
    /// Adds to a set, which is made where it isn't there.
    pub(super) fn extend(
        &mut self,
        name: &str,
        internal: bool,
        members: impl IntoIterator<Item = T>,
    ) {
        let set = self.0.entry(name.to_uppercase()).or_insert_with(|| Set {
            name: name.to_owned(),
            members: Vec::new(),
            internal,
        });
        set.members.extend(members);
    }

    pub(super) fn get(&self, name: &str) -> Option<&Set<T>> {
        self.0.get(&name.to_uppercase())
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Set<T>> {
        self.0.values()
    }
}
