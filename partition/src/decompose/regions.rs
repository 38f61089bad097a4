//! Regions: connected sets of atoms that are merged and divided until there are as many as wanted.

use std::collections::{BTreeMap, VecDeque};

use super::graph::Graph;

/// A partition of a graph into connected regions.
pub(super) struct Regions<'g> {
    graph: &'g Graph,
    weights: &'g [u64],
    /// The region of every atom.
    of: Vec<u32>,
    /// The atoms of every region, none empty.
    members: Vec<Vec<u32>>,
    /// The weight of every region.
    heaviness: Vec<u64>,
}

impl<'g> Regions<'g> {
    /// The connected components of the parts of a partition.
    pub fn of_parts(graph: &'g Graph, weights: &'g [u64], parts: &[u32]) -> Self {
        let mut regions = Self {
            graph,
            weights,
            of: vec![u32::MAX; graph.len()],
            members: Vec::new(),
            heaviness: Vec::new(),
        };
        for atom in 0..graph.len() as u32 {
            if regions.of[atom as usize] != u32::MAX {
                continue;
            }
            let number = regions.members.len() as u32;
            regions.of[atom as usize] = number;
            let mut members = vec![atom];
            let mut at = 0;
            while at < members.len() {
                let from = members[at];
                for &(next, _) in graph.edges(from) {
                    if regions.of[next as usize] == u32::MAX
                        && parts[next as usize] == parts[from as usize]
                    {
                        regions.of[next as usize] = number;
                        members.push(next);
                    }
                }
                at += 1;
            }
            regions.members.push(members);
            regions.heaviness.push(regions.weigh(number as usize));
        }
        regions
    }

    /// The region of every atom.
    pub fn parts(self) -> Vec<u32> {
        self.of
    }

    /// The atoms of every region.
    pub fn members(&self) -> &[Vec<u32>] {
        &self.members
    }

    /// Merges or divides regions until there are exactly `count`, at least one and at most as many
    /// as atoms; every cluster gets a region of its own where `count` allows.
    pub fn adjust(&mut self, count: usize) {
        if count >= self.graph.clusters() {
            self.separate_clusters();
        }
        while self.members.len() > count && self.merge_one() {}
        while self.members.len() < count && self.divide_one() {}
    }

    fn weigh(&self, region: usize) -> u64 {
        self.members[region]
            .iter()
            .map(|&atom| self.weights[atom as usize])
            .sum()
    }

    /// Number of clusters of a region.
    pub fn clusters(&self, region: usize) -> usize {
        let members = self.members[region].iter();
        members.filter(|&&atom| self.graph.is_cluster(atom)).count()
    }

    /// Weight of the facets between regions.
    pub fn cut(&self) -> u64 {
        let across = |atom: u32| {
            let edges = self.graph.edges(atom).iter();
            edges
                .filter(move |&&(next, _)| self.of[next as usize] != self.of[atom as usize])
                .map(|&(_, weight)| u64::from(weight))
        };
        (0..self.graph.len() as u32).flat_map(across).sum::<u64>() / 2
    }

    /// Divides every region with several clusters among them.
    fn separate_clusters(&mut self) {
        for region in 0..self.members.len() {
            let seeds: Vec<u32> = self.members[region]
                .iter()
                .copied()
                .filter(|&atom| self.graph.is_cluster(atom))
                .collect();
            if seeds.len() > 1 {
                self.divide(region, &seeds);
            }
        }
    }

