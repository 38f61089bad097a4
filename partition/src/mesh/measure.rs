//! Measures of cells, areas or volumes, and the orientation of cells.

use super::Mesh;
use crate::element::geometry::{difference, length, shown};
use crate::error::InputError;
use crate::magnitude::SMALLEST_AREA;

/// Measure over the square (in space: the cube) of the largest edge below which a cell is degenerate.
const FLAT: f64 = 1e-13;

/// Range of z, relative to the extent of the mesh, up to which z is constant.
const PLANE: f64 = 1e-9;

impl Mesh {
    /// Signed measure of a cell (m², m³): negative for reversed node order.
    pub fn measure(&self, cell: usize) -> f64 {
        let nodes = self.cells.nodes_of(cell).iter();
        let at: Vec<_> = nodes.map(|&n| self.points[n as usize]).collect();
        self.cells.kind(cell).measure(&at)
    }

    /// Reverses cells of negative measure.
    ///
    /// # Errors
    /// A degenerate cell, or one whose Jacobian isn't positive everywhere, by its tag.
    pub(crate) fn orient_cells(&mut self) -> Result<(), InputError> {
        let mut at = Vec::new();
        let mut borne = Vec::new();
        for cell in 0..self.cells.len() {
            self.points_of(cell, &mut at);
            let measure = self.cells.kind(cell).measure(&at);
            let size = longest_edge(&at).powi(self.dim as i32);
            if measure.is_nan() || measure.abs() <= (FLAT * size).max(SMALLEST_AREA) {
                let (missing, place) = match self.dim {
                    3 => ("volume", "in one plane"),
                    _ => ("area", "on one line"),
                };
                return Err(InputError::new(format!(
                    "element {} has no {missing}: its nodes {} lie {place}",
                    self.cell_tags[cell],
                    self.tags_of(self.cells.nodes_of(cell))
                )));
            }
            if measure < 0.0 {
                let order = self.cells.kind(cell).reversed();
                let old = self.cells.nodes_of(cell).to_vec();
                for (node, &from) in self.cells.nodes_of_mut(cell).iter_mut().zip(order) {
                    *node = old[from];
                }
                self.points_of(cell, &mut at);
            }
            borne.extend(self.check_jacobian(cell, &at, FLAT * size)?);
        }
        if let Some(first) = borne.first() {
            let cells = match borne.len() {
                1 => String::new(),
                count => format!(", one of {count} such"),
            };
            self.warnings.push(format!(
                "{first}{cells}: it is used all the same, as its Jacobian is positive at all points of integration; \
                 stresses there are less exact"
            ));
        }
        Ok(())
    }

    /// Replaces the content of `at` by the points of a cell's nodes.
    fn points_of(&self, cell: usize, at: &mut Vec<[f64; 3]>) {
        let nodes = self.cells.nodes_of(cell).iter();
        at.clear();
        at.extend(nodes.map(|&n| self.points[n as usize]));
    }

    /// Checks that the Jacobian of a cell, whose nodes are `at` these points, is above `floor` everywhere; if it isn't
    /// but the cell is acceptable, returns a warning.
    fn check_jacobian(
        &self,
        cell: usize,
        at: &[[f64; 3]],
        floor: f64,
    ) -> Result<Option<String>, InputError> {
        let (kind, nodes) = (self.cells.kind(cell), self.cells.nodes_of(cell));
        let Some(fold) = kind.fold(at, floor) else {
            return Ok(None);
        };
        let found = format!(
            "element {} ({}) is folded: its Jacobian is {:e} at {}, near node {}",
            self.cell_tags[cell],
            kind.name(),
            fold.jacobian,
            shown(fold.position, self.dim),
            self.node_tags[nodes[fold.node] as usize]
        );
        match kind.bears_fold(at, floor) {
            true => Ok(Some(found)),
            false => Err(InputError::new(match collapsed(at) {
                Some(both) => {
                    let [a, b] = both.map(|i| self.node_tags[nodes[i] as usize]);
                    let why = match a == b {
                        true => format!("it has the node {a} twice"),
                        false => format!("its nodes {a} and {b} are at one place"),
                    };
                    format!(
                        "{found}: {why}; expected nodes that all differ, or triangles or tetrahedra in its place"
                    )
                }
                None => format!(
                    "{found}; expected a positive one everywhere (corners below 180°, nodes on edges near their middle)"
                ),
            })),
        }
    }

    /// Sets the components beyond the mesh's dimension to zero.
    ///
    /// # Errors
    /// A node outside the plane of the others.
    pub(super) fn flatten(&mut self) -> Result<(), InputError> {
        let first = self.points[0];
        let mut extent: f64 = 0.0;
        for point in &self.points {
            for (a, b) in point.iter().zip(first) {
                extent = extent.max((a - b).abs());
            }
        }
        for (point, tag) in self.points.iter_mut().zip(&self.node_tags) {
            for component in self.dim..point.len() {
                if (point[component] - first[component]).abs() > PLANE * extent {
                    return Err(InputError::new(format!(
                        "node {tag} has z = {}, node {} has z = {}: a mesh of plane cells has to lie in \
                         a plane of constant z",
                        point[component], self.node_tags[0], first[component]
                    )));
                }
                point[component] = 0.0;
            }
        }
        Ok(())
    }
}

/// Two coincident points.
fn collapsed(at: &[[f64; 3]]) -> Option<[usize; 2]> {
    (1..at.len()).find_map(|b| Some([at[..b].iter().position(|a| *a == at[b])?, b]))
}

fn longest_edge(at: &[[f64; 3]]) -> f64 {
    let mut longest: f64 = 0.0;
    for (i, &a) in at.iter().enumerate() {
        for &b in &at[..i] {
            longest = longest.max(length(difference(a, b)));
        }
    }
    longest
}
