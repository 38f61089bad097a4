//! The slices of consecutive subdomains, each dataset read once.

use std::collections::HashSet;
use std::ops::Range;

use super::ProblemFile;
use super::goals::ShareSlices;
use super::slice::{NODE, Slice};
use crate::element::geometry::{dot, padded};
use crate::error::InputError;
use crate::model::{PlaneState, Support};
use crate::problem::{InitialStress, InterfaceNode, StepLoads, Subdomain, UNIT_TOLERANCE};

/// The datasets of consecutive subdomains, with each value valid by the schema.
pub(super) struct Slices {
    pub(super) points: Slice<f64>,
    pub(super) tags: Slice<i64>,
    pub(super) types: Slice<i64>,
    pub(super) connectivity: Slice<i64>,
    pub(super) offsets: Slice<i64>,
    pub(super) materials: Slice<i64>,
    pub(super) interface: Slice<i64>,
    pub(super) support_nodes: Slice<i64>,
    pub(super) support_directions: Slice<f64>,
    pub(super) support_values: Slice<f64>,
    /// The boundary condition of every support; `None` for files without their names.
    pub(super) support_conditions: Option<Slice<i64>>,
    pub(super) spring_nodes: Slice<i64>,
    pub(super) spring_stiffness: Slice<f64>,
    pub(super) spring_conditions: Slice<i64>,
    pub(super) force_nodes: Slice<i64>,
    pub(super) force_values: Slice<f64>,
    /// The initial stress of the cells; empty if none has any.
    pub(super) stress_of_cells: Slice<f64>,
    pub(super) stress_of_nodes: Slice<f64>,
    shares: ShareSlices,
}

