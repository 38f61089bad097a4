//! The command line of contact-dd-partition.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Parser, ValueHint};

use crate::element::ElementKind;
use crate::example::EXAMPLES;
use crate::manual::{Document, Manual};
use crate::solver::count;

/// Text of the manual other than the options.
pub const MANUAL: Manual = Manual {
    examples: &[
        (
            "contact-dd-partition scene.toml -n 8 -o problem.h5",
            "makes a problem file of a scene and its mesh",
        ),
        (
            "contact-dd-partition part.inp -o problem.h5",
            "makes a problem file of a deck of Abaqus or CalculiX",
        ),
        (
            "contact-dd-partition part.inp --write-scene my-scene",
            "translates a deck into a scene and its mesh",
        ),
        (
            "contact-dd-partition --example granite --write-scene my-scene",
            "writes a scene and its mesh to start from",
        ),
        (
            "contact-dd-partition --example granite --refine 2 -n 8 -o granite.h5",
            "makes a problem file of a built-in scene with a mesh four times as fine",
        ),
        (
            "contact-dd-partition --info problem.h5",
            "prints the contents of a problem file",
        ),
    ],
    exit_codes: &[
        ("0", "done"),
        (
            "2",
            "bad usage or bad input; the message says where and what was expected",
        ),
        ("5", "the output can't be written"),
    ],
    files: &[
        (
            "scene.toml",
            "the scene: materials, bodies, supports, loads and contacts by physical group",
        ),
        (
            "mesh.msh",
            "its mesh, in Gmsh's format 4.1 or 2.2, beside the scene",
        ),
        (
            "problem.h5",
            "the problem file; it gets its name when it is complete",
        ),
    ],
    environment: &[
        ("NO_COLOR", "no colours, not even on a terminal"),
        ("CLICOLOR_FORCE", "colours wherever the output goes"),
    ],
    see_also: "contact-dd-mpi",
};

/// Splits a scene into subdomains and writes the problem file that contact-dd-mpi solves
#[derive(Clone, Debug, Parser)]
#[command(name = "contact-dd-partition", version, max_term_width = 100,
          override_usage = "contact-dd-partition [OPTIONS] SCENE.toml\n       contact-dd-partition [OPTIONS] DECK.inp\n       contact-dd-partition [OPTIONS] --example NAME\n       contact-dd-partition --info FILE.h5",
          after_help = MANUAL.in_short(), after_long_help = MANUAL.at_length())]
pub struct CommandLine {
    /// The scene, or a deck of Abaqus or CalculiX, whose name ends with .inp
    #[arg(value_name = "SCENE.toml", value_hint = ValueHint::FilePath,
          required_unless_present_any = ["example", "list_examples", "info", "generate", "explain"])]
    pub scene: Option<PathBuf>,

    /// Number of subdomains [default: by size]
    ///
    /// By default each has about 2000 degrees of freedom.
    #[arg(
        short = 'n',
        long,
        value_name = "N",
        allow_negative_numbers = true,
        value_parser = count::<usize>,
        help_heading = "Problem file"
    )]
    pub subdomains: Option<usize>,

    /// Approximate number of clusters of subdomains for contact-dd-mpi --interface iterative [default: by size]
    #[arg(long, value_name = "N", value_parser = count::<usize>, help_heading = "Problem file")]
    pub clusters: Option<usize>,

    /// Problem file to write [default: the scene's stem + .h5]
    #[arg(short, long, value_name = "FILE.h5", help_heading = "Problem file",
          value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    /// Print the contents of a problem file, and exit
    #[arg(long, value_name = "FILE.h5", help_heading = "Problem file", exclusive = true,
          value_hint = ValueHint::FilePath)]
    pub info: Option<PathBuf>,

    /// Use a built-in scene
    #[arg(
        long,
        value_name = "NAME",
        conflicts_with = "scene",
        help_heading = "Built-in scenes",
        value_parser = examples()
    )]
    pub example: Option<String>,

    /// List the built-in scenes
    #[arg(long, exclusive = true, help_heading = "Built-in scenes")]
    pub list_examples: bool,

    /// Halve the mesh size of the built-in scene K times
    #[arg(
        long,
        value_name = "K",
        requires = "example",
        conflicts_with = "scene",
        default_value_t = 0,
        value_parser = count::<u32>,
        help_heading = "Built-in scenes"
    )]
    pub refine: u32,

    /// Cells of the built-in scene [default: triangle3, in space the scene's own]
    ///
    /// In the plane: triangles and quadrilaterals; in space: tetrahedra and hexahedra. Where the mesh size changes, there are triangles between quadrilaterals.
    #[arg(long, value_name = "KIND", requires = "example", conflicts_with = "scene",
          value_parser = elements(), help_heading = "Built-in scenes")]
    pub element: Option<ElementKind>,

    /// Write scene.toml and mesh.msh of the deck or the built-in scene into DIR
    ///
    /// The problem file is then written only with -o.
    #[arg(long, value_name = "DIR", help_heading = "Problem file", value_hint = ValueHint::DirPath)]
    pub write_scene: Option<PathBuf>,

    /// Write the requests of the deck's *NODE PRINT and *EL PRINT, for contact-dd run, which writes their tables
    #[arg(long, value_name = "FILE.json", conflicts_with = "example", help_heading = "Problem file",
          value_hint = ValueHint::FilePath)]
    pub write_prints: Option<PathBuf>,

    /// Print the man page or completions for a shell
    #[arg(
        long,
        value_name = "KIND",
        exclusive = true,
        help_heading = "Documentation"
    )]
    pub generate: Option<Document>,

    /// Explain a message by its name, given in brackets at its end
    #[arg(
        long,
        value_name = "NAME",
        exclusive = true,
        help_heading = "Documentation"
    )]
    pub explain: Option<String>,
}

/// The names of the built-in scenes, with what each shows.
fn examples() -> PossibleValuesParser {
    let names = EXAMPLES.iter();
    PossibleValuesParser::new(names.map(|e| PossibleValue::new(e.name).help(e.about)))
}

/// The kinds of cells by name.
fn elements() -> impl TypedValueParser<Value = ElementKind> {
    const KINDS: [(&str, ElementKind); 10] = [
        ("triangle3", ElementKind::Triangle3),
        ("triangle6", ElementKind::Triangle6),
        ("quad4", ElementKind::Quad4),
        ("quad8", ElementKind::Quad8),
        ("quad9", ElementKind::Quad9),
        ("tetrahedron4", ElementKind::Tetrahedron4),
        ("tetrahedron10", ElementKind::Tetrahedron10),
        ("hexahedron8", ElementKind::Hexahedron8),
        ("hexahedron20", ElementKind::Hexahedron20),
        ("hexahedron27", ElementKind::Hexahedron27),
    ];
    PossibleValuesParser::new(KINDS.map(|(name, _)| name)).try_map(|name| {
        let found = KINDS.iter().find(|(known, _)| *known == name);
        found.map(|&(_, kind)| kind).ok_or("unknown")
    })
}
