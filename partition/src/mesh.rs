//! A mesh: points, cells, facets, and the physical groups that name them.

mod abaqus;
pub mod bounding_box;
mod curve;
pub mod foreign;
pub mod gmsh;
mod measure;
pub mod topology;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::element::Elements;
use crate::error::InputError;

/// A mesh as a mesher made it, without orphan nodes and with every cell positively oriented.
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
    /// Facets that the mesh file lists (dimension `dim − 1`), by node index.
    pub facets: Elements,
    /// Physical groups by name.
    pub groups: BTreeMap<String, Group>,
    /// What a user should know of how the file was read.
    pub warnings: Vec<String>,
}

/// Reads a mesh: a deck of Abaqus or CalculiX where its name ends with `.inp`, else Gmsh's format.
///
/// # Errors
/// What is wrong with the file and where.
pub fn read(path: &Path) -> Result<Mesh, InputError> {
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("inp") => abaqus::read(path),
        _ => gmsh::read(path),
    }
}

/// The files that a mesh is read from, as far as `output`, which is there, may be one of them: that of the mesh, and those
/// that a deck includes.
pub fn files(path: &Path, output: &Path) -> Vec<PathBuf> {
    match path.extension() {
        Some(ending) if output.exists() && ending.eq_ignore_ascii_case("inp") => {
            abaqus::files(path)
        }
        _ => vec![path.to_path_buf()],
    }
}

impl Mesh {
    /// The tags of nodes in words.
    pub(crate) fn tags_of(&self, nodes: &[u32]) -> String {
        let tags = nodes
            .iter()
            .map(|&n| self.node_tags[n as usize].to_string());
        tags.collect::<Vec<_>>().join(", ")
    }
}

/// The name of a group where groups of several dimensions have it.
fn name_of_dim(name: &str, dim: usize) -> String {
    format!("{name} ({})", ["point", "curve", "surface", "volume"][dim])
}

/// A physical group.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Group {
    /// Dimension of its members.
    pub dim: usize,
    /// Indices of cells (`dim` that of the mesh), facets (one less) or nodes (0, and 1 in space: those of curves), ascending.
    pub members: Vec<u32>,
}
