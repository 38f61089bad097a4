//! Regions that are divided.

use std::collections::{BTreeMap, BTreeSet, HashSet, VecDeque};

use super::Regions;

impl Regions<'_> {
    /// Divides every region with several contact patches among them.
    pub(super) fn separate_patches(&mut self) {
        for region in 0..self.members.len() {
            let seeds: Vec<u32> = self.members[region]
                .iter()
                .copied()
                .filter(|&vertex| self.graph.is_contact_patch(vertex))
                .collect();
            if seeds.len() > 1 {
                self.divide(region, &seeds);
            }
        }
    }

    /// Gives each vertex of a region to the seed from which a breadth-first search reaches it first;
    /// the first seed keeps the region's number, the others get new ones.
    fn divide(&mut self, region: usize, seeds: &[u32]) {
        let old = region as u32;
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); seeds.len()];
        let mut owner: BTreeMap<u32, usize> = BTreeMap::new();
        let mut queue = VecDeque::new();
        for (number, &seed) in seeds.iter().enumerate() {
            owner.insert(seed, number);
            queue.push_back((seed, number));
        }
        while let Some((vertex, number)) = queue.pop_front() {
            members[number].push(vertex);
            for &(next, _) in self.graph.edges(vertex) {
                if self.of[next as usize] == old && !owner.contains_key(&next) {
                    owner.insert(next, number);
                    queue.push_back((next, number));
                }
            }
        }
        let mut members = members.into_iter();
        self.members[region] = members.next().unwrap_or_default();
        self.heaviness[region] = self.weigh(region);
        for list in members {
            self.add(list);
        }
    }

    /// Divides the heaviest region of two or more vertices into two of like weight.
    pub(super) fn divide_one(&mut self) -> bool {
        let heaviest = (0..self.members.len())
            .filter(|&region| self.members[region].len() > 1)
            .max_by_key(|&region| (self.heaviness[region], std::cmp::Reverse(region)));
        let Some(region) = heaviest else { return false };
        let order = self.outside_in(region);
        let half = self.heaviness[region] / 2;
        let mut grown = 0;
        let mut size = 0;
        while size + 1 < order.len() {
            let weight = self.weights[order[size] as usize];
            // Taking the next vertex must bring the sum nearer to one half.
            if size > 0 && grown + weight / 2 > half {
                break;
            }
            grown += weight;
            size += 1;
        }
        let mut rest = order[size..].to_vec();
        self.keep_connected(&order[..size], &mut rest);
        self.add(rest);
        let of = &self.of;
        self.members[region].retain(|&vertex| of[vertex as usize] as usize == region);
        self.heaviness[region] = self.weigh(region);
        true
    }

    /// The vertices of a region, breadth-first from one that lies at its outside.
    fn outside_in(&self, region: usize) -> Vec<u32> {
        let first = self.breadth_first(region, self.members[region][0]);
        let far = first.last().copied().unwrap_or(self.members[region][0]);
        self.breadth_first(region, far)
    }

    fn breadth_first(&self, region: usize, start: u32) -> Vec<u32> {
        let mut seen = HashSet::from([start]);
        self.graph.reach(start, |next| {
            self.of[next as usize] as usize == region && seen.insert(next)
        })
    }

    /// Leaves the heaviest component of `rest`; the others touch `grown` and stay with it.
    fn keep_connected(&self, grown: &[u32], rest: &mut Vec<u32>) {
        debug_assert!(!grown.is_empty());
        let mut left: BTreeSet<u32> = rest.iter().copied().collect();
        let mut best: (u64, Vec<u32>) = (0, Vec::new());
        while let Some(start) = left.pop_first() {
            let component = self.graph.reach(start, |next| left.remove(&next));
            let weight = component.iter().map(|&a| self.weights[a as usize]).sum();
            if weight > best.0 {
                best = (weight, component);
            }
        }
        *rest = best.1;
    }
}
