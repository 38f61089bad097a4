//! Regions: connected sets of atoms that are merged and divided until there are as many as wanted.

mod divide;
mod merge;

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

    /// The region of an atom.
    pub fn region(&self, atom: u32) -> u32 {
        self.of[atom as usize]
    }

    /// The atoms of every region.
    pub fn into_members(self) -> Vec<Vec<u32>> {
        self.members
    }

    /// Merges or divides regions until there are exactly `count`, at least one and at most as many
    /// as atoms; every contact patch gets a region of its own where `count` allows.
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
            .map(|&atom| self.weights[atom as usize])
            .sum()
    }

    /// Number of contact patches of a region.
    pub fn contact_patches(&self, region: usize) -> usize {
        let members = self.members[region].iter();
        members
            .filter(|&&atom| self.graph.is_contact_patch(atom))
            .count()
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

    fn add(&mut self, members: Vec<u32>) {
        let number = self.members.len() as u32;
        for &atom in &members {
            self.of[atom as usize] = number;
        }
        self.members.push(members);
        self.heaviness.push(self.weigh(number as usize));
    }
}
