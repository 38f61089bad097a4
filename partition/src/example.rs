//! The built-in scenes.
//!
//! Each has a folder `example/NAME` with its `scene.toml`, its page of the gallery with the numbers that the tests
//! check (`README.md`), that page's picture, and `mesh.rs`: `SHAPE` are the parameters of its mesh, `ABOUT` and
//! `SUBDOMAINS` as in [`Example`]. `build.rs` lists the folders.

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

/// A built-in scene: name and purpose.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// Name for `--example`.
    pub name: &'static str,
    /// Its purpose, in one line.
    pub about: &'static str,
    /// Default number of subdomains.
    pub subdomains: usize,
    /// The scene in the user's format, with its mesh in `mesh.msh`.
    pub scene: &'static str,
    shape: Shape,
}

/// The parameters of a mesh.
#[derive(Clone, Copy, Debug)]
enum Shape {
    /// Mapped squares, to be filled with cells of any kind and size.
    Squares(fn() -> Vec<Square>),
    /// Mapped cubes, to be filled with cells of any kind and size, and the default kind.
    Cubes {
        cubes: fn() -> Vec<Cube>,
        kind: ElementKind,
    },
    /// A geometry of Gmsh, and the mesh that Gmsh generated from it.
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
/// An unknown name, with the most similar known one.
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
    /// A refinement that is too large.
    pub fn make(&self, refine: u32) -> Result<(Scene, Mesh), InputError> {
        Ok((Scene::parse(self.scene)?, self.mesh(refine)?))
    }

    /// Makes its mesh with the mesh size halved `refine` times: linear triangles, or Gmsh's mesh.
    ///
    /// # Errors
    /// A refinement that is too large, or any refinement of a mesh by Gmsh.
    pub fn mesh(&self, refine: u32) -> Result<Mesh, InputError> {
        match self.shape {
            Shape::Squares(_) => self.mesh_of(ElementKind::Triangle3, refine),
            Shape::Cubes { kind, .. } => self.mesh_of(kind, refine),
            Shape::Gmsh { mesh, .. } if refine == 0 => gmsh::parse(mesh),
            Shape::Gmsh { .. } => Err(self.as_gmsh_made_it()),
        }
    }

    /// Makes its mesh of cells of `kind` with the mesh size halved `refine` times; where the mesh size changes, there
    /// are triangles between quadrilaterals.
    ///
    /// # Errors
    /// A refinement that is too large; a mesh by Gmsh.
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

    /// Writes `scene.toml`, `mesh.msh` and the geometry of a mesh by Gmsh into `directory`, which is created if
    /// missing, and returns the path of the scene. Existing files are replaced only if this program wrote them and they
    /// are unchanged.
    ///
    /// # Errors
    /// Files that can't be written, or other files of their names.
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
        // Nothing is written if one of the files can't be replaced.
        files.retain(|(path, text)| fs::read(path).ok().as_ref() != Some(text));
        let others = files.iter().filter(|(path, _)| path.exists());
        let mut others = others.filter(|(path, _)| !is_own_output(path));
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

/// True if a file has the form in which this program writes it: a built-in scene or geometry, or a mesh of any size and
/// cells in the exact format of this program, which neither Gmsh nor an editor produces.
fn is_own_output(path: &Path) -> bool {
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
