//! Lists indexed by one type of index.

use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

use serde::{Deserialize, Serialize};

/// A value for each of the indices 0, 1, … of type `I`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Numbered<I, T> {
    values: Vec<T>,
    of: PhantomData<I>,
}

impl<I, T> Default for Numbered<I, T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<I, T> From<Vec<T>> for Numbered<I, T> {
    fn from(values: Vec<T>) -> Self {
        Self {
            values,
            of: PhantomData,
        }
    }
}

impl<I, T> FromIterator<T> for Numbered<I, T> {
    fn from_iter<V: IntoIterator<Item = T>>(values: V) -> Self {
        values.into_iter().collect::<Vec<T>>().into()
    }
}

impl<I: Into<usize>, T> Numbered<I, T> {
    /// The value of an index, if it is in range.
    pub fn get(&self, id: I) -> Option<&T> {
        self.values.get(id.into())
    }
}

impl<I: Into<usize>, T> Index<I> for Numbered<I, T> {
    type Output = T;

    fn index(&self, id: I) -> &T {
        &self.values[id.into()]
    }
}

impl<I: Into<usize>, T> IndexMut<I> for Numbered<I, T> {
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.values[id.into()]
    }
}

impl<'a, I, T> IntoIterator for &'a Numbered<I, T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.values.iter()
    }
}

impl<'a, I, T> IntoIterator for &'a mut Numbered<I, T> {
    type Item = &'a mut T;
    type IntoIter = std::slice::IterMut<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.values.iter_mut()
    }
}

impl<I, T> Numbered<I, T> {
    /// Number of entries.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// A list of the same length with equal values.
    pub fn like<U: Clone>(&self, value: U) -> Numbered<I, U> {
        vec![value; self.len()].into()
    }

    /// The values, in the order of the indices.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The values, in the order of the indices, mutable.
    pub fn iter_mut(&mut self) -> std::slice::IterMut<'_, T> {
        self.values.iter_mut()
    }

    /// The values, in the order of the indices.
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.values.iter()
    }
}

impl<I: From<usize>, T> Numbered<I, T> {
    /// Appends a value and returns its index.
    pub fn push(&mut self, value: T) -> I {
        self.values.push(value);
        I::from(self.values.len() - 1)
    }

    /// All indices, ascending.
    pub fn ids(
        &self,
    ) -> impl DoubleEndedIterator<Item = I> + ExactSizeIterator + Clone + use<I, T> {
        (0..self.values.len()).map(I::from)
    }

    /// All indices, ascending, with their values.
    pub fn each(&self) -> impl DoubleEndedIterator<Item = (I, &T)> + ExactSizeIterator {
        self.ids().zip(&self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::id::GroupId;

    #[test]
    fn a_number_finds_its_own_value() {
        let mut letters: Numbered<GroupId, char> = vec!['a', 'b'].into();
        let c = letters.push('c');
        assert_eq!((letters[c], letters.get(GroupId::new(3))), ('c', None));
        letters[GroupId::new(0)] = 'z';
        let all: String = letters.each().map(|(g, x)| format!("{g}{x}")).collect();
        assert_eq!(all, "0z1b2c");
        assert_eq!(letters.like(1).values(), [1; 3]);
    }
}
