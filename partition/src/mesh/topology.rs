//! Which cells meet at a facet, and what hangs together.

use super::Mesh;
use crate::lists::Lists;

/// Nodes that tell facets apart: those beyond lie between them.
const CORNERS: usize = 4;

/// The smallest nodes of a facet, ascending.
type Key = [u32; CORNERS];

/// A facet of a cell: the cell and the facet's place in [`crate::element::ElementKind::facets`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct CellFacet {
    /// Cell.
    pub cell: u32,
    /// Local number of the facet.
    pub facet: u8,
}

/// The adjacency of a mesh's cells across facets.
#[derive(Clone, Debug)]
pub struct Topology {
    /// The facets of all cells by their smallest node; those of the same nodes beside each other.
    facets: Lists<(Key, CellFacet)>,
    neighbours: Lists<u32>,
}

impl Topology {
    /// Finds all facets of all cells.
    pub fn new(mesh: &Mesh) -> Self {
        let all = mesh
            .cells
            .iter()
            .enumerate()
            .flat_map(|(cell, (kind, nodes))| {
                let facets = kind.facets().iter().enumerate();
                facets.map(move |(facet, (_, local))| {
                    let key = key(local.iter().map(|&i| nodes[i]));
                    let cell = cell as u32;
                    let facet = facet as u8;
                    (key[0], (key, CellFacet { cell, facet }))
                })
            });
        let mut facets = Lists::new(mesh.points.len(), all);
        facets.sort();
        let same = facets
            .iter()
            .flat_map(|list| list.chunk_by(|a, b| a.0 == b.0));
        let pairs = same.flat_map(|same| {
            let others = move |a: u32| same.iter().map(move |(_, b)| (a, b.cell));
            same.iter().flat_map(move |(_, a)| others(a.cell))
        });
        let mut neighbours = Lists::new(mesh.cells.len(), pairs.filter(|(a, b)| a != b));
        neighbours.sort();
        neighbours.dedup();
        Self { facets, neighbours }
    }

    /// The facets of cells that have exactly these nodes, in any order.
    pub fn cells_at(&self, facet_nodes: &[u32]) -> Vec<CellFacet> {
        let key = key(facet_nodes.iter().copied());
        let list = match key[0] as usize {
            node if node < self.facets.len() => self.facets.of(node),
            _ => &[],
        };
        let start = list.partition_point(|(other, _)| *other < key);
        let same = list[start..].partition_point(|(other, _)| *other == key);
        let found = list[start..start + same].iter();
        found.map(|&(_, facet)| facet).collect()
    }

    /// The cells that share a facet with `cell`, ascending.
    pub fn neighbours(&self, cell: usize) -> &[u32] {
        self.neighbours.of(cell)
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

fn key(nodes: impl Iterator<Item = u32>) -> Key {
    let mut key = [u32::MAX; CORNERS];
    for mut node in nodes {
        // Each node goes where it belongs and pushes the larger ones on.
        for place in &mut key {
            if node < *place {
                std::mem::swap(place, &mut node);
            }
        }
    }
    key
}
