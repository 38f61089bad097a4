//! The built-in scenes.

mod blocks;
mod crack;
mod granite;
mod hertz;
mod junction;
mod patch;
mod pattern;
mod plain;
mod rollers;
mod stack;

use std::path::{Path, PathBuf};

use self::blocks::Patch;
use crate::destination;
use crate::element::ElementKind;
use crate::error::{InputError, OutputError};
use crate::mesh::{Mesh, gmsh};
use crate::scene::Scene;
use crate::scene::suggest::nearest;

/// The built-in scenes.
pub const EXAMPLES: &[Example] = &[
    granite::EXAMPLE,
    hertz::EXAMPLE,
    crack::EXAMPLE,
    patch::EXAMPLE,
    junction::EXAMPLE,
    stack::EXAMPLE,
    rollers::EXAMPLE,
    plain::EXAMPLE,
];

/// A built-in scene: name and what it shows.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// Name for `--example`.
    pub name: &'static str,
    /// One line on what it shows.
    pub about: &'static str,
    /// Number of subdomains where the user doesn't say.
    pub subdomains: usize,
    /// The scene as a user would write it, with its mesh in `mesh.msh`.
    pub scene: &'static str,
    patches: fn() -> Vec<Patch>,
}

/// Name of the mesh file of every built-in scene.
pub const MESH: &str = "mesh.msh";

/// The built-in scene `name`.
///
/// # Errors
/// A name that isn't known, with the nearest one that is.
pub fn find(name: &str) -> Result<&'static Example, InputError> {
    EXAMPLES
        .iter()
        .find(|example| example.name == name)
        .ok_or_else(|| {
            let names: Vec<&str> = EXAMPLES.iter().map(|e| e.name).collect();
            let nearest = nearest(name, names.iter().copied()).unwrap_or_default();
            InputError::new(format!(
                "no example is called `{name}`; did you mean `{nearest}`? There are {}",
                names.join(", ")
            ))
        })
}

impl Example {
    /// Makes the scene and its mesh with the mesh size halved `refine` times.
    ///
    /// # Errors
    /// A refinement too large to be made.
    pub fn make(&self, refine: u32) -> Result<(Scene, Mesh), InputError> {
        Ok((Scene::parse(self.scene)?, self.mesh(refine)?))
    }

    /// Makes its mesh of linear triangles with the mesh size halved `refine` times.
    ///
    /// # Errors
    /// A refinement too large to be made.
    pub fn mesh(&self, refine: u32) -> Result<Mesh, InputError> {
        self.mesh_of(ElementKind::Triangle3, refine)
    }

    /// Makes its mesh of cells of `kind` with the mesh size halved `refine` times; where the mesh
    /// size changes, there are triangles between quadrilaterals.
    ///
    /// # Errors
    /// A refinement too large to be made.
    pub fn mesh_of(&self, kind: ElementKind, refine: u32) -> Result<Mesh, InputError> {
        blocks::mesh(&(self.patches)(), refine, kind)
    }

    /// Writes `scene.toml` and `mesh.msh` into `directory`, which is made where it isn't there,
    /// and returns the path of the scene.
    ///
    /// # Errors
    /// The files can't be written.
    pub fn write(&self, mesh: &Mesh, directory: &Path) -> Result<PathBuf, OutputError> {
        std::fs::create_dir_all(directory).map_err(|e| OutputError {
            path: directory.to_path_buf(),
            reason: e.to_string(),
        })?;
        gmsh::write(mesh, &directory.join(MESH))?;
        let scene = directory.join("scene.toml");
        destination::write_bytes(&scene, |out| out.write_all(self.scene.as_bytes()))?;
        Ok(scene)
    }
}
