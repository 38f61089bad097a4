//! Forests: the parent of every node, and its children as a linked list.

use std::iter;

/// Marker of a node without parent.
pub(super) const NO_PARENT: u32 = u32::MAX;

/// Marker of the end of a list.
const END: u32 = u32::MAX;

/// The children of every node of a forest.
pub(super) struct Children {
    first: Vec<u32>,
    next: Vec<u32>,
}

impl Children {
    /// Lists for this number of nodes, without children yet.
    pub fn none(nodes: usize) -> Self {
        Self {
            first: vec![END; nodes],
            next: vec![END; nodes],
        }
    }

    /// The children of nodes with these `parents`, ascending.
    pub fn new(parents: &[u32]) -> Self {
        let mut children = Self::none(parents.len());
        for (child, &parent) in parents.iter().enumerate().rev() {
            children.add(parent, child);
        }
        children
    }

    /// Inserts `child` before the other children of its `parent`, if it has one.
    pub fn add(&mut self, parent: u32, child: usize) {
        if parent != NO_PARENT {
            self.next[child] = self.first[parent as usize];
            self.first[parent as usize] = child as u32;
        }
    }

    /// The children of a node.
    pub fn of(&self, node: usize) -> impl Iterator<Item = usize> {
        let child = |number: u32| (number != END).then_some(number as usize);
        let next = move |&last: &usize| child(self.next[last]);
        iter::successors(child(self.first[node]), next)
    }

    /// Removes and returns the first child of a node.
    pub fn take(&mut self, node: usize) -> Option<usize> {
        let child = self.of(node).next()?;
        self.first[node] = self.next[child];
        Some(child)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_stand_in_their_order_until_they_are_taken() {
        let mut children = Children::new(&[3, 3, NO_PARENT, 4, NO_PARENT, 3]);
        let of = |children: &Children, node| children.of(node).collect::<Vec<_>>();
        assert_eq!(of(&children, 3), [0, 1, 5]);
        assert_eq!(of(&children, 4), [3]);
        assert!(of(&children, 2).is_empty());
        assert_eq!(children.take(3), Some(0));
        assert_eq!(of(&children, 3), [1, 5]);
        assert_eq!(children.take(0), None);
    }
}
