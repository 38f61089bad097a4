//! The built-in scenes.
//!
//! Each has a folder `example/NAME` with its `scene.toml`, its page of the gallery with the numbers that the
//! tests look for (`README.md`), that page's picture, and `mesh.rs`: `SHAPE` is what its mesh is made from,
//! `ABOUT` and `SUBDOMAINS` are as in [`Example`]. `build.rs` lists the folders.

mod cubes;
mod pattern;
mod squares;

use std::fs;
use std::path::{Path, PathBuf};

use self::cubes::Cube;
use self::squares::Square;
use crate::destination;
use crate::element::ElementKind;
use crate::error::{InputError, OutputError};
use crate::mesh::{Mesh, gmsh};
use crate::scene::Scene;
use crate::scene::suggest::nearest;

include!(concat!(env!("OUT_DIR"), "/scenes.rs"));

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
    shape: Shape,
}

/// The parameters of a mesh.
#[derive(Clone, Copy, Debug)]
enum Shape {
    /// Mapped squares, to be filled with cells of any kind and size.
    Squares(fn() -> Vec<Square>),
    /// Mapped cubes, to be filled with cells of any kind and size, and the kind where the user doesn't say.
    Cubes {
        cubes: fn() -> Vec<Cube>,
        kind: ElementKind,
    },
    /// A geometry of Gmsh, and the mesh that Gmsh made of it.
    Gmsh {
        geometry: &'static str,
        mesh: &'static [u8],
    },
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

    /// Makes its mesh with the mesh size halved `refine` times: linear triangles, or what Gmsh made.
    ///
    /// # Errors
    /// A refinement too large to be made, or any at all of a mesh by Gmsh.
    pub fn mesh(&self, refine: u32) -> Result<Mesh, InputError> {
        match self.shape {
            Shape::Squares(_) => self.mesh_of(ElementKind::Triangle3, refine),
            Shape::Cubes { kind, .. } => self.mesh_of(kind, refine),
            Shape::Gmsh { mesh, .. } if refine == 0 => gmsh::parse(mesh),
            Shape::Gmsh { .. } => Err(self.as_gmsh_made_it()),
        }
    }

    /// Makes its mesh of cells of `kind` with the mesh size halved `refine` times; where the mesh
    /// size changes, there are triangles between quadrilaterals.
    ///
    /// # Errors
    /// A refinement too large to be made; a mesh by Gmsh.
    pub fn mesh_of(&self, kind: ElementKind, refine: u32) -> Result<Mesh, InputError> {
        match self.shape {
            Shape::Squares(of_scene) => squares::mesh(&of_scene(), refine, kind),
            Shape::Cubes { cubes, .. } => cubes::mesh(&cubes(), refine, kind),
            Shape::Gmsh { .. } => Err(self.as_gmsh_made_it()),
        }
    }

    fn as_gmsh_made_it(&self) -> InputError {
        let name = self.name;
        InputError::new(format!(
            "the mesh of example `{name}` is one by Gmsh, which takes neither --refine nor --element; \
             expected `--write-scene DIR`, which writes its geometry: then \
             `gmsh -2 -order 2 -clscale 0.5 DIR/{name}.geo -o DIR/{MESH}` halves the mesh size"
        ))
    }

    /// Writes `scene.toml`, `mesh.msh` and the geometry, where it is one of Gmsh, into `directory`,
    /// which is made where it isn't there, and returns the path of the scene. What is there stays, unless this
    /// program wrote it and nobody edited it.
    ///
    /// # Errors
    /// The files can't be written, or there are others of their names.
    pub fn write(&self, mesh: &Mesh, directory: &Path) -> Result<PathBuf, OutputError> {
        fs::create_dir_all(directory).map_err(|e| OutputError {
            path: directory.to_path_buf(),
            reason: e.to_string(),
        })?;
        let scene = directory.join("scene.toml");
        let mut text = Vec::new();
        gmsh::write_to(&mut text, mesh).map_err(|e| destination::failure(&scene, e))?;
        let mut files = vec![
            (directory.join(MESH), text),
            (scene.clone(), self.scene.into()),
        ];
        if let Shape::Gmsh { geometry, .. } = self.shape {
            let path = directory.join(self.name).with_extension("geo");
            files.push((path, geometry.into()));
        }
        // None is written where one can't be.
        files.retain(|(path, text)| fs::read(path).ok().as_ref() != Some(text));
        let others = files.iter().filter(|(path, _)| path.exists());
        let mut others = others.filter(|(path, _)| !is_ours(path));
        if let Some((other, _)) = others.next() {
            let why = "another file is there, with changes of yours perhaps; expected another folder behind \
                       --write-scene, or that file moved away";
            return Err(destination::failure(other, why));
        }
        for (path, text) in &files {
            destination::write_bytes(path, |out| out.write_all(text))?;
        }
        Ok(scene)
    }
}

/// True if a file is as this program writes one: a built-in scene or geometry, or a mesh in the very form of this
/// program, whichever its size and cells. Neither Gmsh writes it so, nor does an editor leave it so.
fn is_ours(path: &Path) -> bool {
    let Ok(bytes) = fs::read(path) else {
        return false;
    };
    let is_built_in = |example: &Example| match example.shape {
        Shape::Gmsh { geometry, .. } if bytes == geometry.as_bytes() => true,
        _ => bytes == example.scene.as_bytes(),
    };
    let is_written = || {
        let mut text = Vec::new();
        let mesh = gmsh::read(path);
        mesh.is_ok_and(|mesh| gmsh::write_to(&mut text, &mesh).is_ok()) && bytes == text
    };
    EXAMPLES.iter().any(is_built_in) || is_written()
}
