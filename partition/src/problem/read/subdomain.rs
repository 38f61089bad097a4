//! The slice of one subdomain.

use std::collections::HashSet;
use std::ops::Range;

use super::ProblemFile;
use crate::element::{ElementKind, Elements};
use crate::error::InputError;
use crate::model::Support;
use crate::problem::{InterfaceNode, Subdomain, UNIT_TOLERANCE};

impl ProblemFile {
    pub(super) fn read_subdomain(&self, index: usize) -> Result<Subdomain, InputError> {
        let Some(summary) = self.catalog.subdomains.get(index) else {
            return Err(InputError::new(format!("there is no subdomain {index}")));
        };
        let nodes = slice(&self.offsets.points, index);
        let cells = slice(&self.offsets.cells, index);
        let points = self.read_points(nodes.clone())?;
        let elements = self.read_cells(index, &points)?;
        Ok(Subdomain {
            index,
            body: summary.body,
            node_tags: self.read_node_tags(nodes)?,
            cell_material: self.column("/VTKHDF/CellData/Material")?.indices(
                cells,
                self.catalog.materials.len(),
                "material",
            )?,
            supports: self.read_supports(index, points.len())?,
            forces: self.read_forces(index, points.len())?,
            interface: self.read_interface(index, points.len())?,
            points,
            cells: elements,
        })
    }

    fn read_points(&self, rows: Range<usize>) -> Result<Vec<[f64; 3]>, InputError> {
        let dataset = self.table("/VTKHDF/Points", 3)?;
        let start = rows.start;
        let points = dataset.vectors(rows, 3)?;
        let dim = self.catalog.dim;
        match points
            .iter()
            .position(|p| p[dim..].iter().any(|&x| x != 0.0))
        {
            Some(row) => Err(dataset.row_error(
                start + row,
                &format!("expected 0 beyond the first {dim} coordinates"),
            )),
            None => Ok(points),
        }
    }

    fn read_node_tags(&self, rows: Range<usize>) -> Result<Vec<i64>, InputError> {
        let dataset = self.column("/VTKHDF/PointData/GlobalNodeId")?;
        let start = rows.start;
        let tags = dataset.integers(rows)?;
        let mut seen = HashSet::with_capacity(tags.len());
        match tags.iter().position(|&tag| tag < 0 || !seen.insert(tag)) {
            Some(row) => Err(dataset.row_error(
                start + row,
                &format!(
                    "tag {}; expected tags ≥ 0, each once in a subdomain",
                    tags[row]
                ),
            )),
            None => Ok(tags),
        }
    }

    fn read_cells(&self, index: usize, points: &[[f64; 3]]) -> Result<Elements, InputError> {
        let rows = slice(&self.offsets.cells, index);
        let entries = slice(&self.offsets.connectivity, index);
        let types = self.column("/VTKHDF/Types")?;
        let connectivity = self.column("/VTKHDF/Connectivity")?;
        let nodes = connectivity.indices(entries.clone(), points.len(), "node of its subdomain")?;
        let table = self.column("/VTKHDF/Offsets")?;
        // Each of the subdomains before this one has an offset more than cells.
        let first = rows.start + index;
        let offsets = table.integers(first..first + rows.len() + 1)?;
        let mut elements = Elements::default();
        let mut used = vec![false; points.len()];
        let mut at = 0;
        for (cell, code) in types.integers(rows.clone())?.into_iter().enumerate() {
            let kind = u8::try_from(code)
                .ok()
                .and_then(|code| ElementKind::from_vtk(code).ok())
                .filter(|kind| kind.dim() == self.catalog.dim)
                .ok_or_else(|| {
                    types.row_error(
                        rows.start + cell,
                        &format!("VTK cell type {code}; expected 5 (triangle of 3 nodes)"),
                    )
                })?;
            let end = at + kind.nodes();
            if offsets[cell] != at as i64 || offsets[cell + 1] != end as i64 {
                return Err(table.row_error(
                    first + cell,
                    &format!(
                        "the nodes of the cell run from {} to {}; expected {at} to {end}",
                        offsets[cell],
                        offsets[cell + 1]
                    ),
                ));
            }
            let Some(corners) = nodes.get(at..end) else {
                return Err(table.row_error(
                    first + cell + 1,
                    &format!("offset {end}; expected at most {}", nodes.len()),
                ));
            };
            let at_corners: Vec<_> = corners.iter().map(|&n| points[n as usize]).collect();
            let size = kind.measure(&at_corners);
            if !(size > 0.0 && size.is_finite()) {
                return Err(connectivity.row_error(
                    entries.start + at,
                    &format!(
                        "cell {} has the area {size:e}; expected a positive one (counter-clockwise)",
                        rows.start + cell
                    ),
                ));
            }
            for &node in corners {
                used[node as usize] = true;
            }
            elements.push(kind, corners);
            at = end;
        }
        if at != nodes.len() {
            return Err(table.row_error(
                first + rows.len(),
                &format!("offset {at}; expected {}", nodes.len()),
            ));
        }
        match used.iter().position(|used| !used) {
            Some(node) => Err(InputError::new(format!(
                "dataset /VTKHDF/Points, row {}: the point belongs to no cell",
                self.offsets.points[index] + node
            ))),
            None => Ok(elements),
        }
    }

