//! What a file is, for whoever gave the wrong one of the files that the programs know.

use std::fmt;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use crate::error::InputError;

/// How every HDF5 file begins.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

/// How every mesh of Gmsh begins.
const MESH: &[u8] = b"$MeshFormat";

/// How every checkpoint begins.
const CHECKPOINT: &[u8] = b"contact-dd-mpi checkpoint";

/// A kind of file that the programs, or those around them, read and write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A scene in TOML.
    Scene,
    /// A geometry of which Gmsh makes a mesh.
    Geometry,
    /// A mesh of Gmsh.
    Mesh,
    /// A problem file.
    Problem,
    /// A result of contact-dd-mpi.
    Result,
    /// A checkpoint of contact-dd-mpi.
    Checkpoint,
}

impl FileKind {
    /// The kind of a file that is there; `None` where it is none of these.
    pub fn of(path: &Path) -> Option<Self> {
        // A pipe would keep the reader waiting.
        if !path.is_file() {
            return None;
        }
        let mut start = Vec::new();
        let file = File::open(path).ok()?;
        file.take(64).read_to_end(&mut start).ok()?;
        if start.starts_with(HDF5) {
            // Both are laid out as VTKHDF; only results have its ending.
            let is_result = path.extension().is_some_and(|ending| ending == "vtkhdf");
            return Some(match is_result {
                true => Self::Result,
                false => Self::Problem,
            });
        }
        if start.starts_with(MESH) {
            return Some(Self::Mesh);
        }
        if start.starts_with(CHECKPOINT) {
            return Some(Self::Checkpoint);
        }
        match path.extension()?.to_str()? {
            "toml" => Some(Self::Scene),
            "geo" | "geo_unrolled" | "step" | "stp" | "brep" | "iges" => Some(Self::Geometry),
            _ => None,
        }
    }

    /// The error of a reader that expected the kind `wanted`: where the file is of another kind, it
    /// says of which, and what to do with it.
    pub fn explain(wanted: Self, path: &Path, error: InputError) -> InputError {
        match Self::of(path) {
            Some(kind) if kind != wanted => {
                let use_of_it = kind.use_of(path);
                InputError::new(format!("is {kind}; expected {wanted}. {use_of_it}")).in_file(path)
            }
            _ => error,
        }
    }

    /// What to do with such a file, in a sentence.
    fn use_of(self, path: &Path) -> String {
        let path = path.display();
        match self {
            Self::Scene => {
                format!("contact-dd-partition {path} makes a problem file of it")
            }
            Self::Geometry => format!("gmsh -2 {path} makes a mesh of it"),
            Self::Mesh => format!(
                "A scene names it, as in mesh = \"{path}\"; contact-dd-partition --example granite \
                 --write-scene DIR writes one to start from"
            ),
            Self::Problem => format!(
                "contact-dd-mpi {path} solves it, contact-dd-partition --info {path} tells what it \
                 holds"
            ),
            Self::Result => format!("ParaView opens {path}"),
            Self::Checkpoint => {
                "contact-dd-mpi goes on from it with --restart and the problem file".into()
            }
        }
    }
}

impl fmt::Display for FileKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Scene => "a scene in TOML",
            Self::Geometry => "a geometry",
            Self::Mesh => "a mesh in Gmsh's format",
            Self::Problem => "a problem file",
            Self::Result => "a result of contact-dd-mpi",
            Self::Checkpoint => "a checkpoint of contact-dd-mpi",
        })
    }
}
