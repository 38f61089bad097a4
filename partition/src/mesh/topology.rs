//! Adjacency across facets, and connected components.

use super::Mesh;
pub use super::facets::CellFacet;
use super::facets::{Facets, identifying_nodes, key};
use crate::error::InputError;
use crate::lists::Lists;

impl Mesh {
    /// Checks that no cell's edge has a hanging middle node. Returns a warning of an edge on which each cell has a
    /// separate middle node.
    ///
    /// # Errors
    /// Two such cells, by their tags: for example a linear cell next to a quadratic one.
    pub(crate) fn check_edges(&self) -> Result<Option<String>, InputError> {
        let Some(facet) = Facets::nonconforming(&self.cells, self.points.len()) else {
            return Ok(None);
        };
        let tags = self.tags_of(&facet.corners);
        let what = match facet.corners.len() {
            2 => "an edge between",
            _ => "a face of",
        };
        if !facet.hangs {
            let [a, b] = facet.cells.map(|cell| self.cell_tags[cell as usize]);
            return Ok(Some(format!(
                "elements {a} and {b} share {what} the nodes {tags}, but each has a node of its own in its middle: it \
                 opens there, which is right at the front of a crack alone"
            )));
        }
        let [a, b] = facet.cells.map(|cell| cell as usize);
        let [a_name, b_name] = [a, b].map(|cell| self.cells.kind(cell).name());
        Err(InputError::new(format!(
            "elements {} ({a_name}) and {} ({b_name}) share {what} the nodes {tags}, but not the \
             node in its middle; expected linear or quadratic elements on both of its sides, of the same \
             nodes",
            self.cell_tags[a], self.cell_tags[b],
        )))
    }
}

/// The adjacency of a mesh's cells across facets.
#[derive(Clone, Debug, PartialEq)]
pub struct Topology {
    facets: Facets,
    neighbours: Lists<u32>,
}

impl Topology {
    /// Finds all facets of all cells.
    pub fn new(mesh: &Mesh) -> Self {
        let facets = Facets::new(&mesh.cells, mesh.points.len());
        let pairs = facets.places().flat_map(|same| {
            let others = move |a: u32| same.iter().map(move |b| (a, b.facet.cell));
            same.iter().flat_map(move |a| others(a.facet.cell))
        });
        let mut neighbours = Lists::new(mesh.cells.len(), pairs.filter(|(a, b)| a != b));
        neighbours.sort();
        neighbours.dedup();
        Self { facets, neighbours }
    }

    /// Checks that cells share whole facets, and that no two cells lie on the same side of a facet.
    ///
    /// # Errors
    /// Two cells that violate this, by their tags.
    pub fn check_sides(&self, mesh: &Mesh) -> Result<(), InputError> {
        if let Some([a, b]) = self.facets.halved(&mesh.cells) {
            return Err(InputError::new(format!(
                "element {} has the nodes {} of a face of element {} for a face of its own; expected cells of one \
                 body to share whole faces: tetrahedra and hexahedra of different bodies meet in a contact, with \
                 nodes of their own",
                mesh.cell_tags[b.cell as usize],
                mesh.tags_of(&b.nodes(&mesh.cells)),
                mesh.cell_tags[a.cell as usize],
            )));
        }
        let Some([a, b]) = self.facets.overlap(&mesh.cells) else {
            return Ok(());
        };
        Err(InputError::new(format!(
            "elements {} and {} lie on the same side of the {} of nodes {} that they share; \
             expected cells that don't overlap (is one of them inside out?)",
            mesh.cell_tags[a.cell as usize],
            mesh.cell_tags[b.cell as usize],
            if mesh.dim == 3 { "face" } else { "edge" },
            mesh.tags_of(&a.nodes(&mesh.cells))
        )))
    }

    /// The facets of cells with exactly these nodes, in any order, or in space with these corners; where facets with
    /// these corners differ in their inner nodes, those that agree in all nodes.
    pub fn cells_at(&self, facet_nodes: &[u32]) -> Vec<CellFacet> {
        let found = self
            .facets
            .of(key(identifying_nodes(facet_nodes).iter().copied()));
        let has = |facet: &CellFacet| {
            let nodes = self.facets.nodes.get(facet);
            nodes.is_none_or(|nodes| facet_nodes.iter().all(|node| nodes.contains(node)))
        };
        found.iter().map(|entry| entry.facet).filter(has).collect()
    }

    /// The boundary facets, which belong to a single cell, in the order of their nodes.
    pub fn boundary(&self) -> impl Iterator<Item = CellFacet> + Clone {
        self.facets.places().filter_map(|same| match same {
            [one] => Some(one.facet),
            _ => None,
        })
    }

    /// The cells that share a facet with `cell`, ascending.
    pub fn neighbours(&self, cell: usize) -> &[u32] {
        self.neighbours.of(cell)
    }

    /// Number of pairs of cells that share a facet, counted for every facet.
    pub fn pairs(&self) -> usize {
        self.neighbours.items()
    }

    /// Connected component of every cell, across facets; components are numbered in the order of their first cell.
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
