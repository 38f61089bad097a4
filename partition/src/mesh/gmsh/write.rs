//! Writes a mesh as MSH 4.1, ASCII.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;

use super::element_type;
use crate::destination;
use crate::element::ElementKind;
use crate::error::OutputError;
use crate::mesh::Mesh;
use crate::mesh::bounding_box::BoundingBox;

/// Writes a mesh as MSH 4.1, ASCII, with its tags; facets and nodes of groups get tags after those of the cells.
///
/// A mesh with nodes and cells in ascending order of tags, as [`read`](super::read) returns it, is reproduced bit by
/// bit when read again.
///
/// # Errors
/// A file that can't be written.
pub fn write(mesh: &Mesh, path: &Path) -> Result<(), OutputError> {
    destination::write_bytes(path, |out| write_to(out, mesh))
}

/// Writes the content that [`write()`] writes.
///
/// # Errors
/// Errors of `out`.
pub fn write_to(out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
    let plan = Plan::new(mesh);
    writeln!(out, "$MeshFormat\n4.1 0 8\n$EndMeshFormat")?;
    plan.write_names(out)?;
    plan.write_entities(out, mesh)?;
    plan.write_nodes(out, mesh)?;
    plan.write_elements(out, mesh)
}

/// Elements of one kind in the same groups; an entity of the file.
struct Entity {
    dim: usize,
    /// Tag among the entities of its dimension.
    tag: usize,
    kind: ElementKind,
    /// Numbers of its physical groups.
    groups: Vec<usize>,
    /// Tag and nodes of every element.
    elements: Vec<(i64, Vec<u32>)>,
}

/// Layout of the file.
struct Plan<'a> {
    /// Dimension, number and name of the physical groups.
    names: Vec<(usize, usize, &'a str)>,
    /// Entities in ascending order of dimension.
    entities: Vec<Entity>,
}

