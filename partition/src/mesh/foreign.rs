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

/// What else is read.
const INP: &str = "a deck of Abaqus or CalculiX whose name ends with .inp";

/// Formats: name, endings of files, converter.
const FORMATS: [(&str, &[&str], Converter); 11] = [
    ("a STEP geometry", &["step", "stp"], Converter::Mesher),
    (
        "a Gmsh geometry",
        &["geo", "geo_unrolled"],
        Converter::Mesher,
    ),
    ("a geometry", &["brep", "iges", "igs"], Converter::Mesher),
    ("an Exodus mesh", &["e", "exo"], Converter::Meshio),
    ("an XDMF mesh", &["xdmf"], Converter::Meshio),
    ("a VTU mesh", &["vtu"], Converter::Meshio),
    ("a VTK mesh", &["vtk"], Converter::Gmsh),
    ("a UNV mesh", &["unv"], Converter::Gmsh),
    ("a Medit mesh", &["mesh"], Converter::Gmsh),
    (
        "a Nastran mesh",
        &["bdf", "nas", "fem", "dat"],
        Converter::Gmsh,
    ),
    (
        "an HDF5 file, perhaps a MED mesh",
        &["med", "h5"],
        Converter::Gmsh,
    ),
];

/// The error about a file that isn't Gmsh's, with the command that converts it where the ending of its
/// name tells the format.
pub(super) fn refusal(path: &Path) -> InputError {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let is_of = |endings: &[&str]| {
        endings
            .iter()
            .any(|&known| Some(known) == ending.as_deref())
    };
    let Some((name, _, converter)) = FORMATS.iter().find(|(_, endings, _)| is_of(endings)) else {
        return InputError::new(format!(
            "this isn't a Gmsh mesh: expected $MeshFormat in the first line, or {INP}"
        ));
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
        "is {name}; expected a mesh in Gmsh's format with physical groups, or {INP}: {command}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foreign_format_is_named_with_the_command_that_converts_it() {
        for (name, expected) in [
            ("p.step", "gmsh -2 p.step -o p.msh"),
            ("p.geo", "gmsh -2 p.geo -o p.msh"),
            ("p.vtu", "meshio convert p.vtu p.msh --output-format gmsh22"),
            ("p.vtu", "ends with .inp"),
            ("p.unv", "gmsh -save p.unv -o p.msh"),
            ("p.med", "perhaps a MED mesh"),
            ("p.msh", "isn't a Gmsh mesh"),
        ] {
            let said = refusal(Path::new(name)).to_string();
            assert!(said.contains(expected), "{name}: {said}");
        }
    }
}
