//! Regions that are merged.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::Regions;

impl Regions<'_> {
    /// Merges regions until there are no more than `count`, or as few as there can be, and every
    /// one that can be merged has the weight `least`.
    pub fn merge_below(&mut self, count: usize, least: u64) {
        while self.members.len() > count && self.merge_one(u64::MAX) {}
        while self.merge_one(least) {}
    }

    /// Merges the lightest region below `limit` that can be merged without bringing contact patches
    /// together with a neighbour; if there is none, the one where that does least harm.
    pub(super) fn merge_one(&mut self, limit: u64) -> bool {
        let mut lightest: BinaryHeap<Reverse<(u64, usize)>> = (0..self.members.len())
            .map(|region| Reverse((self.heaviness[region], region)))
            .filter(|&Reverse((weight, _))| weight < limit)
            .collect();
        let mut best: Option<(u32, usize, usize)> = None;
        while let Some(Reverse((_, region))) = lightest.pop() {
            if let Some((conflict, other)) = self.best_neighbour(region)
                && best.is_none_or(|(least, ..)| conflict < least)
            {
                best = Some((conflict, region, other));
                if conflict == 0 {
                    break;
                }
            }
        }
        let Some((_, a, b)) = best else { return false };
        self.merge(a, b);
        true
    }

    /// Gives the vertices of the region that has fewer to the other; the last region takes the number
    /// that becomes free.
    fn merge(&mut self, a: usize, b: usize) {
        let (keep, drop) = match self.members[a].len() < self.members[b].len() {
            true => (b, a),
            false => (a, b),
        };
        let moved = std::mem::take(&mut self.members[drop]);
        for &vertex in &moved {
            self.of[vertex as usize] = keep as u32;
        }
        self.members[keep].extend(moved);
        self.heaviness[keep] += self.heaviness[drop];
        self.members.swap_remove(drop);
        self.heaviness.swap_remove(drop);
        for &vertex in self.members.get(drop).into_iter().flatten() {
            self.of[vertex as usize] = drop as u32;
        }
    }

    /// The neighbour with the least conflict and, among those, the longest common boundary.
    fn best_neighbour(&self, region: usize) -> Option<(u32, usize)> {
        let mut boundary: BTreeMap<u32, u64> = BTreeMap::new();
        for &vertex in &self.members[region] {
            for &(next, weight) in self.graph.edges(vertex) {
                let other = self.of[next as usize];
                if other as usize != region {
                    *boundary.entry(other).or_default() += u64::from(weight);
                }
            }
        }
        let contacts = self.contacts(region);
        boundary
            .into_iter()
            .map(|(other, length)| {
                let other = other as usize;
                (self.conflict(&contacts, other), Reverse(length), other)
            })
            .min()
            .map(|(conflict, _, other)| (conflict, other))
    }

    /// 0: not both have contact patches; 1: contact patches of the same contacts; 2: of different ones.
    fn conflict(&self, contacts: &[u32], other: usize) -> u32 {
        if contacts.is_empty() {
            return 0;
        }
        let others = self.contacts(other);
        match (others.is_empty(), contacts == others) {
            (true, _) => 0,
            (_, true) => 1,
            (_, false) => 2,
        }
    }

    /// The contacts of a region, ascending.
    fn contacts(&self, region: usize) -> Vec<u32> {
        let members = self.members[region].iter();
        let mut all: Vec<u32> = members
            .flat_map(|&vertex| &self.graph.contacts[vertex as usize])
            .copied()
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}
