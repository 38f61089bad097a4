//! The cells of a subdomain, checked individually and against each other.

use super::ProblemFile;
use super::slice::NODE;
use super::subdomain::Slices;
use crate::element::{ElementKind, Elements};
use crate::error::InputError;
use crate::magnitude::SMALLEST_AREA;
use crate::mesh::facets::Facets;

impl ProblemFile {
    /// The cells of the subdomain with this index, on its `points`, the last of which are reference nodes.
    ///
    /// # Errors
    /// A cell that is degenerate, overlaps another one or has too few nodes, or a point without cells.
    pub(super) fn take_cells(
        &self,
        slices: &Slices,
        index: usize,
        (points, reference_nodes): (&[[f64; 3]], usize),
    ) -> Result<Elements, InputError> {
        let rows = self.contents.rows('C', index);
        let entries = self.contents.rows('K', index);
        let (types, connectivity) = (&slices.types, &slices.connectivity);
        let nodes = connectivity.indices(entries.clone(), NODE, points.len())?;
        // Each subdomain before this one has one offset more than cells.
        let first = rows.start + index;
        let offsets = slices.offsets.of(first..first + rows.len() + 1);
        let mut elements = Elements::default();
        let mut at_nodes = Vec::new();
        let mut used = vec![false; points.len()];
        let mut start = 0;
        for (cell, &code) in types.of(rows.clone()).iter().enumerate() {
            let kind = ElementKind::cell_from_vtk(code, self.catalog.dim)
                .map_err(|error| types.error(rows.start + cell, &error))?;
            let end = start + kind.nodes();
            let fits = offsets[cell..cell + 2] == [start as i64, end as i64];
            let Some(its_nodes) = nodes.get(start..end).filter(|_| fits) else {
                let what = format!(
                    "the nodes of the cell run from {} to {} of {}; expected {start} to {end}",
                    offsets[cell],
                    offsets[cell + 1],
                    nodes.len()
                );
                return Err(slices.offsets.error(first + cell, &what));
            };
            at_nodes.clear();
            at_nodes.extend(its_nodes.iter().map(|&n| points[n as usize]));
            if let Some((place, what)) = fault_of_cell(kind, its_nodes, &at_nodes) {
                let what = format!("cell {} ({}) {what}", rows.start + cell, kind.name());
                return Err(connectivity.error(entries.start + start + place, &what));
            }
            for &node in its_nodes {
                used[node as usize] = true;
            }
            elements.push(kind, its_nodes);
            start = end;
        }
        if start != nodes.len() {
            let what = format!("offset {start}; expected {}", nodes.len());
            return Err(slices.offsets.error(first + rows.len(), &what));
        }
        self.check_used(slices, index, &used, reference_nodes)?;
        if let Some((cells, what)) = fault_between_cells(&elements, points.len()) {
            let [one, other] = cells.map(|cell| cell as usize);
            let [one, other] = [one.min(other), one.max(other)];
            let row = entries.start + elements.offsets()[other];
            let [one, other] = [one, other].map(|cell| rows.start + cell);
            return Err(connectivity.error(row, &format!("the cells {one} and {other} {what}")));
        }
        Ok(elements)
    }

    /// Checks that all points are `used` by cells, except the last ones, the reference nodes.
    ///
    /// # Errors
    /// A point without cells, or a reference node with one.
    fn check_used(
        &self,
        slices: &Slices,
        index: usize,
        used: &[bool],
        reference_nodes: usize,
    ) -> Result<(), InputError> {
        let of_cells = used.len() - reference_nodes;
        if let Some(node) = used[of_cells..].iter().position(|used| *used) {
            let row = self.contents.rows('P', index).start + of_cells + node;
            let what = "the point belongs to a cell; expected one of a reference point";
            return Err(slices.points.error(row, what));
        }
        if let Some(node) = used[..of_cells].iter().position(|used| !used) {
            let row = self.contents.rows('P', index).start + node;
            return Err(slices.points.error(row, "the point belongs to no cell"));
        }
        Ok(())
    }
}

/// The error of a cell, and its node.
fn fault_of_cell(kind: ElementKind, nodes: &[u32], points: &[[f64; 3]]) -> Option<(usize, String)> {
    if let Some(twice) = (1..nodes.len()).find(|&i| nodes[..i].contains(&nodes[i])) {
        return Some((twice, "has the node twice".into()));
    }
    let size = kind.measure(points);
    if !(size > SMALLEST_AREA && size.is_finite()) {
        let what = format!("has the area {size:e}; expected a positive one (counter-clockwise)");
        return Some((0, what));
    }
    let fold = kind.fold(points, 0.0)?;
    if kind.bears_fold(points, 0.0) {
        return None;
    }
    let what = format!(
        "is folded: its Jacobian near the node is {:e}; expected a positive one everywhere",
        fold.jacobian
    );
    Some((fold.node, what))
}

/// Two incompatible cells, and the reason.
fn fault_between_cells(cells: &Elements, points: usize) -> Option<([u32; 2], &'static str)> {
    if Facets::repeat_edges(cells, points)
        && let Some(two) = Facets::new(cells, points).overlap(cells)
    {
        let what = match cells.kind(0).dim() {
            3 => {
                "lie on the same side of a face that they share; expected cells that don't overlap"
            }
            _ => {
                "lie on the same side of an edge that they share; expected cells that don't overlap"
            }
        };
        return Some((two.map(|facet| facet.cell), what));
    }
    let what = "share the ends of an edge, but not the node between them; expected the same nodes \
                on both sides";
    let facet = Facets::nonconforming(cells, points).filter(|facet| facet.hangs)?;
    Some((facet.cells, what))
}
