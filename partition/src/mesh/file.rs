//! Mesh files of all supported formats.

use std::path::{Path, PathBuf};

use super::{Mesh, abaqus, gmsh};
use crate::error::InputError;

/// Reads a mesh: a deck of Abaqus or CalculiX if its name ends with `.inp`, otherwise Gmsh's format.
///
/// # Errors
/// The error in the file, with its position.
pub fn read(path: &Path) -> Result<Mesh, InputError> {
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("inp") => abaqus::read(path),
        _ => gmsh::read(path),
    }
}

/// The files of a mesh that the existing file `output` may be one of: the mesh, and the files included by a deck.
pub fn files(path: &Path, output: &Path) -> Vec<PathBuf> {
    match path.extension() {
        Some(ending) if output.exists() && ending.eq_ignore_ascii_case("inp") => {
            abaqus::files(path)
        }
        _ => vec![path.to_path_buf()],
    }
}