    fn read_supports(&self, index: usize, nodes: usize) -> Result<Vec<Support>, InputError> {
        let rows = slice(&self.offsets.supports, index);
        if rows.is_empty() {
            return Ok(Vec::new());
        }
        let dim = self.catalog.dim;
        let node = self.column("/support/node")?;
        let direction = self.table("/support/direction", dim)?;
        let value = self.column("/support/value")?;
        let total = node.rows();
        let (direction, value) = (
            direction.shaped(Some(total), &[dim])?,
            value.shaped(Some(total), &[])?,
        );
        let nodes_of = node.indices(rows.clone(), nodes, "node of its subdomain")?;
        let directions = direction.unit_vectors(rows.clone(), dim)?;
        let values = value.floats(rows.clone())?;
        let mut supports: Vec<Support> = Vec::with_capacity(rows.len());
        for ((at, &node_of), (&d, &value)) in nodes_of
            .iter()
            .enumerate()
            .zip(directions.iter().zip(&values))
        {
            for before in supports.iter().rev().take_while(|s| s.node >= node_of) {
                if before.node > node_of {
                    return Err(
                        node.row_error(rows.start + at, "expected nodes in ascending order")
                    );
                }
                let product: f64 = (0..dim).map(|i| before.direction[i] * d[i]).sum();
                if product.abs() > UNIT_TOLERANCE {
                    return Err(direction.row_error(
                        rows.start + at,
                        "expected the directions at a node to be orthogonal",
                    ));
                }
            }
            supports.push(Support {
                node: node_of,
                direction: d,
                value,
            });
        }
        Ok(supports)
    }

    fn read_forces(&self, index: usize, nodes: usize) -> Result<Vec<(u32, [f64; 3])>, InputError> {
        let rows = slice(&self.offsets.forces, index);
        if rows.is_empty() {
            return Ok(Vec::new());
        }
        let dim = self.catalog.dim;
        let node = self.column("/force/node")?;
        let value = self
            .table("/force/value", dim)?
            .shaped(Some(node.rows()), &[dim])?;
        let nodes_of = node.indices(rows.clone(), nodes, "node of its subdomain")?;
        if let Some(at) = nodes_of.windows(2).position(|w| w[0] >= w[1]) {
            return Err(node.row_error(
                rows.start + at + 1,
                "expected the nodes of a subdomain in strictly ascending order",
            ));
        }
        Ok(nodes_of
            .into_iter()
            .zip(value.vectors(rows, dim)?)
            .collect())
    }

    pub(super) fn read_interface(
        &self,
        index: usize,
        nodes: usize,
    ) -> Result<Vec<InterfaceNode>, InputError> {
        let rows = slice(&self.offsets.interface, index);
        if rows.is_empty() {
            return Ok(Vec::new());
        }
        let node = self.column("/interface/node")?;
        let nodes_of = node.indices(rows.clone(), nodes, "node of its subdomain")?;
        let mut seen = HashSet::with_capacity(nodes_of.len());
        if let Some(at) = nodes_of.iter().position(|n| !seen.insert(n)) {
            return Err(node.row_error(rows.start + at, "the node was named before"));
        }
        Ok(nodes_of
            .into_iter()
            .zip(&self.catalog.interface[index])
            .map(|(node, &interface)| InterfaceNode { node, interface })
            .collect())
    }
}

/// The rows of entry `index` in a table of offsets.
pub(super) fn slice(offsets: &[usize], index: usize) -> Range<usize> {
    offsets[index]..offsets[index + 1]
}