impl Slices {
    fn read(file: &ProblemFile, subdomains: Range<usize>) -> Result<Self, InputError> {
        let contents = &file.contents;
        let rows = |letter| contents.rows_of(letter, subdomains.clone());
        let [points, cells, supports, forces] = ['P', 'C', 'S', 'F'].map(rows);
        // Each subdomain before has one offset more than cells.
        let ends = cells.start + subdomains.start..cells.end + subdomains.end;
        let conditions = contents.has("/support/condition");
        let conditions =
            conditions.then(|| contents.integers("/support/condition", supports.clone()));
        Ok(Self {
            stress_of_cells: contents.numbers("/initial_stress/cell", cells.clone())?,
            stress_of_nodes: contents.numbers("/initial_stress/node", points.clone())?,
            points: contents.numbers("/VTKHDF/Points", points.clone())?,
            tags: contents.integers("/VTKHDF/PointData/GlobalNodeId", points)?,
            types: contents.integers("/VTKHDF/Types", cells.clone())?,
            connectivity: contents.integers("/VTKHDF/Connectivity", rows('K'))?,
            offsets: contents.integers("/VTKHDF/Offsets", ends)?,
            materials: contents.integers("/VTKHDF/CellData/Material", cells)?,
            interface: contents.integers("/interface/node", rows('I'))?,
            support_nodes: contents.integers("/support/node", supports.clone())?,
            support_directions: contents.numbers("/support/direction", supports.clone())?,
            support_values: contents.numbers("/support/value", supports)?,
            support_conditions: conditions.transpose()?,
            spring_nodes: contents.integers("/spring/node", rows('Y'))?,
            spring_stiffness: contents.numbers("/spring/stiffness", rows('Y'))?,
            spring_conditions: contents.integers("/spring/condition", rows('Y'))?,
            force_nodes: contents.integers("/force/node", forces.clone())?,
            force_values: contents.numbers("/force/value", forces)?,
            shares: ShareSlices::read(contents, subdomains)?,
        })
    }
}

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
        let slices = Slices::read(self, range.clone())?;
        range.map(|index| self.take(&slices, index)).collect()
    }

    fn take(&self, slices: &Slices, index: usize) -> Result<Subdomain, InputError> {
        let rows = self.contents.rows('P', index);
        let points = self.take_points(slices, rows.clone())?;
        let materials = slices.materials.of(self.contents.rows('C', index));
        let reference_nodes = self.reference_nodes(index, points.len())?;
        let cells = self.take_cells(slices, index, (&points, reference_nodes))?;
        let mut subdomain = Subdomain {
            index,
            body: self.catalog.subdomains[index].body,
            node_tags: take_node_tags(slices, rows)?,
            springs: self.take_springs(slices, index, &cells)?,
            cells,
            cell_material: materials.iter().map(|&material| material as u32).collect(),
            supports: self.take_supports(slices, index, points.len())?,
            forces: self.take_forces(slices, index, points.len())?,
            initial_stress: self.take_stress(slices, index, 0),
            interface: self.take_interface(slices, index)?,
            shares: (slices.shares).take(
                &self.contents,
                index,
                (points.len(), self.catalog.dim),
            )?,
            steps: self.take_steps(slices, index),
            points,
            reference_nodes,
            auxiliary_nodes: 0,
        };
        if let Some(points) = self.auxiliary.get(&(index as u32)) {
            subdomain.add_auxiliary_nodes(points, &self.catalog);
        }
        Ok(subdomain)
    }

    /// The number of reference nodes, which are the last points and belong to no cell.
    fn reference_nodes(&self, index: usize, points: usize) -> Result<usize, InputError> {
        if !self.contents.has("/subdomains/reference") {
            return Ok(0);
        }
        let counts = self.contents.all_integers("/subdomains/reference")?;
        let count = counts.all()[index];
        let count = usize::try_from(count).ok().filter(|&count| count < points);
        count.ok_or_else(|| {
            let what =
                format!("expected 0 or more, and less than the {points} points of the subdomain");
            counts.error(index, &what)
        })
    }

    fn take_steps(&self, slices: &Slices, index: usize) -> Vec<StepLoads> {
        let (dim, steps) = (self.catalog.dim, self.catalog.steps.len());
        let supports = slices.support_values.of(self.contents.rows('S', index));
        let forces = slices.force_values.of(self.contents.rows('F', index));
        let of_step = |k: usize| StepLoads {
            supports: supports.chunks_exact(steps).map(|row| row[k]).collect(),
            forces: (forces.chunks_exact(steps * dim))
                .map(|row| padded(&row[k * dim..][..dim]))
                .collect(),
            initial_stress: self.take_stress(slices, index, k),
        };
        (0..steps).map(of_step).collect()
    }

    /// The initial stress in load step k, the first one without load steps.
    fn take_stress(&self, slices: &Slices, index: usize, k: usize) -> InitialStress {
        if !self.contents.has("/initial_stress/cell") {
            return InitialStress::default();
        }
        let steps = self.catalog.steps.len().max(1);
        let take = |slice: &Slice<f64>, letter| {
            let (stresses, _) = slice.of(self.contents.rows(letter, index)).as_chunks::<6>();
            stresses.iter().skip(k).step_by(steps).copied().collect()
        };
        InitialStress {
            cells: take(&slices.stress_of_cells, 'C'),
            nodes: take(&slices.stress_of_nodes, 'P'),
        }
    }

    fn take_points(
        &self,
        slices: &Slices,
        rows: Range<usize>,
    ) -> Result<Vec<[f64; 3]>, InputError> {
        let start = rows.start;
        let points = slices.points.vectors(rows);
        let dim = self.catalog.dim;
        let beside = |p: &[f64; 3]| p[dim..].iter().any(|&x| x != 0.0);
        if let Some(row) = points.iter().position(beside) {
            let what = format!("expected 0 beyond the first {dim} coordinates");
            return Err(slices.points.error(start + row, &what));
        }
        let is_ring = self.catalog.plane == Some(PlaneState::Axisymmetric);
        match points.iter().position(|p| is_ring && p[0] < 0.0) {
            Some(row) => {
                let what = format!("x = {}; expected a radius ≥ 0", points[row][0]);
                Err(slices.points.error(start + row, &what))
            }
            None => Ok(points),
        }
    }

    fn take_supports(
        &self,
        slices: &Slices,
        index: usize,
        nodes: usize,
    ) -> Result<Vec<Support>, InputError> {
        let rows = self.contents.rows('S', index);
        let (node, direction) = (&slices.support_nodes, &slices.support_directions);
        let nodes_of = node.indices(rows.clone(), NODE, nodes)?;
        let directions = direction.vectors(rows.clone());
        // The values of the first step.
        let values = slices.support_values.of(rows.clone());
        let values = values.iter().step_by(self.catalog.steps.len().max(1));
        let conditions = slices.support_conditions.as_ref();
        let mut supports: Vec<Support> = Vec::with_capacity(rows.len());
        for (((row, node_of), d), &value) in rows.zip(nodes_of).zip(directions).zip(values) {
            for before in supports.iter().rev().take_while(|s| s.node >= node_of) {
                if before.node > node_of {
                    return Err(node.error(row, "expected nodes in ascending order"));
                }
                if dot(before.direction, d).abs() > UNIT_TOLERANCE {
                    let what = "expected the directions at a node to be orthogonal";
                    return Err(direction.error(row, what));
                }
            }
            supports.push(Support {
                node: node_of,
                direction: d,
                value,
                condition: conditions.map_or(0, |of| of.of(row..row + 1)[0] as u32),
            });
        }
        Ok(supports)
    }

    fn take_forces(
        &self,
        slices: &Slices,
        index: usize,
        nodes: usize,
    ) -> Result<Vec<(u32, [f64; 3])>, InputError> {
        let rows = self.contents.rows('F', index);
        let nodes_of = slices.force_nodes.indices(rows.clone(), NODE, nodes)?;
        if let Some(at) = nodes_of.windows(2).position(|w| w[0] >= w[1]) {
            return Err(slices.force_nodes.error(
                rows.start + at + 1,
                "expected the nodes of a subdomain in strictly ascending order",
            ));
        }
        let dim = self.catalog.dim;
        let values = slices.force_values.of(rows);
        let of_node = values.chunks_exact(dim * self.catalog.steps.len().max(1));
        let first_step = of_node.map(|row| padded(&row[..dim]));
        Ok(nodes_of.into_iter().zip(first_step).collect())
    }

    fn take_interface(
        &self,
        slices: &Slices,
        index: usize,
    ) -> Result<Vec<InterfaceNode>, InputError> {
        let rows = self.contents.rows('I', index);
        let nodes = self.catalog.subdomains[index].nodes;
        let nodes_of = slices.interface.indices(rows.clone(), NODE, nodes)?;
        let mut seen = vec![false; nodes];
        let twice = |&node: &u32| std::mem::replace(&mut seen[node as usize], true);
        if let Some(at) = nodes_of.iter().position(twice) {
            return Err(slices
                .interface
                .error(rows.start + at, "the node was named before"));
        }
        let numbers = &self.catalog.interface[index];
        let both = nodes_of.into_iter().zip(numbers);
        Ok(both
            .map(|(node, &interface)| InterfaceNode { node, interface })
            .collect())
    }
}

fn take_node_tags(slices: &Slices, rows: Range<usize>) -> Result<Vec<i64>, InputError> {
    let start = rows.start;
    let tags = slices.tags.of(rows).to_vec();
    let mut sorted = tags.clone();
    sorted.sort_unstable();
    if sorted.first().is_none_or(|&tag| tag >= 0) && sorted.windows(2).all(|w| w[0] < w[1]) {
        return Ok(tags);
    }
    let mut seen = HashSet::new();
    let wrong = |&tag: &i64| tag < 0 || !seen.insert(tag);
    let row = tags.iter().position(wrong).unwrap_or_default();
    Err(slices.tags.error(
        start + row,
        &format!(
            "tag {}; expected tags ≥ 0, each once in a subdomain",
            tags[row]
        ),
    ))
}
