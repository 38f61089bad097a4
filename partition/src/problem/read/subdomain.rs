//! The slice of one subdomain.

use std::collections::HashSet;
use std::ops::Range;

use super::ProblemFile;
use super::slabs::Slabs;
use crate::element::geometry::padded;
use crate::element::{ElementKind, Elements};
use crate::error::InputError;
use crate::magnitude::SMALLEST_AREA;
use crate::mesh::topology::{CellFacet, Facets};
use crate::model::Support;
use crate::problem::slab::Slab;
use crate::problem::{InterfaceNode, StepLoads, Subdomain, UNIT_TOLERANCE};

impl ProblemFile {
    pub(super) fn read_subdomains(
        &self,
        range: Range<usize>,
    ) -> Result<Vec<Subdomain>, InputError> {
        let count = self.catalog.subdomains.len();
        if range.end > count && !range.is_empty() {
            let missing = range.start.max(count);
            return Err(InputError::new(format!("there is no subdomain {missing}")));
        }
        if range.is_empty() {
            return Ok(Vec::new());
        }
        let slabs = Slabs::read(self, range.clone())?;
        range.map(|index| self.take(&slabs, index)).collect()
    }

    fn take(&self, slabs: &Slabs, index: usize) -> Result<Subdomain, InputError> {
        let nodes = slice(&self.offsets.points, index);
        let points = self.take_points(slabs, nodes.clone())?;
        let elements = self.take_cells(slabs, index, &points)?;
        Ok(Subdomain {
            index,
            body: self.catalog.subdomains[index].body,
            node_tags: take_node_tags(slabs, nodes)?,
            cell_material: slabs.materials.indices(
                slice(&self.offsets.cells, index),
                self.catalog.materials.len(),
                "material",
            )?,
            supports: self.take_supports(slabs, index, points.len())?,
            forces: self.take_forces(slabs, index, points.len())?,
            interface: self.take_interface(slabs.interface.as_ref(), index)?,
            steps: self.take_steps(slabs, index),
            points,
            cells: elements,
        })
    }

    fn take_steps(&self, slabs: &Slabs, index: usize) -> Vec<StepLoads> {
        let (dim, steps) = (self.catalog.dim, self.catalog.steps.len());
        let rows = |slab: Option<&Slab<f64>>, offsets| -> Vec<f64> {
            slab.map_or_else(Vec::new, |slab| slab.rows(slice(offsets, index)).to_vec())
        };
        let supports = rows(
            slabs.supports.as_ref().map(|s| &s.value),
            &self.offsets.supports,
        );
        let forces = rows(
            slabs.forces.as_ref().map(|f| &f.value),
            &self.offsets.forces,
        );
        (0..steps)
            .map(|k| StepLoads {
                supports: supports.chunks_exact(steps).map(|row| row[k]).collect(),
                forces: (forces.chunks_exact(steps * dim))
                    .map(|row| padded(&row[k * dim..][..dim]))
                    .collect(),
            })
            .collect()
    }

    fn take_points(&self, slabs: &Slabs, rows: Range<usize>) -> Result<Vec<[f64; 3]>, InputError> {
        let start = rows.start;
        let points = slabs.points.vectors(rows);
        let dim = self.catalog.dim;
        let beside = |p: &[f64; 3]| p[dim..].iter().any(|&x| x != 0.0);
        match points.iter().position(beside) {
            Some(row) => Err(slabs.points.dataset.row_error(
                start + row,
                &format!("expected 0 beyond the first {dim} coordinates"),
            )),
            None => Ok(points),
        }
    }

