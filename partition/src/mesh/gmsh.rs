//! Gmsh's MSH format, versions 4.1 and 2.2, ASCII and binary.

use std::path::Path;

use super::Mesh;
use crate::error::{InputError, OutputError};

/// Reads a mesh.
///
/// # Errors
/// What is wrong with the file and where.
pub fn read(_path: &Path) -> Result<Mesh, InputError> {
    Err(InputError::new("not yet"))
}

/// Writes a mesh as MSH 4.1, ASCII.
///
/// # Errors
/// The file can't be written.
pub fn write(_mesh: &Mesh, path: &Path) -> Result<(), OutputError> {
    Err(OutputError {
        path: path.to_path_buf(),
        reason: "not yet".into(),
    })
}
