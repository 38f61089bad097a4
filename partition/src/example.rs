//! The built-in scenes.

use crate::error::InputError;
use crate::mesh::Mesh;
use crate::scene::Scene;

/// A built-in scene: name and what it shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// Name for `--example`.
    pub name: &'static str,
    /// One line on what it shows.
    pub about: &'static str,
    /// Number of subdomains where the user doesn't say.
    pub subdomains: usize,
}

impl Example {
    /// Makes the scene and its mesh with the mesh size halved `refine` times.
    ///
    /// # Errors
    /// A refinement too large to be made.
    pub fn make(&self, _refine: u32) -> Result<(Scene, Mesh), InputError> {
        Err(InputError::new("not yet"))
    }
}
