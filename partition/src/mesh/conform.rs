//! Whether linear and quadratic cells meet.

use std::collections::HashMap;

use super::Mesh;
use crate::error::InputError;

impl Mesh {
    /// Checks that no edge is linear in one cell and quadratic in another: the node in its middle
    /// would hang.
    ///
    /// # Errors
    /// Two such cells, by their tags.
    pub(crate) fn check_edges(&self) -> Result<(), InputError> {
        let linear = || (0..self.cells.len()).filter(|&c| self.cells.kind(c).is_linear());
        if linear().next().is_none() || linear().count() == self.cells.len() {
            return Ok(());
        }
        let mut cell_at: HashMap<[u32; 2], usize> = HashMap::new();
        for cell in linear() {
            cell_at.extend(self.edges(cell).map(|edge| (edge, cell)));
        }
        for cell in (0..self.cells.len()).filter(|&c| !self.cells.kind(c).is_linear()) {
            for edge in self.edges(cell) {
                let Some(&other) = cell_at.get(&edge) else {
                    continue;
                };
                return Err(InputError::new(format!(
                    "elements {} ({}) and {} ({}) share an edge between the nodes {}; expected \
                     linear or quadratic elements on both of its sides",
                    self.cell_tags[other],
                    self.cells.kind(other).name(),
                    self.cell_tags[cell],
                    self.cells.kind(cell).name(),
                    self.tags_of(&edge)
                )));
            }
        }
        Ok(())
    }

    /// The ends of the edges of a cell of the plane, each pair ascending.
    fn edges(&self, cell: usize) -> impl Iterator<Item = [u32; 2]> {
        let nodes = self.cells.nodes_of(cell);
        let facets = self.cells.kind(cell).facets().iter();
        facets.map(|(_, local)| {
            let (a, b) = (nodes[local[0]], nodes[local[1]]);
            [a.min(b), a.max(b)]
        })
    }
}
