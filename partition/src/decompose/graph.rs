//! The graph of a mesh: atoms, and the facets between them.

use crate::lists::Lists;

/// A graph of atoms.
pub(super) struct Graph {
    /// Number of cells of every atom.
    pub cells: Vec<u32>,
    /// Material of every atom, that of most of its cells.
    pub material: Vec<u32>,
    /// The contacts of every atom, ascending; empty unless it is a contact patch.
    pub contacts: Vec<Vec<u32>>,
    /// The neighbours of every atom with the weight of the facets between them.
    pub edges: Lists<(u32, u32)>,
}

impl Graph {
    /// Makes a graph of directed edges (from, (to, weight)), both directions of each given; those
    /// that occur more than once add up.
    pub fn new(
        cells: Vec<u32>,
        material: Vec<u32>,
        contacts: Vec<Vec<u32>>,
        directed: impl Iterator<Item = (u32, (u32, u32))> + Clone,
    ) -> Self {
        let mut all = Lists::new(cells.len(), directed);
        all.sort();
        let mut offsets = Vec::with_capacity(cells.len() + 1);
        let mut edges: Vec<(u32, u32)> = Vec::new();
        offsets.push(0);
        for list in all.iter() {
            for same in list.chunk_by(|a, b| a.0 == b.0) {
                edges.push((same[0].0, same.iter().map(|&(_, weight)| weight).sum()));
            }
            offsets.push(edges.len());
        }
        Self {
            cells,
            material,
            contacts,
            edges: Lists::from_offsets(offsets, edges),
        }
    }

    /// The graph of some of the atoms for each of several lists, none of which have an atom in
    /// common; an atom's number there is its place in the list.
    pub fn split(&self, lists: &[Vec<u32>]) -> Vec<Self> {
        let mut place = vec![(u32::MAX, 0); self.len()];
        for (list, atoms) in lists.iter().enumerate() {
            for (number, &atom) in atoms.iter().enumerate() {
                place[atom as usize] = (list as u32, number as u32);
            }
        }
        let part = |(list, atoms): (usize, &Vec<u32>)| {
            let mut offsets = Vec::with_capacity(atoms.len() + 1);
            let mut edges = Vec::new();
            offsets.push(0);
            for &atom in atoms {
                for &(next, weight) in self.edges(atom) {
                    if let (of, number) = place[next as usize]
                        && of as usize == list
                    {
                        edges.push((number, weight));
                    }
                }
                offsets.push(edges.len());
            }
            let of_atoms = |values: &[u32]| atoms.iter().map(|&a| values[a as usize]).collect();
            Self {
                cells: of_atoms(&self.cells),
                material: of_atoms(&self.material),
                contacts: (atoms.iter())
                    .map(|&atom| self.contacts[atom as usize].clone())
                    .collect(),
                edges: Lists::from_offsets(offsets, edges),
            }
        };
        lists.iter().enumerate().map(part).collect()
    }

    /// Number of atoms.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// The neighbours of an atom with the weight of the facets between them.
    pub fn edges(&self, atom: u32) -> &[(u32, u32)] {
        self.edges.of(atom as usize)
    }

    /// The numbers of cells as weights.
    pub fn cell_weights(&self) -> Vec<u64> {
        self.cells.iter().map(|&n| u64::from(n)).collect()
    }

    /// Number of cells.
    pub fn size(&self) -> u64 {
        self.cells.iter().map(|&n| u64::from(n)).sum()
    }

    /// Whether an atom holds nodes with contact conditions.
    pub fn is_contact_patch(&self, atom: u32) -> bool {
        !self.contacts[atom as usize].is_empty()
    }

    /// Number of contact patches.
    pub fn contact_patches(&self) -> usize {
        self.contacts.iter().filter(|list| !list.is_empty()).count()
    }
}
