//! A mesh: points, cells, facets, and the physical groups that name them.

pub(crate) mod abaqus;
pub mod bounding_box;
mod curve;
pub mod facets;
mod file;
pub mod foreign;
pub mod gmsh;
mod measure;
pub mod topology;

use std::collections::BTreeMap;

pub use self::file::{files, read};
use crate::element::Elements;

/// A mesh of a mesher, without orphan nodes and with every cell positively oriented.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Dimension of the cells.
    pub dim: usize,
    /// Coordinates in metres; unused components are zero.
    pub points: Vec<[f64; 3]>,
    /// The mesh file's tag of each node.
    pub node_tags: Vec<i64>,
    /// Cells, by node index.
    pub cells: Elements,
    /// The mesh file's tag of each cell.
    pub cell_tags: Vec<i64>,
    /// Flags of the cells with incompatible modes; empty if there is none.
    pub has_modes: Vec<bool>,
    /// Facets that the mesh file lists (dimension `dim − 1`), by node index.
    pub facets: Elements,
    /// Physical groups by name.
    pub groups: BTreeMap<String, Group>,
    /// Warnings from the reader of the file.
    pub warnings: Vec<String>,
}

impl Mesh {
    /// The tags of nodes, as text.
    pub(crate) fn tags_of(&self, nodes: &[u32]) -> String {
        let tags = nodes
            .iter()
            .map(|&n| self.node_tags[n as usize].to_string());
        tags.collect::<Vec<_>>().join(", ")
    }
}

/// The name of a group whose name occurs in several dimensions.
fn name_of_dim(name: &str, dim: usize) -> String {
    format!("{name} ({})", ["point", "curve", "surface", "volume"][dim])
}

/// A physical group.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Group {
    /// Dimension of its members.
    pub dim: usize,
    /// Indices of cells (`dim` that of the mesh), facets (one less) or nodes (0, and 1 in space: those of curves),
    /// ascending.
    pub members: Vec<u32>,
}
