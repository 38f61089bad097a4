//! What a user writes: `scene.toml`.

use std::path::{Path, PathBuf};

use crate::error::InputError;

/// A scene as it was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Title.
    pub title: String,
    /// The mesh file, relative to the scene's.
    pub mesh: PathBuf,
}

impl Scene {
    /// Reads a scene.
    ///
    /// # Errors
    /// What is wrong with it, with line and key.
    pub fn read(_path: &Path) -> Result<Self, InputError> {
        Err(InputError::new("not yet"))
    }

    /// Parses a scene.
    ///
    /// # Errors
    /// What is wrong with it, with line and key.
    pub fn parse(_text: &str) -> Result<Self, InputError> {
        Err(InputError::new("not yet"))
    }
}