    /// Gives each atom of a region to the seed from which a breadth-first search reaches it first;
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
        while let Some((atom, number)) = queue.pop_front() {
            members[number].push(atom);
            for &(next, _) in self.graph.edges(atom) {
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

    fn add(&mut self, members: Vec<u32>) {
        let number = self.members.len() as u32;
        for &atom in &members {
            self.of[atom as usize] = number;
        }
        self.members.push(members);
        self.heaviness.push(self.weigh(number as usize));
    }

    /// Merges the lightest region that can be merged without bringing clusters together with a
    /// neighbour; if there is none, the one where that does least harm.
    fn merge_one(&mut self) -> bool {
        let mut order: Vec<(u64, usize)> = (0..self.members.len())
            .map(|region| (self.heaviness[region], region))
            .collect();
        order.sort_unstable();
        let mut best: Option<(u32, usize, usize)> = None;
        for (_, region) in order {
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
        let (keep, drop) = (a.min(b), a.max(b));
        let moved = self.members.swap_remove(drop);
        self.heaviness[keep] += self.heaviness.swap_remove(drop);
        if let Some(renamed) = self.members.get(drop) {
            for &atom in renamed {
                self.of[atom as usize] = drop as u32;
            }
        }
        for &atom in &moved {
            self.of[atom as usize] = keep as u32;
        }
        self.members[keep].extend(moved);
        true
    }

    /// The neighbour with the least conflict and, among those, the longest common boundary.
    fn best_neighbour(&self, region: usize) -> Option<(u32, usize)> {
        let mut boundary: BTreeMap<u32, u64> = BTreeMap::new();
        for &atom in &self.members[region] {
            for &(next, weight) in self.graph.edges(atom) {
                let other = self.of[next as usize];
                if other as usize != region {
                    *boundary.entry(other).or_default() += u64::from(weight);
                }
            }
        }
        boundary
            .into_iter()
            .map(|(other, length)| {
                let other = other as usize;
                (
                    self.conflict(region, other),
                    std::cmp::Reverse(length),
                    other,
                )
            })
            .min()
            .map(|(conflict, _, other)| (conflict, other))
    }

    /// 0: not both have clusters; 1: clusters of the same contacts; 2: of different ones.
    fn conflict(&self, a: usize, b: usize) -> u32 {
        let contacts = |region: usize| {
            let mut all: Vec<u32> = self.members[region]
                .iter()
                .flat_map(|&atom| &self.graph.contacts[atom as usize])
                .copied()
                .collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let (a, b) = (contacts(a), contacts(b));
        match (a.is_empty() || b.is_empty(), a == b) {
            (true, _) => 0,
            (_, true) => 1,
            (_, false) => 2,
        }
    }

    /// Divides the heaviest region of two or more atoms into two of like weight.
    fn divide_one(&mut self) -> bool {
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
            // Taking the next atom must bring the sum nearer to one half.
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
        self.members[region].retain(|&atom| of[atom as usize] as usize == region);
        self.heaviness[region] = self.weigh(region);
        true
    }

    /// The atoms of a region, breadth-first from one that lies at its outside.
    fn outside_in(&self, region: usize) -> Vec<u32> {
        let first = self.breadth_first(region, self.members[region][0]);
        let far = first.last().copied().unwrap_or(self.members[region][0]);
        self.breadth_first(region, far)
    }

    fn breadth_first(&self, region: usize, start: u32) -> Vec<u32> {
        let mut order = vec![start];
        let mut seen = std::collections::HashSet::from([start]);
        let mut at = 0;
        while at < order.len() {
            for &(next, _) in self.graph.edges(order[at]) {
                if self.of[next as usize] as usize == region && seen.insert(next) {
                    order.push(next);
                }
            }
            at += 1;
        }
        order
    }

    /// Leaves the heaviest component of `rest`; the others touch `grown` and stay with it.
    fn keep_connected(&self, grown: &[u32], rest: &mut Vec<u32>) {
        debug_assert!(!grown.is_empty());
        let mut left: std::collections::BTreeSet<u32> = rest.iter().copied().collect();
        let mut best: (u64, Vec<u32>) = (0, Vec::new());
        while let Some(start) = left.pop_first() {
            let mut component = vec![start];
            let mut at = 0;
            while at < component.len() {
                for (next, _) in self.graph.edges(component[at]) {
                    if left.remove(next) {
                        component.push(*next);
                    }
                }
                at += 1;
            }
            let weight = component.iter().map(|&a| self.weights[a as usize]).sum();
            if weight > best.0 {
                best = (weight, component);
            }
        }
        *rest = best.1;
    }
}
