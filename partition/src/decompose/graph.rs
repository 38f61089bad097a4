//! The graph of one piece: atoms, and the facets between them.

/// A connected graph of atoms.
pub(super) struct Graph {
    /// Number of cells of every atom.
    pub cells: Vec<u32>,
    /// The contacts of every atom, ascending; empty unless it is a cluster.
    pub contacts: Vec<Vec<u32>>,
    offsets: Vec<usize>,
    edges: Vec<(u32, u32)>,
}

impl Graph {
    /// Makes a graph of directed edges (from, to, weight), both directions of each given; those
    /// that occur more than once add up.
    pub fn new(
        cells: Vec<u32>,
        mut directed: Vec<(u32, u32, u32)>,
        contacts: Vec<Vec<u32>>,
    ) -> Self {
        directed.sort_unstable();
        let mut offsets = vec![0; cells.len() + 1];
        let mut edges: Vec<(u32, u32)> = Vec::with_capacity(directed.len());
        let mut last = None;
        for (from, to, weight) in directed {
            match edges.last_mut() {
                Some(edge) if last == Some((from, to)) => edge.1 += weight,
                _ => {
                    edges.push((to, weight));
                    offsets[from as usize + 1] += 1;
                }
            }
            last = Some((from, to));
        }
        for atom in 0..cells.len() {
            offsets[atom + 1] += offsets[atom];
        }
        Self {
            cells,
            contacts,
            offsets,
            edges,
        }
    }

    /// Number of atoms.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// The neighbours of an atom with the weight of the facets between them.
    pub fn edges(&self, atom: u32) -> &[(u32, u32)] {
        &self.edges[self.offsets[atom as usize]..self.offsets[atom as usize + 1]]
    }

    /// Number of cells.
    pub fn size(&self) -> u64 {
        self.cells.iter().map(|&n| u64::from(n)).sum()
    }

    /// Whether an atom holds nodes with contact conditions.
    pub fn is_cluster(&self, atom: u32) -> bool {
        !self.contacts[atom as usize].is_empty()
    }

    /// Number of clusters.
    pub fn clusters(&self) -> usize {
        self.contacts.iter().filter(|list| !list.is_empty()).count()
    }
}