impl<'a> Plan<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let names: Vec<(usize, usize, &str)> = mesh
            .groups
            .iter()
            .enumerate()
            .map(|(number, (name, group))| {
                // Groups of curves in space consist of nodes only.
                let dim = if group.dim + 1 < mesh.dim {
                    0
                } else {
                    group.dim
                };
                (dim, number + 1, name.as_str())
            })
            .collect();
        let groups_of = |dim: usize, count: usize| {
            let mut groups = vec![Vec::new(); count];
            for (&(group_dim, number, _), group) in names.iter().zip(mesh.groups.values()) {
                if group_dim == dim {
                    for &member in &group.members {
                        groups[member as usize].push(number);
                    }
                }
            }
            groups
        };
        let mut next_tag = mesh.cell_tags.iter().max().map_or(1, |tag| tag + 1);
        let mut fresh_tag = || {
            next_tag += 1;
            next_tag - 1
        };
        let mut entities = Vec::new();
        let facet_dim = mesh.dim.saturating_sub(1);
        let facets = groups_of(facet_dim, mesh.facets.len());
        let facets = mesh.facets.iter().zip(facets);
        let facets = facets.map(|((kind, nodes), groups)| (fresh_tag(), kind, nodes, groups));
        let facets = gathered(facet_dim, facets);
        let nodes = groups_of(0, mesh.points.len()).into_iter().enumerate();
        for (node, groups) in nodes.filter(|(_, groups)| !groups.is_empty()) {
            entities.push(Entity {
                dim: 0,
                tag: entities.len() + 1,
                kind: ElementKind::Point1,
                groups,
                elements: vec![(fresh_tag(), vec![node as u32])],
            });
        }
        entities.extend(facets);
        let cells = mesh.cells.iter().zip(&mesh.cell_tags);
        let cells = cells.zip(groups_of(mesh.dim, mesh.cells.len()));
        let cells = cells.map(|(((kind, nodes), &tag), groups)| (tag, kind, nodes, groups));
        entities.extend(gathered(mesh.dim, cells));
        Self { names, entities }
    }

    fn write_names(&self, out: &mut dyn Write) -> io::Result<()> {
        if self.names.is_empty() {
            return Ok(());
        }
        writeln!(out, "$PhysicalNames\n{}", self.names.len())?;
        for (dim, number, name) in &self.names {
            if name.contains(['\n', '\r']) {
                return Err(io::Error::other(format!(
                    "the group {name:?} has a line break in its name"
                )));
            }
            writeln!(out, "{dim} {number} \"{name}\"")?;
        }
        writeln!(out, "$EndPhysicalNames")
    }

    fn write_entities(&self, out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
        let count = |dim| self.entities.iter().filter(|e| e.dim == dim).count();
        writeln!(
            out,
            "$Entities\n{} {} {} {}",
            count(0),
            count(1),
            count(2),
            count(3)
        )?;
        for entity in &self.entities {
            let BoundingBox { low, high } = entity.bounds(mesh);
            write!(out, "{} {}", entity.tag, row(&low))?;
            if entity.dim > 0 {
                write!(out, " {}", row(&high))?;
            }
            write!(out, " {}", entity.groups.len())?;
            for number in &entity.groups {
                write!(out, " {number}")?;
            }
            writeln!(out, "{}", if entity.dim > 0 { " 0" } else { "" })?;
        }
        writeln!(out, "$EndEntities")
    }

    fn write_nodes(&self, out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
        let smallest = mesh.node_tags.iter().min().copied().unwrap_or_default();
        let largest = mesh.node_tags.iter().max().copied().unwrap_or_default();
        let count = mesh.points.len();
        writeln!(out, "$Nodes\n1 {count} {smallest} {largest}")?;
        writeln!(out, "{} 1 0 {count}", mesh.dim)?;
        for tag in &mesh.node_tags {
            writeln!(out, "{tag}")?;
        }
        for point in &mesh.points {
            writeln!(out, "{}", row(point))?;
        }
        writeln!(out, "$EndNodes")
    }

    fn write_elements(&self, out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
        let tags = || self.entities.iter().flat_map(|e| &e.elements).map(|e| e.0);
        writeln!(
            out,
            "$Elements\n{} {} {} {}",
            self.entities.len(),
            tags().count(),
            tags().min().unwrap_or_default(),
            tags().max().unwrap_or_default()
        )?;
        for entity in &self.entities {
            let code = element_type::code(entity.kind);
            let count = entity.elements.len();
            writeln!(out, "{} {} {code} {count}", entity.dim, entity.tag)?;
            for (tag, nodes) in &entity.elements {
                write!(out, "{tag}")?;
                let mut places: Vec<usize> = (0..nodes.len()).collect();
                if let Some(order) = element_type::order(entity.kind) {
                    places.sort_unstable_by_key(|&place| order[place]);
                }
                for place in places {
                    write!(out, " {}", mesh.node_tags[nodes[place] as usize])?;
                }
                writeln!(out)?;
            }
        }
        writeln!(out, "$EndElements")
    }
}

impl Entity {
    fn bounds(&self, mesh: &Mesh) -> BoundingBox {
        let nodes = self.elements.iter().flat_map(|(_, nodes)| nodes);
        BoundingBox::around(nodes.map(|&node| &mesh.points[node as usize]))
    }
}

/// Gathers elements of one dimension into entities.
fn gathered<'a>(
    dim: usize,
    elements: impl Iterator<Item = (i64, ElementKind, &'a [u32], Vec<usize>)>,
) -> Vec<Entity> {
    let mut by_groups: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for (tag, kind, nodes, groups) in elements {
        let entity = by_groups.entry((groups, kind)).or_default();
        entity.push((tag, nodes.to_vec()));
    }
    by_groups
        .into_iter()
        .enumerate()
        .map(|(place, ((groups, kind), elements))| Entity {
            dim,
            tag: place + 1,
            kind,
            groups,
            elements,
        })
        .collect()
}

/// Numbers as text that reproduces the same bits when read.
fn row(values: &[f64; 3]) -> String {
    format!("{:?} {:?} {:?}", values[0], values[1], values[2])
}
