//! Sets by names that are compared without regard to case.

use std::collections::BTreeMap;

/// Members that are sorted out no sooner than so many have come.
const FEW: usize = 64;

/// Members of a set: those that came last may be there twice, but never more than half of them.
#[derive(Clone)]
pub(crate) struct Members<T> {
    list: Vec<T>,
    /// Number of members when each was there once.
    distinct: usize,
}

impl<T> Default for Members<T> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            distinct: 0,
        }
    }
}

impl<T: Copy + Ord> Members<T> {
    /// Adds members.
    pub(crate) fn extend(&mut self, more: impl IntoIterator<Item = T>) {
        self.list.extend(more);
        if self.list.len() > 2 * self.distinct.max(FEW) {
            self.list.sort_unstable();
            self.list.dedup();
            self.distinct = self.list.len();
        }
    }

    /// All of them, some perhaps twice.
    pub(crate) fn list(&self) -> &[T] {
        &self.list
    }
}

/// A set.
#[derive(Clone)]
pub(crate) struct Set<T> {
    /// Name as the deck first writes it.
    pub(crate) name: String,
    pub(crate) members: Members<T>,
    /// Made by a program for itself, not by its user.
    pub(crate) internal: bool,
}

/// Sets by name.
#[derive(Clone)]
pub(crate) struct Sets<T>(BTreeMap<String, Set<T>>);

impl<T> Default for Sets<T> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<T: Copy + Ord> Sets<T> {
    /// Adds to a set, which is made where it isn't there.
    pub(crate) fn extend(
        &mut self,
        name: &str,
        internal: bool,
        members: impl IntoIterator<Item = T>,
    ) {
        let set = self.0.entry(name.to_uppercase()).or_insert_with(|| Set {
            name: name.to_owned(),
            members: Members::default(),
            internal,
        });
        set.members.extend(members);
    }

    pub(crate) fn get(&self, name: &str) -> Option<&Set<T>> {
        self.0.get(&name.to_uppercase())
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Set<T>> {
        self.0.values()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_that_is_added_to_itself_time_and_again_doesnt_grow() {
        let mut members = Members::default();
        members.extend(0..1000);
        for _ in 0..40 {
            let all = members.list().to_vec();
            members.extend(all);
            assert!(members.list().len() <= 2000);
        }
        let mut distinct = members.list().to_vec();
        distinct.sort_unstable();
        distinct.dedup();
        assert_eq!(distinct, (0..1000).collect::<Vec<_>>());
    }
}
