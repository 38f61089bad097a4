//! What a file is, for whoever gave the wrong one of the files that the programs know.

use std::fmt;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use crate::error::InputError;
use crate::problem::FORMAT;
use crate::problem::strings::read_strings;

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
            return Self::of_hdf5(path);
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

    fn of_hdf5(path: &Path) -> Option<Self> {
        let file = open(path)?;
        let names = file.attr_names().ok()?;
        let has = |name: &str| names.iter().any(|known| known == name);
        if has("format") {
            let format = read_strings(&*file.attr("format").ok()?).ok()?;
            return (format.first()? == FORMAT).then_some(Self::Problem);
        }
        has("report").then_some(Self::Result)
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
        let problem = problem_of(path);
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
            Self::Result => match problem {
                Some(problem) => format!("ParaView opens {path}; it was made from {problem}"),
                None => format!("ParaView opens {path}"),
            },
            Self::Checkpoint => {
                "contact-dd-mpi goes on from it with --restart and the problem file".into()
            }
        }
    }
}

/// The problem file that a result was made from, as its report says.
fn problem_of(result: &Path) -> Option<String> {
    let file = open(result)?;
    let report = read_strings(&*file.attr("report").ok()?).ok()?;
    let report: serde_json::Value = serde_json::from_str(report.first()?).ok()?;
    Some(report["settings"]["problem"].as_str()?.to_owned())
}

/// Opens an HDF5 file without a word where it can't be.
fn open(path: &Path) -> Option<hdf5::File> {
    hdf5::silence_errors(true);
    hdf5::File::with_options()
        .with_fapl(|access| access.file_locking(false))
        .open(path)
        .ok()
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
