//! Which cells meet at a facet, and what hangs together.

use std::collections::HashMap;

use super::Mesh;

/// A facet of a cell: the cell and the facet's place in [`crate::element::ElementKind::facets`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellFacet {
    /// Cell.
    pub cell: u32,
    /// Local number of the facet.
    pub facet: u8,
}

/// The adjacency of a mesh's cells across facets.
#[derive(Clone, Debug)]
pub struct Topology {
    by_nodes: HashMap<Vec<u32>, Vec<CellFacet>>,
    neighbours: Vec<Vec<u32>>,
}

impl Topology {
    /// Finds all facets of all cells.
    pub fn new(mesh: &Mesh) -> Self {
        let mut by_nodes: HashMap<Vec<u32>, Vec<CellFacet>> =
            HashMap::with_capacity(2 * mesh.cells.len());
        for (cell, (kind, nodes)) in mesh.cells.iter().enumerate() {
            for (facet, (_, local)) in kind.facets().iter().enumerate() {
                let mut key: Vec<u32> = local.iter().map(|&i| nodes[i]).collect();
                key.sort_unstable();
                by_nodes.entry(key).or_default().push(CellFacet {
                    cell: cell as u32,
                    facet: facet as u8,
                });
            }
        }
        let mut neighbours = vec![Vec::new(); mesh.cells.len()];
        for facets in by_nodes.values() {
            for a in facets {
                for b in facets {
                    if a.cell != b.cell {
                        neighbours[a.cell as usize].push(b.cell);
                    }
                }
            }
        }
        for list in &mut neighbours {
            list.sort_unstable();
            list.dedup();
        }
        Self {
            by_nodes,
            neighbours,
        }
    }

    /// The facets of cells that have exactly these nodes, in any order.
    pub fn cells_at(&self, facet_nodes: &[u32]) -> &[CellFacet] {
        let mut key = facet_nodes.to_vec();
        key.sort_unstable();
        self.by_nodes.get(&key).map_or(&[], Vec::as_slice)
    }

    /// The cells that share a facet with `cell`, ascending.
    pub fn neighbours(&self, cell: usize) -> &[u32] {
        &self.neighbours[cell]
    }

    /// For every cell the piece of the mesh that it hangs together with across facets; pieces are
    /// numbered in the order of their first cell.
    pub fn pieces(&self) -> Vec<u32> {
        let mut piece = vec![u32::MAX; self.neighbours.len()];
        let mut count = 0;
        for seed in 0..piece.len() {
            if piece[seed] != u32::MAX {
                continue;
            }
            let mut stack = vec![seed];
            piece[seed] = count;
            while let Some(cell) = stack.pop() {
                for &next in self.neighbours(cell) {
                    if piece[next as usize] == u32::MAX {
                        piece[next as usize] = count;
                        stack.push(next as usize);
                    }
                }
            }
            count += 1;
        }
        piece
    }
}
