//! The symbolic factorization: the supernodes of a Cholesky factor and their patterns.
//!
//! Unknowns with equal patterns, such as the components of a node, are grouped first. The pattern of a group is the
//! union of its own and the updates of its children in the elimination tree. Neighbours in that tree are merged into
//! one supernode if this adds few zeros.

use super::children::{Children, NO_PARENT};
use super::panel::packed_len;
use super::pattern::LowerPattern;

/// Two supernodes are merged if the number of columns and the fraction of zeros among the entries are at most one of
/// these pairs: small supernodes cost more in overhead than in arithmetic.
const RELAXATION: [(usize, f64); 5] = [
    (8, 1.0),
    (16, 0.6),
    (32, 0.3),
    (64, 0.1),
    (usize::MAX, 0.05),
];

/// A group that hasn't been in any union yet.
const UNSEEN: u32 = u32::MAX;

/// Supernodes of the first columns of a matrix: contiguous columns with common rows below.
#[derive(Clone, Debug, Default)]
pub(super) struct Supernodes {
    /// First column of each supernode, and the end of the last.
    pub begin: Vec<u32>,
    /// Offset in `rows` of the rows below each supernode's own columns, and the end of the last.
    pub row_offsets: Vec<usize>,
    /// Rows below, ascending.
    pub rows: Vec<u32>,
    /// Offset of each supernode's values, and the end of the last.
    pub value_offsets: Vec<usize>,
    /// The supernode whose columns contain the first row below; [`NO_PARENT`] if that row isn't eliminated, or there is
    /// none.
    pub parents: Vec<u32>,
}

impl Supernodes {
    /// The supernodes of the first `count` columns; `pattern` should be postordered.
    pub fn new(pattern: &LowerPattern, count: usize) -> Self {
        let groups = Groups::new(pattern, count);
        let structures = Structures::new(pattern, &groups);
        Self::merge(&groups, &structures)
    }

    /// The same supernodes with only those rows below that are before row `end`.
    pub fn before(&self, end: usize) -> Self {
        let mut within = Self {
            begin: self.begin.clone(),
            row_offsets: vec![0],
            rows: Vec::new(),
            value_offsets: vec![0],
            parents: self.parents.clone(),
        };
        for s in 0..self.len() {
            let below = self.below(s);
            let below = &below[..below.partition_point(|&i| (i as usize) < end)];
            let columns = self.columns(s).len();
            within.rows.extend_from_slice(below);
            within.row_offsets.push(within.rows.len());
            let values = within.values() + packed_len(columns + below.len(), columns);
            within.value_offsets.push(values);
        }
        within
    }

    /// Number of supernodes.
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// Number of values of all panels together.
    pub fn values(&self) -> usize {
        self.value_offsets.last().copied().unwrap_or(0)
    }

    /// The columns of supernode `s`.
    pub fn columns(&self, s: usize) -> std::ops::Range<usize> {
        self.begin[s] as usize..self.begin[s + 1] as usize
    }

    /// The rows below the columns of supernode `s`.
    pub fn below(&self, s: usize) -> &[u32] {
        &self.rows[self.row_offsets[s]..self.row_offsets[s + 1]]
    }

    /// The range of the values of supernode `s`.
    pub fn places(&self, s: usize) -> std::ops::Range<usize> {
        self.value_offsets[s]..self.value_offsets[s + 1]
    }

    fn merge(groups: &Groups, structures: &Structures) -> Self {
        let mut stack: Vec<Merged> = Vec::new();
        for g in 0..groups.eliminated {
            let below = structures.of(g);
            let mut last = Merged {
                first: g,
                last: g,
                columns: groups.size(g),
                below: below.iter().map(|&i| groups.size(i as usize)).sum(),
                parent: structures.parent(g),
                zeros: 0,
            };
            while let Some(child) = stack.last()
                && (last.first..=g).contains(&(child.parent as usize))
                && let Some(merged) = last.with(child)
            {
                last = merged;
                stack.pop();
            }
            stack.push(last);
        }
        Self::of(&stack, groups, structures)
    }

    fn of(list: &[Merged], groups: &Groups, structures: &Structures) -> Self {
        let mut supernodes = Self {
            begin: vec![0],
            row_offsets: vec![0],
            value_offsets: vec![0],
            ..Self::default()
        };
        let mut supernode_of = vec![NO_PARENT; groups.eliminated];
        for (s, merged) in list.iter().enumerate() {
            supernode_of[merged.first..=merged.last].fill(s as u32);
            for &i in structures.of(merged.last) {
                let unknowns = groups.starts[i as usize]..groups.starts[i as usize + 1];
                supernodes.rows.extend(unknowns);
            }
            let values =
                supernodes.values() + packed_len(merged.columns + merged.below, merged.columns);
            supernodes.begin.push(groups.starts[merged.last + 1]);
            supernodes.row_offsets.push(supernodes.rows.len());
            supernodes.value_offsets.push(values);
        }
        let parent = |merged: &Merged| match merged.parent {
            NO_PARENT => NO_PARENT,
            group => supernode_of[group as usize],
        };
        supernodes.parents = list.iter().map(parent).collect();
        supernodes
    }
}

