//! Units: what gets subdomains of its own.

use super::graph::Graph;
use super::regions::Regions;

/// The atoms of a mesh in connected sets, those of one material apart.
pub(super) struct Units<'g> {
    graph: &'g Graph,
    cells: Vec<u64>,
}

impl<'g> Units<'g> {
    /// Gets the atoms of a graph ready.
    pub fn new(graph: &'g Graph) -> Self {
        Self {
            graph,
            cells: graph.cells.iter().map(|&n| u64::from(n)).collect(),
        }
    }

    /// Number of sets that hang together across facets: the fewest subdomains that there can be.
    pub fn pieces(&self) -> usize {
        let everywhere = vec![0; self.graph.len()];
        let pieces = Regions::of_parts(self.graph, &self.cells, &everywhere);
        pieces.members().len()
    }

    /// Number of sets of one material that hang together across facets.
    pub fn of_one_material(&self) -> usize {
        self.by_material().members().len()
    }

    /// The sets to be split into `count` subdomains: those of one material where there are no
    /// more than `count`; otherwise neighbours are merged, and sets smaller than one half of a
    /// mean subdomain with them, so that grains don't unbalance a partition that mixes materials
    /// anyway.
    pub fn for_count(&self, count: usize) -> Vec<Vec<u32>> {
        let mut regions = self.by_material();
        if regions.members().len() > count {
            regions.merge_below(count, self.graph.size() / (2 * count as u64));
        }
        regions.members().to_vec()
    }

    fn by_material(&self) -> Regions<'_> {
        Regions::of_parts(self.graph, &self.cells, &self.graph.material)
    }
}
