//! Regions: connected sets of vertices that are merged and divided until there are as many as wanted.

mod divide;
mod merge;

use super::graph::Graph;
use crate::disjoint_sets::DisjointSets;

/// A partition of a graph into connected regions.
pub(super) struct Regions<'g> {
    graph: &'g Graph,
    weights: &'g [u64],
    /// The region of every vertex.
    of: Vec<u32>,
    /// The vertices of every region, none empty.
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
        for vertex in 0..graph.len() as u32 {
            if regions.of[vertex as usize] != u32::MAX {
                continue;
            }
            let number = regions.members.len() as u32;
            regions.of[vertex as usize] = number;
            let members = graph.reach(vertex, |next| {
                let of = &mut regions.of[next as usize];
                let enters = *of == u32::MAX && parts[next as usize] == parts[vertex as usize];
                if enters {
                    *of = number;
                }
                enters
            });
            regions.members.push(members);
            regions.heaviness.push(regions.weigh(number as usize));
        }
        regions
    }

    /// The region of every vertex.
    pub fn parts(self) -> Vec<u32> {
        self.of
    }

    /// The vertices of every region.
    pub fn members(&self) -> &[Vec<u32>] {
        &self.members
    }

    /// Number of sets of regions that hang together across facets: the fewest subdomains that there
    /// can be.
    pub fn pieces(&self) -> usize {
        let mut sets = DisjointSets::new(self.members.len());
        for vertex in 0..self.graph.len() as u32 {
            for &(next, _) in self.graph.edges(vertex) {
                sets.unite(self.of[vertex as usize], self.of[next as usize]);
            }
        }
        let numbers = 0..self.members.len() as u32;
        numbers
            .filter(|&region| sets.find(region) == region)
            .count()
    }

    /// Merges or divides regions until there are exactly `count`, at least one and at most as many
    /// as vertices; every contact patch gets a region of its own where `count` allows.
    pub fn adjust(&mut self, count: usize) {
        if count >= self.graph.contact_patches() {
            self.separate_patches();
        }
        while self.members.len() > count && self.merge_one(u64::MAX) {}
        while self.members.len() < count && self.divide_one() {}
    }

    fn weigh(&self, region: usize) -> u64 {
        self.members[region]
            .iter()
            .map(|&vertex| self.weights[vertex as usize])
            .sum()
    }

    /// Number of contact patches of a region.
    pub fn contact_patches(&self, region: usize) -> usize {
        let members = self.members[region].iter();
        members
            .filter(|&&vertex| self.graph.is_contact_patch(vertex))
            .count()
    }

    /// Weight of the facets between regions.
    pub fn cut(&self) -> u64 {
        let across = |vertex: u32| {
            let edges = self.graph.edges(vertex).iter();
            edges
                .filter(move |&&(next, _)| self.of[next as usize] != self.of[vertex as usize])
                .map(|&(_, weight)| u64::from(weight))
        };
        (0..self.graph.len() as u32).flat_map(across).sum::<u64>() / 2
    }

    fn add(&mut self, members: Vec<u32>) {
        let number = self.members.len() as u32;
        for &vertex in &members {
            self.of[vertex as usize] = number;
        }
        self.members.push(members);
        self.heaviness.push(self.weigh(number as usize));
    }
}
