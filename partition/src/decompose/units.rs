//! Units: what gets subdomains of its own.

use super::graph::Graph;
use super::regions::Regions;
use crate::disjoint_sets::DisjointSets;

/// The atoms of a mesh in connected sets, those of one material apart.
pub(super) struct Units<'g> {
    graph: &'g Graph,
    of_one_material: Regions<'g>,
}

impl<'g> Units<'g> {
    /// Finds the sets of a graph whose atoms have these numbers of cells.
    pub fn new(graph: &'g Graph, cells: &'g [u64]) -> Self {
        Self {
            graph,
            of_one_material: Regions::of_parts(graph, cells, &graph.material),
        }
    }

    /// Number of sets that hang together across facets: the fewest subdomains that there can be.
    pub fn pieces(&self) -> usize {
        let regions = &self.of_one_material;
        let mut sets = DisjointSets::new(regions.members().len());
        for atom in 0..self.graph.len() as u32 {
            for &(next, _) in self.graph.edges(atom) {
                sets.unite(regions.region(atom), regions.region(next));
            }
        }
        let numbers = 0..regions.members().len() as u32;
        numbers
            .filter(|&region| sets.find(region) == region)
            .count()
    }

    /// Number of sets of one material that hang together across facets.
    pub fn of_one_material(&self) -> usize {
        self.of_one_material.members().len()
    }

    /// The sets to be split into `count` subdomains: those of one material where there are no
    /// more than `count`; otherwise neighbours are merged, and sets smaller than one half of a
    /// mean subdomain with them, so that grains don't unbalance a partition that mixes materials
    /// anyway.
    pub fn for_count(self, count: usize) -> Vec<Vec<u32>> {
        let mut regions = self.of_one_material;
        if regions.members().len() > count {
            regions.merge_below(count, self.graph.size() / (2 * count as u64));
        }
        regions.into_members()
    }
}
