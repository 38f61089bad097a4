//! Many short lists in two allocations (compressed rows).

/// Lists of items, one for each of `0..len`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lists<T> {
    offsets: Vec<usize>,
    items: Vec<T>,
}

impl<T> Default for Lists<T> {
    fn default() -> Self {
        Self {
            offsets: vec![0],
            items: Vec::new(),
        }
    }
}

impl<T, L: IntoIterator<Item = T>> FromIterator<L> for Lists<T> {
    fn from_iter<I: IntoIterator<Item = L>>(lists: I) -> Self {
        let (mut offsets, mut items) = (vec![0], Vec::new());
        for list in lists {
            items.extend(list);
            offsets.push(items.len());
        }
        Self { offsets, items }
    }
}

impl<T: Copy> Lists<T> {
    /// Sorts items into the lists given by their first components, in a stable order. O(items + lists).
    pub fn new(len: usize, items: impl Iterator<Item = (u32, T)> + Clone) -> Self {
        let mut offsets = vec![0; len + 1];
        let mut first = None;
        for (list, item) in items.clone() {
            offsets[list as usize + 1] += 1;
            first.get_or_insert(item);
        }
        for list in 0..len {
            offsets[list + 1] += offsets[list];
        }
        let mut sorted = first.map_or_else(Vec::new, |item| vec![item; offsets[len]]);
        let mut ends = offsets.clone();
        for (list, item) in items {
            sorted[ends[list as usize]] = item;
            ends[list as usize] += 1;
        }
        Self {
            offsets,
            items: sorted,
        }
    }

    /// An empty sequence with room for `lists` lists and `items` items.
    pub fn with_capacity(lists: usize, items: usize) -> Self {
        let mut offsets = Vec::with_capacity(lists + 1);
        offsets.push(0);
        Self {
            offsets,
            items: Vec::with_capacity(items),
        }
    }

    /// Appends a list.
    pub fn push(&mut self, list: impl Iterator<Item = T>) {
        self.items.extend(list);
        self.offsets.push(self.items.len());
    }

    /// Number of items of all lists.
    pub fn items(&self) -> usize {
        self.items.len()
    }

    /// Number of lists.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The list with this number.
    pub fn of(&self, list: usize) -> &[T] {
        &self.items[self.offsets[list]..self.offsets[list + 1]]
    }

    /// The items of a list, mutable.
    pub fn of_mut(&mut self, list: usize) -> &mut [T] {
        &mut self.items[self.offsets[list]..self.offsets[list + 1]]
    }

    /// The items of all lists in order, mutable.
    pub fn items_mut(&mut self) -> &mut [T] {
        &mut self.items
    }

    /// The lists in order.
    pub fn iter(&self) -> impl Iterator<Item = &[T]> + Clone {
        (0..self.len()).map(|list| self.of(list))
    }
}

impl<T: Copy + Ord> Lists<T> {
    /// Sorts every list.
    pub fn sort(&mut self) {
        for list in 0..self.len() {
            self.items[self.offsets[list]..self.offsets[list + 1]].sort_unstable();
        }
    }

    /// Removes consecutive repetitions in every list.
    pub fn dedup(&mut self) {
        let mut kept = 0;
        for list in 0..self.len() {
            let range = self.offsets[list]..self.offsets[list + 1];
            let start = kept;
            for at in range {
                if kept == start || self.items[at] != self.items[kept - 1] {
                    self.items[kept] = self.items[at];
                    kept += 1;
                }
            }
            self.offsets[list] = start;
        }
        let len = self.len();
        self.offsets[len] = kept;
        self.items.truncate(kept);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_hold_what_was_put_into_them_and_nothing_else() {
        let items = [(2, 'b'), (0, 'z'), (2, 'a'), (2, 'b'), (4, 'z'), (0, 'z')];
        let mut lists = Lists::new(6, items.into_iter());
        let words = |lists: &Lists<char>| -> Vec<String> {
            lists.iter().map(|list| list.iter().collect()).collect()
        };
        assert_eq!(words(&lists), ["zz", "", "bab", "", "z", ""]);
        lists.sort();
        assert_eq!(words(&lists), ["zz", "", "abb", "", "z", ""]);
        lists.dedup();
        assert_eq!(words(&lists), ["z", "", "ab", "", "z", ""]);
        let none: [(u32, char); 0] = [];
        assert_eq!(words(&Lists::new(0, none.into_iter())), [""; 0]);
    }
}
