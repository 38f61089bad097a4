//! Measures of cells: areas in the plane, and which way round a cell's nodes run.

use super::Mesh;
use crate::element::ElementKind;
use crate::error::InputError;

/// Measure over the square (in space: the cube) of the largest edge below which a cell is flat.
const FLAT: f64 = 1e-13;

impl Mesh {
    /// Signed measure of a cell, in m²: negative where its nodes run clockwise.
    pub fn measure(&self, cell: usize) -> f64 {
        let nodes = self.cells.nodes_of(cell);
        match self.cells.kind(cell) {
            ElementKind::Point1 | ElementKind::Line2 => 0.0,
            ElementKind::Triangle3 => {
                let [a, b, c] = [0, 1, 2].map(|i| self.points[nodes[i] as usize]);
                0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]))
            }
        }
    }

    /// Turns cells of negative measure over.
    ///
    /// # Errors
    /// A cell without measure, by its tag.
    pub(crate) fn orient_cells(&mut self) -> Result<(), InputError> {
        for cell in 0..self.cells.len() {
            let measure = self.measure(cell);
            let size = self.longest_edge(cell).powi(self.dim as i32);
            if measure.is_nan() || measure.abs() <= FLAT * size {
                return Err(InputError::new(format!(
                    "element {} has no area: its nodes {} lie on one line",
                    self.cell_tags[cell],
                    self.tags_of(cell)
                )));
            }
            if measure < 0.0 {
                let order = self.cells.kind(cell).reversed();
                let old = self.cells.nodes_of(cell).to_vec();
                for (node, &from) in self.cells.nodes_of_mut(cell).iter_mut().zip(order) {
                    *node = old[from];
                }
            }
        }
        Ok(())
    }

    fn longest_edge(&self, cell: usize) -> f64 {
        let nodes = self.cells.nodes_of(cell);
        let mut longest: f64 = 0.0;
        for (i, &a) in nodes.iter().enumerate() {
            for &b in &nodes[..i] {
                let (a, b) = (self.points[a as usize], self.points[b as usize]);
                let squared: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
                longest = longest.max(squared.sqrt());
            }
        }
        longest
    }

    fn tags_of(&self, cell: usize) -> String {
        let nodes = self.cells.nodes_of(cell).iter();
        let tags: Vec<String> = nodes
            .map(|&n| self.node_tags[n as usize].to_string())
            .collect();
        tags.join(", ")
    }
}
