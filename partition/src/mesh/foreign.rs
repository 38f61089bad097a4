//! Files of other programs given as a mesh, and the commands that convert them.

use std::path::Path;

use crate::error::InputError;

/// The program that converts a file into Gmsh's format.
#[derive(Clone, Copy)]
enum Converter {
    /// Gmsh meshes the geometry.
    Mesher,
    /// Gmsh fills the surface with cells, given a geometry of the enclosed volume.
    Filler,
    /// Gmsh reads the mesh and saves it in its own format.
    Gmsh,
    /// Gmsh can't read it, but the Python package meshio can.
    Meshio,
    /// The file isn't a mesh: the advice.
    Other(&'static str),
}

/// The other supported format.
const INP: &str = "a deck of Abaqus or CalculiX whose name ends with .inp";

/// A format: name, file extensions, converter.
type Format = (&'static str, &'static [&'static str], Converter);

/// Formats recognized by the extension of a name.
const FORMATS: [Format; 27] = [
    ("a STEP geometry", &["step", "stp"], Converter::Mesher),
    (
        "a Gmsh geometry",
        &["geo", "geo_unrolled"],
        Converter::Mesher,
    ),
    (
        "a geometry",
        &["brep", "iges", "igs", "xao"],
        Converter::Mesher,
    ),
    ("an STL surface", &["stl"], Converter::Filler),
    (
        "a surface",
        &["ply", "ply2", "off", "obj", "wrl"],
        Converter::Filler,
    ),
    ("an Exodus mesh", &["e", "exo", "ex2"], Converter::Meshio),
    ("an XDMF mesh", &["xdmf", "xmf"], Converter::Meshio),
    ("a VTU mesh", &["vtu"], Converter::Meshio),
    ("an SU2 mesh", &["su2"], Converter::Meshio),
    ("a Netgen mesh", &["vol"], Converter::Meshio),
    ("a TetGen mesh", &["ele", "node"], Converter::Meshio),
    ("a mesh of DOLFIN", &["xml"], Converter::Meshio),
    ("a Tecplot mesh", &["tec"], Converter::Meshio),
    ("a mesh of AVS-UCD", &["avs"], Converter::Meshio),
    ("a Permas mesh", &["post", "dato"], Converter::Meshio),
    ("a VTK mesh", &["vtk"], Converter::Gmsh),
    ("a UNV mesh", &["unv"], Converter::Gmsh),
    ("a Medit mesh", &["mesh", "meshb"], Converter::Gmsh),
    ("a CGNS mesh", &["cgns"], Converter::Gmsh),
    (
        "a Nastran mesh",
        &["bdf", "nas", "fem", "dat"],
        Converter::Gmsh,
    ),
    (
        "an LS-DYNA deck",
        &["k", "key"],
        Converter::Other("save the mesh as one of Gmsh or Abaqus"),
    ),
    (
        "an Ansys deck",
        &["cdb"],
        Converter::Other("save the mesh as one of Gmsh or Abaqus"),
    ),
    (
        "a COMSOL mesh",
        &["mphtxt", "mphbin"],
        Converter::Other("export the mesh as one of Nastran, which gmsh -save converts"),
    ),
    (
        "a file of results of CalculiX",
        &["frd"],
        Converter::Other("take the deck that they were made from"),
    ),
    (
        "a file of results of Abaqus",
        &["odb", "fil"],
        Converter::Other("take the deck that they were made from"),
    ),
    (
        "a result of contact-dd-mpi",
        &["vtkhdf"],
        Converter::Other("take the mesh that it was made from"),
    ),
    (
        "an HDF5 file, perhaps a MED mesh",
        &["med", "h5", "hdf"],
        Converter::Gmsh,
    ),
];

/// Formats recognized by the first bytes of a file, whatever its name.
const BEGINNINGS: [(&[u8], Format); 3] = [
    (b"$NOD", ("an MSH mesh of version 1", &[], Converter::Gmsh)),
    (b"(", ("a Fluent mesh", &[], Converter::Meshio)),
    (b"solid", ("an STL surface", &[], Converter::Filler)),
];

/// The error for a file in another format that begins with `head`, with the command that converts it if the format is
/// known.
pub(super) fn refusal(path: &Path, head: &[u8]) -> InputError {
    let by_head = || {
        let head = head.trim_ascii_start();
        let format = BEGINNINGS.iter().find(|(first, _)| head.starts_with(first));
        format.map(|(_, format)| format)
    };
    let Some((name, _, converter)) = by_name(path).or_else(by_head) else {
        return InputError::new(format!(
            "this isn't a Gmsh mesh: expected $MeshFormat in the first line, or {INP}"
        ));
    };
    let from = path.display();
    let to = match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("msh") => path.with_extension("2.msh"),
        _ => path.with_extension("msh"),
    };
    let to = to.display();
    let command = match converter {
        Converter::Mesher => {
            format!("gmsh -2 {from} -o {to}, of bodies in space gmsh -3 {from} -o {to}")
        }
        Converter::Filler => format!(
            "a geometry with Merge \"{from}\"; Surface Loop(1) = {{1}}; Volume(1) = {{1}}; Physical Volume(\"body\") = {{1}}; \
             is meshed by gmsh -3"
        ),
        Converter::Gmsh => format!("gmsh -save -format msh41 {from} -o {to}"),
        Converter::Meshio => format!("meshio convert {from} {to} --output-format gmsh22"),
        Converter::Other(what) => (*what).to_owned(),
    };
    InputError::new(format!(
        "is {name}; expected a mesh in Gmsh's format with physical groups, or {INP}: {command}"
    ))
}

fn by_name(path: &Path) -> Option<&'static Format> {
    let ending = path.extension()?.to_string_lossy().to_lowercase();
    (FORMATS.iter()).find(|(_, endings, _)| endings.contains(&&*ending))
}

/// Kind of a file that isn't a scene, by its name and first bytes.
pub fn instead_of_scene(path: &Path, head: &[u8]) -> Option<&'static str> {
    if head.trim_ascii_start().starts_with(b"$MeshFormat") {
        return Some("a mesh in Gmsh's format");
    }
    let ending = path.extension()?.to_string_lossy().to_lowercase();
    match &*ending {
        "msh" => Some("a mesh"),
        "inp" => Some("a deck of Abaqus or CalculiX"),
        "h5" => Some("an HDF5 file, perhaps a problem file, which contact-dd-mpi solves"),
        _ => by_name(path).map(|(name, ..)| *name),
    }
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
            ("p.unv", "gmsh -save -format msh41 p.unv -o p.msh"),
            ("p.med", "perhaps a MED mesh"),
            ("p.stl", "is an STL surface … Merge \"p.stl\""),
            ("p.STL", "is an STL surface"),
            ("p.su2", "is an SU2 mesh … meshio convert p.su2 p.msh"),
            ("p.cgns", "is a CGNS mesh"),
            ("p.frd", "is a file of results of CalculiX"),
            ("p.msh", "isn't a Gmsh mesh"),
        ] {
            let printed = refusal(Path::new(name), b"").to_string();
            let mut rest = &printed[..];
            for part in expected.split(" … ") {
                let at = rest.find(part);
                assert!(at.is_some(), "{name}: {printed}");
                rest = &rest[at.unwrap_or_default()..];
            }
        }
    }

    #[test]
    fn a_format_without_an_ending_of_its_own_is_told_by_its_first_bytes() {
        for (head, expected) in [
            (&b"$NOD\n8\n"[..], "an MSH mesh of version 1"),
            (b"(0 \"GAMBIT to Fluent File\")", "a Fluent mesh"),
            (b"solid part\n facet normal", "an STL surface"),
        ] {
            let printed = refusal(Path::new("p.msh"), head).to_string();
            assert!(printed.contains(expected), "{printed}");
            assert!(
                !printed.contains("-o p.msh"),
                "the file isn't written over: {printed}"
            );
        }
    }
}