    fn take_cells(
        &self,
        slabs: &Slabs,
        index: usize,
        points: &[[f64; 3]],
    ) -> Result<Elements, InputError> {
        let rows = slice(&self.offsets.cells, index);
        let entries = slice(&self.offsets.connectivity, index);
        let (types, connectivity) = (&slabs.types.dataset, &slabs.connectivity.dataset);
        let nodes =
            (slabs.connectivity).indices(entries.clone(), points.len(), "node of its subdomain")?;
        // Each of the subdomains before this one has an offset more than cells.
        let first = rows.start + index;
        let table = &slabs.offsets.dataset;
        let offsets = slabs.offsets.rows(first..first + rows.len() + 1);
        let mut elements = Elements::default();
        let mut at_nodes = Vec::new();
        let mut used = vec![false; points.len()];
        let mut at = 0;
        for (cell, &code) in slabs.types.rows(rows.clone()).iter().enumerate() {
            let kind = ElementKind::cell_from_vtk(code, self.catalog.dim)
                .map_err(|error| types.row_error(rows.start + cell, &error))?;
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
            let Some(its_nodes) = nodes.get(at..end) else {
                return Err(table.row_error(
                    first + cell + 1,
                    &format!("offset {end}; expected at most {}", nodes.len()),
                ));
            };
            if let Some(twice) =
                (1..its_nodes.len()).find(|&i| its_nodes[..i].contains(&its_nodes[i]))
            {
                return Err(connectivity.row_error(
                    entries.start + at + twice,
                    &format!("cell {} has the node twice", rows.start + cell),
                ));
            }
            at_nodes.clear();
            at_nodes.extend(its_nodes.iter().map(|&n| points[n as usize]));
            let size = kind.measure(&at_nodes);
            if !(size > SMALLEST_AREA && size.is_finite()) {
                return Err(connectivity.row_error(
                    entries.start + at,
                    &format!(
                        "cell {} has the area {size:e}; expected a positive one (counter-clockwise)",
                        rows.start + cell
                    ),
                ));
            }
            if let Some(fold) = kind.fold(&at_nodes, 0.0) {
                return Err(connectivity.row_error(
                    entries.start + at + fold.node,
                    &format!(
                        "cell {} ({}) is folded: its Jacobian near the node is {:e}; expected a \
                         positive one everywhere",
                        rows.start + cell,
                        kind.name(),
                        fold.jacobian
                    ),
                ));
            }
            for &node in its_nodes {
                used[node as usize] = true;
            }
            elements.push(kind, its_nodes);
            at = end;
        }
        if at != nodes.len() {
            return Err(table.row_error(
                first + rows.len(),
                &format!("offset {at}; expected {}", nodes.len()),
            ));
        }
        if let Some(node) = used.iter().position(|used| !used) {
            return Err(InputError::new(format!(
                "dataset /VTKHDF/Points, row {}: the point belongs to no cell",
                self.offsets.points[index] + node
            )));
        }
        let refused = |[one, other]: [CellFacet; 2], what: &str| {
            let [one, other] = [one.cell.min(other.cell), one.cell.max(other.cell)];
            let [one, other] = [one as usize, other as usize];
            Err(connectivity.row_error(
                entries.start + elements.offsets()[other],
                &format!(
                    "the cells {} and {} {what}",
                    rows.start + one,
                    rows.start + other
                ),
            ))
        };
        if Facets::repeat_themselves(&elements, points.len())
            && let Some(cells) = Facets::new(&elements, points.len()).overlap(&elements)
        {
            return refused(
                cells,
                "lie on the same side of an edge that they share; expected cells that don't overlap",
            );
        }
        if let Some(cells) = Facets::torn(&elements, points.len()) {
            return refused(
                cells,
                "share the ends of an edge, but not the node between them; expected the same nodes \
                 on both sides",
            );
        }
        Ok(elements)
    }

