//! Files of other programs given as a mesh, and the commands that convert them.

use std::path::Path;

use crate::error::InputError;

/// What makes a mesh in Gmsh's format of a file.
#[derive(Clone, Copy)]
enum Converter {
    /// Gmsh meshes the geometry.
    Mesher,
    /// Gmsh reads the mesh and saves it as its own.
    Gmsh,
    /// Gmsh can't read it, but the Python package meshio can.
    Meshio,
}

/// A format: its name, the endings of its files, how their contents begin, and its converter.
type Format = (
    &'static str,
    &'static [&'static str],
    &'static str,
    Converter,
);

const FORMATS: [Format; 12] = [
    (
        "a STEP geometry",
        &["step", "stp"],
        "ISO-10303-21",
        Converter::Mesher,
    ),
    (
        "a geometry",
        &["geo", "geo_unrolled", "brep", "iges", "igs"],
        "DBRep_DrawableShape",
        Converter::Mesher,
    ),
    ("an Abaqus mesh", &["inp"], "*", Converter::Meshio),
    ("an Exodus mesh", &["e", "exo"], "CDF", Converter::Meshio),
    ("an XDMF mesh", &["xdmf"], "<Xdmf", Converter::Meshio),
    ("a VTU mesh", &["vtu"], "<VTKFile", Converter::Meshio),
    ("a VTK mesh", &["vtk"], "# vtk", Converter::Gmsh),
    ("a UNV mesh", &["unv"], "-1\n", Converter::Gmsh),
    ("a Medit mesh", &["mesh"], "MeshVersion", Converter::Gmsh),
    (
        "a Nastran mesh",
        &["bdf", "nas", "fem", "dat"],
        "BEGIN BULK",
        Converter::Gmsh,
    ),
    ("an STL surface", &["stl"], "solid", Converter::Gmsh),
    (
        "an HDF5 file, perhaps a MED mesh",
        &["med"],
        "\u{89}HDF",
        Converter::Gmsh,
    ),
];

/// The error about a file that isn't Gmsh's, with the command that converts it where its name's ending
/// or its first `bytes` tell the format.
pub(super) fn refusal(path: &Path, bytes: &[u8]) -> InputError {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let start: String = bytes.iter().take(64).map(|&b| char::from(b)).collect();
    let start = start.trim_start();
    let by_ending = FORMATS.iter().find(|(_, endings, ..)| {
        let ending = ending.as_deref();
        ending.is_some_and(|ending| endings.contains(&ending))
    });
    let by_start = || {
        FORMATS
            .iter()
            .find(|(_, _, first, _)| start.starts_with(first))
    };
    let Some((name, _, _, converter)) = by_ending.or_else(by_start) else {
        return InputError::new("this isn't a Gmsh mesh: expected $MeshFormat in the first line");
    };
    let from = path.display();
    let to = path.with_extension("msh");
    let to = to.display();
    let command = match converter {
        Converter::Mesher => format!("gmsh -2 {from} -o {to}"),
        Converter::Gmsh => format!("gmsh -save {from} -o {to}"),
        Converter::Meshio => format!("meshio convert {from} {to} --output-format gmsh22"),
    };
    InputError::new(format!(
        "is {name}; expected a mesh in Gmsh's format with physical groups: {command}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foreign_format_is_named_with_the_command_that_converts_it() {
        for (name, bytes, expected) in [
            ("p.step", &b""[..], "gmsh -2 p.step -o p.msh"),
            ("p", b"ISO-10303-21;\nHEADER;", "gmsh -2 p -o p.msh"),
            ("p.geo", b"Point(1) = {0, 0, 0};", "gmsh -2 p.geo -o p.msh"),
            (
                "p.INP",
                b"*HEADING",
                "meshio convert p.INP p.msh --output-format gmsh22",
            ),
            ("p.unv", b"    -1\n  2411\n", "gmsh -save p.unv -o p.msh"),
            ("p.msh", b"\x89HDF\r\n\x1a\n", "perhaps a MED mesh"),
            (
                "p.vtu",
                b"<?xml",
                "meshio convert p.vtu p.msh --output-format gmsh22",
            ),
            ("p.msh", b"nodes", "isn't a Gmsh mesh"),
        ] {
            let said = refusal(Path::new(name), bytes).to_string();
            assert!(said.contains(expected), "{name}: {said}");
        }
    }
}