/// A supernode during merging.
#[derive(Clone, Copy)]
struct Merged {
    first: usize,
    last: usize,
    columns: usize,
    below: usize,
    parent: u32,
    zeros: usize,
}

impl Merged {
    /// The union of this supernode and a child directly before it, if merging them pays.
    fn with(&self, child: &Self) -> Option<Self> {
        let new = child.columns * (self.columns + self.below - child.below);
        let zeros = self.zeros + child.zeros + new;
        let columns = self.columns + child.columns;
        let entries = columns * (columns + 1) / 2 + columns * self.below;
        let few = |&(most, share): &(usize, f64)| {
            columns <= most && zeros as f64 <= share * entries as f64
        };
        (new == 0 || RELAXATION.iter().any(few)).then_some(Self {
            first: child.first,
            columns,
            zeros,
            ..*self
        })
    }
}

/// Runs of unknowns with equal patterns.
struct Groups {
    /// First unknown of each group, and the end of the last.
    starts: Vec<u32>,
    of: Vec<u32>,
    /// Number of groups of eliminated unknowns, which come first.
    eliminated: usize,
}

impl Groups {
    fn new(pattern: &LowerPattern, count: usize) -> Self {
        let n = pattern.n();
        // A hash sum over the earlier neighbours of each unknown: equal sets have equal sums.
        let mix = |j: usize| (j as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut earlier = vec![0u64; n];
        for j in 0..n {
            for &i in &pattern.rows_of(j)[1..] {
                earlier[i as usize] = earlier[i as usize].wrapping_add(mix(j));
            }
        }
        let mut groups = Self {
            starts: Vec::with_capacity(n / 2 + 2),
            of: Vec::with_capacity(n),
            eliminated: 0,
        };
        for j in 0..n {
            let joins = j > 0
                && j != count
                && earlier[j] == earlier[j - 1].wrapping_add(mix(j - 1))
                && pattern.rows_of(j - 1)[1..] == *pattern.rows_of(j);
            if !joins {
                groups.starts.push(j as u32);
                groups.eliminated += usize::from(j < count);
            }
            groups.of.push(groups.starts.len() as u32 - 1);
        }
        groups.starts.push(n as u32);
        groups
    }

    fn len(&self) -> usize {
        self.starts.len() - 1
    }

    fn size(&self, g: usize) -> usize {
        (self.starts[g + 1] - self.starts[g]) as usize
    }
}

/// The pattern of each group's columns in the factor, as ascending groups below the diagonal.
struct Structures {
    members: Vec<u32>,
    ranges: Vec<(usize, usize)>,
    eliminated: usize,
}

impl Structures {
    fn new(pattern: &LowerPattern, groups: &Groups) -> Self {
        let mut structures = Self {
            members: Vec::with_capacity(8 * groups.eliminated),
            ranges: Vec::with_capacity(groups.eliminated),
            eliminated: groups.eliminated,
        };
        let mut children = Children::none(groups.eliminated);
        let mut seen = vec![UNSEEN; groups.len()];
        for g in 0..groups.eliminated {
            let first = groups.starts[g] as usize;
            let own = pattern.rows_of(first)[groups.size(g)..]
                .iter()
                .map(|&i| groups.of[i as usize]);
            structures.push(g, own, &children, &mut seen);
            children.add(structures.parent(g), g);
        }
        structures
    }

    /// Appends the union of a group's `own` neighbours and its children's patterns.
    fn push(
        &mut self,
        g: usize,
        own: impl Iterator<Item = u32>,
        children: &Children,
        seen: &mut [u32],
    ) {
        let start = self.members.len();
        let mark = g as u32;
        seen[g] = mark;
        for i in own {
            if seen[i as usize] != mark {
                seen[i as usize] = mark;
                self.members.push(i);
            }
        }
        let is_only_child = children.of(g).nth(1).is_none();
        for child in children.of(g) {
            let (from, to) = self.ranges[child];
            for place in from..to {
                let i = self.members[place];
                if seen[i as usize] != mark {
                    seen[i as usize] = mark;
                    self.members.push(i);
                }
            }
            // Most groups have the pattern of their only child.
            if is_only_child && to - from == self.members.len() - start + 1 {
                self.members.truncate(start);
                self.ranges.push((from + 1, to));
                return;
            }
        }
        self.members[start..].sort_unstable();
        self.ranges.push((start, self.members.len()));
    }

    fn of(&self, g: usize) -> &[u32] {
        let (from, to) = self.ranges[g];
        &self.members[from..to]
    }

    fn parent(&self, g: usize) -> u32 {
        match self.of(g).first() {
            Some(&i) if (i as usize) < self.eliminated => i,
            _ => NO_PARENT,
        }
    }
}