    fn take_supports(
        &self,
        slabs: &Slabs,
        index: usize,
        nodes: usize,
    ) -> Result<Vec<Support>, InputError> {
        let rows = slice(&self.offsets.supports, index);
        let Some(slab) = slabs.supports.as_ref().filter(|_| !rows.is_empty()) else {
            return Ok(Vec::new());
        };
        let dim = self.catalog.dim;
        let (node, direction) = (&slab.node.dataset, &slab.direction.dataset);
        let nodes_of = slab
            .node
            .indices(rows.clone(), nodes, "node of its subdomain")?;
        let directions = slab.direction.vectors(rows.clone());
        let values = slab.value.rows(rows.clone());
        let values = values.iter().step_by(slab.value.width());
        let conditions = match &slab.condition {
            Some(slab) => slab.indices(rows.clone(), self.catalog.supports.len(), "condition")?,
            None => vec![0; rows.len()],
        };
        let mut supports: Vec<Support> = Vec::with_capacity(rows.len());
        for (((at, &node_of), (&d, &value)), &condition) in (nodes_of.iter().enumerate())
            .zip(directions.iter().zip(values))
            .zip(&conditions)
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
                condition,
            });
        }
        Ok(supports)
    }

    fn take_forces(
        &self,
        slabs: &Slabs,
        index: usize,
        nodes: usize,
    ) -> Result<Vec<(u32, [f64; 3])>, InputError> {
        let rows = slice(&self.offsets.forces, index);
        let Some(slab) = slabs.forces.as_ref().filter(|_| !rows.is_empty()) else {
            return Ok(Vec::new());
        };
        let nodes_of = slab
            .node
            .indices(rows.clone(), nodes, "node of its subdomain")?;
        if let Some(at) = nodes_of.windows(2).position(|w| w[0] >= w[1]) {
            return Err(slab.node.dataset.row_error(
                rows.start + at + 1,
                "expected the nodes of a subdomain in strictly ascending order",
            ));
        }
        let first_step = |row: &[f64]| padded(&row[..self.catalog.dim]);
        let forces = slab.value.rows(rows).chunks_exact(slab.value.width());
        Ok(nodes_of.into_iter().zip(forces.map(first_step)).collect())
    }

    fn take_interface(
        &self,
        slab: Option<&Slab<i64>>,
        index: usize,
    ) -> Result<Vec<InterfaceNode>, InputError> {
        let rows = slice(&self.offsets.interface, index);
        let Some(slab) = slab.filter(|_| !rows.is_empty()) else {
            return Ok(Vec::new());
        };
        let nodes = self.catalog.subdomains[index].nodes;
        let nodes_of = slab.indices(rows.clone(), nodes, "node of its subdomain")?;
        let mut seen = vec![false; nodes];
        let twice = |&node: &u32| std::mem::replace(&mut seen[node as usize], true);
        if let Some(at) = nodes_of.iter().position(twice) {
            return Err((slab.dataset).row_error(rows.start + at, "the node was named before"));
        }
        Ok(nodes_of
            .into_iter()
            .zip(&self.catalog.interface[index])
            .map(|(node, &interface)| InterfaceNode { node, interface })
            .collect())
    }
}

fn take_node_tags(slabs: &Slabs, rows: Range<usize>) -> Result<Vec<i64>, InputError> {
    let start = rows.start;
    let tags = slabs.tags.rows(rows).to_vec();
    let mut sorted = tags.clone();
    sorted.sort_unstable();
    if sorted.first().is_none_or(|&tag| tag >= 0) && sorted.windows(2).all(|w| w[0] < w[1]) {
        return Ok(tags);
    }
    let mut seen = HashSet::new();
    let wrong = |&tag: &i64| tag < 0 || !seen.insert(tag);
    let row = tags.iter().position(wrong).unwrap_or_default();
    Err(slabs.tags.dataset.row_error(
        start + row,
        &format!(
            "tag {}; expected tags ≥ 0, each once in a subdomain",
            tags[row]
        ),
    ))
}

/// The rows of entry `index` in a table of offsets.
pub(super) fn slice(offsets: &[usize], index: usize) -> Range<usize> {
    offsets[index]..offsets[index + 1]
}
