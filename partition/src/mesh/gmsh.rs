//! Gmsh's MSH format, versions 4.1 and 2.2, ASCII and binary.
//!
//! The reader belongs to this project: the crate `mshio` drops node tags without gaps, even unordered ones, and
//! supports neither names of physical groups nor parametric nodes nor version 2.2.
//!
//! Cells are the elements of the highest dimension. Cells, facets and nodes are in ascending order of their tags,
//! whatever their order in the file. Nodes without cells are dropped, and so are cells outside all physical groups if
//! other cells are in one. A physical group without a name is called by its number; a name used in several dimensions
//! gets the dimension appended, "7 (curve)" and "7 (surface)".

mod content;
mod cursor;
mod element_type;
mod import;
mod names;
mod version2;
mod version4;
mod write;

use std::io::Read as _;
use std::path::Path;

use self::content::Content;
use self::cursor::{Cursor, Encoding, shown};
use super::{Mesh, foreign};
use crate::error::InputError;
use crate::source;

pub use self::write::{write, write_to};

/// Number of bytes within which a mesh is recognized.
const HEAD: u64 = 1 << 20;

/// Reads a mesh.
///
/// # Errors
/// The error in the file and its position: the line of an ASCII file, section and byte of a binary one, tags of nodes
/// and elements.
pub fn read(path: &Path) -> Result<Mesh, InputError> {
    read_unnamed(path).map_err(|error| error.in_file(path))
}

fn read_unnamed(path: &Path) -> Result<Mesh, InputError> {
    let unreadable = |e: std::io::Error| InputError::new(format!("the mesh can't be read: {e}"));
    let mut file = source::open(path, "a mesh in Gmsh's format")?;
    let mut bytes = Vec::new();
    // A file that doesn't start as a mesh isn't read to its end, as it may be long.
    (&mut file)
        .take(HEAD)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    let first = b"$MeshFormat";
    if !bytes.windows(first.len()).any(|w| w == first) {
        return Err(foreign::refusal(path, &bytes));
    }
    file.read_to_end(&mut bytes).map_err(unreadable)?;
    parse(&bytes)
}

/// Reads a mesh from the bytes of an MSH file.
///
/// # Errors
/// Errors of [`read`].
pub fn parse(bytes: &[u8]) -> Result<Mesh, InputError> {
    import::mesh(contents(bytes)?)
}

/// Version of a file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    V2,
    V4,
}

fn contents(bytes: &[u8]) -> Result<Content, InputError> {
    let mut cursor = Cursor::new(bytes);
    let mut content = Content::default();
    let mut version = None;
    while let Some(section) = cursor.next_section()? {
        match (section, version) {
            ("MeshFormat", _) => version = Some(mesh_format(&mut cursor)?),
            ("Comments", _) => {
                cursor.skip_section(section)?;
                continue;
            }
            (_, None) => {
                return Err(InputError::new(format!(
                    "this isn't a Gmsh mesh of version 4.1 or 2.2: expected $MeshFormat first, found ${section}"
                )));
            }
            ("PhysicalNames", _) => content.names = names::read(&mut cursor)?,
            (name @ ("Entities" | "PartitionedEntities"), Some(Version::V4)) => {
                version4::entities(&mut cursor, &mut content, name != "Entities")?;
            }
            ("Nodes", Some(Version::V4)) => version4::nodes(&mut cursor, &mut content)?,
            ("Elements", Some(Version::V4)) => version4::elements(&mut cursor, &mut content)?,
            ("Nodes", Some(Version::V2)) => version2::nodes(&mut cursor, &mut content, false)?,
            ("ParametricNodes", Some(Version::V2)) => {
                version2::nodes(&mut cursor, &mut content, true)?;
            }
            ("Elements", Some(Version::V2)) => version2::elements(&mut cursor, &mut content)?,
            _ => {
                cursor.skip_section(section)?;
                continue;
            }
        }
        cursor.end_section(section)?;
    }
    if version.is_none() {
        return Err(InputError::new(
            "this isn't a Gmsh mesh: expected $MeshFormat in the first line",
        ));
    }
    for (section, empty) in [
        ("Nodes", content.nodes.is_empty()),
        ("Elements", content.blocks.is_empty()),
    ] {
        if empty {
            return Err(InputError::new(format!(
                "the mesh is empty, it has no ${section}; expected one that gmsh -2, in space gmsh -3, has made of a geometry"
            )));
        }
    }
    Ok(content)
}

/// Reads the body of `$MeshFormat` and sets the cursor to its encoding.
fn mesh_format(cursor: &mut Cursor) -> Result<Version, InputError> {
    let line = cursor.line("version, file type and data size")?;
    let words: Vec<&str> = line.split_whitespace().collect();
    let (number, file_type, data_size) = match words[..] {
        [number, file_type, data_size] => (number, file_type, data_size),
        _ => {
            return Err(cursor.error(format!(
                "expected version, file type and data size, such as `4.1 0 8`, found `{}`",
                shown(line.as_bytes())
            )));
        }
    };
    let version = match number {
        "4.1" => Version::V4,
        "2.2" => Version::V2,
        _ => {
            return Err(cursor.error(format!(
                "MSH version {number} isn't supported; expected 4.1 or 2.2 \
                 (`gmsh -save -format msh41 …` converts)"
            )));
        }
    };
    let size_bytes = match (data_size, version) {
        ("8", _) => 8,
        ("4", Version::V4) => 4,
        _ => {
            return Err(cursor.error(format!("expected the data size 8, found {data_size}")));
        }
    };
    match file_type {
        "0" => {}
        "1" => {
            let big_endian = cursor.byte_order()?;
            cursor.set_encoding(Encoding::Binary {
                big_endian,
                size_bytes,
            });
        }
        _ => {
            return Err(cursor.error(format!(
                "expected the file type 0 (ASCII) or 1 (binary), found {file_type}"
            )));
        }
    }
    Ok(version)
}
