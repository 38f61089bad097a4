//! The files of a mesh, in any of the formats that are read.

use std::path::{Path, PathBuf};

use super::{Mesh, abaqus, gmsh};
use crate::error::InputError;

/// Reads a mesh: a deck of Abaqus or CalculiX where its name ends with `.inp`, else Gmsh's format.
///
/// # Errors
/// The fault of the file, and its place.
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
